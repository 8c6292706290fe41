//! `squama merge`.

use std::ops::RangeInclusive;

use super::run::{conclude, summary};
use super::{DONE, INCOMPLETE, PROGRAM};
use crate::args;
use crate::print::{counted, print};

/// Runs of missing designs that are named before the list is cut short.
const NAMED: usize = 20;

/// Puts the shards of a sweep together.
pub fn merge(arguments: &args::MergeArguments) -> anyhow::Result<u8> {
    let merged = run::merge(&arguments.folders, &arguments.out, arguments.format.csv, &PROGRAM)?;
    conclude(&arguments.out, &merged.finished);
    if !arguments.quiet {
        print(&report(arguments, &merged))?;
    }
    let finished = &merged.finished;
    let complete = finished.summary.failed == 0 && finished.missing == 0;
    Ok(if complete { DONE } else { INCOMPLETE })
}

fn report(arguments: &args::MergeArguments, merged: &run::Merged) -> String {
    let folders = counted(arguments.folders.len() as u64, "folder");
    let added = counted(merged.added, "design");
    let name = merged.sweep.name();
    let results = summary(name, &arguments.out, 1, &merged.finished);
    format!("merged: {added} from {folders}\n{}{results}", missing(merged))
}

/// The numbers of the designs that are missing, runs of them as `first-last`.
fn missing(merged: &run::Merged) -> String {
    if merged.missing.is_empty() {
        return String::new();
    }
    let number = |number: u64| merged.sweep.grid().number(number - 1);
    let name = |range: &RangeInclusive<u64>| match (*range.start(), *range.end()) {
        (first, last) if first == last => number(first).to_string(),
        (first, last) => format!("{}-{}", number(first), number(last)),
    };
    let named: Vec<_> = merged.missing.iter().take(NAMED).map(name).collect();
    let more = if merged.missing.len() > NAMED { " …" } else { "" };
    format!("missing designs: {}{more}\n", named.join(" "))
}
