//! Arguments of `squama tolerance`.

use std::path::PathBuf;

use clap::Args;

use super::{Definition, Threads};

/// Arguments of `squama tolerance`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama tolerance armour.toml --design 0417 --require 'critical_force >= 2'
  squama tolerance results/armour --design 0417 --require 'critical_force_N >= 2' --require 'coverage >= 0.6'
  squama tolerance sweeps/smoke.toml --set 'tolerance.gap_over_t={ batch_sd = 0.02, scale_sd = 0.01 }'
  squama tolerance sweeps/paper.toml --samples 0 --set 'tolerance.slant_deg={ batch_within = 2 }'

What is made differs from what is drawn, by the deviations that [tolerance] gives: batch_sd, the standard
deviation of what all scales of a batch share (normal), or batch_within, at most so much to either side
(uniform); scale_sd, the standard deviation from scale to scale, of gaps and slants. A key is that of a
parameter, as gap_over_t, or, with material.thickness_mm, that of a length in mm, as gap_mm.
The spread of every measure is predicted from its derivatives, with the share of each source, and solved
for with samples; both are told, and how far the prediction is off. The yield is the share of samples that
meet a requirement, with its 95 % interval; a sample that fails does not meet it, and is counted apart.
Writes tolerance.csv, tolerance_sources.csv, yield.csv, figures of a single design, and the samples of each
design in samples/, from which the same command goes on after an interruption, or with more samples.
Exit code: 0 done, 1 a design as drawn stopped early, 2 bad input or disk.")]
pub struct ToleranceArguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Numbers of designs in the grid of the sweep, e.g. 0417 or 1-12,0417 [default: all]
    #[arg(long = "design", value_name = "NUMBERS", value_delimiter = ',')]
    pub numbers: Vec<String>,

    /// A bound that samples must keep: >=, <=, >, < or == in any column of numbers (may be repeated: all must hold)
    #[arg(long, value_name = "COLUMN OP NUMBER")]
    pub require: Vec<String>,

    /// Samples of each design; 0 for the linear prediction alone
    #[arg(long, value_name = "N", default_value_t = 1000, allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(0..=1_000_000))]
    pub samples: u32,

    #[command(flatten)]
    pub threads: Threads,

    /// Folder of the tables [default: tolerance in the results of the sweep]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,
}
