//! Arguments of `squama slurm`.

use std::path::PathBuf;

use clap::Args;

use super::Definition;

/// Arguments of `squama slurm`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama slurm sweeps/paper.toml --shards 20
  results/paper/slurm/submit.sh --time=12:00:00 --cpus-per-task=4

Writes submit.sh, which submits a job array with one element for each shard and a job that merges them,
to DIR/slurm, with the complete definition beside it. Shards go to DIR/shards, the whole to DIR. Submitted
again, shards go on where they ended. The folder may be moved.
Exit code: 0 done, 2 bad input or disk.")]
pub struct SlurmArguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Shards, 1 to 1000: elements of the job array
    #[arg(long, allow_hyphen_values = true, value_name = "N")]
    pub shards: u64,

    /// Folder of the results [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}
