//! Tables of the paths of one design: equilibria, events, scales and Newton iterations.

use journal::OutputError;
use skin::flexure::Flexure;
use skin::puncture::{Instability, Puncture};

use crate::columns::{
    BentScale, Cell, Column, DERIVATIVE_COLUMNS, EVENTS, FLEXURE_EVENTS, FLEXURE_SCALES,
    FLEXURE_STEPS, LOAD_POSITIONS, PunctureEvent, SCALES, STEPS, flexure_path_columns,
    path_columns, tip_force_columns,
};
use crate::design::row::SolvedDesign;
use crate::folder::ResultsFolder;
use crate::tables::csv_file::write_rows;

/// A table of the paths of one design.
pub struct PathTable {
    /// Name of the file.
    pub file: &'static str,
    /// Columns, which return the cell of a row for the number of the row, from 0.
    pub columns: Vec<Column<usize>>,
    /// Number of rows.
    pub rows: usize,
}

impl PathTable {
    fn new<R>(file: &'static str, columns: &[Column<R>], rows: &[R]) -> Self {
        // The type of a row differs between the tables. Compute the cells before they are written,
        // so that all path tables have the same type.
        let filled = |column: &Column<R>| {
            let cells: Vec<Cell> = rows.iter().map(|row| column.cell(row)).collect();
            Column::computed(
                column.name.clone(),
                column.unit,
                column.meaning,
                move |&row: &usize| cells[row].clone(),
            )
        };
        Self { file, columns: columns.iter().map(filled).collect(), rows: rows.len() }
    }
}

/// Returns the tables of the solved paths, and the table of derivatives, if there are any.
pub fn path_tables(solved: &SolvedDesign) -> Vec<PathTable> {
    let SolvedDesign { row, puncture, flexure } = solved;
    let mut tables = Vec::new();
    if let Some(puncture) = puncture {
        tables.extend(of_puncture(puncture));
    }
    if let Some(flexure) = flexure {
        tables.extend(of_flexure(flexure));
    }
    if !row.result.sensitivity.is_empty() {
        let rows: Vec<_> = row.derivatives().collect();
        tables.push(PathTable::new(ResultsFolder::SENSITIVITY, DERIVATIVE_COLUMNS, &rows));
    }
    tables
}

/// Writes the path tables of a design to `folder`.
///
/// Returns the names of the files.
///
/// # Errors
///
/// If the folder cannot be written.
pub fn write_path_tables(
    folder: &ResultsFolder,
    solved: &SolvedDesign,
) -> Result<Vec<&'static str>, OutputError> {
    let format = folder.csv_format();
    path_tables(solved)
        .into_iter()
        .map(|PathTable { file, columns, rows }| {
            write_rows(folder, file, format, &columns, 0..rows).map(|_| file)
        })
        .collect()
}

fn of_puncture(puncture: &Puncture) -> Vec<PathTable> {
    let [path, events, scales, steps] = ResultsFolder::PUNCTURE;
    let mut columns = path_columns(!puncture.measures.passage.is_none(), puncture.has_friction());
    let points = puncture.path.iter().copied().zip(puncture.instability.iter().copied());
    let mut tables = vec![
        PathTable::new(path, &columns, &points.collect::<Vec<_>>()),
        PathTable::new(events, EVENTS, &PunctureEvent::all(puncture)),
        PathTable::new(scales, SCALES, &puncture.scales),
        PathTable::new(steps, STEPS, &puncture.history),
    ];
    // A round tip has a column for each scale that it touches anywhere along the path.
    tables[0].columns.extend(tip_force_columns(&puncture.tip_forces));
    if let Some(back) = &puncture.unloading {
        // Stability is not computed during unloading.
        columns.retain(|column| !column.name.starts_with("unstable"));
        let points = back.path.iter().map(|&point| (point, Instability::default()));
        let points: Vec<_> = points.collect();
        tables.push(PathTable::new(ResultsFolder::UNLOADING[0], &columns, &points));
    }
    if !puncture.places.is_empty() {
        tables.push(PathTable::new(ResultsFolder::PLACES, LOAD_POSITIONS, &puncture.places));
    }
    tables
}

fn of_flexure(flexure: &Flexure) -> Vec<PathTable> {
    let [path, events, scales, steps] = ResultsFolder::FLEXURE;
    let columns = flexure_path_columns(flexure.has_friction());
    // A path without equilibria has no shape, so the table of its scales has no rows.
    let shape = flexure.shape(flexure.path.len().saturating_sub(1)).unwrap_or_default();
    let shape: Vec<BentScale> = shape.into_iter().enumerate().collect();
    let mut tables = vec![
        PathTable::new(path, &columns, &flexure.path),
        PathTable::new(events, FLEXURE_EVENTS, &flexure.events),
        PathTable::new(scales, FLEXURE_SCALES, &shape),
        PathTable::new(steps, FLEXURE_STEPS, &flexure.history),
    ];
    if let Some(back) = &flexure.unloading {
        tables.push(PathTable::new(ResultsFolder::UNLOADING[1], &columns, &back.path));
    }
    tables
}
