//! Arguments of `squama design`.

use std::path::PathBuf;

use clap::Args;

use super::{Definition, Selection};

/// Arguments of `squama design`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama design sweeps/paper.toml --design 0417
  squama design sweeps/paper.toml --gap 0.1 --length 1 --slant 75
  squama design sweeps/paper.toml --gap 0.15 --length 1 --slant 40 --set scale.width_over_t=2
  squama design results/paper --design 0417 --json
  squama design results/paper --design 0417 --sensitivity

Solves the design exactly as the sweep does. A design given by its lengths need not be on the
grid; if the grid has further axes, give a value for each with --set designs.KEY=VALUE.
Writes measures.csv (every value with all its digits), path.csv, events.csv, scales.csv,
steps.csv (every Newton iteration), the same of bending in flexure_path.csv and so on, and design.toml.
With --sensitivity, sensitivity.csv as well, and what one per cent of each parameter does to the measures.
Exit code: 0 done, 1 the design stopped early, 2 bad input or disk.")]
pub struct DesignArguments {
    #[command(flatten)]
    pub definition: Definition,

    #[command(flatten)]
    pub selection: Selection,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,

    /// Differentiate every measure with respect to every continuous parameter: sensitivity.csv
    #[arg(long)]
    pub sensitivity: bool,

    /// Folder of the files [default: designs/NUMBER in the results of the sweep]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}
