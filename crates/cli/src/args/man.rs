//! Arguments of `squama man`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `squama man`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama man ~/.local/share/man/man1

Writes squama.1 and a page for each command, e.g. squama-run.1.
Exit code: 0 done, 2 bad input or disk.")]
pub struct ManArguments {
    /// Folder of the pages
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}
