//! The course of one design: its paths, events, scales and Newton iterations as tables.

use std::fs;
use std::path::Path;

use skin::flexure::Flexure;
use skin::puncture::Puncture;

use crate::columns::{
    BentScale, EVENTS, FLEXURE_EVENTS, FLEXURE_PATH, FLEXURE_SCALES, FLEXURE_STEPS, PATH, SCALES,
    STEPS,
};
use crate::table::write_table;
use crate::whole_file::{self, OutputError};
use crate::workbench::Solved;

/// Names of the tables of a puncture.
const PUNCTURE: [&str; 4] = ["path.csv", "events.csv", "scales.csv", "steps.csv"];

/// Names of the tables of a bending.
const FLEXURE: [&str; 4] =
    ["flexure_path.csv", "flexure_events.csv", "flexure_scales.csv", "flexure_steps.csv"];

/// Writes the course of a design to `folder` and returns the names of the files: those of what was
/// solved. Of what was not, none of an earlier time stays.
///
/// # Errors
/// If the folder or the disk does not take them.
pub fn write_course(folder: &Path, solved: &Solved) -> Result<Vec<&'static str>, OutputError> {
    whole_file::make_folder(folder)?;
    let mut files = Vec::new();
    match &solved.puncture {
        Some(puncture) => files.extend(write_puncture(folder, puncture)?),
        None => remove(folder, PUNCTURE),
    }
    match &solved.flexure {
        Some(flexure) => files.extend(write_flexure(folder, flexure)?),
        None => remove(folder, FLEXURE),
    }
    whole_file::sync_folder(folder);
    Ok(files)
}

fn write_puncture(folder: &Path, puncture: &Puncture) -> Result<[&'static str; 4], OutputError> {
    let [path, events, scales, steps] = PUNCTURE;
    write_table(folder, path, PATH, &puncture.path)?;
    write_table(folder, events, EVENTS, &puncture.events)?;
    write_table(folder, scales, SCALES, &puncture.scales)?;
    write_table(folder, steps, STEPS, &puncture.history)?;
    Ok(PUNCTURE)
}

fn write_flexure(folder: &Path, flexure: &Flexure) -> Result<[&'static str; 4], OutputError> {
    let [path, events, scales, steps] = FLEXURE;
    let shape = flexure.shape(flexure.path.len().saturating_sub(1)).unwrap_or_default();
    let shape: Vec<BentScale> = shape.into_iter().enumerate().collect();
    write_table(folder, path, FLEXURE_PATH, &flexure.path)?;
    write_table(folder, events, FLEXURE_EVENTS, &flexure.events)?;
    write_table(folder, scales, FLEXURE_SCALES, &shape)?;
    write_table(folder, steps, FLEXURE_STEPS, &flexure.history)?;
    Ok(FLEXURE)
}

fn remove(folder: &Path, files: [&str; 4]) {
    for file in files {
        // Nearly always there is none.
        let _ = fs::remove_file(folder.join(file));
    }
}
