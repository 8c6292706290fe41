//! `squama explore`.

use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use optimisation::Statistic;
use ranking::Requirement;
use report::Explorer;
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

Drag a scale or a slider, and the page solves the design. It is one file that contains the solver; it needs
no network and no server. Sliders range from the smallest to the largest value in the definition; the one of
the body ranges from a concave over a flat to a convex body. The requirements come from [goal], if there is
one, and from --require.")]
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
    let SearchedDesign { failed_checks, .. } = SearchedDesign::read(&arguments.definition.path)?;
    let failed = failed_checks.iter().map(|check| format!("The optimum fails a check: {check}"));
    requirements.extend(arguments.required.read()?);
    // On the page they would never have a value.
    let of_samples = requirements.extract_if(.., |of| Statistic::named(&of.column).is_some());
    for requirement in of_samples {
        note(&format!(
            "{requirement} is left out: it concerns many samples, and the page solves one design"
        ));
    }
    require_folder_of("--out", &arguments.out)?;
    let Definition { path, settings } = &arguments.definition;
    // Quoted for a shell, because the page contains a command to copy.
    let settings = settings.iter().map(|setting| format!(" --set {}", shell_word(setting)));
    let page = Explorer {
        sweep,
        source: shell_word(&path.display().to_string()) + &settings.collect::<String>(),
        requirements: requirements.iter().map(ToString::to_string).collect(),
        notes: failed.collect(),
        version: PROGRAM.version.to_owned(),
    };
    let mut html = Vec::new();
    page.write(&mut html)?;
    write_file(&arguments.out, &html)?;
    print(&format!("{}\n", arguments.out.display()))?;
    // Scripts do not open a browser.
    let is_watched = std::io::stdout().is_terminal();
    if is_watched && !arguments.no_open && !open(&arguments.out) {
        note("no browser was found: open the page by hand");
    }
    Ok(DONE)
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
    // Browsers would print messages to the terminal.
    command.arg(page).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // Not waited for: the browser may run for hours.
    command.spawn().is_ok()
}
