//! Command-line arguments.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

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
  squama check sweeps/paper.toml                   what would run
  squama run sweeps/smoke.toml                     a handful of designs, in results/smoke/
  squama design sweeps/paper.toml --design 0417    one design, with its whole path
  squama status results/paper                      how far a run is

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
    /// Find the best designs of a run: by weights, for all weights, and without any
    Rank(RankArguments),
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
}

/// A definition and what is put in its place.
#[derive(Debug, Args)]
pub struct Definition {
    /// Sweep definition in TOML, or the run.toml of an earlier run
    #[arg(value_name = "SWEEP.toml")]
    pub path: PathBuf,

    /// Set a key of the definition, e.g. puncture.scales=41 (may be repeated)
    ///
    /// The key is dotted, the value is TOML; a single word needs no quotes. A parameter under
    /// `designs` becomes an axis of the grid, e.g. `designs.width_over_t=[1,2]`.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,
}

/// Arguments of `squama run`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama run sweeps/paper.toml
  squama run sweeps/paper.toml --resume
  squama run sweeps/paper.toml --set puncture.scales=41 --out results/short-rows
  squama run sweeps/paper.toml --set 'designs.c2=[0.23, 1.1]' --set name=exponent
  squama run sweeps/paper.toml --sample 100 --seed 7 --out results/sample
  squama run sweeps/paper.toml --shard 3/8

Writes designs.csv, a table for each measure, failures.csv and run.toml, from a journal to which
every design is added as it is done. The tables do not depend on the number of threads, nor on
how often the run was ended and resumed. The first SIGINT or SIGTERM ends the run once the designs in
hand are done, the second at once.
Exit code: 0 done, 1 some designs failed or are missing, 2 bad input or disk, 130 or 143 ended by
SIGINT or SIGTERM.")]
pub struct RunArguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Folder of the results [default: results/NAME, or results/NAME/shards/i-of-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Go on with the results that are there, if there are any
    #[arg(long, conflicts_with = "fresh")]
    pub resume: bool,

    /// Throw away the results that are there, if there are any
    #[arg(long)]
    pub fresh: bool,

    /// Solve a random subset of this many designs
    #[arg(long, value_name = "DESIGNS")]
    pub sample: Option<u64>,

    /// Seed of the random subset: the same seed, the same designs
    #[arg(long, value_name = "SEED", requires = "sample", default_value_t = 0)]
    pub seed: u64,

    /// Solve one shard: of N, the i-th, that is every N-th design from the i-th on
    #[arg(long, value_name = "i/N")]
    pub shard: Option<sweep::Shard>,

    #[command(flatten)]
    pub work: Work,

    #[command(flatten)]
    pub format: Format,
}

/// How designs are solved.
#[derive(Debug, Args)]
pub struct Work {
    /// Threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,

    /// End the run at the first design that fails
    #[arg(long)]
    pub fail_fast: bool,

    /// No progress bar and no summary
    #[arg(long, short)]
    pub quiet: bool,
}

/// The format of the tables.
#[derive(Debug, Args)]
pub struct Format {
    /// How the tables are written: plain (`,` between cells, `.` in decimals) or excel-eu (`;`, `,`
    /// and a byte-order mark) [default: as they were before, or plain]
    #[arg(long, value_name = "FORMAT")]
    pub csv: Option<results::CsvFormat>,
}

/// Arguments of `squama rerun`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama rerun results/paper --failed --dry-run
  squama rerun results/paper --failed --set solver.max_step=0.01
  squama rerun results/paper --design 0417,0533 --set puncture.scales=801
  squama rerun results/paper --where slant_deg=75 --where 'puncture_status=row limit'

Replaces the rows of these designs in every table. Their column `settings` then says what was set;
it is empty where the settings are the sweep's own. reruns.csv says which values have changed.
Without --set designs are solved with the sweep's own settings.
Exit code: 0 done, 1 some designs failed or are missing, 2 bad input or disk, 130 or 143 ended by
SIGINT or SIGTERM.")]
#[command(group(clap::ArgGroup::new("which").required(true).multiple(true)))]
pub struct RerunArguments {
    /// Folder of a run
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// Designs that lack a value
    #[arg(long, group = "which")]
    pub failed: bool,

