//! Arguments of `squama check`.

use clap::Args;

use super::Definition;

/// Arguments of `squama check`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama check sweeps/paper.toml
  squama check sweeps/paper.toml --set 'designs.c2=[0.23, 1.1]'
  squama check sweeps/paper.toml --json")]
pub struct CheckArguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,
}
