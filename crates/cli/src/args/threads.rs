//! How many threads solve.

use std::thread::available_parallelism;

use clap::Args;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// The number of threads.
#[derive(Clone, Copy, Debug, Args)]
pub struct Threads {
    /// Threads [default: all cores]
    #[arg(long = "threads", allow_hyphen_values = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    number: Option<u16>,
}

impl Threads {
    /// As many as are asked for, or one for each core.
    pub fn count(self) -> usize {
        let cores = || available_parallelism().map_or(1, usize::from);
        self.number.map_or_else(cores, usize::from)
    }

    /// A pool of so many threads.
    pub fn pool(self) -> anyhow::Result<ThreadPool> {
        Ok(ThreadPoolBuilder::new().num_threads(self.count()).build()?)
    }
}
