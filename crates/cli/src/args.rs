//! Command-line arguments: a file per command, and one each for what several share.

mod calibrate;
mod check;
mod compare;
mod completions;
mod definition;
mod design;
mod draw;
mod earlier;
mod export;
mod figure_output;
mod init;
mod man;
mod merge;
mod optimise;
mod partial;
mod plot;
mod rank;
mod report;
mod rerun;
mod run;
mod selection;
mod sensitivity;
mod slurm;
mod status;
mod threads;
mod tolerance;
mod validate;
mod work;

pub use calibrate::CalibrateArguments;
pub use check::CheckArguments;
pub use compare::CompareArguments;
pub use completions::CompletionsArguments;
pub use definition::Definition;
pub use design::DesignArguments;
pub use draw::DrawArguments;
pub use earlier::Earlier;
pub use export::ExportArguments;
pub use figure_output::FigureOutput;
pub use init::InitArguments;
pub use man::ManArguments;
pub use merge::MergeArguments;
pub use optimise::OptimiseArguments;
pub use partial::Partial;
pub use plot::{CurvesArguments, MapArguments, PlotArguments, PlotWhat};
pub use rank::RankArguments;
pub use report::ReportArguments;
pub use rerun::RerunArguments;
pub use run::RunArguments;
pub use selection::Selection;
pub use sensitivity::SensitivityArguments;
pub use slurm::SlurmArguments;
pub use status::StatusArguments;
pub use threads::Threads;
pub use tolerance::ToleranceArguments;
pub use validate::ValidateArguments;
pub use work::{Format, Work};

use clap::{Parser, Subcommand};

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
    Init(InitArguments),
    /// Solve every design of a sweep and write the tables
    Run(RunArguments),
    /// Solve some designs of a run again, with other settings
    Rerun(RerunArguments),
    /// Say how far a run is, what failed and why
    Status(StatusArguments),
    /// Put the shards of a sweep together
    Merge(MergeArguments),
    /// Write the scripts that run a sweep on a cluster with Slurm
    Slurm(SlurmArguments),
    /// Solve one design, print its measures and write its path
    Design(DesignArguments),
    /// Say how far what is made may differ from what is drawn, and how much of it meets what is required
    Tolerance(ToleranceArguments),
    /// Say which parameters the measures depend on most, over a box of them
    Sensitivity(SensitivityArguments),
    /// Find the best designs of a run: by weights, for all weights, and without any
    Rank(RankArguments),
    /// Find the best designs between the grid points, as a goal asks for them
    #[command(visible_alias = "optimize")]
    Optimise(OptimiseArguments),
    /// Say where two runs differ, and by how much
    Compare(CompareArguments),
    /// Draw designs to scale: at rest, punctured, bent
    Draw(DrawArguments),
    /// Plot the figures of a sweep, or the curves of designs
    Plot(PlotArguments),
    /// Write one page that shows a sweep
    Report(ReportArguments),
    /// Write the tables of a run as one workbook for Excel and other spreadsheets
    Export(ExportArguments),
    /// Validate a sweep definition and say what would run
    Check(CheckArguments),
    /// Print the springs that stand for the substrate under a row of scales
    Calibrate(CalibrateArguments),
    /// Show what squama reproduces: benchmarks, the claims of the paper, sensitivity
    Validate(ValidateArguments),
    /// Print completions for a shell
    Completions(CompletionsArguments),
    /// Write manual pages
    Man(ManArguments),
}
