//! Arguments of `squama plot`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::{Definition, Partial, Selection};

/// Arguments of `squama plot`.
#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "\
Examples:
  squama plot results/paper
  squama plot results/paper --png --out figures
  squama plot curves sweeps/paper.toml --design 0417,0418"
)]
pub struct PlotArguments {
    /// What to plot instead of a sweep
    #[command(subcommand)]
    pub what: Option<PlotWhat>,

    /// Folder of a run, or the definition of its sweep
    #[arg(value_name = "RESULTS")]
    pub results: Option<PathBuf>,

    /// An image beside each figure, if squama is built with --features png
    #[arg(long)]
    pub png: bool,

    /// Folder of the figures [default: RESULTS/figures]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    #[command(flatten)]
    pub partial: Partial,
}

/// The subjects of `squama plot` besides a sweep.
#[derive(Debug, Subcommand)]
pub enum PlotWhat {
    /// Force–displacement, moment–curvature and energies of designs, solved anew
    Curves(CurvesArguments),
}

/// Arguments of `squama plot curves`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama plot curves sweeps/paper.toml --design 0417,0418
  squama plot curves sweeps/paper.toml --design 0067,0070,0072 --to 0.7 --png
  squama plot curves results/paper --gap 0.1 --length 1")]
pub struct CurvesArguments {
    #[command(flatten)]
    pub definition: Definition,

    #[command(flatten)]
    pub selection: Selection,

    /// Displacement u/t at which punctures end, instead of the critical tilt
    #[arg(long, value_name = "U", allow_hyphen_values = true)]
    pub to: Option<f64>,

    /// An image beside each figure, if squama is built with --features png
    #[arg(long)]
    pub png: bool,

    /// Folder of the figures [default: curves in the results of the sweep]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}
