//! Tests that interrupted analyses resume from stored samples.

use std::fs;
use std::path::{Path, PathBuf};

use uncertainty::AnalysisError;

use crate::{QUICK, analysed, sweep};

#[test]
fn an_interrupted_analysis_resumes_from_stored_samples() {
    let place = tempfile::tempdir().expect("a folder");
    let (whole, parts) = (place.path().join("whole"), place.path().join("parts"));
    let sweep = sweep(
        QUICK,
        "gap_over_t = 0.2\nlength_over_t = 0.5\nslant_deg = 45",
        "[tolerance]\ngap_over_t = { batch_sd = 0.01, scale_sd = 0.01 }",
    );
    let at_once = analysed(&sweep, &[], 250, &whole, false).expect("tolerances");
    // Interrupt the analysis before the first sample and after 150 samples. Then complete it.
    let stopped = analysed(&sweep, &[], 250, &parts, true).expect_err("stopped");
    assert!(matches!(stopped, AnalysisError::Stopped { done: 0, of: 250 }));
    analysed(&sweep, &[], 150, &parts, false).expect("tolerances");
    let stopped = analysed(&sweep, &[], 250, &parts, true).expect_err("stopped");
    assert!(matches!(stopped, AnalysisError::Stopped { done: 150, of: 250 }));
    let again = analysed(&sweep, &[], 250, &parts, false).expect("tolerances");
    assert_eq!((&again.samples, &again.measures), (&at_once.samples, &at_once.measures));
    let [table] = files(&parts, "csv").try_into().expect("one table");
    let file =
        |folder: &Path| fs::read(folder.join(table.file_name().expect("a name"))).expect("a table");
    assert_eq!(file(&whole), file(&parts));
    // An edited table is replaced: its samples are solved again and agree with the journal.
    let damaged = String::from_utf8(file(&parts)).expect("readable text").replacen("0.2", "0.3", 1);
    fs::write(&table, damaged).expect("writable");
    let again = analysed(&sweep, &[], 250, &parts, false).expect("tolerances");
    assert_eq!(again.samples, at_once.samples);
    assert_eq!(file(&whole), file(&parts));
    // A damaged line followed by intact lines is an error, and the journal remains unchanged.
    let [journal] = files(&parts, "jsonl").try_into().expect("one journal");
    let sound = fs::read_to_string(&journal).expect("readable text");
    let third = sound.lines().nth(2).expect("a line");
    let damaged = sound.replace(third, &third.replace("\"number\"", "\"numbar\""));
    fs::write(&journal, &damaged).expect("writable");
    let refused =
        analysed(&sweep, &[], 250, &parts, false).expect_err("a damaged journal").to_string();
    assert!(refused.contains(".jsonl:3: damaged line"), "{refused}");
    assert_eq!(fs::read_to_string(&journal).expect("readable text"), damaged);
    // If the last line is incomplete, its sample is solved again.
    fs::write(&journal, &sound[..sound.len() - 20]).expect("writable");
    let again = analysed(&sweep, &[], 250, &parts, false).expect("tolerances");
    assert_eq!(again.samples, at_once.samples);
}

/// Returns the files in `folder` with this extension.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    paths.filter(|path| path.extension().is_some_and(|found| found == extension)).collect()
}

#[test]
fn each_definition_has_its_own_samples() {
    let place = tempfile::tempdir().expect("a folder");
    let sampled = |sd: &str| {
        let lines = format!("[tolerance]\ngap_over_t = {{ batch_sd = {sd} }}");
        let sweep = sweep(QUICK, "gap_over_t = 0.2\nlength_over_t = 0.5\nslant_deg = 45", &lines);
        analysed(&sweep, &[], 2, place.path(), false).expect("tolerances").samples
    };
    let first = sampled("0.01");
    assert_ne!(first, sampled("0.02"));
    // Returning to the first definition reuses its samples.
    let kept = || -> Vec<Vec<u8>> {
        files(place.path(), "jsonl")
            .iter()
            .map(|path| fs::read(path).expect("a readable journal"))
            .collect()
    };
    let before = kept();
    assert_eq!(before.len(), 2);
    assert_eq!(first, sampled("0.01"));
    assert_eq!(before, kept(), "no sample is solved again");
}
