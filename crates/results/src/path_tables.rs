//! The course of one design: its paths, events, scales and Newton iterations as tables.

use std::path::Path;

use skin::flexure::Flexure;
use skin::puncture::Puncture;

use crate::columns::{
    BentScale, EVENTS, FLEXURE_EVENTS, FLEXURE_PATH, FLEXURE_SCALES, FLEXURE_STEPS, PATH, SCALES,
    STEPS,
};
use crate::design::design_result::Solved;
use crate::folder::{OutputError, RunFolder};
use crate::tables::csv_file::write_table;

/// Writes the course of a design to `folder` and returns the names of the files: those of what was
/// solved. Of what was not, none of an earlier time stays.
///
/// # Errors
/// If the folder or the disk does not take them.
pub fn write_course(folder: &Path, solved: &Solved) -> Result<Vec<&'static str>, OutputError> {
    let place = RunFolder::new(folder);
    place.make()?;
    let mut files = Vec::new();
    match &solved.puncture {
        Some(puncture) => files.extend(write_puncture(folder, puncture)?),
        None => remove(&place, RunFolder::PUNCTURE),
    }
    match &solved.flexure {
        Some(flexure) => files.extend(write_flexure(folder, flexure)?),
        None => remove(&place, RunFolder::FLEXURE),
    }
    place.sync();
    Ok(files)
}

fn write_puncture(folder: &Path, puncture: &Puncture) -> Result<[&'static str; 4], OutputError> {
    let [path, events, scales, steps] = RunFolder::PUNCTURE;
    write_table(folder, path, PATH, &puncture.path)?;
    write_table(folder, events, EVENTS, &puncture.events)?;
    write_table(folder, scales, SCALES, &puncture.scales)?;
    write_table(folder, steps, STEPS, &puncture.history)?;
    Ok(RunFolder::PUNCTURE)
}

fn write_flexure(folder: &Path, flexure: &Flexure) -> Result<[&'static str; 4], OutputError> {
    let [path, events, scales, steps] = RunFolder::FLEXURE;
    let shape = flexure.shape(flexure.path.len().saturating_sub(1)).unwrap_or_default();
    let shape: Vec<BentScale> = shape.into_iter().enumerate().collect();
    write_table(folder, path, FLEXURE_PATH, &flexure.path)?;
    write_table(folder, events, FLEXURE_EVENTS, &flexure.events)?;
    write_table(folder, scales, FLEXURE_SCALES, &shape)?;
    write_table(folder, steps, FLEXURE_STEPS, &flexure.history)?;
    Ok(RunFolder::FLEXURE)
}

fn remove(folder: &RunFolder, files: [&str; 4]) {
    for file in files {
        folder.remove(file);
    }
}
