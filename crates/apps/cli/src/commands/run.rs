//! The command `squama run`, which solves the designs of a sweep.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use results::columns::name::{FOLD_FORCE, SOUND_FORCE};
use results::round_off::Leader;
use results::{Completeness, VerifiedFolder};
use run::{Best, Finished, Options, Progress};
use sweep::{DesignNumber, RandomSample, Subset, Sweep};

use super::options::{EarlierResults, RunOptions, TableFormat, whole};
use super::source::{Definition, folder_of, read};
use super::{DONE, INCOMPLETE, PROGRAM, audit};
use crate::interrupt::Interrupt;
use crate::print::{FOLDED, aligned, counted, note, print, time};
use crate::progress::{ProgressDisplay, RESUMED};

/// Parses a fraction above 0 and at most 1.
fn fraction(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| *value > 0.0 && *value <= 1.0);
    value.ok_or_else(|| format!("{text} is out of range, expected a number above 0 and at most 1"))
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

Writes designs.csv, a table for each measure, failures.csv and run.toml. A journal records every design as
soon as it is solved, so that --resume can continue an interrupted run. The tables do not depend on the
number of threads or on interruptions. contents.toml is written last and lists the tables with their
checksums, which every command that reads the folder verifies. The first SIGINT, SIGTERM or SIGHUP ends the
run without the designs in progress; a second one, at least a second later, does not wait for the tables.
Exit code: 0 done, 1 some designs failed or are missing, 2 bad input or a disk error, 130, 143 or 129 ended by
SIGINT, SIGTERM or SIGHUP.")]
pub struct Arguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Results folder; missing parent folders are created [default: results/NAME, or
    /// results/NAME/shards/i-of-N]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    #[command(flatten)]
    pub earlier: EarlierResults,

    /// Solve a random subset of this many designs
    #[arg(long, allow_hyphen_values = true, value_name = "DESIGNS", value_parser = whole::<1, { u64::MAX }>)]
    pub sample: Option<u64>,

    /// Seed of the random subset; the same seed gives the same designs
    #[arg(
        long,
        allow_hyphen_values = true,
        value_name = "SEED",
        requires = "sample",
        default_value_t = 0,
        value_parser = whole::<0, { u64::MAX }>
    )]
    pub seed: u64,

    /// Solve one shard: every N-th design, starting with the i-th
    #[arg(long, value_name = "i/N")]
    pub shard: Option<sweep::Shard>,

    /// Solve this fraction of the designs again by a second method, and show the differences
    ///
    /// The second method takes steps a tenth as large, and solves a strip as a chain of all its
    /// gaps. A relative difference above 1e-6, or a different status, gives exit code 1.
    #[arg(long, value_name = "FRACTION", value_parser = fraction)]
    pub audit: Option<f64>,

    #[command(flatten)]
    pub work: RunOptions,

    #[command(flatten)]
    pub format: TableFormat,
}

/// Interval between updates of the tables during a run.
const TABLES_EVERY: Duration = Duration::from_secs(30);

/// Solves all remaining designs and writes the tables.
pub fn run(arguments: &Arguments, interrupt: &Interrupt) -> anyhow::Result<u8> {
    let sweep = read(&arguments.definition)?;
    let folder = folder(arguments, &sweep);
    note_variables(&sweep);
    let (subset, start) = (subset(arguments), arguments.earlier.start());
    let how = (&arguments.work, &arguments.format);
    let (finished, audited) = with_progress_bar(how, interrupt, |options, show| {
        let finished = run::run(&sweep, subset, &folder, start, options, &PROGRAM, show)?;
        // Skip the audit after an interruption.
        let fraction = arguments.audit.filter(|_| interrupt.exit_code().is_none());
        let audited = fraction.map(|f| run::Audit::solve(&folder, f, options)).transpose()?;
        anyhow::Ok((finished, audited))
    })?;
    conclude(&folder, &finished);
    if !arguments.work.quiet {
        let threads = arguments.work.threads.count();
        print(&summary(sweep.name(), &folder, threads, &finished))?;
    }
    let code = exit_code(&finished, interrupt);
    let Some(audit) = audited else { return Ok(code) };
    print(&audit::report(&audit))?;
    Ok(if audit::agrees(&audit) { code } else { INCOMPLETE })
}

/// Prints a note if the definition has variables, which a run does not vary.
fn note_variables(sweep: &Sweep) {
    let keys: Vec<_> = sweep.variables().iter().map(|v| v.parameter().key).collect();
    if !keys.is_empty() {
        note(&format!(
            "[variables] {}: a run uses the middle of their ranges; squama optimise and squama sensitivity vary them",
            keys.join(", ")
        ));
    }
}

/// Prints the notes of a finished run, and the figures and rankings that are now out of date.
pub(super) fn conclude(folder: &Path, finished: &Finished) {
    for text in &finished.notes {
        note(text);
    }
    // Accept a partial run: figures and rankings are out of date after an interruption, too.
    let verified = VerifiedFolder::open(folder, Completeness::Partial);
    for outdated in verified.iter().flat_map(VerifiedFolder::outdated) {
        note(&format!(
            "{} is out of date: it was made from earlier tables; update it with {}",
            outdated.product, outdated.command
        ));
    }
}

