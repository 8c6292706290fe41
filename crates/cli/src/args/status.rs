//! Arguments of `squama status`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `squama status`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama status results/paper
  squama status results/paper --json

The run may be going on meanwhile. Checks every table against what the run states of it, and lists
what was made from tables that are no longer there.
Exit code: 0 done, 1 some designs failed or are missing, or a table is not as it was written, 2 bad input.")]
pub struct StatusArguments {
    /// Folder of a run, or the definition of its sweep
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,
}
