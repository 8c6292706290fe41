//! The folder of a run: the name of every file in it, and how files get there.

mod atomic_file;
mod partial_file;

use std::fs;
use std::path::{Path, PathBuf};

use sweep::Measure;

pub use atomic_file::{AtomicFile, OutputError, make_folder, sync_folder, write_text};
pub use partial_file::{exit_without_partial_files, remove_abandoned_files};

use crate::contents::derivation::Derivation;

/// The tables of one measure, named by the value that they are about.
pub const MEASURE_TABLES: [(&str, Measure); 4] = [
    ("coverage", Measure::Coverage),
    ("critical_force", Measure::Puncture),
    ("penetration", Measure::Puncture),
    ("compliance", Measure::Flexure),
];

/// The folder of a run. It owns the names of all files that squama writes there and reads back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunFolder {
    path: PathBuf,
}

impl RunFolder {
    /// The journal: every finished design, from which the tables are written.
    pub const JOURNAL: &'static str = "journal.jsonl";
    /// The name of the journal of a search.
    pub const EVALUATIONS: &'static str = "evaluations.jsonl";
    /// The record of the run: its program, its counts, its definition.
    pub const RUN_INFO: &'static str = "run.toml";
    /// The statement of what the folder holds, written last.
    pub const CONTENTS: &'static str = "contents.toml";
    /// The folder of the records of what was made from the tables.
    pub const DERIVED: &'static str = "derived";
    /// The name of the record of a ranking.
    pub const RANKING_RECORD: &'static str = "ranking";
    /// The table of all designs.
    pub const DESIGNS: &'static str = "designs.csv";
    /// The table of measures without a value.
    pub const FAILURES: &'static str = "failures.csv";
    /// The table of the derivatives of the measures.
    pub const SENSITIVITY: &'static str = "sensitivity.csv";
    /// The table of what reruns have changed.
    pub const RERUNS: &'static str = "reruns.csv";
    /// The tables of a ranking: by fitness, the Pareto front, the winners, the winner at every weight.
    pub const RANKING: [&'static str; 4] =
        ["ranking.csv", "pareto.csv", "winners.csv", "quaternary.csv"];
    /// The preferences that a ranking goes by: requirements, criteria, weights, scale.
    pub const PREFERENCES: &'static str = "ranking.toml";
    /// The tables of a comparison: by column and by cell.
    pub const COMPARISON: [&'static str; 2] = ["compare.csv", "differences.csv"];
    /// The table of the measures of one design.
    pub const MEASURES: &'static str = "measures.csv";
    /// The tables of the puncture of one design: path, events, scales, iterations.
    pub const PUNCTURE: [&'static str; 4] = ["path.csv", "events.csv", "scales.csv", "steps.csv"];
    /// The tables of the bending of one design: path, events, scales, iterations.
    pub const FLEXURE: [&'static str; 4] =
        ["flexure_path.csv", "flexure_events.csv", "flexure_scales.csv", "flexure_steps.csv"];

    /// The folder at `path`, which need not exist.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into() }
    }

    /// The name of the table of a measured value, e.g. `coverage.csv`.
    pub fn measure_table(value: &str) -> String {
        format!("{value}.csv")
    }

    /// The names of all tables that a run, its ranking and its comparison may leave here, in the
    /// order in which people read them.
    pub fn tables() -> impl Iterator<Item = String> {
        let measures = MEASURE_TABLES.iter().map(|(value, _)| Self::measure_table(value));
        let of_runs = [Self::SENSITIVITY, Self::FAILURES, Self::RERUNS].into_iter();
        let others = of_runs.chain(Self::RANKING).chain(Self::COMPARISON).map(str::to_owned);
        std::iter::once(Self::DESIGNS.to_owned()).chain(measures).chain(others)
    }

    /// The path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The path of the file `name` in this folder.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// The path of the journal.
    pub fn journal(&self) -> PathBuf {
        self.file(Self::JOURNAL)
    }

    /// Whether it holds the file `name`.
    pub fn holds(&self, name: &str) -> bool {
        self.file(name).is_file()
    }

    /// Makes the folder and those above it.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn make(&self) -> Result<(), OutputError> {
        make_folder(&self.path)
    }

    /// Begins the file `name`, which appears when it is complete.
    ///
    /// # Errors
    /// If the folder cannot be written.
    pub fn create(&self, name: &str) -> Result<AtomicFile, OutputError> {
        AtomicFile::create(&self.path, name)
    }

    /// Writes `text` as the file `name`; returns its SHA-256.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write_text(&self, name: &str, text: &str) -> Result<String, OutputError> {
        write_text(&self.path, name, text)
    }

    /// Asks the system to keep the files that were moved into their places.
    pub fn sync(&self) {
        sync_folder(&self.path);
    }

    /// The first file of a run that stands here though there is no journal: nobody knows whose it is.
    pub fn stray_file(&self) -> Option<String> {
        let mut names = Self::of_runs().chain([Self::CONTENTS.to_owned()]);
        names.find(|name| fs::symlink_metadata(self.file(name)).is_ok())
    }

    /// Removes the tables of an earlier run, but for those named in `files`: a folder describes one run.
    pub fn remove_tables_but(&self, files: &[String]) {
        let is_kept = |file: &String| files.contains(file) || file == Self::RUN_INFO;
        Self::of_runs().filter(|file| !is_kept(file)).for_each(|file| self.remove(&file));
    }

    /// Removes the tables of an earlier run and what it states of itself, but not its journal.
    pub fn remove_results(&self) {
        // From here on nobody takes the tables for whole.
        self.remove(Self::CONTENTS);
        Self::of_runs().for_each(|file| self.remove(&file));
    }

    /// Removes what was made from the tables and is as it was made; returns the names of the files.
    pub fn remove_derived(&self) -> Vec<String> {
        let all = Derivation::all(self).into_iter();
        let removed = all.flat_map(|made| made.remove(self)).collect();
        // Records, and nothing else, stand in that folder.
        let _ = fs::remove_dir_all(self.file(Self::DERIVED));
        removed
    }

    /// Removes what killed processes left half-written.
    pub fn remove_abandoned_files(&self) {
        remove_abandoned_files(&self.path);
    }

    /// Removes the file `name`, if it is there.
    pub fn remove(&self, name: &str) {
        // Nearly always there is none.
        let _ = fs::remove_file(self.file(name));
    }

    /// The names of the tables and the record of a run. Rankings and comparisons have commands of their own.
    pub(crate) fn of_runs() -> impl Iterator<Item = String> {
        let measures = MEASURE_TABLES.iter().map(|(value, _)| Self::measure_table(value));
        let others = [Self::DESIGNS, Self::FAILURES, Self::RERUNS, Self::RUN_INFO];
        measures.chain(others.map(str::to_owned))
    }
}
