//! Arguments of `squama report`.

use std::path::PathBuf;

use clap::Args;

use super::Partial;

/// Arguments of `squama report`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama report results/paper
  squama report results/paper --out paper.html
  squama report results/paper --front results/front      # with what squama optimise has found

The page needs no network and no server: open it in a browser.")]
pub struct ReportArguments {
    /// Folder of a run, or the definition of its sweep
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// The page [default: RESULTS/report.html]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,

    /// Folder of squama optimise, whose designs stand beside those of the grid
    #[arg(long, value_name = "DIR")]
    pub front: Option<PathBuf>,

    #[command(flatten)]
    pub partial: Partial,
}
