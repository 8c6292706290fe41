//! Arguments of `squama status`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `squama status`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama status results/paper

The run may be going on meanwhile.
Exit code: 0 done, 1 some designs failed or are missing, 2 bad input.")]
pub struct StatusArguments {
    /// Folder of a run
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,
}
