//! The command `squama rerun`, which solves some designs of a run again.

use std::path::PathBuf;

use clap::Args;
use run::{Filter, Rerun};

use super::options::{RunOptions, TableFormat};
use super::run::{conclude, exit_code, summary, with_progress_bar};
use super::source::{results_folder, settings};
use super::{DONE, PROGRAM};
use crate::interrupt::Interrupt;
use crate::print::{counted, print};

/// Arguments of `squama rerun`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama rerun results/paper --failed --dry-run
  squama rerun results/paper --failed --set solver.max_step=0.01
  squama rerun results/paper --design 0417,0533 --set puncture.scales=801
  squama rerun results/paper --where slant_deg=75 --where 'puncture_status=row limit'

Replaces the rows of these designs in every table. The column `settings` then shows what --set changed;
without --set the designs are solved with the sweep's own settings, and the column is empty. reruns.csv
lists the values that changed.
Exit code: 0 done, 1 some designs failed or are missing, 2 bad input or a disk error, 130, 143 or 129 ended by
SIGINT, SIGTERM or SIGHUP.")]
#[command(group(clap::ArgGroup::new("which").required(true).multiple(true)))]
pub struct Arguments {
    /// Results folder of a run, or its definition
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,

    /// Select the designs that lack a value
    #[arg(long, group = "which")]
    pub failed: bool,

    /// Select designs by their numbers, e.g. 0417 or 1-12,0417
    #[arg(long = "design", value_name = "NUMBERS", group = "which", value_delimiter = ',')]
    pub numbers: Option<Vec<String>>,

    /// Select designs by a value in designs.csv (may be repeated: all must hold)
    #[arg(long = "where", value_name = "COLUMN=VALUE", group = "which")]
    pub conditions: Vec<run::ColumnFilter>,

    /// Set a key of the definition for these designs, e.g. `solver.max_step=0.01` (may be repeated)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub settings: Vec<String>,

    /// List the designs that would be solved, without solving them
    #[arg(long)]
    pub dry_run: bool,

    #[command(flatten)]
    pub work: RunOptions,

    #[command(flatten)]
    pub format: TableFormat,
}

/// Maximum number of designs that the plan lists by number.
const NAMED: usize = 20;

/// Solves some designs of a run again.
pub fn rerun(arguments: &Arguments, interrupt: &Interrupt) -> anyhow::Result<u8> {
    let settings = settings(&arguments.settings)?;
    let folder = results_folder(&arguments.results)?;
    let rerun = Rerun::plan(&folder, &filter(arguments), &settings, &PROGRAM)?;
    if rerun.designs().len() == 0 {
        print(&format!("{}: no design matches; nothing to solve\n", folder.display()))?;
        return Ok(DONE);
    }
    if arguments.dry_run {
        print(&plan(&rerun))?;
        return Ok(DONE);
    }
    let how = (&arguments.work, &arguments.format);
    let finished =
        with_progress_bar(how, interrupt, |options, show| rerun.run(options, &PROGRAM, show))?;
    conclude(&folder, &finished);
    if !arguments.work.quiet {
        let threads = arguments.work.threads.count();
        let results = summary("all results", &folder, threads, &finished);
        print(&format!("{}{results}", plan(&rerun)))?;
    }
    Ok(exit_code(&finished, interrupt))
}

/// Returns the selection of designs that the arguments request.
fn filter(arguments: &Arguments) -> Filter {
    Filter {
        failed: arguments.failed,
        numbers: arguments.numbers.clone(),
        columns: arguments.conditions.clone(),
    }
}

/// Formats the number, the settings and the list of the selected designs.
fn plan(rerun: &Rerun) -> String {
    let count = rerun.designs().len();
    let named: Vec<_> = rerun.designs().take(NAMED).map(|number| number.to_string()).collect();
    let more = if count > NAMED { " …" } else { "" };
    let settings = match rerun.settings() {
        "" => "the sweep's own settings".to_owned(),
        settings => settings.to_owned(),
    };
    let designs = counted(count as u64, "design");
    format!("solved again: {designs} with {settings}\n  {}{more}\n", named.join(" "))
}
