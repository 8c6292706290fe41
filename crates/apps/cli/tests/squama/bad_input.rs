//! Bad input gives exit code 2 and a line with file, key, value and the expected value.

use crate::{FEW, Place};

#[test]
fn bad_definitions_are_reported_with_their_location() {
    insta::assert_snapshot!(
        [
            "contact.cc1 = 1.1",
            "designs.gap_over_t = -0.1",
            "designs.slant_deg = 90",
            "designs.slant_deg = []",
            "contact.c2 = 0",
            "this is no toml",
        ]
        .map(|lines| {
            let place = Place::with(&format!("name = 'x'\n{lines}"));
            let message = place.refused("run x.toml");
            assert_eq!(place.list("."), "x.toml", "nothing is written");
            message
        })
        .concat()
    );
}

#[test]
fn bad_options_are_reported_with_the_expected_value() {
    let place = Place::with(FEW);
    place.prints("run x.toml --out r");
    let messages: Vec<_> = [
        "run missing.toml",
        "run .",
        "run x.toml --set contact.c3=1",
        "run x.toml --set contact.c2=0",
        "run x.toml --set contact.c2",
        "run x.toml --set designs.slant_deg=[0,",
        "check x.toml --set puncture.scales=many",
        "run x.toml --design 1",
        "draw x.toml --design 1 --width 85mm",
        "design x.toml --gap 0,1 --length .5 --slant 60",
        "rank r --require critical_force_N>=2",
        "rank r --require force>=2",
        "rank r --top 0",
        "design x.toml --design 0009",
        "design x.toml --design 0",
        "design x.toml --gap 0.1 --slant 0",
        "design x.toml --gap -0.1 --length 1 --slant 0",
        "run x.toml --threads 0",
        "run x.toml --shard 4/3",
        "run x.toml --sample 9",
        "run x.toml --resume --fresh",
        "run x.toml --csv excel",
        "run",
        "rerun x",
        "rerun x --failed",
        "status x",
        "merge x --out y",
        "calibrate --gap 0 --length 1",
        "calibrate --gap 1 --length 1 --base 3L",
        "calibrate --gap 1 --length 1 --poisson-ratio 0.6",
    ]
    .iter()
    .map(|arguments| place.refused(arguments))
    .collect();
    insta::assert_snapshot!(messages.concat());
    assert_eq!(place.list("."), "r x.toml", "nothing is written");
}

#[test]
fn all_errors_of_a_definition_are_reported_at_once() {
    let place = Place::with("names = 'x'\n[designs]\ngap = 0.1\n[contact]\nc2 = 0\n");
    let assert = place.squama("run x.toml --set solver.max_step=0").assert().code(2).stdout("");
    let message = String::from_utf8(assert.get_output().stderr.clone()).expect("text");
    insta::assert_snapshot!(message, @r#"
    error: x.toml:1: names: unknown key (its value is "x"), did you mean name?
    error: x.toml:3: designs.gap: unknown key (its value is 0.1), did you mean designs.gap_over_t?
    error: x.toml:5: contact.c2: 0 is out of range, expected a number of at least 0.05 and at most 1.5
    error: --set solver.max_step=0: solver.max_step: 0 is out of range, expected a fraction above 0 and at most 1
    error: x.toml: name: missing, expected the name of the sweep, e.g. name = "paper"
    "#);
}

#[test]
fn errors_suggest_valid_input() {
    let place = Place::with(FEW);
    insta::assert_snapshot!(place.refused("draw x.toml --design 1 --at -1"), @"error: --at -1: out of range, expected a displacement u/t of at least 0");
    insta::assert_snapshot!(place.refused("draw x.toml --design 1 --force -1"), @"error: --force -1: out of range, expected a force F* of at least 0");
    insta::assert_snapshot!(place.refused("plot curves x.toml --design 1 --to -0.5"), @"error: --to -0.5: out of range, expected a displacement u/t of at least 0");
    insta::assert_snapshot!(place.refused("run x.toml --threads -1"), @"error: invalid value '-1' for '--threads <N>': expected a whole number from 1 to 1024");
    insta::assert_snapshot!(place.refused("rnu x.toml"), @"error: there is no command rnu, did you mean run?");
    insta::assert_snapshot!(place.refused("frobnicate"), @"error: there is no command frobnicate, expected one of init, run, rerun, status, merge, slurm, design, tolerance, sensitivity, rank, optimise, fit, compare, draw, make, plot, report, explore, export, check, schema, calibrate, validate, completions, man");
    insta::assert_snapshot!(place.refused("run x.toml --set designs.gap=0.1"), @"error: --set designs.gap=0.1: designs.gap: unknown key (its value is 0.1), did you mean designs.gap_over_t?");
    insta::assert_snapshot!(place.refused("run x.toml --set substrate.thickness_mm=1"), @"error: --set substrate.thickness_mm=1: substrate.thickness_mm: unknown key (its value is 1), did you mean substrate.tissue_thickness_mm?");
    insta::assert_snapshot!(place.refused("run x.toml --set designs.gap_mm=1"), @"error: --set designs.gap_mm=1: designs.gap_mm: needs material.thickness_mm to be set");
    assert_eq!(place.list("."), "x.toml", "nothing is written");
}

#[test]
fn mistyped_paths_create_no_folders() {
    let place = Place::with(FEW);
    place.squama("run x.toml -q --out r").assert().code(0);
    insta::assert_snapshot!(place.refused("export r --xlsx reslts/x.xlsx"), @"error: --xlsx reslts/x.xlsx: there is no folder reslts");
    insta::assert_snapshot!(place.refused("report r --out reslts/x.html"), @"error: --out reslts/x.html: there is no folder reslts");
    insta::assert_snapshot!(place.refused("report r --out x.pdf"), @"error: --out x.pdf: not accepted, expected a name that ends in .html");
    insta::assert_snapshot!(place.refused("validate --out reslts/x.md"), @"error: --out reslts/x.md: there is no folder reslts");
    assert_eq!(place.list("."), "r x.toml", "nothing is written");
}

#[test]
fn files_that_are_not_text_are_rejected() {
    let place = Place::new();
    std::fs::write(place.path("x.toml"), [0xff, 0xfe, 0x00]).expect("writable");
    insta::assert_snapshot!(place.refused("check x.toml"), @"error: x.toml: cannot be read (stream did not contain valid UTF-8), expected a sweep definition in TOML");
}

#[test]
fn unwritable_output_folders_are_rejected() {
    let place = Place::with(FEW);
    insta::assert_snapshot!(place.refused("run x.toml --out x.toml/y"), @"error: x.toml/y: cannot be written (Not a directory), expected a folder that can be written, e.g. with --out DIR");
    insta::assert_snapshot!(place.refused("run x.toml --out x.toml"), @"error: x.toml: cannot be written (File exists), expected a folder that can be written, e.g. with --out DIR");
    insta::assert_snapshot!(place.refused("design x.toml --design 1 --out x.toml"), @"error: x.toml: cannot be written (File exists), expected a folder that can be written, e.g. with --out DIR");
}
