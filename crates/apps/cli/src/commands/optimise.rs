//! The command `squama optimise`, which searches for the best designs of a goal.

mod figures;
mod record;
mod report;
mod samples;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use ::report::Figure;
use clap::Args;
use optimisation::{Answer, DesignGoal, Found, SearchOptions, SearchProgress, write_found};
use ranking::TILTING_ONLY;
use results::ResultsFolder;
use sweep::Setting;

use super::options::{EarlierResults, SolveOptions, TableFormat, decimal};
use super::requirement_args::RequirementArgs;
use super::source::{folder_of, print_notes, settings};
use super::{DONE, INCOMPLETE, PROGRAM};
use crate::interrupt::Interrupt;
use crate::json;
use crate::print::note;
use crate::progress::{Display, RESUMED};
use figures::figures;
use record::record;
use report::SearchReport;

/// Arguments of `squama optimise`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama optimise sweeps/goals/strong-and-covered.toml
  squama optimise glove.toml --set 'goal.require=[\"coverage >= 0.6\"]' --out results/glove-60
  squama optimise sweeps/goals/pin.toml --require 'failure_force_N >= 5' --require 'gap_mm >= 0.4'
  squama optimise sweeps/goals/pin.toml --require 'failure_force_N >= 5' --round 0.05
  squama optimise glove.toml --set goal.seed=1 --fresh
  squama optimise glove.toml --resume

A goal is a definition with two more sections. [variables] lists the parameters to search over: ranges, such
as gap_over_t = { from = 0.1, to = 1 }, or lists of values. [goal] has maximize or minimize (one column gives
the optimum, two to four give a Pareto front) and require, a list of constraints on columns; --require adds to it,
and protects = \"needle 2\" adds a level of a standard. Every other parameter has one value. The search leaves out
designs that fail, and designs with a fold of the surface unless sound = false, and states their numbers.
One objective may be fitness (Eq. 7 of the paper). weights = { coverage = 1, compliance = 2 } names its criteria
[default: the paper's four, with equal weights]; rescale = { coverage = [0, 0.9] } gives the worst and the best
value of a criterion [default: those of the sample].
With a [tolerance] section (see squama tolerance), the goal may also name statistics over samples: quantiles, such
as critical_force_p05 (or _p50, _p95), and yield, the fraction of samples that meet all constraints on columns and do
not fold (unless sound = false), as in require = [\"coverage >= 0.5\", \"yield >= 0.9\"]. The search solves
skins = 200 samples of each design, with the same deviations for all, and five times as many near the best.
Finally it solves 1000 new samples of the best design, and shows their statistics beside those of the search.
The search first solves samples = 128 designs that fill the space; a front has points = 30 designs; seed = 0
selects the random numbers.
Writes optimum.csv, optimum.toml, the definition of the best design, and optimum.svg, its drawing, or front.csv;
history.csv with every design of the search; and evaluations.jsonl, from which --resume continues. The results do
not depend on the number of threads.
Checks solve the best design with full substrate coupling, at 11 load positions under a guided needle, and with
new samples. A requirement that a check contradicts is reported below the answer. With confirm = true in [goal]
the search tightens the limits until the checks pass. With --round the answer is the best rounded design near the
best one that still meets the requirements, and states the loss.
Exit code: 0 done, 1 no design meets the constraints, no rounded design meets them, or a check of the best
design contradicts a constraint, 2 bad input or a disk error, 130, 143 or 129 ended by SIGINT, SIGTERM or SIGHUP.")]
pub struct Arguments {
    /// Goal in TOML
    #[arg(value_name = "GOAL.toml")]
    pub path: PathBuf,

    /// Set a key of the goal, e.g. goal.seed=1 (may be repeated)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,

    #[command(flatten)]
    pub required: RequirementArgs,

    /// Round the lengths of the best design to multiples of STEP mm, and angles to whole degrees
    ///
    /// The same as goal.round. Without a thickness in mm, STEP is a fraction of the thickness.
    #[arg(long, value_name = "STEP", allow_hyphen_values = true, value_parser = decimal)]
    pub round: Option<f64>,

    /// Results folder [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    #[command(flatten)]
    pub earlier: EarlierResults,

    #[command(flatten)]
    pub solving: SolveOptions,

    #[command(flatten)]
    pub format: TableFormat,
}

/// Searches for the best designs of a goal and writes them.
pub fn optimise(arguments: &Arguments, interrupt: &Interrupt) -> anyhow::Result<u8> {
    let (mut settings, required) = (settings(&arguments.settings)?, arguments.required.read()?);
    if let Some(step) = arguments.round {
        settings.push(Setting::parse(&format!("goal.round={step}"))?);
    }
    let goal = DesignGoal::read_with(&arguments.path, &settings, &required)?;
    print_notes(goal.space.sweep());
    for standard in &goal.standards {
        note(&format!("goal.protects: {}; {TILTING_ONLY}", standard.source));
    }
    let folder = folder_of(goal.space.sweep(), arguments.out.as_deref());
    interrupt.end_gracefully();
    let begun = Instant::now();
    let display = Display::new(arguments.solving.quiet, interrupt, Arc::default(), RESUMED);
    let options = options(arguments, interrupt, &display);
    let found = optimisation::optimise(&goal, &folder, &options, &PROGRAM)?;
    // Remove the progress bar before printing.
    drop(display);
    let Some(found) = found else {
        note(&format!(
            "{}: the designs solved so far are kept; --resume continues from them",
            folder.display()
        ));
        return Ok(interrupt.exit_code().unwrap_or(INCOMPLETE));
    };
    let written = ResultsFolder::new(&folder);
    let format = arguments.format.csv.unwrap_or_else(|| written.csv_format());
    let figures = figures(&goal, &found)?;
    let figures = figures.into_iter().map(|Figure { name, svg, .. }| (format!("{name}.svg"), svg));
    let files = write_found(&written, &goal, &found, &figures.collect::<Vec<_>>(), format)?;
    let report = SearchReport { goal: &goal, found: &found };
    json::answer(
        arguments.solving.json,
        || record(&report),
        || report.text(begun.elapsed(), arguments.solving.threads.count()),
        (&folder, &files),
    )?;
    Ok(exit_code(&goal, &found))
}

/// Returns the options of the search.
fn options<'i>(
    arguments: &Arguments,
    interrupt: &'i Interrupt,
    display: &'i Display<SearchProgress>,
) -> SearchOptions<'i> {
    SearchOptions {
        threads: arguments.solving.threads.count(),
        start: arguments.earlier.start(),
        stop: interrupt.stop(),
        progress: display.watched(),
    }
}

/// Returns [`DONE`] if a design meets the requirements, also after rounding and in the checks.
fn exit_code(goal: &DesignGoal, found: &Found) -> u8 {
    let is_met = match &found.answer {
        Answer::Optimum(best) => {
            let is_unrounded = found.rounding.as_ref().is_some_and(|of| of.rounded.is_none());
            !is_unrounded && best.contradictions(goal).is_empty()
        }
        Answer::Front(_) => true,
        Answer::Infeasible(_) => false,
    };
    if is_met { DONE } else { INCOMPLETE }
}
