//! The command `squama completions`, which prints a completion script for a shell.

use clap::{Args, CommandFactory as _};
use clap_complete::Shell;

use super::{Arguments as Squama, DONE};
use crate::print::print;

/// Arguments of `squama completions`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama completions bash > ~/.local/share/bash-completion/completions/squama
  squama completions zsh > ~/.zfunc/_squama
  squama completions fish > ~/.config/fish/completions/squama.fish")]
pub struct Arguments {
    /// Shell to print completions for
    pub shell: Shell,
}

/// Prints the completion script for a shell.
pub fn completions(arguments: &Arguments) -> anyhow::Result<u8> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Squama::command(), "squama", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(DONE)
}
