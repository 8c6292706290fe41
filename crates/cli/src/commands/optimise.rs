//! `squama optimise`.

mod figures;
mod record;
mod report;
mod skins;

use std::path::PathBuf;
use std::time::Instant;

use ::report::Figure;
use clap::Args;
use optimisation::{Answer, DesignGoal, Found, SearchOptions, write_found};
use results::{RunFolder, make_folder};

use super::source::{folder_of, settings};
use super::work::{Earlier, Format, Threads};
use super::{DONE, INCOMPLETE, PROGRAM};
use crate::interrupt::Interrupt;
use crate::json;
use crate::print::{note, print};
use crate::progress::SearchDisplay;
use figures::figures;
use record::record;
use report::SearchReport;

/// Arguments of `squama optimise`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama optimise sweeps/goals/strong-and-covered.toml
  squama optimise glove.toml --set 'goal.require=[\"coverage >= 0.6\"]' --out results/glove-60
  squama optimise glove.toml --set goal.seed=1 --fresh
  squama optimise glove.toml --resume

A goal is a sweep definition with two sections more: [variables] has parameters between two numbers, as
gap_over_t = { from = 0.1, to = 1 }, or lists of values; [goal] has maximize or minimize (one column gives
an optimum, two to four a front) and require, bounds that columns must keep. What is not a variable has one
value. Designs that fail are left out and counted; so are those whose surface has folded, unless sound = false.
One of the objectives may be fitness, the paper's (Eq. 7): weights = { coverage = 1, compliance = 2 } has its
criteria, all four alike if it is left out, and rescale = { coverage = [0, 0.9] } the worst and the best value of
each, those of the sample if it is left out.
With a [tolerance], as squama tolerance reads it, the goal may be about what is made: maximize or require has
quantiles, as critical_force_p05 (or _p50, _p95), and yield, the share of skins that meet all requirements of
columns and whose surface has not folded, unless sound = false, as in require = [\"coverage >= 0.5\", \"yield >= 0.9\"]. skins = 200 are made of each design, the same deviations
for all, and five times as many near the best; at the end 1000 others are made of it, and what they say stands
beside what the search saw.
samples = 1024 designs fill the space first, points = 30 stand on a front, seed = 0 shifts the samples.
Writes optimum.csv and optimum.toml, which is the definition of the best design, or front.csv; history.csv
with every design that was looked at; and evaluations.jsonl, from which --resume goes on. Nothing depends on
the number of threads.
Exit code: 0 done, 1 no design meets the requirements, or what is made of the best does not, 2 bad input or disk, 130, 143 or 129 ended by
SIGINT, SIGTERM or SIGHUP.")]
pub struct Arguments {
    /// Goal in TOML
    #[arg(value_name = "GOAL.toml")]
    pub path: PathBuf,

    /// Set a key of the goal, e.g. goal.seed=1 (may be repeated)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,

    /// Folder of the results [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    #[command(flatten)]
    pub earlier: Earlier,

    #[command(flatten)]
    pub threads: Threads,

    /// No bar
    #[arg(long, short)]
    pub quiet: bool,

    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,

    #[command(flatten)]
    pub format: Format,
}

/// Finds the best designs of a goal and writes them down.
pub fn optimise(arguments: &Arguments, interrupt: &Interrupt) -> anyhow::Result<u8> {
    let goal = DesignGoal::read(&arguments.path, &settings(&arguments.settings)?)?;
    let folder = folder_of(goal.space.sweep(), arguments.out.as_deref());
    make_folder(&folder)?;
    interrupt.ask_first();
    let begun = Instant::now();
    let display = SearchDisplay::new(arguments.quiet, interrupt);
    let options = options(arguments, interrupt, &display);
    let found = optimisation::optimise(&goal, &folder, &options, &PROGRAM)?;
    drop(display);
    let Some(found) = found else {
        note(&format!("{}: what is solved so far is kept, --resume goes on", folder.display()));
        return Ok(interrupt.exit_code().unwrap_or(INCOMPLETE));
    };
    let written = RunFolder::new(&folder);
    let format = arguments.format.csv.unwrap_or_default();
    let mut files: Vec<String> =
        write_found(&written, &goal, &found, format)?.into_iter().map(str::to_owned).collect();
    for Figure { name, svg } in figures(&goal, &found) {
        let file = format!("{name}.svg");
        written.write_text(&file, &svg)?;
        files.push(file);
    }
    let report = SearchReport { goal: &goal, found: &found };
    if arguments.json {
        json::print(&record(&goal, &found))?;
    } else {
        let text = report.text(begun.elapsed(), arguments.threads.count());
        print(&format!("{text}\n{}: {}\n", folder.display(), files.join(" ")))?;
    }
    Ok(exit_code(&found))
}

fn options<'i>(
    arguments: &Arguments,
    interrupt: &'i Interrupt,
    display: &'i SearchDisplay,
) -> SearchOptions<'i> {
    SearchOptions {
        threads: arguments.threads.count(),
        start: arguments.earlier.start(),
        stop: interrupt.stop(),
        meter: display.meter(),
    }
}

fn exit_code(found: &Found) -> u8 {
    let is_met = match &found.answer {
        Answer::Optimum(best) => {
            best.made.as_ref().is_none_or(|made| made.broken.iter().all(|r| made.is_open(r)))
        }
        Answer::Front(_) => true,
        Answer::Infeasible(_) => false,
    };
    if is_met { DONE } else { INCOMPLETE }
}
