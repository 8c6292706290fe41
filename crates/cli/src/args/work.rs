//! How designs are solved and how tables are written.

use clap::Args;

/// How designs are solved.
#[derive(Debug, Args)]
pub struct Work {
    /// Threads [default: all cores]
    #[arg(long, allow_hyphen_values = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,

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
