//! Arguments of `squama completions`.

use clap::Args;
use clap_complete::Shell;

/// Arguments of `squama completions`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama completions bash > ~/.local/share/bash-completion/completions/squama
  squama completions zsh > ~/.zfunc/_squama
  squama completions fish > ~/.config/fish/completions/squama.fish")]
pub struct CompletionsArguments {
    /// The shell
    pub shell: Shell,
}
