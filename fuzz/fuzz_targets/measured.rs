//! Fuzzes the reader of test data: it accepts an input, or rejects it with an error that names the
//! file.
#![no_main]

use fit::MeasuredCurve;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.csv");
    std::fs::write(&path, bytes).expect("writable");
    match MeasuredCurve::read(&path, None) {
        Ok(curves) => {
            // Each point takes at least one byte of the input.
            let points: usize = curves.iter().map(|curve| curve.points.len()).sum();
            assert!(points <= bytes.len());
            for curve in &curves {
                assert!(curve.loading().len() <= curve.points.len());
            }
        }
        Err(error) => assert!(error.to_string().contains("a.csv"), "{error}"),
    }
});
