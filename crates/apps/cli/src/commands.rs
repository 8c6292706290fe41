//! The commands of squama, each in its own file, and modules that several commands share.

mod answer;
mod audit;
mod calibrate;
mod check;
mod compare;
mod completions;
mod couplings;
mod derivation;
mod design;
mod draw;
mod explore;
mod export;
mod figure_file;
mod fit;
mod folder_contents;
mod init;
mod make;
mod man;
mod measured;
mod merge;
mod optimise;
mod options;
mod own_files;
mod plot;
mod rank;
mod report;
mod requirement_args;
mod rerun;
mod run;
mod sample_args;
mod schema;
mod selection;
mod sensitivity;
mod slurm;
mod source;
mod status;
mod tolerance;
mod validate;

use ::run::Program;
use clap::{CommandFactory as _, FromArgMatches as _, Parser, Subcommand};

use crate::interrupt::Interrupt;

/// Version and source revision of the program; results record both.
const PROGRAM: Program =
    Program { version: env!("CARGO_PKG_VERSION"), revision: env!("SQUAMA_REVISION") };

/// Exit code of a completed command.
const DONE: u8 = 0;
/// Exit code if designs failed or are missing, or if no design meets the requirements.
const INCOMPLETE: u8 = 1;
/// Exit code of `squama compare --exit-code` if the two runs differ.
const DIFFERENT: u8 = 1;

/// Output of `squama --version` after the name: version and source revision.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (", env!("SQUAMA_REVISION"), ")");

/// Design flexible armour: solve, rank and optimise skins of hard scales.
#[derive(Debug, Parser)]
#[command(
    name = "squama",
    version = VERSION,
    arg_required_else_help = true,
    after_help = "\
Examples:
  squama init smoke                         write a commented definition, smoke.toml
  squama check smoke.toml                   show what would run
  squama run smoke.toml                     solve a handful of designs, into results/smoke/
  squama rank results/smoke                 show the best of them
  squama design smoke.toml --design 0007    solve one design, with its whole path

Commands accept a definition or a results folder.

Exit code: 0 done, 1 some designs failed or are missing, 2 bad input or a disk error."
)]
pub struct Arguments {
    /// Command to run, with its arguments.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands, with their arguments.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a commented definition to start from
    Init(init::Arguments),
    /// Solve every design of a sweep and write the tables
    Run(run::Arguments),
    /// Solve some designs of a run again, with other settings
    Rerun(rerun::Arguments),
    /// Show how far a run is, which designs failed, and why
    Status(status::Arguments),
    /// Combine the shards of a sweep in one results folder
    Merge(merge::Arguments),
    /// Write the scripts that run a sweep on a Slurm cluster
    Slurm(slurm::Arguments),
    /// Solve one design, print its measures and write its path
    Design(design::Arguments),
    /// Predict the effect of manufacturing tolerances, and the yield
    Tolerance(tolerance::Arguments),
    /// Find the parameters that the measures depend on most, over whole ranges
    Sensitivity(sensitivity::Arguments),
    /// Rank designs by weighted criteria, and list the Pareto front
    Rank(rank::Arguments),
    /// Search between the grid points for the optimum of a goal, or its Pareto front
    #[command(visible_alias = "optimize")]
    Optimise(optimise::Arguments),
    /// Fit moduli, friction and lengths of a skin to test data
    Fit(fit::Arguments),
    /// Show where two runs differ, and by how much
    Compare(compare::Arguments),
    /// Draw designs to scale: at rest, punctured, bent
    Draw(draw::Arguments),
    /// Write a design as a file for a printer, a CAD program or a laser cutter
    Make(make::Arguments),
    /// Plot the figures of a sweep, a map, or the curves of designs
    Plot(plot::Arguments),
    /// Write one HTML page with the figures and designs of a sweep
    Report(report::Arguments),
    /// Write an HTML page to try a design interactively, and open it
    Explore(explore::Arguments),
    /// Write the tables of a run as one workbook for Excel and other spreadsheets
    Export(export::Arguments),
    /// Check a definition and show what would run
    Check(check::Arguments),
    /// Print the JSON schema of definitions, for editors
    Schema(schema::Arguments),
    /// Print the stiffness of the springs that represent the substrate
    Calibrate(calibrate::Arguments),
    /// Compare squama with benchmarks and with the claims of the paper
    Validate(validate::Arguments),
    /// Print shell completions
    Completions(completions::Arguments),
    /// Write manual pages
    Man(man::Arguments),
}

