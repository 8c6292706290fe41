//! Fuzzes the reader of design tables: it accepts an input, or rejects it with a one-line error.
#![no_main]

use libfuzzer_sys::fuzz_target;
use results::Results;

fuzz_target!(|bytes: &[u8]| {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("designs.csv"), bytes).expect("writable");
    match Results::read(folder.path()) {
        Ok(results) => {
            for row in 0..results.len() {
                let _ = (results.design(row), results.number(row, 0));
            }
        }
        Err(error) => assert_eq!(error.to_string().lines().count(), 1, "{error}"),
    }
});
