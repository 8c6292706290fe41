//! Errors in a definition of a fit name the line, the key and the expected value.

use std::sync::atomic::AtomicBool;

use fit::{FitDefinition, FitError};
use run::WorkMeter;

use crate::synthetic_curves::Place;

const SKIN: &str =
    "name = 'x'\ndesigns.gap_over_t = 0.2\ndesigns.length_over_t = 1\ndesigns.slant_deg = 0\n";

fn refused(text: &str) -> String {
    let place = Place::new();
    place.write("a.csv", "displacement_mm,force_N\n0.1,1\n0.2,2\n");
    place.write("b.csv", "displacement_mm,force_N\n0.1,one\n");
    place.refused(&format!("{SKIN}{text}"))
}

#[test]
fn invalid_keys_of_curves_are_refused() {
    let curve = "material.thickness_mm = 1\nmaterial.substrate_modulus_MPa = 1\n[[curve]]\n";
    let wrong = |keys: &str| refused(&format!("{curve}{keys}"));
    insta::assert_snapshot!(refused(""), @"test.toml: curve: missing, expected at least one [[curve]] with a file and its kind");
    insta::assert_snapshot!(refused("curve = 3\n"), @"test.toml:5: curve: missing, expected at least one [[curve]] with a file and its kind");
    insta::assert_snapshot!(wrong("kind = 'puncture'\n"), @"test.toml:8: curve.file: missing, expected the name of a CSV file");
    insta::assert_snapshot!(wrong("file = 'a.csv'\n"), @r#"test.toml:8: curve.kind: missing, expected "puncture" or "bending""#);
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'bending'\n"), @r#"test.toml:9: curve.kind: "bending" is not accepted, expected "puncture", as the columns of the file state"#);
    insta::assert_snapshot!(wrong("file = 'b.csv'\nkind = 'puncture'\n"), @r#"b.csv:2: force_N: "one" is not accepted, expected a number"#);
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'puncture'\nto = 'end'\n"), @r#"test.toml:10: curve.to: "end" is not accepted, expected a number, in the unit of the first column"#);
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'puncture'\nto = 0.01\n"), @"test.toml:10: curve.to: 0.01 is not accepted, expected a range with points of the file in it");
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'puncture'\nbranch = 'up'\n"), @r#"test.toml:10: curve.branch: "up" is not accepted, expected "loading", "unloading" or "both""#);
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'puncture'\nbranch = 'both'\n"), @r#"test.toml:10: curve.branch: "both" is not accepted, expected "loading": the curve does not turn back"#);
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'puncture'\noffsets = ['moment']\n"), @r#"test.toml:10: curve.offsets: ["moment"] is not accepted, expected "displacement", "force" or both"#);
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'puncture'\nspecimen = 2\n"), @"test.toml:10: curve.specimen: 2 is not accepted, expected no key specimen: the file has a single specimen");
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'puncture'\noffsets = { displacement = [1, 0] }\n"), @"test.toml:10: curve.offsets: { displacement = [1, 0] } is not accepted, expected ranges, e.g. { displacement = [-0.1, 3] }");
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'puncture'\n[[curve]]\nfile = 'a.csv'\nkind = 'puncture'\n"), @"test.toml:11: curve.file: a.csv is not accepted, expected each measured curve once");
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'puncture'\n[[curve]]\nfile = './a.csv'\nkind = 'puncture'\n"), @"test.toml:11: curve.file: ./a.csv is not accepted, expected each measured curve once");
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'puncture'\ngap = 1\n"), @"test.toml:10: curve.gap: unknown key (its value is 1), expected file, kind, columns, specimen, branch, from, to, offsets or a parameter of this specimen alone, e.g. gap_over_t");
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'puncture'\ngap_over_t = -1\n"), @"test.toml:10: curve.gap_over_t: designs.gap_over_t: -1 is out of range, expected a length of at least 0.001 and at most 1000");
    insta::assert_snapshot!(wrong("file = 'a.csv'\nkind = 'puncture'\ngap_over_t = [0.1, 0.2]\n"), @"test.toml: designs.gap_over_t: [0.1, 0.2] is not accepted, expected one value, or gap_over_t among [variables]");
}

/// Constant forces come from a dead load cell. They determine no parameter, but a fit to zeros
/// would succeed, because many parameters fit zeros exactly.
#[test]
fn constant_loads_are_refused() {
    let place = Place::new();
    let units = "material.thickness_mm = 1\nmaterial.substrate_modulus_MPa = 1\n";
    let curve = format!("{SKIN}{units}[[curve]]\nfile = 'z.csv'\nkind = 'puncture'\n");
    for (force, keys) in [("0", ""), ("0.013", ""), ("-0", "from = 0.1\n")] {
        place.write("z.csv", &format!("displacement_mm,force_N\n0.1,{force}\n0.2,{force}\n"));
        let message = place.refused(&format!("{curve}{keys}"));
        assert!(message.starts_with("test.toml:8: curve.file: z.csv is not accepted"), "{message}");
        assert!(message.contains(&format!("it is {force} at all 2 points")), "{message}");
    }
    place.write("z.csv", "displacement_mm,force_N\n0.1,0\n0.2,0\n0.3,1\n");
    let message = place.refused(&format!("{curve}to = 0.25\n"));
    assert!(message.contains("it is 0 at all 2 points"), "{message}");
}

#[test]
fn a_stopped_fit_returns_an_error() {
    let place = Place::new();
    place.write("a.csv", "displacement,force\n0.1,1\n0.2,2\n");
    let sought = "[variables]\nfriction = { from = 0, to = 1 }\n[[curve]]\nfile = 'a.csv'\nkind = 'puncture'\n";
    place.write("test.toml", &format!("{SKIN}{sought}"));
    let definition = FitDefinition::read(&place.path("test.toml"), &[]).expect("a definition");
    let stopped = definition.fit(&AtomicBool::new(true), &WorkMeter::default());
    assert!(matches!(stopped, Err(FitError::Stopped)), "{stopped:?}");
}

#[test]
fn invalid_unknowns_are_refused() {
    let curve = "[[curve]]\nfile = 'a.csv'\nkind = 'puncture'\n";
    let wrong = |keys: &str| refused(&format!("{keys}{curve}"));
    insta::assert_snapshot!(wrong("[variables]\nthickness_mm = { from = 1, to = 2 }\n"), @"test.toml:8: curve.file: a.csv is not accepted, expected material.thickness_mm and material.substrate_modulus_MPa for a file in physical units");
    insta::assert_snapshot!(wrong("[variables]\nwidth_over_t = [1, 2]\n"), @"test.toml:6: variables.width_over_t: [1, 2] is not accepted, expected bounds of a continuous parameter of the skin, e.g. { from = 0.1, to = 1 }");
    insta::assert_snapshot!(wrong("[variables]\nfirst_step = { from = 0.1, to = 0.2 }\n"), @"test.toml:6: variables.first_step: { from = 0.1, to = 0.2 } is not accepted, expected bounds of a continuous parameter of the skin, e.g. { from = 0.1, to = 1 }");
    insta::assert_snapshot!(wrong("designs.width_over_t = [1, 2]\n"), @"test.toml: designs.width_over_t: [1, 2] is not accepted, expected one value, or width_over_t among [variables]");
    let place = Place::new();
    place.write("a.csv", "displacement,force\n0.1,1\n");
    let none = place.fit(&format!("{SKIN}{curve}")).expect_err("nothing sought").to_string();
    insta::assert_snapshot!(none, @"there are no unknowns; add [variables] or offsets to a [[curve]]");
    let sought = "[variables]\nfriction = { from = 0, to = 1 }\n";
    let few = place.fit(&format!("{SKIN}{sought}{curve}")).expect_err("one point").to_string();
    insta::assert_snapshot!(few, @"too few points: 1, for 1 unknowns; expected more points than unknowns");
}

fn refused_specimens(value: &str) -> String {
    let units = "material.thickness_mm = 1\n";
    let sought = "[variables]\nsubstrate_modulus_MPa = { from = 0.1, to = 1 }\n";
    let curve = "[[curve]]\nfile = 'a.csv'\nkind = 'puncture'\n";
    refused(&format!("{units}per_specimen = {value}\n{sought}{curve}"))
}

#[test]
fn invalid_parameters_per_specimen_are_refused() {
    insta::assert_snapshot!(refused_specimens("3"), @r#"test.toml:6: per_specimen: 3 is not accepted, expected a list of [variables], e.g. ["substrate_modulus_MPa"]"#);
    insta::assert_snapshot!(refused_specimens("['friction']"), @r#"test.toml:6: per_specimen: ["friction"] is not accepted, expected names of [variables]"#);
    insta::assert_snapshot!(refused_specimens("['substrate_modulus_MPa']"), @r#"test.toml:6: per_specimen: ["substrate_modulus_MPa"] is not accepted, expected at least two [[curve]] that do not set this parameter"#);
}
