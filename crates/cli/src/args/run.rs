//! Arguments of `squama run`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

use super::{Definition, Earlier, Format, Work};

/// A part of the designs.
#[derive(Clone, Copy, Debug)]
pub struct Share(pub f64);

impl FromStr for Share {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let share = text.parse().ok().filter(|share| *share > 0.0 && *share <= 1.0);
        share.map(Self).ok_or_else(|| {
            format!("{text} is out of range, expected a number above 0 and at most 1")
        })
    }
}

/// Arguments of `squama run`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama run sweeps/paper.toml
  squama run sweeps/paper.toml --resume
  squama run sweeps/paper.toml --set puncture.scales=41 --out results/short-rows
  squama run sweeps/paper.toml --set 'designs.c2=[0.23, 1.1]' --set name=exponent
  squama run sweeps/paper.toml --sample 100 --seed 7 --out results/sample
  squama run sweeps/paper.toml --shard 3/8

Writes designs.csv, a table for each measure, failures.csv and run.toml, from a journal to which
every design is added as it is done. The tables do not depend on the number of threads, nor on
how often the run was ended and resumed. Last comes contents.toml, which says what was written: every
command that reads the folder checks it. The first SIGINT, SIGTERM or SIGHUP ends the run once the
designs in hand are done, a second one at once, if it comes a second later.
Exit code: 0 done, 1 some designs failed or are missing, 2 bad input or disk, 130, 143 or 129 ended by
SIGINT, SIGTERM or SIGHUP.")]
pub struct RunArguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Folder of the results, which is made with those above it [default: results/NAME, or results/NAME/shards/i-of-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    #[command(flatten)]
    pub earlier: Earlier,

    /// Solve a random subset of this many designs
    #[arg(long, allow_hyphen_values = true, value_name = "DESIGNS")]
    pub sample: Option<u64>,

    /// Seed of the random subset: the same seed, the same designs
    #[arg(
        long,
        allow_hyphen_values = true,
        value_name = "SEED",
        requires = "sample",
        default_value_t = 0
    )]
    pub seed: u64,

    /// Solve one shard: of N, the i-th, that is every N-th design from the i-th on
    #[arg(long, value_name = "i/N")]
    pub shard: Option<sweep::Shard>,

    /// Solve this share of the designs again by another way, and say how far the two are apart
    ///
    /// Once more with steps a tenth as large, and strips as a chain of all gaps, e.g. 0.1. A relative difference above
    /// 1e-6, or a status that is another, makes the exit code 1.
    #[arg(long, value_name = "SHARE")]
    pub audit: Option<Share>,

    #[command(flatten)]
    pub work: Work,

    #[command(flatten)]
    pub format: Format,
}
