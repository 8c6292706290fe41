//! Tests of definitions that name a body, such as a finger.

use std::path::Path;

use sweep::{BODIES, Case, NamedValues, Setting, Sweep};

const THICKNESS: &str = "[material]\nthickness_mm = 2\n";

fn read(text: &str, settings: &[&str]) -> Result<Sweep, String> {
    let settings: Vec<_> = settings.iter().map(|s| Setting::parse(s).expect("valid")).collect();
    let text = format!("name = 'x'\n{text}");
    Sweep::parse(&text, "x.toml", &settings).map_err(|error| error.to_string())
}

fn case(text: &str, settings: &[&str]) -> Case {
    read(text, settings).expect("valid").grid().case(0)
}

#[test]
fn a_body_supplies_radius_and_tissue_unless_they_are_given() {
    for (text, settings) in [
        (format!("body = 'Finger'\n{THICKNESS}"), &[][..]),
        (format!("body.name = 'finger'\n{THICKNESS}"), &[]),
        (format!("[body]\nname = 'finger'\n{THICKNESS}"), &[]),
        (THICKNESS.to_owned(), &["body=finger"]),
        (THICKNESS.to_owned(), &["body.name=finger"]),
    ] {
        let case = case(&text, settings);
        assert_eq!((case.body_radius, case.tissue_thickness), (Some(5.0), Some(2.5)), "{text}");
    }
    let explicit = format!("[body]\nname = 'finger'\nradius_over_t = -20\n{THICKNESS}");
    let explicit = case(&explicit, &["substrate.tissue_thickness_over_t=7"]);
    assert_eq!((explicit.body_radius, explicit.tissue_thickness), (Some(-20.0), Some(7.0)));
    let curved = format!("[body]\nname = 'finger'\ncurvature_times_t = 0.01\n{THICKNESS}");
    assert_eq!(case(&curved, &[]).body().curvature, 0.01);
}

#[test]
fn a_named_body_needs_a_thickness_and_a_known_name() {
    insta::assert_snapshot!(read("body = 'finger'", &[]).expect_err("no thickness"), @r"
    x.toml:2: body.radius_mm: needs material.thickness_mm to be set
    x.toml:2: substrate.tissue_thickness_mm: needs material.thickness_mm to be set
    ");
    insta::assert_snapshot!(read("body = 'nose'", &[]).expect_err("unknown"), @r#"x.toml:2: body.name: "nose" is not accepted, expected "finger" or "forearm" or "thigh" or "torso""#);
}

#[test]
fn a_complete_definition_states_the_lengths_of_the_body() {
    let written = read(&format!("body = 'thigh'\n{THICKNESS}"), &[]).expect("valid").to_toml();
    assert!(written.contains("radius_mm = 99\n") && !written.contains("thigh"), "{written}");
}

#[test]
fn a_convex_body_narrower_than_two_pitches_raises_a_note() {
    let notes = ["[4, -3, 30]", "[2, 3.5, 4]"].map(|radii| {
        let text = format!(
            "[designs]\ngap_over_t = 1\nlength_over_t = 1\nslant_deg = 0\nradius_over_t = {radii}"
        );
        read(&text, &[]).expect("valid").notes().join("\n")
    });
    assert_eq!(notes[0], "");
    insta::assert_snapshot!(notes[1], @"the radius of the convex body is less than 2 pitches in 2 designs, the smallest 1.0: the tissue then differs from the half-space or layer of the model");
}

#[test]
fn the_range_of_radii_contains_bodies_of_equally_spaced_curvatures() {
    let text = format!("[body]\nradius_mm = 10\nradius_to_mm = -20\n{THICKNESS}");
    let case = case(&text, &[]);
    for (fraction, expected) in [(0.0, 0.2), (0.5, 0.05), (1.0, -0.1)] {
        let curvature = case.on_body_between(fraction).expect("a range").body().curvature;
        assert!((curvature - expected).abs() < 1e-15, "{fraction}");
    }
    assert!(read("[body]\nradius_to_over_t = 0.2", &[]).is_err());
}

/// Checks that `docs/bodies.md` has exactly the rows of the table [`BODIES`].
#[test]
fn the_documented_bodies_match_the_table() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/bodies.md");
    let page = std::fs::read_to_string(page).expect("readable");
    let rows = page.lines().filter(|line| line.starts_with("| `"));
    let mut documented = rows.filter(|row| !row.starts_with("| `pain"));
    for NamedValues { name, values } in BODIES {
        let [(_, radius), (_, tissue)] = values else { panic!("radius and tissue of {name}") };
        let row = format!("| `{name}` | {radius} | {tissue} |");
        let line = documented.next().expect("a row for each body");
        assert!(line.starts_with(&row), "{line} instead of {row}");
    }
    assert_eq!(documented.next(), None);
}
