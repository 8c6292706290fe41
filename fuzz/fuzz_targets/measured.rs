//! Files of testing machines are accepted, or rejected with an error that names the file.
#![no_main]

use fit::MeasuredCurve;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.csv");
    std::fs::write(&path, bytes).expect("writable");
    match MeasuredCurve::read(&path, None) {
        Ok(curves) => {
            // A point takes at least one byte.
            let points: usize = curves.iter().map(|curve| curve.points.len()).sum();
            assert!(points <= bytes.len());
            for curve in &curves {
                assert!(curve.loading().len() <= curve.points.len());
            }
        }
        Err(error) => assert!(error.to_string().contains("a.csv"), "{error}"),
    }
});
