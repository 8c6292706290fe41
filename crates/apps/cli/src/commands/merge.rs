//! The command `squama merge`, which combines the shards of a sweep.

use std::path::PathBuf;

use clap::Args;

use super::options::TableFormat;
use super::run::{conclude, summary};
use super::{DONE, INCOMPLETE, PROGRAM};
use crate::print::{counted, print};

/// Arguments of `squama merge`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama merge results/paper/shards/* --out results/paper

Combines the results of shards; the tables are the same as those of a run without shards. Designs that
are already in --out stay there, so merging again adds the new ones. Merging a folder into itself
(squama merge DIR --out DIR) writes its tables again from its journal.
Exit code: 0 done, 1 some designs failed or are missing, 2 bad input or a disk error.")]
pub struct Arguments {
    /// Folders of the shards
    #[arg(value_name = "DIR", required = true)]
    pub folders: Vec<PathBuf>,

    /// Results folder of the combined sweep
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,

    /// Print no summary
    #[arg(long, short)]
    pub quiet: bool,

    #[command(flatten)]
    pub format: TableFormat,
}

/// Maximum number of ranges of missing designs that the report lists.
const NAMED: usize = 20;

/// Combines the shards of a sweep in one results folder.
pub fn merge(arguments: &Arguments) -> anyhow::Result<u8> {
    let merged = run::merge(&arguments.folders, &arguments.out, arguments.format.csv, &PROGRAM)?;
    conclude(&arguments.out, &merged.finished);
    if !arguments.quiet {
        print(&report(arguments, &merged))?;
    }
    let finished = &merged.finished;
    let complete = finished.summary.failed == 0 && finished.missing == 0;
    Ok(if complete { DONE } else { INCOMPLETE })
}

/// Formats the number of added designs, the missing designs and a summary of the results.
fn report(arguments: &Arguments, merged: &run::Merged) -> String {
    let folders = counted(arguments.folders.len() as u64, "folder");
    let added = counted(merged.added, "design");
    let name = merged.sweep.name();
    let results = summary(name, &arguments.out, 1, &merged.finished);
    format!("merged: {added} from {folders}\n{}{results}", missing(merged))
}

/// Lists the missing designs; consecutive designs are listed as `first-last`.
fn missing(merged: &run::Merged) -> String {
    if merged.missing.is_empty() {
        return String::new();
    }
    let grid = merged.sweep.grid();
    let named = merged.missing.iter().take(NAMED).map(|range| {
        // `missing` contains numbers from 1, but `grid.number` expects an index from 0.
        let [first, last] = [range.start(), range.end()].map(|number| grid.number(number - 1));
        if first == last { first.to_string() } else { format!("{first}-{last}") }
    });
    let named: Vec<_> = named.collect();
    let more = if merged.missing.len() > NAMED { " …" } else { "" };
    format!("missing designs: {}{more}\n", named.join(" "))
}