    /// Designs with these numbers
    #[arg(long = "design", value_name = "NUMBER,…", group = "which", value_delimiter = ',')]
    pub numbers: Option<Vec<String>>,

    /// Designs with this value in a column of designs.csv (may be repeated: all must hold)
    #[arg(long = "where", value_name = "COLUMN=VALUE", group = "which")]
    pub conditions: Vec<run::ColumnFilter>,

    /// Set a key of the definition for these designs, e.g. `solver.max_step=0.01` (may be repeated)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,

    /// Say what would be solved, and solve nothing
    #[arg(long)]
    pub dry_run: bool,

    #[command(flatten)]
    pub work: Work,

    #[command(flatten)]
    pub format: Format,
}

/// Arguments of `squama status`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama status results/paper

The run may be going on meanwhile.
Exit code: 0 done, 1 some designs failed or are missing, 2 bad input.")]
pub struct StatusArguments {
    /// Folder of a run
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,
}

/// Arguments of `squama merge`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama merge results/paper/shards/* --out results/paper

Puts the results of shards together; the tables are those of a run without shards. What is in the
folder --out already stays there, so that merging again adds what has come meanwhile.
Exit code: 0 done, 1 some designs failed or are missing, 2 bad input or disk.")]
pub struct MergeArguments {
    /// Folders of the shards
    #[arg(value_name = "DIR", required = true)]
    pub folders: Vec<PathBuf>,

    /// Folder of the whole
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,

    /// No summary
    #[arg(long, short)]
    pub quiet: bool,

    #[command(flatten)]
    pub format: Format,
}

/// Arguments of `squama slurm`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama slurm sweeps/paper.toml --shards 20
  results/paper/slurm/submit.sh --time=12:00:00 --cpus-per-task=4

Writes submit.sh, which submits a job array with one element for each shard and a job that merges them,
to DIR/slurm, with the complete definition beside it. Shards go to DIR/shards, the whole to DIR. Submitted
again, shards go on where they ended. The folder may be moved.
Exit code: 0 done, 2 bad input or disk.")]
pub struct SlurmArguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Shards, 1 to 1000: elements of the job array
    #[arg(long, value_name = "N")]
    pub shards: u64,

    /// Folder of the results [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `squama design`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama design sweeps/paper.toml --design 0417
  squama design sweeps/paper.toml --gap 0.1 --length 1 --slant 75
  squama design sweeps/paper.toml --gap 0.15 --length 1 --slant 40 --set scale.width_over_t=2

Solves the design exactly as the sweep does. A design given by its lengths need not be on the
grid; if the grid has further axes, give a value for each with --set designs.KEY=VALUE.
Writes path.csv, events.csv, scales.csv, steps.csv (every Newton iteration), the same of bending
in flexure_path.csv and so on, and design.toml.
Exit code: 0 done, 1 the design stopped early, 2 bad input or disk.")]
pub struct DesignArguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Number of the design in the grid of the sweep
    #[arg(long = "design", value_name = "NUMBER", conflicts_with_all = ["gap", "length", "slant"], required_unless_present_any = ["gap", "length", "slant"])]
    pub number: Option<String>,

    /// Gap d/t
    #[arg(long, value_name = "GAP", allow_hyphen_values = true)]
    pub gap: Option<String>,

    /// Length L/t
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub length: Option<String>,

    /// Slant in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub slant: Option<String>,

    /// Folder of the files [default: results/NAME/designs/NUMBER]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `squama draw`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama draw sweeps/paper.toml --design 0417
  squama draw sweeps/paper.toml --design 0417 --at 0.1,0.4,0.7 --png
  squama draw sweeps/paper.toml --design 0417,0418 --flexure
  squama draw sweeps/paper.toml --design 0067,0070,0072 --force 0.1
  squama draw sweeps/paper.toml --design 0417 --animate

