//! The command `squama export`, which writes the tables of a folder as a workbook.

use std::path::{Path, PathBuf};

use clap::Args;
use optimisation::{DesignGoal, FRONT, GOAL, HISTORY, OPTIMUM, history_columns, optimum_columns};
use report::OtherTable;
use results::{Column, FileEntry, Maker, VerifiedFolder};
use uncertainty::{INDEX_COLUMNS, SOURCE_COLUMNS, TOLERANCE_COLUMNS, YIELD_COLUMNS};

use super::figure_file::utf8_name;
use super::fit::{ESTIMATES, FILES, MEANS, POINTS};
use super::own_files::require_own;
use super::source::{Partial, require_folder_of, verified_folder};
use super::{DONE, derivation};
use crate::print::{aligned, counted, print, shortfall};

/// Arguments of `squama export`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama export results/paper --xlsx paper.xlsx
  squama export results/glove/tolerance --xlsx tolerance.xlsx

The workbook has a sheet for each table of the folder, and a sheet that explains the columns. The folder may
also be written by squama optimise, tolerance, sensitivity or fit. The same tables always give the same bytes. A
sheet contains at most 1,048,575 rows.
Exit code: 0 done, 2 bad input or a disk error.")]
pub struct Arguments {
    /// Results folder of a run, a search or an analysis, or the definition of a run
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// Workbook to write
    #[arg(long, value_name = "FILE")]
    pub xlsx: PathBuf,

    #[command(flatten)]
    pub partial: Partial,
}

/// Writes the tables of a run, a search or an analysis as one workbook.
pub fn export(arguments: &Arguments) -> anyhow::Result<u8> {
    // Print no message for a panic: the workbook library panics if the disk is full, and
    // `report::export` turns this panic into an error.
    std::panic::set_hook(Box::new(|_| ()));
    require_folder_of("--xlsx", &arguments.xlsx)?;
    let name = utf8_name(&arguments.xlsx)?;
    require_own(&arguments.xlsx)?;
    let (path, completeness) = (&arguments.results, arguments.partial.completeness());
    // Open a search or an analysis directly, because `verified_folder` accepts only runs.
    let mut other_files = results::FILES.iter().filter(|file| is_other(file));
    let is_other = other_files.any(|file| path.join(file.name).is_file());
    let results = if is_other {
        VerifiedFolder::open(path, completeness)?
    } else {
        verified_folder(path, completeness)?
    };
    let exported = report::export(&results, &others(&results)?, &arguments.xlsx)?;
    let folder = arguments.xlsx.parent();
    derivation::record(&results, "workbook", folder.unwrap_or(Path::new("")), &[name])?;
    let rows = exported.tables.iter();
    let rows = rows.map(|(table, rows)| [table.clone(), counted(u64::from(*rows), "row")]);
    let rows: Vec<_> = rows.collect();
    let from = shortfall(&results);
    print(&format!("{}\n{from}{}", arguments.xlsx.display(), aligned(&rows)))?;
    Ok(DONE)
}

/// Returns true if a file is a table of a search or an analysis.
fn is_other(file: &FileEntry) -> bool {
    let makers = [Maker::Search, Maker::Tolerance, Maker::Sensitivity, Maker::Fit];
    makers.contains(&file.maker)
        && Path::new(file.name).extension().is_some_and(|kind| kind == "csv")
}

/// Returns the tables that a search or an analysis can write, with their columns.
fn others(results: &VerifiedFolder) -> anyhow::Result<Vec<OtherTable>> {
    let [of_best, of_history] = if results.holds(GOAL) {
        let name = results.path().join(GOAL).display().to_string();
        let goal = DesignGoal::parse(&results.text(GOAL)?, &name, &[])?;
        [explained(&optimum_columns(&goal)), explained(&history_columns(&goal))]
    } else {
        [Vec::new(), Vec::new()]
    };
    let tables = [
        (OPTIMUM, of_best.clone()),
        (FRONT, of_best),
        (HISTORY, of_history),
        ("tolerance.csv", explained(TOLERANCE_COLUMNS)),
        ("tolerance_sources.csv", explained(SOURCE_COLUMNS)),
        ("yield.csv", explained(YIELD_COLUMNS)),
        ("sobol.csv", explained(INDEX_COLUMNS)),
        (FILES[0], explained(ESTIMATES)),
        (FILES[1], explained(POINTS)),
        (FILES[2], explained(MEANS)),
    ];
    Ok(tables.into_iter().map(|(file, columns)| OtherTable { file, columns }).collect())
}

/// Returns name, unit and meaning of each column.
fn explained<R>(columns: &[Column<R>]) -> Vec<(String, &'static str, &'static str)> {
    columns.iter().map(|column| (column.name.to_string(), column.unit, column.meaning)).collect()
}
