//! `squama run`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use results::columns::{FOLD_FORCE, SOUND_FORCE};
use results::{Completeness, VerifiedFolder};
use run::{Best, Finished, Options};
use sweep::{RandomSample, Subset, Sweep};

use super::source::{folder_of, read};
use super::{DONE, INCOMPLETE, PROGRAM, audit};
use crate::args;
use crate::interrupt::Interrupt;
use crate::print::{aligned, counted, note, print, time};
use crate::progress::ProgressDisplay;

/// How often the tables are written while a run goes on.
const TABLES_EVERY: Duration = Duration::from_secs(30);

/// Solves every design that is not done and writes the tables.
pub fn run(arguments: &args::RunArguments, interrupt: &Interrupt) -> anyhow::Result<u8> {
    let sweep = read(&arguments.definition)?;
    let folder = folder(arguments, &sweep);
    note_variables(&sweep);
    interrupt.ask_first();
    let display = ProgressDisplay::new(arguments.work.quiet, interrupt);
    let options = options(&arguments.work, &arguments.format, interrupt, &display);
    let progress = |progress| display.show(progress);
    let (subset, start) = (subset(arguments), arguments.earlier.start());
    let finished = run::run(&sweep, subset, &folder, start, &options, &PROGRAM, progress);
    let threads = options.threads;
    let finished = finished?;
    let audited = arguments.audit.filter(|_| interrupt.exit_code().is_none());
    let audited = audited.map(|share| run::Audit::of(&folder, share.0, &options)).transpose()?;
    drop(display);
    conclude(&folder, &finished);
    if !arguments.work.quiet {
        print(&summary(sweep.name(), &folder, threads, &finished))?;
    }
    let code = exit_code(&finished, interrupt);
    let Some(audit) = audited else { return Ok(code) };
    print(&audit::report(&audit))?;
    Ok(if audit::agrees(&audit) { code } else { INCOMPLETE })
}

/// Says that a run does not go through variables.
fn note_variables(sweep: &Sweep) {
    let keys: Vec<_> = sweep.variables().iter().map(|v| v.parameter().key).collect();
    if !keys.is_empty() {
        note(&format!(
            "[variables] {} stand in the middle of their values; squama optimise and squama sensitivity --global go through them",
            keys.join(", ")
        ));
    }
}

/// Says what a person should know of a run that came to its end: what was cut off, lost or removed, and what was made from
/// earlier tables.
pub(super) fn conclude(folder: &Path, finished: &Finished) {
    for text in &finished.notes {
        note(text);
    }
    let verified = VerifiedFolder::open(folder, Completeness::Partial);
    for made in verified.iter().flat_map(VerifiedFolder::outdated) {
        note(&format!(
            "{} is made from earlier tables; {} makes it again",
            made.product, made.command
        ));
    }
}

fn folder(arguments: &args::RunArguments, sweep: &Sweep) -> PathBuf {
    let folder = folder_of(sweep, arguments.out.as_deref());
    match &arguments.shard {
        Some(shard) if arguments.out.is_none() => {
            folder.join("shards").join(shard.to_string().replace('/', "-of-"))
        }
        _ => folder,
    }
}

fn subset(arguments: &args::RunArguments) -> Subset {
    let sample = arguments.sample.map(|designs| RandomSample { designs, seed: arguments.seed });
    Subset { sample, shard: arguments.shard }
}

/// How designs are solved, as the arguments have it.
pub(super) fn options<'i>(
    work: &args::Work,
    format: &args::Format,
    interrupt: &'i Interrupt,
    display: &'i ProgressDisplay,
) -> Options<'i> {
    Options {
        threads: work.threads.count(),
        format: format.csv,
        fail_fast: work.fail_fast,
        tables_every: TABLES_EVERY,
        stop: interrupt.stop(),
        work: display.work(),
    }
}

pub(super) fn exit_code(finished: &Finished, interrupt: &Interrupt) -> u8 {
    let complete = finished.summary.failed == 0 && finished.missing == 0;
    interrupt.exit_code().unwrap_or(if complete { DONE } else { INCOMPLETE })
}

pub(super) fn summary(name: &str, folder: &Path, threads: usize, finished: &Finished) -> String {
    let designs = counted(finished.summary.designs, "design");
    let threads = counted(threads as u64, "thread");
    let time = time(finished.duration);
    let mut text = format!("{name}: {designs} in {time} on {threads}\n");
    let mut rows = Vec::new();
    if finished.missing > 0 {
        let missing = counted(finished.missing, "design");
        rows.push(["missing".to_owned(), format!("{missing}, --resume goes on")]);
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

/// Designs whose numbers are not to be trusted to the end.
fn folded_row(finished: &Finished) -> Option<[String; 2]> {
    let folded = finished.summary.folded;
    let designs = counted(folded, "design");
    let what = format!("{designs}: two bases pass each other, see {FOLD_FORCE} and {SOUND_FORCE}");
    (folded > 0).then(|| ["folded over".to_owned(), what])
}

fn best_rows(finished: &Finished) -> impl Iterator<Item = [String; 2]> {
    let row = |Best { what, leader, apart }: Best| {
        if let Some(parameter) = apart {
            let text =
                format!("not told: designs of different {parameter} cannot be compared by it");
            return [what.to_owned(), text];
        }
        let ties = match leader.ties {
            0 => String::new(),
            ties => format!(", and {ties} more"),
        };
        [what.to_owned(), format!("{:.6} (design {}{ties})", leader.value, leader.first)]
    };
    finished.summary.best().map(row)
}
