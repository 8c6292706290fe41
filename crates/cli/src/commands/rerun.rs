//! `squama rerun`.

use run::{Filter, Rerun};
use sweep::Setting;

use super::run::{conclude, exit_code, options, summary};
use super::source::results_folder;
use super::{DONE, PROGRAM};
use crate::args;
use crate::interrupt::Interrupt;
use crate::print::{counted, print};
use crate::progress::ProgressDisplay;

/// Designs that are named before the list is cut short.
const NAMED: usize = 20;

/// Solves some designs of a run again.
pub fn rerun(arguments: &args::RerunArguments, interrupt: &Interrupt) -> anyhow::Result<u8> {
    let settings = arguments.settings.iter().map(|text| Setting::parse(text));
    let settings = settings.collect::<Result<Vec<_>, _>>()?;
    let folder = results_folder(&arguments.results)?;
    let rerun = Rerun::plan(&folder, &filter(arguments), &settings, &PROGRAM)?;
    if rerun.designs().len() == 0 {
        print(&format!("{}: no design is as asked, nothing is solved again\n", folder.display()))?;
        return Ok(DONE);
    }
    if arguments.dry_run {
        print(&plan(&rerun))?;
        return Ok(DONE);
    }
    interrupt.ask_first();
    let display = ProgressDisplay::new(arguments.work.quiet, interrupt);
    let options = options(&arguments.work, &arguments.format, interrupt, &display);
    let progress = |progress| display.show(progress);
    let finished = rerun.run(&options, &PROGRAM, progress);
    let threads = options.threads;
    drop(display);
    let finished = finished?;
    conclude(&folder, &finished);
    if !arguments.work.quiet {
        let results = summary("all results", &folder, threads, &finished);
        print(&format!("{}{results}", plan(&rerun)))?;
    }
    Ok(exit_code(&finished, interrupt))
}

fn filter(arguments: &args::RerunArguments) -> Filter {
    Filter {
        failed: arguments.failed,
        numbers: arguments.numbers.clone(),
        columns: arguments.conditions.clone(),
    }
}

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
