//! Arguments of `squama draw`.

use clap::Args;

use super::{Definition, FigureOutput, Selection};

/// Arguments of `squama draw`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama draw sweeps/paper.toml --design 0417
  squama draw sweeps/paper.toml --design 0417 --at 0.1,0.4,0.7 --png
  squama draw sweeps/paper.toml --design 0417,0418 --flexure
  squama draw sweeps/paper.toml --design 0067,0070,0072 --force 0.1
  squama draw sweeps/paper.toml --design 0417 --animate
  squama draw results/paper --gap 0.1 --length 1 --slant 15..60

Shows the row at rest and at the critical tilt, or at the displacements u/t of --at; each is solved
for. Contacts are red, forces between scales are arrows, the bars are the reactions of the
substrate. With --flexure, the strip where its ends have turned by the angles of --at (degrees).")]
pub struct DrawArguments {
    #[command(flatten)]
    pub definition: Definition,

    #[command(flatten)]
    pub selection: Selection,

    /// Displacements u/t of the punctured point, or rotations of the ends in degrees
    #[arg(long, value_name = "VALUES", value_delimiter = ',', allow_hyphen_values = true)]
    pub at: Vec<f64>,

    /// Puncture forces F* instead of displacements
    #[arg(long, value_name = "VALUES", value_delimiter = ',', allow_hyphen_values = true, conflicts_with_all = ["at", "flexure", "animate"])]
    pub force: Vec<f64>,

    /// The strip in bending instead of the puncture
    #[arg(long)]
    pub flexure: bool,

    /// One page that plays the path instead of drawings
    #[arg(long)]
    pub animate: bool,

    #[command(flatten)]
    pub output: FigureOutput,
}
