//! The `squama` command: designs flexible armour by sweeping over skins of hard scales.
//!
//! | Module | Role |
//! |---|---|
//! | `commands` | command-line arguments, and a file per command |
//! | `interrupt` | signals that ask a process to end |
//! | `progress` | the bar on the terminal |
//! | `print`, `json` | text for people: aligned tables, closed pipes; the same for programs |

mod commands;
mod interrupt;
mod json;
mod print;
mod progress;

use std::io::Write as _;
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory as _, Parser as _};

use crate::commands::Arguments;
use crate::interrupt::Interrupt;

/// The input, or the disk, is at fault.
const BAD_INPUT: u8 = 2;

fn main() -> ExitCode {
    let command = match Arguments::try_parse() {
        Ok(arguments) => arguments.command,
        // Help, also where arguments are missing, keeps its lines; only mistakes are told in one.
        Err(error) if error.use_stderr() && !is_help(&error) => return refuse(&one_line(&error)),
        Err(error) => error.exit(),
    };
    // Before any file is opened, so that no signal leaves half of one behind.
    let interrupt = match Interrupt::listen() {
        Ok(interrupt) => interrupt,
        Err(error) => {
            return refuse(&anyhow::Error::new(error).context("cannot listen to signals"));
        }
    };
    command.run(&interrupt).map_or_else(|error| refuse(&error), ExitCode::from)
}

/// Whether the error is a question for help.
fn is_help(error: &clap::Error) -> bool {
    error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
}

/// The error in the arguments, without the advice that follows it.
fn one_line(error: &clap::Error) -> anyhow::Error {
    if let Some(ContextValue::String(found)) = error.get(ContextKind::InvalidSubcommand) {
        return no_such_command(found);
    }
    let text = error.to_string();
    let lines = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    // No value is passed in that way, because a number below zero is one.
    let advice = ["For more information", "tip: to pass"];
    let lines = lines
        .filter(|line| !line.is_empty() && !advice.iter().any(|advice| line.starts_with(advice)));
    let lines: Vec<_> = lines.collect();
    // What clap lists on lines of their own follows a line that ends in a colon.
    let line = lines.join(", ").replace(":, ", ": ");
    let line = line.trim_start_matches("error: ");
    match error.get(ContextKind::Usage) {
        // Nothing near is known by clap: what there is stands in the help.
        Some(usage) if error.kind() == ErrorKind::UnknownArgument && !line.contains("tip:") => {
            let usage = usage.to_string();
            let words = usage.trim_start_matches("Usage:").split_whitespace();
            let command: Vec<_> =
                words.take_while(|word| !word.starts_with(['[', '<', '-'])).collect();
            anyhow::anyhow!("{line}; {} --help tells what there is", command.join(" "))
        }
        _ => anyhow::anyhow!(line.to_owned()),
    }
}

/// The error of a command that does not exist.
fn no_such_command(found: &str) -> anyhow::Error {
    let squama = Arguments::command();
    let known: Vec<_> = squama.get_subcommands().map(clap::Command::get_name).collect();
    let hint = match sweep::nearest(found, &known) {
        Some(near) => format!("did you mean {near}?"),
        None => format!("expected one of {}", known.join(", ")),
    };
    anyhow::anyhow!("there is no command {found}, {hint}")
}

/// Tells an error, in a line for each thing that is wrong.
fn refuse(error: &anyhow::Error) -> ExitCode {
    for line in format!("{error:#}").lines() {
        // With nowhere left to say it, the exit code says it.
        let line = sweep::shortened(line);
        // Escaped last, because the cut might go through an escape.
        let _ = writeln!(std::io::stderr(), "error: {}", sweep::visible(&line));
    }
    ExitCode::from(BAD_INPUT)
}
