//! Compares spreads and yields predicted by derivatives with solved samples.

use uncertainty::{DesignTolerance, MeasureTolerance};

use crate::{sweep, tolerance};

/// Measures with derivatives.
const ALL: &str = "'coverage', 'puncture', 'flexure'";

const DESIGN: &str = "gap_over_t = 0.23\nlength_over_t = 0.7\nslant_deg = 52";

fn measure<'d>(design: &'d DesignTolerance, name: &str) -> &'d MeasureTolerance {
    design.measures.iter().find(|measure| measure.name == name).expect("a measure")
}

/// Asserts that predicted and sampled spread agree within four standard errors plus 1 %.
fn assert_agree(measure: &MeasureTolerance) {
    let sampled = measure.sampled.as_ref().expect("samples");
    let allowed = 0.01 + 4.0 * sampled.spread_error / sampled.spread;
    let off = measure.discrepancy().expect("a predicted and a sampled spread");
    assert!(off.abs() < allowed, "{}: off by {off}, {measure:?}", measure.name);
}

#[test]
fn batch_spreads_agree_with_the_linear_prediction() {
    let lines = "[puncture]\nscales = 21\n[material]\nthickness_mm = 8\nsubstrate_modulus_MPa = 0.31\n\
                 membrane_modulus_MPa = 4.5\nscale_density_kg_m3 = 1200\n[tolerance]\n\
                 gap_mm = { batch_sd = 0.002 }\nlength_over_t = { batch_within = 0.0005 }\n\
                 slant_deg = { batch_sd = 0.01 }\nthickness_mm = { batch_sd = 0.002 }\n\
                 substrate_modulus_MPa = { batch_sd = 1e-4 }\nmembrane_modulus_MPa = { batch_sd = 1e-3 }\n\
                 scale_density_kg_m3 = { batch_sd = 1 }\nc1 = { batch_sd = 1e-3 }";
    let design = tolerance(&sweep(ALL, DESIGN, lines), &[], 300);
    let compared: Vec<_> = design.measures.iter().filter(|m| m.discrepancy().is_some()).collect();
    // The compared columns are dimensionless columns, columns in mm and N, and the areal mass.
    assert!(compared.len() > 25, "{}", compared.len());
    for measure in compared {
        assert_agree(measure);
    }
    let force = measure(&design, "critical_force_N").linear.as_ref().expect("a spread");
    assert_eq!(force.sources.len(), 8);
    let shares: f64 = force.sources.iter().map(|source| source.share).sum();
    assert!((shares - 1.0).abs() < 1e-12);
    // Slant and contact law do not change the areal mass.
    let mass = measure(&design, "areal_mass_kg_m2").linear.as_ref().expect("a spread");
    let [slant, law, density] = ["slant_deg", "c1", "scale_density_kg_m3"]
        .map(|key| mass.sources.iter().find(|s| s.source == key).expect("a source").share);
    assert!(slant == 0.0 && law == 0.0 && density > 0.1, "{slant} {law} {density}");
}

#[test]
fn scatter_spreads_agree_with_the_linear_prediction() {
    for scales in ["\"auto\"", "9"] {
        let lines = format!(
            "[puncture]\nscales = {scales}\n[flexure]\ngaps = 8\nmax_end_rotation_deg = 1\n[tolerance]\n\
             gap_over_t = {{ scale_sd = 0.0005 }}\nslant_deg = {{ scale_sd = 0.004 }}"
        );
        let design = tolerance(&sweep(ALL, DESIGN, &lines), &[], 300);
        let names =
            ["critical_force", "penetration", "critical_displacement", "initial_compliance"];
        for name in names {
            assert_agree(measure(&design, name));
        }
        let force = measure(&design, "critical_force").linear.as_ref().expect("a spread");
        assert!(force.sources.iter().all(|source| source.share > 0.001), "{force:?}");
    }
}

#[test]
fn independent_deviations_of_gaps_partly_cancel() {
    let [together, single] = ["batch_sd", "scale_sd"].map(|level| {
        let lines = format!("[tolerance]\ngap_over_t = {{ {level} = 0.001 }}");
        let design = tolerance(&sweep(ALL, DESIGN, &lines), &[], 0);
        measure(&design, "initial_compliance").linear.as_ref().expect("a spread").spread
    });
    // The strip has the length 100 t and the pitch 0.93 t, so 107.5 gaps, rounded to 108.
    let ratio = together / single;
    assert!((ratio - 108.0_f64.sqrt()).abs() < 0.06, "{ratio}");
}

#[test]
fn yield_is_the_fraction_of_samples_that_meet_the_requirement() {
    let sweep = sweep("'coverage'", DESIGN, "[tolerance]\ngap_over_t = { batch_sd = 0.02 }");
    let design = tolerance(&sweep, &["coverage >= 0.62", "gap_over_t <= 0.23"], 400);
    let [coverage, gap, all] = design.yields.as_slice() else { panic!("three yields") };
    let shares = [coverage, gap, all].map(|of| of.proportion.expect("samples").share());
    // The limit of the gap is its nominal value, which half of the samples do not exceed.
    let [low, high] = gap.proportion.expect("samples").interval();
    assert!(low < 0.5 && 0.5 < high, "{low} {high}");
    assert!(shares[2] <= shares[0].min(shares[1]) && shares[2] > 0.2, "{shares:?}");
    let [low, high] = coverage.proportion.expect("samples").interval();
    let predicted = coverage.linear.expect("a prediction");
    assert!(low < predicted && predicted < high, "{predicted} {low} {high}");
}
