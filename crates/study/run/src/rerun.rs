//! Reruns: solve selected designs of a run again with other settings.

use std::path::Path;
use std::time::Instant;

use journal::{JournalError, Program};
use results::{ResultsFolder, SEPARATOR};
use sweep::{DesignNumber, PARAMETERS, Setting, Sweep};

use crate::filter::{Filter, InvalidFilter};
use crate::options::Options;
use crate::progress::{Finished, Progress, RunError};
use crate::run::Run;
use crate::run_journal::{self, Archive};
use crate::solve::task::Task;
use crate::tables::run_info::RunInfo;

/// Designs of a run and the settings for solving them again.
#[derive(Debug)]
pub struct Rerun {
    folder: ResultsFolder,
    sweep: Sweep,
    settings: String,
    designs: Vec<u64>,
}

/// Reason why a rerun cannot start.
#[derive(Debug, thiserror::Error)]
pub enum InvalidRerun {
    /// The journal cannot be opened, or another version of the program wrote it.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// A design does not exist or is not solved yet, or a column does not exist.
    #[error(transparent)]
    Filter(#[from] InvalidFilter),
    /// The settings are not valid.
    #[error(transparent)]
    Definition(#[from] sweep::InvalidDefinition),
    /// The keys of the settings are axes of the sweep, or not parameters of a design.
    #[error(
        "{0}: cannot be set in a rerun, expected a parameter of a design that is not an axis of the grid, or a key such as solver.max_step"
    )]
    Axis(String),
    /// The settings would turn imperfections on or off, which changes the columns of the tables.
    #[error(
        "imperfections are {before} in the run and {after} in the settings; they must be the same, because a run keeps its columns"
    )]
    Imperfection {
        /// State of imperfections in the run: on or off.
        before: &'static str,
        /// State of imperfections with the settings: on or off.
        after: &'static str,
    },
}

impl Rerun {
    /// Plans to solve the designs that pass `filter` again, after applying `settings` to the sweep.
    ///
    /// # Errors
    ///
    /// If `folder` holds no run, another version of the program has solved it, or `filter` or
    /// `settings` are invalid.
    pub fn plan(
        folder: &Path,
        filter: &Filter,
        settings: &[Setting],
        program: &Program,
    ) -> Result<Self, InvalidRerun> {
        let folder = ResultsFolder::new(folder);
        let archive = Archive::open(&folder)?;
        // In one table, differences between program versions would look like effects of settings.
        require_program(&archive, &folder, program)?;
        let (sweep, settings) = changed(archive.sweep(), settings)?;
        let designs = filter.designs(&archive)?;
        Ok(Self { folder, sweep, settings, designs })
    }

    /// Returns the keys that differ from the sweep, as `key=value` separated by spaces.
    pub fn settings(&self) -> &str {
        &self.settings
    }

    /// Returns the numbers of the designs to be solved again.
    pub fn designs(&self) -> impl ExactSizeIterator<Item = DesignNumber> {
        self.designs.iter().map(|index| self.sweep.grid().number(*index))
    }

    /// Solves the designs again, replaces their rows in every table, and lists changes in
    /// `reruns.csv`.
    ///
    /// Calls `progress` when a design is done, in any order.
    ///
    /// # Errors
    ///
    /// If the folder is in use, or the results cannot be written.
    pub fn run(
        &self,
        options: &Options<'_>,
        program: &Program,
        mut progress: impl FnMut(Progress),
    ) -> Result<Finished, RunError> {
        let clock = Instant::now();
        let folder = self.folder.clone();
        // `resume` locks the journal. Other processes may have added designs and reruns to the
        // journal after `plan`.
        let journal = run_journal::resume(&folder)?;
        require_program(journal.records(), &folder, program)?;
        folder.make()?;
        progress(Progress::Begun { designs: self.designs.len() as u64, done: 0 });
        // All designs of this rerun share one number, which identifies it in `reruns.csv`.
        let rerun = journal.records().reruns() + 1;
        let settings = self.settings.clone();
        let task = Task::new(&self.sweep, settings, rerun, clock, options.work);
        let mut run = Run::new(journal, folder, options, RunInfo::new(program, options, clock));
        run.solve(&task, self.designs.iter().copied(), progress)?;
        run.finish()
    }
}

fn require_program(
    archive: &Archive,
    folder: &ResultsFolder,
    program: &Program,
) -> Result<(), JournalError> {
    let header = archive.header();
    let wanted = run_journal::header(archive.sweep(), *header.subset(), program);
    header.require(&wanted, &folder.journal(), "the program version that solved this run")
}

/// Applies `settings` to `sweep`; returns the new sweep and its differences as `key=value` texts.
fn changed(sweep: &Sweep, settings: &[Setting]) -> Result<(Sweep, String), InvalidRerun> {
    let changed = Sweep::parse(&sweep.to_toml(), "definition", settings)?;
    for setting in settings {
        if !setting.parameter().is_some_and(|parameter| {
            // A change of an axis would move designs to other positions in the grid.
            sweep.grid().axis(parameter.key).is_none()
                && changed.grid().axis(parameter.key).is_none()
        }) {
            return Err(InvalidRerun::Axis(setting.location().to_string()));
        }
    }
    let on_or_off = |sweep: &Sweep| if sweep.is_imperfect() { "on" } else { "off" };
    // Imperfections add columns, but a table keeps its header.
    let (before, after) = (on_or_off(sweep), on_or_off(&changed));
    if before != after {
        return Err(InvalidRerun::Imperfection { before, after });
    }
    let (old, new) = (sweep.grid().base(), changed.grid().base());
    // Settings that equal the value in the sweep are not recorded.
    let different = PARAMETERS.iter().filter(|p| p.get(old) != p.get(new));
    // Spaces separate the settings, so the values of lists are written without spaces.
    let texts: Vec<_> =
        different.map(|p| format!("{}={}", p.path(), p.get(new)).replace(SEPARATOR, "")).collect();
    Ok((changed, texts.join(&SEPARATOR.to_string())))
}