/// Groups of commands in the help: the heading of each group and its commands.
const GROUPS: [(&str, &[&str]); 5] = [
    ("Try", &["init", "check", "explore", "schema"]),
    ("Solve", &["run", "design", "optimise", "sensitivity"]),
    ("Choose", &["rank", "tolerance", "report", "plot", "draw"]),
    ("Make and test", &["make", "fit", "export"]),
    (
        "Upkeep",
        &[
            "status",
            "rerun",
            "merge",
            "compare",
            "slurm",
            "calibrate",
            "validate",
            "completions",
            "man",
            "help",
        ],
    ),
];

/// Clap template of the help; `{before-help}` contains the commands by group.
const TEMPLATE: &str = "{about-with-newline}\n{usage-heading} {usage}\n\n{before-help}\
    Options:\n{options}{after-help}";

/// Parses the command line.
pub fn parsed() -> Result<Arguments, clap::Error> {
    let squama = Arguments::command();
    let groups = grouped(&squama);
    let squama = squama.help_template(TEMPLATE).before_help(groups);
    Arguments::from_arg_matches(&squama.try_get_matches()?)
}

/// Lists the commands by group, with their descriptions, for the help.
fn grouped(squama: &clap::Command) -> String {
    let mut text = String::new();
    for (group, names) in GROUPS {
        text.extend([group, ":\n"]);
        for name in names {
            let about = squama.find_subcommand(name).and_then(clap::Command::get_about);
            // Clap adds the command `help` when it parses, so the command has no description here.
            let about = about.map_or("Print the help of a command".to_owned(), ToString::to_string);
            text.extend(["  ", &format!("{name:12}"), " ", &about, "\n"]);
        }
        text.push('\n');
    }
    text
}

impl Command {
    /// Runs the command and returns its exit code.
    pub fn run(self, interrupt: &Interrupt) -> anyhow::Result<u8> {
        match self {
            // The first signal ends a command that does not take `interrupt`: the command has no
            // work to save.
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
            Self::Fit(arguments) => fit::fit(&arguments, interrupt),
            Self::Compare(arguments) => compare::compare(&arguments),
            Self::Draw(arguments) => draw::draw(&arguments),
            Self::Make(arguments) => make::make(&arguments, interrupt),
            Self::Plot(arguments) => plot::plot(&arguments),
            Self::Report(arguments) => report::report(&arguments),
            Self::Explore(arguments) => explore::explore(&arguments),
            Self::Export(arguments) => export::export(&arguments),
            Self::Check(arguments) => check::check(&arguments),
            Self::Schema(arguments) => schema::schema(&arguments),
            Self::Calibrate(arguments) => calibrate::calibrate(&arguments),
            Self::Validate(arguments) => validate::validate(&arguments),
            Self::Completions(arguments) => completions::completions(&arguments),
            Self::Man(arguments) => man::man(&arguments),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_is_in_one_group_of_the_help() {
        let mut squama = Arguments::command();
        squama.build();
        let mut known: Vec<_> = squama.get_subcommands().map(clap::Command::get_name).collect();
        let mut grouped: Vec<_> = GROUPS.iter().flat_map(|(_, names)| *names).copied().collect();
        known.sort_unstable();
        grouped.sort_unstable();
        assert_eq!(known, grouped);
    }
}
