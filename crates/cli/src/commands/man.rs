//! `squama man`.

use clap::{Command, CommandFactory as _};
use clap_mangen::Man;

use super::DONE;
use crate::args::{Arguments, ManArguments};
use crate::print::{counted, print};

/// Writes a manual page for each command.
pub fn man(arguments: &ManArguments) -> anyhow::Result<u8> {
    let folder = &arguments.folder;
    results::make_folder(folder)?;
    let mut squama = Arguments::command().disable_help_subcommand(true);
    squama.build();
    let pages = pages(&squama, "squama");
    for (name, command) in &pages {
        let mut page = Vec::new();
        Man::new(command.clone()).title(name.to_uppercase()).render(&mut page)?;
        results::write_text(folder, &format!("{name}.1"), &String::from_utf8_lossy(&page))?;
    }
    let count = counted(pages.len() as u64, "page");
    print(&format!("{}: {count}; to read the first: man -l {0}/squama.1\n", folder.display()))?;
    Ok(DONE)
}

/// A command and those below it, each with the name of its page.
fn pages(command: &Command, name: &str) -> Vec<(String, Command)> {
    let below = command.get_subcommands();
    let below = below.flat_map(|below| pages(below, &format!("{name}-{}", below.get_name())));
    std::iter::once((name.to_owned(), command.clone())).chain(below).collect()
}
