//! Random files of measurements are read or refused, and never cause a panic.
//!
//! `scripts/fuzz` runs these tests for any length of time.

use std::fmt::Write as _;

use fit::MeasuredCurve;
use proptest::collection::vec;
use proptest::prelude::*;

/// Fragments of files of testing machines, from which random files are composed.
const PARTS: [&str; 24] = [
    "\n",
    "\n",
    "\n",
    "\r",
    "\r\n",
    ";",
    ";",
    ",",
    "\t",
    " ",
    "\"",
    "#",
    "1",
    "2,5",
    "-0.3",
    "7e3",
    "x",
    "displacement_mm",
    "force_N",
    "Weg",
    "(mm)",
    "Kraft",
    "[N]",
    "µ",
];

/// Reads a file of `bytes`, and checks that the result is not larger than the file.
fn read(bytes: &[u8]) {
    let place = tempfile::tempdir().expect("a folder");
    let path = place.path().join("a.csv");
    std::fs::write(&path, bytes).expect("writable");
    match MeasuredCurve::read(&path, None) {
        Ok(curves) => {
            let points: usize = curves.iter().map(|curve| curve.points.len()).sum();
            let lines: usize = curves.iter().map(|curve| curve.skipped_lines.len()).sum();
            assert!(points <= bytes.len() && lines <= bytes.len(), "{points} {lines}");
            assert!(curves.iter().all(|curve| curve.loading().len() <= curve.points.len()));
        }
        Err(error) => assert!(error.to_string().contains("a.csv")),
    }
}

proptest! {
    #[test]
    fn random_bytes_are_read_or_refused(bytes in vec(any::<u8>(), 0..400)) {
        read(&bytes);
    }

    #[test]
    fn random_tables_are_read_or_refused(parts in vec(0..PARTS.len(), 0..300), has_header in any::<bool>()) {
        let mut text = if has_header { "displacement_mm;force_N\n" } else { "" }.to_owned();
        text.extend(parts.into_iter().map(|part| PARTS[part]));
        read(text.as_bytes());
    }
}

/// Every second row has a mistake. `read` checks that the points do not outnumber the bytes.
#[test]
fn rows_with_mistakes_take_linear_memory() {
    let mut text = "displacement_mm;force_N\n".to_owned();
    for k in 0..20_000 {
        writeln!(text, "{k};2\nx;3").expect("writing to a string succeeds");
    }
    read(text.as_bytes());
}

/// Only one of many specimens side by side lists the lines outside of their table.
#[test]
fn many_specimens_take_linear_memory() {
    let columns = 2_000;
    let header = "displacement_mm;force_N;".repeat(columns);
    let row = "1;2;".repeat(columns);
    let single = "3;4\n".repeat(columns);
    let text = format!("{header}\n{row}\n{row}\n{single}{}", "end\n".repeat(columns));
    read(text.as_bytes());
}
