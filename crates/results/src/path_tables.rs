//! The path tables of one design: its paths, events, scales and Newton iterations.

use skin::flexure::Flexure;
use skin::puncture::{Instability, Puncture};
use store::OutputError;

use crate::columns::{
    BentScale, DERIVATIVE_COLUMNS, EVENTS, FLEXURE_EVENTS, FLEXURE_SCALES, FLEXURE_STEPS,
    LOADED_PLACES, PunctureEvent, SCALES, STEPS, flexure_path_columns, path_columns,
};
use crate::design::row::SolvedDesign;
use crate::folder::RunFolder;
use crate::tables::csv_file::write_rows;
use crate::tables::csv_format::CsvFormat::Plain;

/// Writes the path tables of a design to `folder` and returns the names of the files: those of what
/// was solved.
///
/// # Errors
/// If the folder or the disk does not take them.
pub fn write_path_tables(
    folder: &RunFolder,
    solved: &SolvedDesign,
) -> Result<Vec<&'static str>, OutputError> {
    let mut files = Vec::new();
    if let Some(puncture) = &solved.puncture {
        files.extend(write_puncture(folder, puncture)?);
    }
    if let Some(flexure) = &solved.flexure {
        files.extend(write_flexure(folder, flexure)?);
    }
    files.extend(write_ways_back(folder, solved)?);
    if let Some(puncture) = solved.puncture.as_ref().filter(|solved| !solved.places.is_empty()) {
        write_rows(folder, RunFolder::PLACES, Plain, LOADED_PLACES, &puncture.places)?;
        files.push(RunFolder::PLACES);
    }
    if !solved.row.result.sensitivity.is_empty() {
        let (name, rows) = (RunFolder::SENSITIVITY, solved.row.derivatives());
        write_rows(folder, name, Plain, DERIVATIVE_COLUMNS, rows)?;
        files.push(name);
    }
    Ok(files)
}

/// Writes the ways back of a design that was unloaded, in the columns of its paths.
fn write_ways_back(
    folder: &RunFolder,
    solved: &SolvedDesign,
) -> Result<Vec<&'static str>, OutputError> {
    let [puncture, flexure] = RunFolder::WAY_BACK;
    let mut files = Vec::new();
    if let Some(solved) = &solved.puncture
        && let Some(back) = &solved.way_back
    {
        let mut columns = path_columns(!solved.measures.passage.is_none(), solved.rubs());
        // Nothing is known of the stability of a row whose load is taken away.
        columns.retain(|column| !column.name.starts_with("unstable"));
        let points = back.path.iter().map(|&point| (point, Instability::default()));
        write_rows(folder, puncture, Plain, &columns, points.collect::<Vec<_>>())?;
        files.push(puncture);
    }
    if let Some(solved) = &solved.flexure
        && let Some(back) = &solved.way_back
    {
        write_rows(folder, flexure, Plain, &flexure_path_columns(solved.rubs()), &back.path)?;
        files.push(flexure);
    }
    Ok(files)
}

fn write_puncture(
    folder: &RunFolder,
    puncture: &Puncture,
) -> Result<[&'static str; 4], OutputError> {
    let [path, events, scales, steps] = RunFolder::PUNCTURE;
    let points = puncture.path.iter().copied().zip(puncture.instability.iter().copied());
    let columns = path_columns(!puncture.measures.passage.is_none(), puncture.rubs());
    write_rows(folder, path, Plain, &columns, points.collect::<Vec<_>>())?;
    write_rows(folder, events, Plain, EVENTS, PunctureEvent::all(puncture))?;
    write_rows(folder, scales, Plain, SCALES, &puncture.scales)?;
    write_rows(folder, steps, Plain, STEPS, &puncture.history)?;
    Ok(RunFolder::PUNCTURE)
}

fn write_flexure(folder: &RunFolder, flexure: &Flexure) -> Result<[&'static str; 4], OutputError> {
    let [path, events, scales, steps] = RunFolder::FLEXURE;
    let shape = flexure.shape(flexure.path.len().saturating_sub(1)).unwrap_or_default();
    let shape: Vec<BentScale> = shape.into_iter().enumerate().collect();
    write_rows(folder, path, Plain, &flexure_path_columns(flexure.rubs()), &flexure.path)?;
    write_rows(folder, events, Plain, FLEXURE_EVENTS, &flexure.events)?;
    write_rows(folder, scales, Plain, FLEXURE_SCALES, &shape)?;
    write_rows(folder, steps, Plain, FLEXURE_STEPS, &flexure.history)?;
    Ok(RunFolder::FLEXURE)
}
