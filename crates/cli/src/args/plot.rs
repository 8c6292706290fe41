//! Arguments of `squama plot`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::{Definition, FigureOutput, Partial, Selection};

/// Arguments of `squama plot`.
#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "\
Examples:
  squama plot results/paper
  squama plot results/paper --png --out figures
  squama plot curves sweeps/paper.toml --design 0417,0418
  squama plot map results/paper --x gap_over_t --y slant_deg --of critical_force"
)]
pub struct PlotArguments {
    /// Plot curves of designs or a map instead of the figures of a sweep
    #[command(subcommand)]
    pub what: Option<PlotWhat>,

    /// Folder of a run, or the definition of its sweep
    #[arg(value_name = "RESULTS")]
    pub results: Option<PathBuf>,

    #[command(flatten)]
    pub output: FigureOutput,

    #[command(flatten)]
    pub partial: Partial,
}

/// The subjects of `squama plot` besides a sweep.
#[derive(Debug, Subcommand)]
pub enum PlotWhat {
    /// Force–displacement, moment–curvature and energies of designs, solved anew
    Curves(CurvesArguments),
    /// Any column over any two parameters, with contours
    Map(MapArguments),
}

/// Arguments of `squama plot map`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama plot map results/paper --x gap_over_t --y slant_deg --of critical_force
  squama plot map results/paper --x gap_over_t --y slant_deg --of compliance --at length_over_t=0.1")]
pub struct MapArguments {
    /// Folder of a run, or the definition of its sweep
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// Parameter across, by its column
    #[arg(long, value_name = "COLUMN")]
    pub x: String,

    /// Parameter upwards, by its column
    #[arg(long, value_name = "COLUMN")]
    pub y: String,

    /// Column that is shown: any with numbers; its scale is logarithmic where its values span decades
    #[arg(long, value_name = "COLUMN")]
    pub of: String,

    /// Value that another parameter is held at (may be repeated); of the rest there is a map for each value
    #[arg(long, value_name = "COLUMN=VALUE")]
    pub at: Vec<String>,

    #[command(flatten)]
    pub output: FigureOutput,

    #[command(flatten)]
    pub partial: Partial,
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

    #[command(flatten)]
    pub output: FigureOutput,
}
