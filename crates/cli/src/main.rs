//! The `squama` command: designs flexible armour by sweeping over skins of hard scales.
//!
//! | Module | Role |
//! |---|---|
//! | `args` | command-line arguments |
//! | `commands` | one file per command |
//! | `interrupt` | signals that ask a run to end |
//! | `progress` | the bar on the terminal |
//! | `print` | text for people: aligned tables, closed pipes |

mod args;
mod commands;
mod interrupt;
mod print;
mod progress;

use std::io::Write as _;
use std::process::ExitCode;

use clap::Parser as _;

use crate::args::{Arguments, Command};

/// The input, or the disk, is at fault.
const BAD_INPUT: u8 = 2;

fn main() -> ExitCode {
    let command = match Arguments::try_parse() {
        Ok(arguments) => arguments.command,
        Err(error) if error.use_stderr() && !is_help(&error) => return refuse(&one_line(&error)),
        Err(error) => error.exit(),
    };
    let done = match command {
        Command::Run(arguments) => commands::run(&arguments),
        Command::Rerun(arguments) => commands::rerun(&arguments),
        Command::Status(arguments) => commands::status(&arguments),
        Command::Merge(arguments) => commands::merge(&arguments),
        Command::Slurm(arguments) => commands::slurm(&arguments),
        Command::Design(arguments) => commands::design(&arguments),
        Command::Rank(arguments) => commands::rank(&arguments),
        Command::Compare(arguments) => commands::compare(&arguments),
        Command::Draw(arguments) => commands::draw(&arguments),
        Command::Plot(arguments) => commands::plot(&arguments),
        Command::Report(arguments) => commands::report(&arguments),
        Command::Export(arguments) => commands::export(&arguments),
        Command::Check(arguments) => commands::check(&arguments),
        Command::Calibrate(arguments) => commands::calibrate(&arguments),
        Command::Validate(arguments) => commands::validate(&arguments),
    };
    done.map_or_else(|error| refuse(&error), ExitCode::from)
}

/// Whether the error is a question for help.
fn is_help(error: &clap::Error) -> bool {
    error.kind() == clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
}

/// The fault of the arguments in one line, without the advice that follows it.
fn one_line(error: &clap::Error) -> anyhow::Error {
    let text = error.to_string();
    let lines = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    let lines = lines.filter(|line| !line.is_empty() && !line.starts_with("For more information"));
    let lines: Vec<_> = lines.collect();
    let line = lines.join(", ").replace(":, ", ": ");
    anyhow::anyhow!(line.trim_start_matches("error: ").to_owned())
}

fn refuse(error: &anyhow::Error) -> ExitCode {
    // With nowhere left to say it, the exit code says it.
    let _ = writeln!(std::io::stderr(), "error: {error:#}");
    ExitCode::from(BAD_INPUT)
}
