//! The command `squama explore`, which writes an interactive page.

use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use optimisation::Statistic;
use ranking::Requirement;
use report::{Explorer, SolvedTable};
use results::columns::name;
use results::{Completeness, Results, ResultsFolder, VerifiedFolder};
use sweep::Sweep;
use text::shell_word;

use super::answer::SearchedDesign;
use super::figure_file::write_file;
use super::requirement_args::RequirementArgs;
use super::source::{Defined, Definition, defined, require_folder_of};
use super::{DONE, PROGRAM};
use crate::print::{note, print};

/// Arguments of `squama explore`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama explore sweeps/glove.toml
  squama explore sweeps/glove.toml --require 'coverage >= 0.4' --require 'failure_force_N >= 0.5'
  squama explore sweeps/goals/strong-and-covered.toml --out goal.html --no-open

Drag a scale or a slider, and the page solves the design. The page is one file that contains the solver and
needs no network and no server. Sliders range from the smallest to the largest value in the definition; the
slider of the body curvature ranges from concave through flat to convex. The requirements come from [goal], if
there is one, and from --require; a field on the page accepts more requirements in words, and searches for a
design that meets them. A results folder adds its solved designs to this search.")]
pub struct Arguments {
    #[command(flatten)]
    pub definition: Definition,

    #[command(flatten)]
    pub required: RequirementArgs,

    /// Page to write
    #[arg(long, value_name = "FILE", default_value = "explore.html")]
    pub out: PathBuf,

    /// Do not open the page in a browser
    #[arg(long)]
    pub no_open: bool,
}

/// Writes the interactive page and opens it.
pub fn explore(arguments: &Arguments) -> anyhow::Result<u8> {
    let (sweep, mut requirements) = sweep_and_goal(&arguments.definition)?;
    let searched = SearchedDesign::read(&arguments.definition.path)?;
    let failed = searched.failed_checks.iter();
    let failed = failed.map(|check| format!("The optimum fails a check: {check}"));
    requirements.extend(searched.requirements);
    requirements.extend(arguments.required.read()?);
    // Omit requirements on statistics of samples, because the page solves only single designs.
    let of_samples = requirements.extract_if(.., |of| Statistic::named(&of.column).is_some());
    for requirement in of_samples {
        note(&format!(
            "{requirement} is left out: it concerns many samples, and the page solves one design"
        ));
    }
    require_folder_of("--out", &arguments.out)?;
    let Definition { path, settings } = &arguments.definition;
    let solved = solved_designs(path, &sweep)?;
    // Quote the settings for a shell, because users copy a command from the page.
    let settings = settings.iter().map(|setting| format!(" --set {}", shell_word(setting)));
    let page = Explorer {
        solved,
        sweep,
        variables: searched.variables,
        source: shell_word(&path.display().to_string()) + &settings.collect::<String>(),
        requirements: requirements.iter().map(ToString::to_string).collect(),
        notes: failed.collect(),
        version: PROGRAM.version.to_owned(),
    };
    let mut html = Vec::new();
    page.write(&mut html)?;
    write_file(&arguments.out, &html)?;
    print(&format!("{}\n", arguments.out.display()))?;
    // Open a browser only if stdout is a terminal, not in a script.
    let is_terminal = std::io::stdout().is_terminal();
    if is_terminal && !arguments.no_open && !open(&arguments.out) {
        note("no browser was found: open the page by hand");
    }
    Ok(DONE)
}

/// Columns that requirements in the text field of the page can limit.
const REQUIRED: [&str; 7] = [
    name::COVERAGE,
    "failure_force_N",
    "critical_force_N",
    "bend_radius_mm",
    "clearance_mm",
    "critical_displacement_mm",
    "areal_mass_kg_m2",
];

/// Maximum number of solved designs on a page.
const MOST_SOLVED: usize = 5000;

/// Returns the solved designs of a results folder; an empty table if `path` is a definition.
fn solved_designs(path: &Path, sweep: &Sweep) -> anyhow::Result<SolvedTable> {
    if !path.join(ResultsFolder::RUN_INFO).is_file() {
        return Ok(SolvedTable::default());
    }
    let results =
        Results::thinned(&VerifiedFolder::open(path, Completeness::Partial)?, MOST_SOLVED)?;
    let axes = sweep.grid().axes().iter().map(|axis| axis.parameter().key);
    let known = axes.chain(REQUIRED).filter_map(|name| Some((name, results.column(name).ok()?)));
    let (columns, indices): (Vec<_>, Vec<_>) =
        known.map(|(name, index)| (name.to_owned(), index)).unzip();
    let rows = (0..results.len())
        .map(|row| indices.iter().map(|k| results.number(row, *k).ok().flatten()).collect());
    Ok(SolvedTable { columns, rows: rows.collect() })
}

/// Returns the sweep of a definition, and the requirements of its goal if it has one.
fn sweep_and_goal(definition: &Definition) -> anyhow::Result<(Sweep, Vec<Requirement>)> {
    Ok(match defined(definition)? {
        Defined::Goal(goal) => (goal.space.sweep().clone(), goal.requirements),
        Defined::Sweep(sweep) => (*sweep, Vec::new()),
    })
}

/// Opens a page in the default browser; returns false if there is none.
fn open(page: &Path) -> bool {
    let program = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let mut command = Command::new(program);
    // Discard the output, because browsers print messages to the terminal.
    command.arg(page).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // Do not wait for the browser, which may run for hours.
    command.spawn().is_ok()
}
