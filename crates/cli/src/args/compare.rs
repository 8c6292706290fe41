//! Arguments of `squama compare`.

use std::path::PathBuf;

use clap::Args;

use super::Partial;

/// Arguments of `squama compare`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama compare results/paper results/paper-as-written
  squama compare results/reference/paper results/paper --tolerance 1e-9 --exit-code

Designs are the same if their parameters are, whatever their numbers. With --out, writes
compare.csv (column by column) and differences.csv (cell by cell).
Exit code: 0 done, 1 the runs differ (with --exit-code), 2 bad input or disk.")]
pub struct CompareArguments {
    /// Folder of a run, or the definition of its sweep
    #[arg(value_name = "RESULTS")]
    pub first: PathBuf,

    /// Folder of another run, or its definition
    #[arg(value_name = "OTHER")]
    pub second: PathBuf,

    /// Numbers are the same if they differ by at most this, relative to the larger; 0 takes every bit
    #[arg(long, value_name = "T", allow_hyphen_values = true, default_value = "1e-12")]
    pub tolerance: String,

    /// Exit with 1 if the runs differ
    #[arg(long)]
    pub exit_code: bool,

    /// Folder of the tables of what differs
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    #[command(flatten)]
    pub partial: Partial,
}
