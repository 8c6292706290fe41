//! Fuzzes the readers of `run.toml` and `contents.toml`: they accept an input, or reject it with
//! one-line errors.
#![no_main]

use libfuzzer_sys::fuzz_target;
use results::{Completeness, VerifiedFolder, verify_record};

fuzz_target!(|text: &str| {
    let folder = tempfile::tempdir().expect("a folder");
    let (record, contents) = text.split_once('\0').unwrap_or((text, ""));
    std::fs::write(folder.path().join("run.toml"), record).expect("writable");
    if !contents.is_empty() {
        std::fs::write(folder.path().join("contents.toml"), contents).expect("writable");
    }
    let path = folder.path().join("run.toml");
    if let Err(error) = sweep::Sweep::read(&path, &[]) {
        assert!(error.to_string().lines().all(|mistake| mistake.contains(": ")));
    }
    let _ = verify_record(&path);
    if let Err(error) = VerifiedFolder::open(folder.path(), Completeness::Partial) {
        assert_eq!(error.to_string().lines().count(), 1);
    }
});
