//! Arguments of `squama export`.

use std::path::PathBuf;

use clap::Args;

use super::Partial;

/// Arguments of `squama export`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama export results/paper --xlsx paper.xlsx

A sheet for each table of the folder, and one that explains the columns. The same tables make the
same bytes. A sheet takes 1,048,575 rows.
Exit code: 0 done, 2 bad input or disk.")]
pub struct ExportArguments {
    /// Folder of a run, or the definition of its sweep
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// The workbook
    #[arg(long, value_name = "FILE")]
    pub xlsx: PathBuf,

    #[command(flatten)]
    pub partial: Partial,
}
