//! The commands: a file for each, with its arguments and what it does, and files that several share.

mod audit;
mod calibrate;
mod check;
mod compare;
mod completions;
mod derived;
mod design;
mod draw;
mod export;
mod figure_file;
mod init;
mod man;
mod merge;
mod optimise;
mod plot;
mod rank;
mod report;
mod rerun;
mod results_folder;
mod run;
mod selection;
mod sensitivity;
mod slurm;
mod source;
mod status;
mod tolerance;
mod validate;
mod work;

use ::run::Program;
use clap::{Parser, Subcommand};

use crate::interrupt::Interrupt;

/// This program.
const PROGRAM: Program =
    Program { version: env!("CARGO_PKG_VERSION"), revision: env!("SQUAMA_REVISION") };

/// Exit code of a command that was done.
const DONE: u8 = 0;
/// Exit code when designs failed or are missing.
const INCOMPLETE: u8 = 1;
/// Exit code when two runs differ and the exit code is to say so.
const DIFFERENT: u8 = 1;

/// Version and revision of the source.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (", env!("SQUAMA_REVISION"), ")");

/// Design flexible armour: solve every design of a sweep over skins of hard scales.
#[derive(Debug, Parser)]
#[command(
    name = "squama",
    version = VERSION,
    arg_required_else_help = true,
    after_help = "\
Examples:
  squama init smoke                         a commented definition, in smoke.toml
  squama check smoke.toml                   what would run
  squama run smoke.toml                     a handful of designs, in results/smoke/
  squama design smoke.toml --design 0007    one design, with its whole path
  squama status results/smoke               how far a run is

A folder of results does where a definition is asked for, and the other way round.

Exit code: 0 done, 1 some designs failed or are missing, 2 bad input or disk."
)]
pub struct Arguments {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

/// The command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a commented definition to begin with
    Init(init::Arguments),
    /// Solve every design of a sweep and write the tables
    Run(run::Arguments),
    /// Solve some designs of a run again, with other settings
    Rerun(rerun::Arguments),
    /// Say how far a run is, what failed and why
    Status(status::Arguments),
    /// Put the shards of a sweep together
    Merge(merge::Arguments),
    /// Write the scripts that run a sweep on a cluster with Slurm
    Slurm(slurm::Arguments),
    /// Solve one design, print its measures and write its path
    Design(design::Arguments),
    /// Say how far what is made may differ from what is drawn, and how much of it meets what is required
    Tolerance(tolerance::Arguments),
    /// Say which parameters the measures depend on most, over a box of them
    Sensitivity(sensitivity::Arguments),
    /// Find the best designs of a run: by weights, for all weights, and without any
    Rank(rank::Arguments),
    /// Find the best designs between the grid points, as a goal asks for them
    #[command(visible_alias = "optimize")]
    Optimise(optimise::Arguments),
    /// Say where two runs differ, and by how much
    Compare(compare::Arguments),
    /// Draw designs to scale: at rest, punctured, bent
    Draw(draw::Arguments),
    /// Plot the figures of a sweep, or the curves of designs
    Plot(plot::Arguments),
    /// Write one page that shows a sweep
    Report(report::Arguments),
    /// Write the tables of a run as one workbook for Excel and other spreadsheets
    Export(export::Arguments),
    /// Validate a sweep definition and say what would run
    Check(check::Arguments),
    /// Print the springs that stand for the substrate under a row of scales
    Calibrate(calibrate::Arguments),
    /// Show what squama reproduces: benchmarks, the claims of the paper, sensitivity
    Validate(validate::Arguments),
    /// Print completions for a shell
    Completions(completions::Arguments),
    /// Write manual pages
    Man(man::Arguments),
}

impl Command {
    /// Does what the command asks for, and returns its exit code.
    pub fn run(self, interrupt: &Interrupt) -> anyhow::Result<u8> {
        match self {
            Self::Init(arguments) => init::init(&arguments),
            Self::Run(arguments) => run::run(&arguments, interrupt),
            Self::Rerun(arguments) => rerun::rerun(&arguments, interrupt),
            Self::Status(arguments) => status::status(&arguments),
            Self::Merge(arguments) => merge::merge(&arguments),
            Self::Slurm(arguments) => slurm::slurm(&arguments),
            Self::Design(arguments) => design::design(&arguments),
            Self::Tolerance(arguments) => tolerance::tolerance(&arguments, interrupt),
            Self::Sensitivity(arguments) => sensitivity::sensitivity(&arguments, interrupt),
            Self::Rank(arguments) => rank::rank(&arguments),
            Self::Optimise(arguments) => optimise::optimise(&arguments, interrupt),
            Self::Compare(arguments) => compare::compare(&arguments),
            Self::Draw(arguments) => draw::draw(&arguments),
            Self::Plot(arguments) => plot::plot(&arguments),
            Self::Report(arguments) => report::report(&arguments),
            Self::Export(arguments) => export::export(&arguments),
            Self::Check(arguments) => check::check(&arguments),
            Self::Calibrate(arguments) => calibrate::calibrate(&arguments),
            Self::Validate(arguments) => validate::validate(&arguments),
            Self::Completions(arguments) => completions::completions(&arguments),
            Self::Man(arguments) => man::man(&arguments),
        }
    }
}
