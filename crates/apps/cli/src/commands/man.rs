//! The command `squama man`, which writes manual pages.

use std::path::PathBuf;

use clap::{Args, Command, CommandFactory as _};
use clap_mangen::Man;

use super::own_files::require_own;
use super::{Arguments as Squama, DONE};
use crate::print::{counted, print};

/// Arguments of `squama man`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama man ~/.local/share/man/man1

Writes squama.1 and a page for each command, e.g. squama-run.1.
Exit code: 0 done, 2 bad input or a disk error.")]
pub struct Arguments {
    /// Folder for the pages
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

/// Writes a manual page for each command.
pub fn man(arguments: &Arguments) -> anyhow::Result<u8> {
    let folder = &arguments.folder;
    results::make_folder(folder)?;
    // Leave out the command `help`: it has a subcommand for each command, and each subcommand would
    // get a page.
    let mut squama = Squama::command().disable_help_subcommand(true);
    squama.build();
    let pages = pages(&squama, "squama");
    for (name, command) in &pages {
        let mut page = Vec::new();
        Man::new(command.clone()).title(name.to_uppercase()).render(&mut page)?;
        let file = format!("{name}.1");
        require_own(&folder.join(&file))?;
        results::write_text(folder, &file, &String::from_utf8_lossy(&page))?;
    }
    let count = counted(pages.len() as u64, "page");
    print(&format!("{}: {count}; to read the first: man -l {0}/squama.1\n", folder.display()))?;
    Ok(DONE)
}

/// Lists `command` and all commands below it, each with the name of its page.
fn pages(command: &Command, name: &str) -> Vec<(String, Command)> {
    let below = command.get_subcommands();
    let below = below.flat_map(|below| pages(below, &format!("{name}-{}", below.get_name())));
    std::iter::once((name.to_owned(), command.clone())).chain(below).collect()
}
