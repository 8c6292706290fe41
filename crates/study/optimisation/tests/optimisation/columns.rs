//! Compares derivatives of columns from extrapolated rows with differences of solved designs.

use results::columns::{Cell, design_columns};
use results::{Column, DesignRow, SlopeSide};
use run::Evaluator;
use sweep::{Case, Measure, Parameter, Sweep};

const TEXT: &str = "name = 'x'\n[designs]\ngap_over_t = 0.37\nlength_over_t = 0.81\nslant_deg = 41\n\
    [material]\nthickness_mm = 1.3\nsubstrate_modulus_MPa = 0.4\nmembrane_modulus_MPa = 2\nscale_density_kg_m3 = 1100\n";

/// Solves `case` as the first design of `sweep`.
fn solved(evaluator: &Evaluator, sweep: &Sweep, case: &Case) -> DesignRow {
    evaluator.solve(sweep.grid().number(0), case).row
}

/// Returns the number in a column; `None` for an empty cell or text.
fn value(column: &Column<DesignRow>, row: &DesignRow) -> Option<f64> {
    match column.cell(row) {
        Cell::Number(number) => Some(number),
        _ => None,
    }
}

#[test]
fn extrapolated_columns_match_solved_designs() {
    let keys = ["gap_over_t", "length_over_t", "slant_deg", "poisson_ratio", "thickness_mm"];
    assert_extrapolation_matches_solutions(TEXT, &keys);
}

/// Tests derivatives with respect to lengths in mm.
///
/// The results depend on lengths divided by the thickness, and the length of a scale follows from
/// pitch and gap.
#[test]
fn extrapolated_columns_match_solved_designs_for_lengths_in_mm() {
    let text = "name = 'x'\ndesigns = { gap_mm = 0.48, pitch_mm = 1.53, slant_deg = 41 }\n\
        scale.width_mm = 1.5\nflexure.membrane_thickness_mm = 0.2\n\
        [material]\nthickness_mm = 1.3\nsubstrate_modulus_MPa = 0.4\nmembrane_modulus_MPa = 2\nscale_density_kg_m3 = 1100\n";
    let keys = ["gap_mm", "pitch_mm", "width_mm", "membrane_thickness_mm", "thickness_mm"];
    assert_extrapolation_matches_solutions(text, &keys);
}

/// Tests derivatives with respect to moduli.
///
/// The modulus of the scales changes both ratios of moduli. The scales are soft, so that the
/// contact is compliant and the ratios affect the results.
#[test]
fn extrapolated_columns_match_solved_designs_for_moduli_of_soft_scales() {
    let text = format!("{TEXT}scale_modulus_MPa = 8\n");
    let keys = ["substrate_modulus_MPa", "membrane_modulus_MPa", "scale_modulus_MPa"];
    assert_extrapolation_matches_solutions(&text, &keys);
    let sweep = Sweep::parse(&text, "x.toml", &[]).expect("a sweep");
    assert!(
        keys.iter().all(|key| sweep.has_followers(Parameter::named(key).expect("a parameter")))
    );
}

/// Asserts that a step of each parameter in `keys` changes extrapolated and solved columns equally.
fn assert_extrapolation_matches_solutions(text: &str, keys: &[&str]) {
    let sweep = Sweep::parse(text, "x.toml", &[]).expect("a sweep");
    let case = sweep.grid().case(0);
    let all = Evaluator::new(&Measure::ALL);
    let plain = Evaluator::new(&Measure::USUAL);
    let row = solved(&all, &sweep, &case);
    let mut compared = 0;
    for key in keys {
        let parameter = Parameter::named(key).expect("a parameter");
        let step = 1e-4 * parameter.size(&case).expect("a size");
        let [below, above] = [-step, step]
            .map(|by| solved(&plain, &sweep, &parameter.moved(&case, by).expect("a case")));
        let [low, high] = [-step, step]
            .map(|by| row.extrapolated_by(parameter, by, SlopeSide::Right).expect("a number"));
        for column in design_columns(&sweep) {
            let name = column.name.as_ref();
            let numbers = [&below, &above, &low, &high].map(|row| value(&column, row));
            let [Some(below), Some(above), Some(low), Some(high)] = numbers else { continue };
            if name.ends_with("_error") || name.contains("strain") {
                continue;
            }
            let (solved, extrapolated) = (above - below, high - low);
            let size = above.abs().max(below.abs());
            assert!(
                (solved - extrapolated).abs() <= 2e-4 * solved.abs() + 1e-9 * size,
                "{name} by {key}: change {solved} if solved, {extrapolated} if extrapolated"
            );
            compared += 1;
        }
    }
    assert!(compared > 24 * keys.len(), "{compared}");
}

#[test]
fn values_without_derivatives_are_not_extrapolated() {
    let sweep = Sweep::parse(TEXT, "x.toml", &[]).expect("a sweep");
    let case = sweep.grid().case(0);
    let row = solved(&Evaluator::new(&Measure::USUAL), &sweep, &case);
    for (key, affects_force, affects_compliance) in [
        ("gap_over_t", true, true),
        // Poisson's ratio of the substrate affects puncture but not bending. The thickness in mm
        // affects neither puncture nor bending.
        ("poisson_ratio", true, false),
        ("thickness_mm", false, false),
    ] {
        let parameter = Parameter::named(key).expect("a parameter");
        let moved =
            row.extrapolated(&parameter.moved(&case, 1e-3).expect("a case"), SlopeSide::Left);
        let [before, after] = [&row, &moved].map(|row| {
            let puncture = row.result.puncture.expect("a solved path").measures;
            [
                puncture.critical_force,
                row.result.flexure.expect("a solved path").measures.compliance,
            ]
        });
        assert_eq!(after[0], before[0].filter(|_| !affects_force), "{key}");
        assert_eq!(after[1], before[1].filter(|_| !affects_compliance), "{key}");
    }
}

#[test]
fn compliance_of_upright_scales_has_the_derivative_of_the_closed_form() {
    let sweep = Sweep::parse(&TEXT.replace("slant_deg = 41", "slant_deg = 0"), "x.toml", &[])
        .expect("a sweep");
    let row = solved(&Evaluator::new(&Measure::ALL), &sweep, &sweep.grid().case(0));
    assert!(row.result.failures.is_empty(), "{:?}", row.result.failures);
    let derivative = row
        .result
        .sensitivity
        .iter()
        .find(|derivative| {
            derivative.measure == "compliance" && derivative.parameter == "gap_over_t"
        })
        .expect("a derivative");
    // The compliance is C = d/p.
    let (gap, length) = (0.37_f64, 0.81);
    let expected = length / (gap + length).powi(2);
    assert!(
        (derivative.derivative().expect("a derivative without a kink") - expected).abs() < 1e-9
    );
}
