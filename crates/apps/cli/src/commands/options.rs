//! Options that several commands share: threads, output, format of tables, earlier results.

use std::thread::available_parallelism;

use clap::Args;
use rayon::{ThreadPool, ThreadPoolBuilder};
use run::Start;

/// The options `--resume` and `--fresh`; without them, earlier results are an error.
#[derive(Clone, Copy, Debug, Args)]
pub struct EarlierResults {
    /// Continue from earlier results in the folder, if it has any
    #[arg(long, conflicts_with = "fresh")]
    resume: bool,

    /// Discard earlier results in the folder, if it has any
    #[arg(long)]
    fresh: bool,
}

impl EarlierResults {
    /// Returns how the command treats earlier results: continue, discard, or return an error.
    pub fn start(self) -> Start {
        match (self.resume, self.fresh) {
            (true, _) => Start::Resume,
            (_, true) => Start::Fresh,
            _ => Start::New,
        }
    }
}

/// Options of commands that run a sweep.
#[derive(Debug, Args)]
pub struct RunOptions {
    #[command(flatten)]
    pub threads: Threads,

    /// End the run at the first design that fails
    #[arg(long)]
    pub fail_fast: bool,

    /// Show no progress bar and no summary
    #[arg(long, short)]
    pub quiet: bool,
}

/// Options of commands that solve and print a result.
#[derive(Debug, Args)]
pub struct SolveOptions {
    #[command(flatten)]
    pub threads: Threads,

    /// Show no progress bar
    #[arg(long, short)]
    pub quiet: bool,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,
}

/// The option `--csv`, the format of the tables.
#[derive(Debug, Args)]
pub struct TableFormat {
    /// Format of the tables: plain (`,` between cells, `.` in decimals) or excel-eu (`;`, `,` and a
    /// byte-order mark) [default: the folder's present format, else plain]
    #[arg(long, value_name = "FORMAT")]
    pub csv: Option<results::CsvFormat>,
}

/// The option `--threads`.
#[derive(Clone, Copy, Debug, Args)]
pub struct Threads {
    /// Number of threads [default: all cores]
    // Hyphens are allowed, so that the error for `-1` is an invalid number, not an unknown option.
    #[arg(long = "threads", allow_hyphen_values = true, value_name = "N", value_parser = whole::<1, 1024>)]
    number: Option<u64>,
}

impl Threads {
    /// Returns the requested number of threads, or the number of cores.
    pub fn count(self) -> usize {
        self.number.map_or_else(
            || available_parallelism().map_or(1, usize::from),
            |number| number as usize,
        )
    }

    /// Creates a pool with this number of threads.
    pub fn pool(self) -> anyhow::Result<ThreadPool> {
        Ok(ThreadPoolBuilder::new().num_threads(self.count()).build()?)
    }
}

/// Parses a decimal number without a unit.
pub fn decimal(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "expected a number, without a unit".to_owned())
}

/// Parses an integer from `LOW` to `HIGH`.
///
/// The error states the accepted numbers more clearly than the error of clap.
pub fn whole<const LOW: u64, const HIGH: u64>(text: &str) -> Result<u64, String> {
    let number = text.parse().ok().filter(|number| (LOW..=HIGH).contains(number));
    number.ok_or_else(|| match HIGH {
        u64::MAX => format!("expected a whole number of at least {LOW}"),
        _ => format!("expected a whole number from {LOW} to {HIGH}"),
    })
}