Shows the row at rest and at the critical tilt, or at the displacements u/t of --at; each is solved
for. Contacts are red, forces between scales are arrows, the bars are the reactions of the
substrate. With --flexure, the strip where its ends have turned by the angles of --at (degrees).")]
pub struct DrawArguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Numbers of the designs in the grid of the sweep
    #[arg(long = "design", value_name = "NUMBERS", value_delimiter = ',', required = true)]
    pub designs: Vec<String>,

    /// Displacements u/t of the punctured point, or rotations of the ends in degrees
    #[arg(long, value_name = "VALUES", value_delimiter = ',')]
    pub at: Vec<f64>,

    /// Puncture forces F* instead of displacements
    #[arg(long, value_name = "VALUES", value_delimiter = ',', conflicts_with_all = ["at", "flexure", "animate"])]
    pub force: Vec<f64>,

    /// The strip in bending instead of the puncture
    #[arg(long)]
    pub flexure: bool,

    /// An image beside each drawing, if squama is built with --features png
    #[arg(long)]
    pub png: bool,

    /// One page that plays the path instead of drawings
    #[arg(long)]
    pub animate: bool,

    /// Folder of the drawings [default: results/NAME/drawings]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `squama plot`.
#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "\
Examples:
  squama plot results/paper
  squama plot results/paper --png --out figures
  squama plot curves sweeps/paper.toml --design 0417,0418"
)]
pub struct PlotArguments {
    /// What to plot instead of a sweep
    #[command(subcommand)]
    pub what: Option<PlotWhat>,

    /// Folder of the results of a run
    #[arg(value_name = "RESULTS")]
    pub results: Option<PathBuf>,

    /// An image beside each figure, if squama is built with --features png
    #[arg(long)]
    pub png: bool,

    /// Folder of the figures [default: RESULTS/figures]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// What `squama plot` plots besides a sweep.
#[derive(Debug, Subcommand)]
pub enum PlotWhat {
    /// Force–displacement, moment–curvature and energies of designs, solved anew
    Curves(CurvesArguments),
}

/// Arguments of `squama plot curves`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama plot curves sweeps/paper.toml --design 0417,0418
  squama plot curves sweeps/paper.toml --design 0067,0070,0072 --to 0.7 --png")]
pub struct CurvesArguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Numbers of the designs in the grid of the sweep
    #[arg(long = "design", value_name = "NUMBERS", value_delimiter = ',', required = true)]
    pub designs: Vec<String>,

    /// Displacement u/t at which punctures end, instead of the critical tilt
    #[arg(long, value_name = "U")]
    pub to: Option<f64>,

    /// An image beside each figure, if squama is built with --features png
    #[arg(long)]
    pub png: bool,

    /// Folder of the figures [default: results/NAME/curves]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `squama report`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama report results/paper
  squama report results/paper --out paper.html

The page needs no network and no server: open it in a browser.")]
pub struct ReportArguments {
    /// Folder of the results of a run
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// The page [default: RESULTS/report.html]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// Arguments of `squama export`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama export results/paper --xlsx paper.xlsx

A sheet for each table of the folder, and one that explains the columns. The same tables make the
same bytes. A sheet takes 1,048,575 rows.
Exit code: 0 done, 2 bad input or disk.")]
pub struct ExportArguments {
    /// Folder of the results of a run
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// The workbook
    #[arg(long, value_name = "FILE")]
    pub xlsx: PathBuf,
}

/// Arguments of `squama rank`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama rank results/paper
  squama rank results/paper --weights 4,4,1,1 --top 20
  squama rank results/paper --require 'coverage >= 0.6' --require 'penetration < 0.3'
  squama rank results/paper --maximize critical_force --minimize gap_over_t
  squama rank results/paper --criteria coverage,max:peak_force,min:sink --scale log

Ranks the designs that meet all requirements and have every criterion: those of the paper (coverage,
critical force, penetration resistance, flexural compliance), or those of --criteria, or of --maximize
and --minimize. The fitness of a design is the product of its criteria, each rescaled from 0, the worst,
to 1, the best, to the power of its weight; with --scale linear or log it is their weighted mean. A
criterion without weight is ignored, and so is one that is the same for all but for round-off. Equal
designs stand in the order of their numbers.
Writes ranking.csv (by the weights), pareto.csv (designs that no other beats in every criterion),
ranking.toml (what the ranking goes by) and, with four criteria, winners.csv and quaternary.csv (the best
design for all weights). Where no design meets the requirements: the one that comes nearest, and which
requirement stands in the way.
Exit code: 0 done, 1 no design meets the requirements, 2 bad input or disk.")]
pub struct RankArguments {
    /// Folder of a run
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// A bound that designs must keep: >=, <=, >, < or == in any column of numbers (may be repeated: all must hold)
    #[arg(long, value_name = "COLUMN OP NUMBER")]
    pub require: Vec<String>,

