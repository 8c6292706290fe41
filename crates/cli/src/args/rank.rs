//! Arguments of `squama rank`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `squama rank`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama rank results/paper
  squama rank results/paper --weights 0.4,0.4,0.1,0.1 --top 20
  squama rank results/paper --resolution 50 --out results/paper/fine

Ranks the designs that cover the substrate and have every measure. The fitness of a design is the
product of its criteria, each rescaled from 0, the worst, to 1, the best, to the power of its
weight; a criterion without weight is ignored, and of equal designs the first is the best.
Writes ranking.csv (by the weights), winners.csv and quaternary.csv (the best design for all
weights) and pareto.csv (designs that no other beats in every criterion).
Exit code: 0 done, 2 bad input or disk.")]
pub struct RankArguments {
    /// Folder of a run, with coverage, puncture and flexure
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// Weights of coverage, critical force, penetration resistance and flexural compliance
    ///
    /// None is negative, and they sum to 1.
    #[arg(
        long,
        value_name = "M,N,K,L",
        allow_hyphen_values = true,
        default_value = "0.25,0.25,0.25,0.25"
    )]
    pub weights: String,

    /// Designs that are printed
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub top: usize,

    /// Steps from one corner of the tetrahedron of weights to the next, 1 to 200
    #[arg(long, value_name = "R", allow_hyphen_values = true, default_value = "20")]
    pub resolution: String,

    /// Folder of the tables [default: RESULTS]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}
