//! `squama optimise`.

mod figures;
mod record;
mod report;
mod skins;

use std::time::Instant;

use ::report::Figure;
use optimisation::{Answer, DesignGoal, Found, SearchOptions, write_found};
use results::{RunFolder, make_folder};
use sweep::Setting;

use super::source::folder_of;
use super::{DONE, INCOMPLETE, PROGRAM};
use crate::args;
use crate::interrupt::Interrupt;
use crate::json;
use crate::print::{note, print};
use crate::progress::SearchDisplay;
use figures::figures;
use record::record;
use report::SearchReport;

/// Finds the best designs of a goal and writes them down.
pub fn optimise(arguments: &args::OptimiseArguments, interrupt: &Interrupt) -> anyhow::Result<u8> {
    let settings = arguments.settings.iter().map(|text| Setting::parse(text));
    let settings: Vec<Setting> = settings.collect::<Result<_, _>>()?;
    let goal = DesignGoal::read(&arguments.path, &settings)?;
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
    arguments: &args::OptimiseArguments,
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
        Answer::Optimum(best) => best
            .confirmation
            .as_ref()
            .is_none_or(|made| made.broken.iter().all(|r| made.is_open(r))),
        Answer::Front(_) => true,
        Answer::Infeasible(_) => false,
    };
    if is_met { DONE } else { INCOMPLETE }
}
