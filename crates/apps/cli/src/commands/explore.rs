//! `squama explore`.

use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::ensure;
use clap::Args;
use optimisation::Statistic;
use ranking::Requirement;
use report::Explorer;
use results::shell_word;
use sweep::{Sweep, key};

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
  squama explore sweeps/glove.toml --require 'coverage >= 0.6' --require 'critical_force_N >= 2'
  squama explore sweeps/goals/strong-and-covered.toml --out goal.html --no-open

The page solves the design under your hand: drag a scale or a slider. It is one file that carries the
solver; it needs no network and no server. Sliders go from the smallest to the largest value of the
definition, and requirements are those of [goal], if there is one, and of --require.")]
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

/// Writes a page that solves, and opens it.
pub fn explore(arguments: &Arguments) -> anyhow::Result<u8> {
    let (sweep, mut requirements) = sweep_and_goal(&arguments.definition)?;
    // Its springs take boundary elements, which would make every page larger and slower than a hand.
    ensure!(
        !sweep.gives(key::TISSUE),
        "{}: a page solves skins on a half-space alone, `squama run` those on a layer",
        key::TISSUE
    );
    requirements.extend(arguments.required.read()?);
    // On the page they would stand in red and without a value, whatever the skin is.
    let of_samples = requirements.extract_if(.., |of| Statistic::named(&of.column).is_some());
    for requirement in of_samples {
        note(&format!(
            "left out: {requirement}, which many skins meet or not, and the page solves one"
        ));
    }
    require_folder_of("--out", &arguments.out)?;
    let Definition { path, settings } = &arguments.definition;
    // The page has a command to copy, so all is quoted for a shell.
    let settings = settings.iter().map(|setting| format!(" --set {}", shell_word(setting)));
    let page = Explorer {
        sweep,
        source: shell_word(&path.display().to_string()) + &settings.collect::<String>(),
        requirements: requirements.iter().map(ToString::to_string).collect(),
        version: PROGRAM.version.to_owned(),
    };
    let mut html = Vec::new();
    page.write(&mut html)?;
    write_file(&arguments.out, &html)?;
    print(&format!("{}\n", arguments.out.display()))?;
    // A script that writes pages shall open none.
    let is_watched = std::io::stdout().is_terminal();
    if is_watched && !arguments.no_open && !open(&arguments.out) {
        note("no browser was found: open the page yourself");
    }
    Ok(DONE)
}

/// The sweep of a definition, and the requirements of its goal if it has one.
fn sweep_and_goal(definition: &Definition) -> anyhow::Result<(Sweep, Vec<Requirement>)> {
    Ok(match defined(definition)? {
        Defined::Goal(goal) => (goal.space.sweep().clone(), goal.requirements),
        Defined::Sweep(sweep) => (*sweep, Vec::new()),
    })
}

/// Opens a page as the desktop does; whether there is a program for it.
fn open(page: &Path) -> bool {
    let program = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let mut command = Command::new(program);
    // Browsers talk to the terminal that has started them.
    command.arg(page).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // It is not waited for: a browser that opens may go on for hours.
    command.spawn().is_ok()
}
