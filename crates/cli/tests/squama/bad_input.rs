//! Bad input is one line that names file, key, value and what would be right, and exit code 2.

use crate::{FEW, Place};

#[test]
fn of_the_definition() {
    let message = |lines: &str| {
        let place = Place::with(&format!("name = 'x'\n{lines}"));
        let message = place.refused("run x.toml");
        assert_eq!(place.list("."), "x.toml", "nothing is written");
        message
    };
    insta::assert_snapshot!(
        [
            "contact.cc1 = 1.1",
            "designs.gap_over_t = -0.1",
            "designs.slant_deg = 90",
            "designs.slant_deg = []",
            "contact.c2 = 0",
            "this is no toml",
        ]
        .map(message)
        .concat()
    );
}

#[test]
fn of_the_command_line() {
    let place = Place::with(FEW);
    let message = |arguments: &&str| place.refused(arguments);
    let messages: Vec<_> = [
        "run missing.toml",
        "run .",
        "run x.toml --set contact.c3=1",
        "run x.toml --set contact.c2=0",
        "run x.toml --set contact.c2",
        "run x.toml --set designs.slant_deg=[0,",
        "check x.toml --set puncture.scales=many",
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
    .map(message)
    .collect();
    insta::assert_snapshot!(messages.concat());
    assert_eq!(place.list("."), "x.toml", "nothing is written");
}

#[test]
fn a_file_that_is_no_text() {
    let place = Place::new();
    std::fs::write(place.path("x.toml"), [0xff, 0xfe, 0x00]).expect("writable");
    insta::assert_snapshot!(place.refused("check x.toml"), @"error: x.toml: cannot be read (stream did not contain valid UTF-8), expected a sweep definition in TOML");
}

#[test]
fn an_output_folder_that_cannot_be_written() {
    let place = Place::with(FEW);
    insta::assert_snapshot!(place.refused("run x.toml --out x.toml/y"), @"error: x.toml/y: cannot be written (Not a directory), expected a folder that can be written, e.g. with --out DIR");
    insta::assert_snapshot!(place.refused("run x.toml --out x.toml"), @"error: x.toml: cannot be written (File exists), expected a folder that can be written, e.g. with --out DIR");
    insta::assert_snapshot!(place.refused("design x.toml --design 1 --out x.toml"), @"error: x.toml: cannot be written (File exists), expected a folder that can be written, e.g. with --out DIR");
}
