//! Arguments of `squama sensitivity`.

use std::path::PathBuf;

use clap::Args;

use super::{Definition, Threads};

/// Arguments of `squama sensitivity`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama sensitivity --global box.toml
  squama sensitivity --global box.toml --samples 4000 --json

Draws the parameters of [variables], as gap_over_t = { from = 0.1, to = 1 } or length_over_t = [0.5, 1],
independently and evenly, everything else as the definition has it, and says which part of the variance of
each measure every variable has: alone (first-order Sobol' index) and together with others (total index),
each with its 95 % interval. A sample is solved at as many points as there are variables, and two more;
one that fails anywhere is left out, and counted.
Writes sobol.csv, and the samples in samples/, from which the same command goes on after an interruption.
The derivatives at one design are those of squama design --sensitivity.
Exit code: 0 done, 2 bad input or disk.")]
pub struct SensitivityArguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Over the whole box of the variables
    #[arg(long, required = true)]
    pub global: bool,

    /// Samples
    #[arg(long, value_name = "N", default_value_t = 1000, allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub samples: u32,

    #[command(flatten)]
    pub threads: Threads,

    /// Folder of the table [default: sensitivity in the results of the sweep]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,
}
