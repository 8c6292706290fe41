//! Arguments of `squama validate`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `squama validate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama validate
  squama validate --out validation.md
  squama validate --search sweeps/open-questions.toml sweeps/gaps.toml

Solves problems with known answers, both sweeps of the paper, sweeps over what the paper leaves open, and
searches between the grid points; prints the tables and writes them down. Takes half a minute on two
cores, half of it for the searches. With --search, checks the claims on every setting of sweeps over
open choices instead, and prints what each reproduces.
Exit code: 0 done, 1 a benchmark is outside of its band, 2 disk. What becomes of the claims does not
change it.")]
pub struct ValidateArguments {
    /// The page
    #[arg(long, value_name = "FILE", default_value = "docs/validation.md")]
    pub out: PathBuf,

    /// Leave out the searches between the grid points
    #[arg(long)]
    pub quick: bool,

    /// Sweeps of the paper's designs with further axes: which settings come closest to the claims
    #[arg(long, value_name = "SWEEP.toml", num_args = 1.., conflicts_with_all = ["out", "quick"])]
    pub search: Vec<PathBuf>,
}
