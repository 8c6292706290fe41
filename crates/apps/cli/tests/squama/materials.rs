//! A material adds columns in physical units and changes nothing else.

use crate::table::{cells, columns};
use crate::{FEW, Place};

const MATERIAL: &str = "[material]\nthickness_mm = 2\nsubstrate_modulus_MPa = 0.3\n\
                        membrane_modulus_MPa = 4.5\nscale_density_kg_m3 = 1200\n";

fn numbers(table: &str, column: &str) -> Vec<f64> {
    cells(table, column).iter().map(|cell| cell.parse().expect("a number")).collect()
}

#[test]
fn a_material_adds_columns_and_changes_none() {
    let place = Place::with(FEW);
    std::fs::write(place.path("y.toml"), format!("{FEW}{MATERIAL}")).expect("writable");
    place.squama("run x.toml -q --out bare").assert().code(0);
    place.squama("run y.toml -q --out given").assert().code(0);
    for table in ["designs", "coverage", "critical_force", "penetration", "compliance"] {
        let [bare, given] =
            ["bare", "given"].map(|folder| place.read(&format!("{folder}/{table}.csv")));
        for (bare, given) in bare.lines().zip(given.lines()) {
            assert!(given.len() > bare.len() && given.starts_with(bare), "{table}: {given}");
        }
    }
    let table = place.read("given/designs.csv");
    let by_hand = |column: &str, of: &str, unit: fn(f64, f64) -> f64| {
        let lengths = numbers(&table, "length_over_t");
        let values = numbers(&table, of).into_iter().zip(lengths);
        for (found, (value, length)) in numbers(&table, column).into_iter().zip(values) {
            let expected = unit(value, length);
            assert!((found - expected).abs() <= 1e-12 * expected, "{column}: {found} {expected}");
        }
    };
    // E_s/(1 − ν²) = 0.4 MPa; I_m = 2 · 0.25³/12 mm⁴.
    by_hand("critical_force_N", "critical_force", |value, length| value * 0.4 * length * 4.0);
    by_hand("penetration_mm", "penetration", |value, _| 2.0 * value);
    by_hand("bend_radius_mm", "contact_curvature", |value, _| 2.0 / value);
    by_hand("flexural_rigidity_N_mm2", "compliance", |value, _| {
        4.5 * 2.0 * 0.25_f64.powi(3) / 12.0 / value
    });
    by_hand("areal_mass_kg_m2", "gap_over_t", |gap, length| 2.4 * length / (length + gap));
    insta::assert_snapshot!(
        columns(&table)
            .skip_while(|name| *name != "critical_force_N")
            .collect::<Vec<_>>()
            .join(" ")
    );
}

#[test]
fn missing_material_constants_add_no_columns() {
    let place = Place::with(FEW);
    let length = "run x.toml -q --out r --set material.thickness_mm=2 --set measures=coverage";
    place.squama(length).assert().code(0);
    let table = place.read("r/designs.csv");
    assert!(columns(&table).any(|name| name == "penetration_mm"));
    assert!(!columns(&table).any(|name| name.ends_with("_N") || name == "areal_mass_kg_m2"));
    insta::assert_snapshot!(place.refused("check x.toml --set material.thickness_mm=0"), @"error: --set material.thickness_mm=0: material.thickness_mm: 0 is out of range, expected a length of at least 1e-6 and at most 1000000000");
    insta::assert_snapshot!(place.refused("check x.toml --set material.thickness=1"), @"error: --set material.thickness=1: material.thickness: unknown key (its value is 1), did you mean material.thickness_mm?");
}

#[test]
fn a_material_may_vary_and_is_shown() {
    let place = Place::with(FEW);
    std::fs::write(place.path("y.toml"), format!("{FEW}{MATERIAL}")).expect("writable");
    let vary = "--set designs.thickness_mm=[1,2] --set designs.gap_over_t=0.1";
    place.squama(&format!("run y.toml -q --out r {vary}")).assert().code(0);
    let table = place.read("r/designs.csv");
    assert_eq!(numbers(&table, "thickness_mm")[..4], [1.0, 1.0, 2.0, 2.0]);
    let text = place.prints("rank r --require critical_force_N>=0 --minimize areal_mass_kg_m2");
    assert!(text.contains("Best by least areal_mass_kg_m2\n"), "{text}");
    let text = place.prints("check y.toml");
    assert!(
        text.contains("contact modulus  2903.1 MPa in puncture, 3001.5 MPa in bending"),
        "{text}"
    );
    let text = place.prints("design y.toml --design 4");
    assert!(text.contains("critical_force  ") && text.contains("critical_force_N  "), "{text}");
    place.prints("draw y.toml --design 4 --out d");
    assert!(place.read("d/design-0004-puncture-at-critical-tilt.svg").contains(" mm"));
}

#[test]
fn suspicious_units_of_a_modulus_are_noted_and_the_scale_modulus_sets_contact_ratios() {
    let place = Place::with(
        "name = 'x'\ndesigns = { gap_over_t = 0.2, length_over_t = 1, slant_deg = 45 }\n[material]\n\
         thickness_mm = 2\nsubstrate_modulus_MPa = 310000\nmembrane_modulus_MPa = 4.5\n",
    );
    let checked = place.squama("check x.toml").assert().code(0).get_output().stderr.clone();
    let question = "note: material.substrate_modulus_MPa is 310000 MPa, 310 GPa:";
    assert!(String::from_utf8_lossy(&checked).starts_with(question));
    // The scales are 100 times as stiff as the substrate.
    let known = "design x.toml --set material.substrate_modulus_MPa=0.31 --json";
    let force = |set: &str| {
        let json: serde_json::Value =
            serde_json::from_str(&place.prints(&format!("{known} {set}"))).expect("JSON");
        json["measures"]["critical_force_N"].as_f64().expect("a force")
    };
    let by_ratio = force("--set puncture.contact_modulus_over_substrate=100");
    let by_modulus = force("--set material.scale_modulus_MPa=31");
    assert!((by_ratio - by_modulus).abs() < 1e-9 * by_ratio && by_ratio != force(""), "{by_ratio}");
}
