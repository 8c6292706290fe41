//! Arguments of `squama rank`.

use std::path::PathBuf;

use clap::Args;

use super::Partial;

/// Arguments of `squama rank`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama rank results/paper
  squama rank results/paper --weights 4,4,1,1 --top 20
  squama rank results/paper --require 'coverage >= 0.6' --require 'penetration < 0.3'
  squama rank results/paper --maximize critical_force --minimize gap_over_t
  squama rank results/paper --criteria coverage,max:peak_force,min:sink --scale log
  squama rank sweeps/paper.toml --json

Ranks the designs that meet all requirements and have every criterion: those of the paper (coverage,
critical force, penetration resistance, flexural compliance), or those of --criteria, or of --maximize
and --minimize. The fitness of a design is the product of its criteria, each rescaled from 0, the worst,
to 1, the best, to the power of its weight; with --scale linear or log it is their weighted mean. A
criterion without weight is ignored, and so is one that is the same for all but for round-off. Equal
designs stand in the order of their numbers.
Writes ranking.csv (by the weights), pareto.csv (designs that no other beats in every criterion),
ranking.toml (what the ranking goes by) and, with four criteria, winners.csv and quaternary.csv (the best
design for all weights). Where no design meets the requirements: the one that comes nearest, and which
requirement stands in the way.
Exit code: 0 done, 1 no design meets the requirements, 2 bad input or disk.")]
pub struct RankArguments {
    /// Folder of a run, or the definition of its sweep
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// A bound that designs must keep: >=, <=, >, < or == in any column of numbers (may be repeated: all must hold)
    #[arg(long, value_name = "COLUMN OP NUMBER")]
    pub require: Vec<String>,

    /// A column that is to be large (may be repeated: the Pareto front of all, and its knee)
    #[arg(long, value_name = "COLUMN", conflicts_with = "criteria")]
    pub maximize: Vec<String>,

    /// A column that is to be small (may be repeated)
    #[arg(long, value_name = "COLUMN", conflicts_with = "criteria")]
    pub minimize: Vec<String>,

    /// Criteria instead of those of the paper: max:COLUMN or min:COLUMN, or COLUMN where it is plain what is good
    #[arg(long, value_name = "CRITERION,…")]
    pub criteria: Option<String>,

    /// Weights of the criteria in their order, those of --maximize first [default: all the same]
    ///
    /// None is negative; they count in proportion, whatever their sum. The order of the paper's criteria is coverage,
    /// critical force, penetration resistance and flexural compliance.
    #[arg(long, value_name = "W,…", allow_hyphen_values = true)]
    pub weights: Option<String>,

    /// How criteria are rescaled: paper, linear or log
    #[arg(long, value_name = "SCALE", default_value = "paper")]
    pub scale: String,

    /// Count the force up to the first fold of the substrate's surface instead of the critical force
    ///
    /// Beyond a fold two bases have passed each other, and the model cannot answer for the force.
    #[arg(long, conflicts_with_all = ["criteria", "maximize", "minimize"])]
    pub sound: bool,

    /// Designs that are printed
    #[arg(long, allow_hyphen_values = true, value_name = "N", default_value_t = 10)]
    pub top: usize,

    /// Steps from one corner of the tetrahedron of weights to the next, 1 to 200
    #[arg(long, value_name = "R", allow_hyphen_values = true, default_value = "20")]
    pub resolution: String,

    /// Folder of the tables [default: RESULTS]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,

    #[command(flatten)]
    pub partial: Partial,
}
