//! A material adds columns in physical units and changes no other column.

use crate::table::{cells, columns};
use crate::{FEW, Place};

const MATERIAL: &str = "[material]\nthickness_mm = 2\nsubstrate_modulus_MPa = 0.3\n\
                        membrane_modulus_MPa = 4.5\nscale_density_kg_m3 = 1200\n";

/// Returns the numbers in a column of a table.
fn numbers(table: &str, column: &str) -> Vec<f64> {
    cells(table, column).iter().map(|cell| cell.parse().expect("a number")).collect()
}

/// Function that computes a physical value from a dimensionless value and the length `L/t`.
type Conversion = fn(f64, f64) -> f64;

#[test]
fn a_material_adds_columns_and_changes_none() {
    let place = Place::with(FEW);
    std::fs::write(place.path("y.toml"), format!("{FEW}{MATERIAL}")).expect("writable");
    place.squama("run x.toml -q --out bare").assert().code(0);
    place.squama("run y.toml -q --out given").assert().code(0);
    for table in ["designs", "coverage", "critical_force", "penetration", "compliance"] {
        let [bare, given] =
            ["bare", "given"].map(|folder| place.read(&format!("{folder}/{table}.csv")));
        assert!(columns(&given).count() > columns(&bare).count(), "{table}: {given}");
        for column in columns(&bare) {
            assert_eq!(cells(&bare, column), cells(&given, column), "{table}: {column}");
        }
    }
    let table = place.read("given/designs.csv");
    // E_s/(1 − ν²) = 0.4 MPa, t² = 4 mm², and I_m = 2 · 0.25³/12 mm⁴.
    let by_hand: [(&str, &str, Conversion); 5] = [
        ("critical_force_N", "critical_force", |value, length| value * 0.4 * length * 4.0),
        ("penetration_mm", "penetration", |value, _| 2.0 * value),
        ("bend_radius_mm", "contact_curvature", |value, _| 2.0 / value),
        ("flexural_rigidity_N_mm2", "compliance", |value, _| {
            4.5 * 2.0 * 0.25_f64.powi(3) / 12.0 / value
        }),
        ("areal_mass_kg_m2", "gap_over_t", |gap, length| 2.4 * length / (length + gap)),
    ];
    for (column, of, unit) in by_hand {
        let lengths = numbers(&table, "length_over_t");
        let values = numbers(&table, of).into_iter().zip(lengths);
        for (found, (value, length)) in numbers(&table, column).into_iter().zip(values) {
            let expected = unit(value, length);
            assert!((found - expected).abs() <= 1e-12 * expected, "{column}: {found} {expected}");
        }
    }
    insta::assert_snapshot!(
        columns(&table)
            .skip_while(|name| *name != "critical_force_N")
            .collect::<Vec<_>>()
            .join(" ")
    );
}

#[test]
fn a_gap_that_cannot_close_bends_to_any_radius() {
    let place = Place::with(&format!("{FEW}{MATERIAL}"));
    place.squama("run x.toml -q --out r --set designs.gap_over_t=[0.5,4]").assert().code(0);
    let table = place.read("r/designs.csv");
    let curvatures = cells(&table, "contact_curvature");
    let radii = numbers(&table, "bend_radius_mm");
    assert!(curvatures.iter().any(|cell| cell.is_empty()));
    for (curvature, radius) in curvatures.iter().zip(radii) {
        assert_eq!(curvature.is_empty(), radius == 0.0, "{curvature} {radius}");
    }
}

