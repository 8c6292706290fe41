//! The `squama` command: designs flexible armour by sweeping over skins of hard scales.
//!
//! | Module | Role |
//! |---|---|
//! | `commands` | command-line arguments, and a file per command |
//! | `interrupt` | handling of termination signals |
//! | `progress` | progress bar on the terminal |
//! | `print`, `json` | output as text (aligned tables) or as JSON |

mod commands;
mod interrupt;
mod json;
mod print;
mod progress;

use std::io::Write as _;
use std::process::ExitCode;

use clap::CommandFactory as _;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use crate::commands::Arguments;
use crate::interrupt::Interrupt;

/// Exit code for bad input or a disk error.
const BAD_INPUT: u8 = 2;

fn main() -> ExitCode {
    let command = match commands::parsed() {
        Ok(arguments) => arguments.command,
        // Errors are printed on one line. Help and version are printed by clap, on several lines.
        Err(error) if error.use_stderr() && !is_help(&error) => return refuse(&one_line(&error)),
        Err(error) => error.exit(),
    };
    // Install the signal handlers before a command opens any file, so that a signal never leaves a
    // partial file.
    let interrupt = match Interrupt::listen() {
        Ok(interrupt) => interrupt,
        Err(error) => {
            return refuse(&anyhow::Error::new(error).context("cannot listen to signals"));
        }
    };
    command.run(&interrupt).map_or_else(|error| refuse(&error), ExitCode::from)
}

/// Returns true if clap shows the help because an argument or a command is missing.
fn is_help(error: &clap::Error) -> bool {
    error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
}

/// Formats an argument error on one line, without the usage and hints that clap adds.
fn one_line(error: &clap::Error) -> anyhow::Error {
    if let Some(ContextValue::String(found)) = error.get(ContextKind::InvalidSubcommand) {
        return no_such_command(found);
    }
    let text = error.to_string();
    let lines = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    // Omit the tip to pass `-- VALUE`, which is wrong here: options accept negative numbers.
    let advice = ["For more information", "tip: to pass"];
    let lines = lines
        .filter(|line| !line.is_empty() && !advice.iter().any(|advice| line.starts_with(advice)));
    let lines: Vec<_> = lines.collect();
    // Clap prints the items of a list on separate lines, after a line that ends in a colon.
    let line = lines.join(", ").replace(":, ", ": ");
    let line = line.trim_start_matches("error: ");
    match error.get(ContextKind::Usage) {
        // Refer to the help if clap suggests no similar option.
        Some(usage) if error.kind() == ErrorKind::UnknownArgument && !line.contains("tip:") => {
            let usage = usage.to_string();
            let words = usage.trim_start_matches("Usage:").split_whitespace();
            let command: Vec<_> =
                words.take_while(|word| !word.starts_with(['[', '<', '-'])).collect();
            anyhow::anyhow!("{line}; {} --help lists the options", command.join(" "))
        }
        _ => anyhow::anyhow!(line.to_owned()),
    }
}

/// Returns the error for an unknown command.
fn no_such_command(found: &str) -> anyhow::Error {
    let squama = Arguments::command();
    let known: Vec<_> = squama.get_subcommands().map(clap::Command::get_name).collect();
    let hint = match text::nearest(found, &known) {
        Some(near) => format!("did you mean {near}?"),
        None => format!("expected one of {}", known.join(", ")),
    };
    anyhow::anyhow!("there is no command {found}, {hint}")
}

/// Prints an error, one line per problem, and returns the exit code.
fn refuse(error: &anyhow::Error) -> ExitCode {
    for line in format!("{error:#}").lines() {
        // Shorten before escaping, because shortening could cut an escape sequence.
        let line = text::shortened(line);
        // Ignore a closed stderr: the exit code still reports the error.
        let _ = writeln!(std::io::stderr(), "error: {}", text::visible(&line));
    }
    ExitCode::from(BAD_INPUT)
}
