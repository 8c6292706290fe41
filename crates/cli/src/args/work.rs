//! How designs are solved and how tables are written.

use clap::Args;

use super::Threads;

/// How designs are solved.
#[derive(Debug, Args)]
pub struct Work {
    #[command(flatten)]
    pub threads: Threads,

    /// End the run at the first design that fails
    #[arg(long)]
    pub fail_fast: bool,

    /// No progress bar and no summary
    #[arg(long, short)]
    pub quiet: bool,
}

/// The format of the tables.
#[derive(Debug, Args)]
pub struct Format {
    /// How the tables are written: plain (`,` between cells, `.` in decimals) or excel-eu (`;`, `,`
    /// and a byte-order mark) [default: as they were before, or plain]
    #[arg(long, value_name = "FORMAT")]
    pub csv: Option<results::CsvFormat>,
}
