//! `squama completions`.

use clap::CommandFactory as _;

use super::DONE;
use crate::args::{Arguments, CompletionsArguments};
use crate::print::print;

/// Prints completions for a shell.
pub fn completions(arguments: &CompletionsArguments) -> anyhow::Result<u8> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "squama", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(DONE)
}
