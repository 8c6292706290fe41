//! `squama export`.

use std::path::{Path, PathBuf};

use clap::Args;

use super::source::{Partial, require_folder_of, verified_folder};
use super::{DONE, derived};
use crate::print::{aligned, counted, print, shortfall};

/// Arguments of `squama export`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama export results/paper --xlsx paper.xlsx

The workbook has a sheet for each table of the folder, and one that explains the columns. The same
tables always give the same bytes. A sheet holds at most 1,048,575 rows.
Exit code: 0 done, 2 bad input or a disk error.")]
pub struct Arguments {
    /// Results folder of a run, or its definition
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// Workbook to write
    #[arg(long, value_name = "FILE")]
    pub xlsx: PathBuf,

    #[command(flatten)]
    pub partial: Partial,
}

/// Writes the tables of a run as one workbook.
pub fn export(arguments: &Arguments) -> anyhow::Result<u8> {
    // A disk that is full is told of in an error, and not by whatever panics over it.
    std::panic::set_hook(Box::new(|_| ()));
    require_folder_of("--xlsx", &arguments.xlsx)?;
    let results = verified_folder(&arguments.results, arguments.partial.completeness())?;
    let exported = report::export(&results, &arguments.xlsx)?;
    let (folder, name) = (arguments.xlsx.parent(), arguments.xlsx.file_name());
    let name = name.unwrap_or_default().to_string_lossy();
    derived::note(&results, "workbook", folder.unwrap_or(Path::new("")), &[name])?;
    let row = |(table, rows): &(String, u32)| [table.clone(), counted(u64::from(*rows), "row")];
    let rows: Vec<_> = exported.tables.iter().map(row).collect();
    let from = shortfall(&results);
    print(&format!("{}\n{from}{}", arguments.xlsx.display(), aligned(&rows)))?;
    Ok(DONE)
}
