//! The path tables of one design: its paths, events, scales and Newton iterations.

use skin::flexure::Flexure;
use skin::puncture::Puncture;
use store::OutputError;

use crate::columns::{
    BentScale, DERIVATIVE_COLUMNS, EVENTS, FLEXURE_EVENTS, FLEXURE_SCALES, FLEXURE_STEPS,
    PunctureEvent, SCALES, STEPS, flexure_path_columns, path_columns,
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
    if !solved.row.result.sensitivity.is_empty() {
        let (name, rows) = (RunFolder::SENSITIVITY, solved.row.derivatives());
        write_rows(folder, name, Plain, DERIVATIVE_COLUMNS, rows)?;
        files.push(name);
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
