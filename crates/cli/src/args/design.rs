//! Arguments of `squama design`.

use std::path::PathBuf;

use clap::Args;

use super::Definition;

/// Arguments of `squama design`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama design sweeps/paper.toml --design 0417
  squama design sweeps/paper.toml --gap 0.1 --length 1 --slant 75
  squama design sweeps/paper.toml --gap 0.15 --length 1 --slant 40 --set scale.width_over_t=2
  squama design sweeps/paper.toml --design 0417 --sensitivity

Solves the design exactly as the sweep does. A design given by its lengths need not be on the
grid; if the grid has further axes, give a value for each with --set designs.KEY=VALUE.
Writes path.csv, events.csv, scales.csv, steps.csv (every Newton iteration), the same of bending
in flexure_path.csv and so on, and design.toml; with --sensitivity, sensitivity.csv as well, and
prints what a change of one per cent of each parameter does to the measures.
Exit code: 0 done, 1 the design stopped early, 2 bad input or disk.")]
pub struct DesignArguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Number of the design in the grid of the sweep
    #[arg(long = "design", value_name = "NUMBER", conflicts_with_all = ["gap", "length", "slant"], required_unless_present_any = ["gap", "length", "slant"])]
    pub number: Option<String>,

    /// Gap d/t
    #[arg(long, value_name = "GAP", allow_hyphen_values = true)]
    pub gap: Option<String>,

    /// Length L/t
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub length: Option<String>,

    /// Slant in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub slant: Option<String>,

    /// Differentiate every measure with respect to every continuous parameter: sensitivity.csv
    #[arg(long)]
    pub sensitivity: bool,

    /// Folder of the files [default: results/NAME/designs/NUMBER]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}