/// Other warnings begin with the mark ⚠, like folds, but must not add the legend of a fold.
#[test]
fn other_warnings_do_not_add_the_legend_of_folds() {
    let thin = MATERIAL.replace("thickness_mm = 2", "thickness_mm = 0.5");
    let place = Place::with(&format!("{FEW}{thin}"));
    place.squama("run x.toml -q --out r").assert().code(0);
    let printed = place.prints("rank r --require coverage>=0.2");
    assert!(printed.contains("nozzle") && !printed.contains("surface of the substrate folds"));
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
fn commands_accept_a_varying_material_and_show_its_moduli() {
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
    // Scales 100 times as stiff as the substrate, defined by the ratio or by the modulus, give the
    // same force.
    let known = "design x.toml --set material.substrate_modulus_MPa=0.31 --json";
    let ratio = "--set puncture.contact_modulus_over_substrate=100";
    let modulus = "--set material.scale_modulus_MPa=31";
    let [by_ratio, by_modulus, by_default] = [ratio, modulus, ""].map(|set| {
        let json: serde_json::Value =
            serde_json::from_str(&place.prints(&format!("{known} {set}"))).expect("JSON");
        json["measures"]["critical_force_N"].as_f64().expect("a force")
    });
    assert!(
        (by_ratio - by_modulus).abs() < 1e-9 * by_ratio && by_ratio != by_default,
        "{by_ratio}"
    );
}

#[test]
fn strengths_add_failure_columns_and_change_no_other_column() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out bare").assert().code(0);
    place
        .squama("run x.toml -q --out judged --set puncture.bond_strength_over_substrate=0.5")
        .assert()
        .code(0);
    let (bare, judged) = (place.read("bare/designs.csv"), place.read("judged/designs.csv"));
    let added: Vec<_> =
        columns(&judged).filter(|name| columns(&bare).all(|other| other != *name)).collect();
    assert_eq!(
        added,
        [
            "failure_force",
            "first_failure",
            "scale_stress_max",
            "scale_deflection_max",
            "bond_stress_max",
            "tissue_pressure_max",
            "clearance"
        ]
    );
    for name in columns(&bare) {
        assert_eq!(cells(&bare, name), cells(&judged, name), "{name}");
    }
    // A strength of 0.15 MPa with a modulus of 0.3 MPa is the same ratio of 0.5.
    let in_mpa = "--set material.thickness_mm=2 --set material.substrate_modulus_MPa=0.3 \
                  --set material.bond_strength_MPa=0.15";
    place.squama(&format!("run x.toml -q --out given {in_mpa}")).assert().code(0);
    let given = place.read("given/designs.csv");
    assert_eq!(cells(&given, "first_failure"), cells(&judged, "first_failure"));
    for (stress, in_mpa) in
        numbers(&judged, "scale_stress_max").iter().zip(numbers(&given, "scale_stress_max_MPa"))
    {
        assert!((0.3 * stress - in_mpa).abs() <= 1e-9 * in_mpa, "{stress} {in_mpa}");
    }
    for (pressure, in_kpa) in numbers(&judged, "tissue_pressure_max")
        .iter()
        .zip(numbers(&given, "tissue_pressure_max_kPa"))
    {
        assert!((300.0 * pressure - in_kpa).abs() <= 1e-9 * in_kpa, "{pressure} {in_kpa}");
    }
    insta::assert_snapshot!(place.refused("check x.toml --set material.bond_strength_MPa=1"), @"error: --set material.bond_strength_MPa=1: material.bond_strength_MPa: needs material.substrate_modulus_MPa to be set");
    let both = "check x.toml --set material.substrate_modulus_MPa=1 \
                --set material.bond_strength_MPa=1 --set puncture.bond_strength_over_substrate=1";
    insta::assert_snapshot!(place.refused(both), @"error: --set puncture.bond_strength_over_substrate=1: puncture.bond_strength_over_substrate: cannot be combined with material.bond_strength_MPa at --set material.bond_strength_MPa=1; keep one of the two");
}

#[test]
fn design_states_which_failure_modes_were_judged() {
    let place = Place::with(FEW);
    let design = "design x.toml --design 1 --set material.thickness_mm=2 \
                  --set material.substrate_modulus_MPa=0.3 --set material.scale_strength_MPa=40";
    let text = place.prints(design);
    let lines = text.lines().skip_while(|line| !line.starts_with("Failure modes"));
    insta::assert_snapshot!(lines.take(2).collect::<Vec<_>>().join("\n"), @r"
    Failure modes judged: tilt, fold, break, bend
    Not judged: through (the needle is not guided), debond (the strength of the bond is not given), perforate (the needle has no radius), across (the gap across the row is not given)
    ");
    let json: serde_json::Value =
        serde_json::from_str(&place.prints(&format!("{design} --json"))).expect("JSON");
    let modes = &json["failure_modes"];
    assert_eq!(modes["break"], serde_json::Value::Null);
    assert_eq!(modes["through"], "the needle is not guided");
    assert!(!place.prints("design x.toml --design 1 --json").contains("failure_modes"));
}

/// The page warns that a leading design, which was solved flat, withstands less force on bodies.
#[test]
fn the_page_of_a_flat_sweep_names_the_forces_on_bodies() {
    let definition = FEW.replace("slant_deg = ", "slant_deg = 60 # ");
    let place = Place::with(&format!("{definition}{MATERIAL}"));
    let note = notes_of_page(&place, "");
    let (_, note) = note.split_once("The skin was solved flat. Design ").expect("a note");
    let (design, sentence) = note.trim_end_matches('"').split_once(": ").expect("a number");
    assert!(sentence.contains(" on a finger (radius 10 mm)"), "{sentence}");
    let answer = place.prints(&format!("design x.toml --design {design} --json --out d"));
    assert!(answer.contains(sentence), "{sentence}\n{answer}");
    assert_eq!(notes_of_page(&place, "--set body.radius_mm=10"), "");
}

/// Runs `x.toml` with the options `set`, and returns the notes on the page of its report.
fn notes_of_page(place: &Place, set: &str) -> String {
    place.squama(&format!("run x.toml -q --fresh --out r {set}")).assert().code(0);
    place.squama("report r").assert().code(0);
    let page = place.read("r/report.html");
    let (_, notes) = page.split_once("\"notes\":[").expect("notes");
    notes.split_once(']').expect("an end").0.to_owned()
}