/// Returns the results folder of the run or of its shard.
fn folder(arguments: &Arguments, sweep: &Sweep) -> PathBuf {
    let folder = folder_of(sweep, arguments.out.as_deref());
    match &arguments.shard {
        Some(shard) if arguments.out.is_none() => {
            folder.join("shards").join(shard.to_string().replace('/', "-of-"))
        }
        _ => folder,
    }
}

/// Returns the subset of designs that the arguments request.
fn subset(arguments: &Arguments) -> Subset {
    let sample = arguments.sample.map(|designs| RandomSample { designs, seed: arguments.seed });
    Subset { sample, shard: arguments.shard }
}

/// Calls `solve` with the options of a run, and shows its progress.
pub(super) fn with_progress_bar<T>(
    (work, format): (&RunOptions, &TableFormat),
    interrupt: &Interrupt,
    solve: impl FnOnce(&Options<'_>, &dyn Fn(Progress)) -> T,
) -> T {
    // From here on, the first signal ends the run but keeps the solved designs.
    interrupt.end_gracefully();
    let display = ProgressDisplay::new(work.quiet, interrupt, Arc::default(), RESUMED);
    let options = Options {
        threads: work.threads.count(),
        format: format.csv,
        fail_fast: work.fail_fast,
        tables_every: TABLES_EVERY,
        stop: interrupt.stop(),
        work: display.watched().work(),
    };
    solve(&options, &|progress| display.watched().show(progress))
}

/// Returns the exit code of a finished or interrupted run.
pub(super) fn exit_code(finished: &Finished, interrupt: &Interrupt) -> u8 {
    let complete = finished.summary.failed == 0 && finished.missing == 0;
    // The code of a signal takes precedence, because the signal explains missing designs.
    interrupt.exit_code().unwrap_or(if complete { DONE } else { INCOMPLETE })
}

/// Formats the numbers of designs by status, the best designs and the tables.
pub(super) fn summary(name: &str, folder: &Path, threads: usize, finished: &Finished) -> String {
    let designs = counted(finished.summary.designs, "design");
    let threads = counted(threads as u64, "thread");
    let time = time(finished.duration);
    let mut text = format!("{name}: {designs} in {time} on {threads}\n");
    let mut rows = Vec::new();
    if finished.missing > 0 {
        let missing = counted(finished.missing, "design");
        rows.push(["missing".to_owned(), format!("{missing}; --resume solves them")]);
    }
    rows.extend(status_rows(finished));
    rows.extend(folded_row(finished));
    rows.extend(best_rows(finished));
    let tables = finished.tables.join(" ");
    rows.push(["tables", &format!("{}: {tables} run.toml", folder.display())].map(str::to_owned));
    let _ = write!(text, "{}", aligned(&rows));
    text
}

fn status_rows(finished: &Finished) -> impl Iterator<Item = [String; 2]> {
    finished.summary.statuses.iter().map(|(measure, counts)| {
        let counts: Vec<_> = counts.iter().map(|(status, n)| format!("{n} {status}")).collect();
        [measure.key().to_owned(), counts.join(", ")]
    })
}

/// Returns the row that counts designs with a fold of the surface; `None` if there are none.
fn folded_row(finished: &Finished) -> Option<[String; 2]> {
    let folded = finished.summary.folded;
    let designs = counted(folded, "design");
    let what = format!(
        "{designs}: two neighbouring bases cross; results are valid up to {SOUND_FORCE}, see also {FOLD_FORCE}"
    );
    (folded > 0).then(|| ["folded over".to_owned(), what])
}

fn best_rows(finished: &Finished) -> impl Iterator<Item = [String; 2]> {
    finished.summary.best().map(|best| [best.label.to_owned(), best_text(&best)])
}

/// Formats the best value of a measure with its design.
///
/// If the surface of this design folds, the text adds the best value without a fold.
fn best_text(best: &Best) -> String {
    if let Some(parameter) = best.incomparable_by {
        return format!("not comparable between designs of different {parameter}");
    }
    let text = leader_text(&best.leader, best.unit);
    match (best.is_folded, &best.unfolded) {
        (false, _) => text,
        (true, None) => format!("{text} {FOLDED} not valid, the surface folds"),
        (true, Some(unfolded)) => {
            let unfolded = leader_text(unfolded, best.unit);
            format!("{text} {FOLDED} not valid, the surface folds; without a fold {unfolded}")
        }
    }
}

/// Formats a value, the design that has it, and the number of other designs with the same value.
fn leader_text(leader: &Leader<DesignNumber>, unit: Option<&str>) -> String {
    let ties = match leader.ties {
        0 => String::new(),
        ties => format!(", and {ties} more"),
    };
    let unit = unit.map_or_else(String::new, |unit| format!(" {unit}"));
    format!("{:.6}{unit} (design {}{ties})", leader.value, leader.first)
}
