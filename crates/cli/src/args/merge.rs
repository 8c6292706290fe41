//! Arguments of `squama merge`.

use std::path::PathBuf;

use clap::Args;

use super::Format;

/// Arguments of `squama merge`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama merge results/paper/shards/* --out results/paper

Puts the results of shards together; the tables are those of a run without shards. What is in the
folder --out already stays there, so that merging again adds what has come meanwhile. A folder that is
merged into itself, squama merge DIR --out DIR, has its tables written again from its journal.
Exit code: 0 done, 1 some designs failed or are missing, 2 bad input or disk.")]
pub struct MergeArguments {
    /// Folders of the shards
    #[arg(value_name = "DIR", required = true)]
    pub folders: Vec<PathBuf>,

    /// Folder of the whole
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,

    /// No summary
    #[arg(long, short)]
    pub quiet: bool,

    #[command(flatten)]
    pub format: Format,
}