    /// A column that is to be large (may be repeated: the Pareto front of all, and its knee)
    #[arg(long, value_name = "COLUMN", conflicts_with = "criteria")]
    pub maximize: Vec<String>,

    /// A column that is to be small (may be repeated)
    #[arg(long, value_name = "COLUMN", conflicts_with = "criteria")]
    pub minimize: Vec<String>,

    /// Criteria instead of those of the paper: max:COLUMN or min:COLUMN, or COLUMN where it is plain what is good
    #[arg(long, value_name = "CRITERION,…")]
    pub criteria: Option<String>,

    /// Weights of the criteria in their order, those of --maximize first [default: all the same]
    ///
    /// None is negative; they count in proportion, whatever their sum. The order of the paper's criteria is coverage,
    /// critical force, penetration resistance and flexural compliance.
    #[arg(long, value_name = "W,…", allow_hyphen_values = true)]
    pub weights: Option<String>,

    /// How criteria are rescaled: paper, linear or log
    #[arg(long, value_name = "SCALE", default_value = "paper")]
    pub scale: String,

    /// Designs that are printed
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub top: usize,

    /// Steps from one corner of the tetrahedron of weights to the next, 1 to 200
    #[arg(long, value_name = "R", allow_hyphen_values = true, default_value = "20")]
    pub resolution: String,

    /// Folder of the tables [default: RESULTS]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `squama compare`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama compare results/paper results/paper-as-written
  squama compare results/reference/paper results/paper --tolerance 1e-9 --exit-code

Designs are the same if their parameters are, whatever their numbers. With --out, writes
compare.csv (column by column) and differences.csv (cell by cell).
Exit code: 0 done, 1 the runs differ (with --exit-code), 2 bad input or disk.")]
pub struct CompareArguments {
    /// Folder of a run
    #[arg(value_name = "RESULTS")]
    pub first: PathBuf,

    /// Folder of another run
    #[arg(value_name = "OTHER")]
    pub second: PathBuf,

    /// Numbers are the same if they differ by at most this, relative to the larger
    #[arg(long, value_name = "T", allow_hyphen_values = true, default_value = "0")]
    pub tolerance: String,

    /// Exit with 1 if the runs differ
    #[arg(long)]
    pub exit_code: bool,

    /// Folder of the tables of what differs
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `squama check`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama check sweeps/paper.toml
  squama check sweeps/paper.toml --set 'designs.c2=[0.23, 1.1]'")]
pub struct CheckArguments {
    #[command(flatten)]
    pub definition: Definition,
}

/// Arguments of `squama calibrate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama calibrate --gap 0.1 --length 1
  squama calibrate --gap 0.1 --length 1 --width 2 --base 2L --poisson-ratio 0.3")]
pub struct CalibrateArguments {
    /// Gap d/t
    #[arg(long, value_name = "GAP", allow_hyphen_values = true)]
    pub gap: String,

    /// Length L/t
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub length: String,

    /// Out-of-plane width b/t
    #[arg(long, value_name = "WIDTH", allow_hyphen_values = true, default_value = "1")]
    pub width: String,

    /// Base of a scale, L or 2L
    #[arg(long, value_name = "BASE", default_value = "L")]
    pub base: String,

    /// Poisson's ratio of the substrate
    #[arg(long, value_name = "RATIO", allow_hyphen_values = true, default_value = "0.5")]
    pub poisson_ratio: String,
}

/// Arguments of `squama validate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama validate
  squama validate --out validation.md
  squama validate --search sweeps/open-questions.toml

Solves problems with known answers, both sweeps of the paper, and sweeps over what the paper leaves
open; prints the tables and writes them down. Takes about a minute on two cores. With --search, checks
the claims on every setting of a sweep over open choices instead, and prints what each reproduces.
Exit code: 0 done, 1 a benchmark is outside of its band, 2 disk. What becomes of the claims does not
change it.")]
pub struct ValidateArguments {
    /// The page
    #[arg(long, value_name = "FILE", default_value = "docs/validation.md")]
    pub out: PathBuf,

    /// A sweep of the paper's designs with further axes: which settings come closest to the claims
    #[arg(long, value_name = "SWEEP.toml", conflicts_with = "out")]
    pub search: Option<PathBuf>,
}
