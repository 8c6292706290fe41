//! The results folder: name, maker and role of every file, and safe writing of files.

use std::fs::{self, File};
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};

use journal::{AtomicFile, JournalError, OutputError, Start, make_folder, sync_folder, write_text};
use sweep::Measure;

use crate::columns::name;
use crate::tables::csv_format::CsvFormat;

/// Name and measure of each measure table; the name is the name of the leading value.
pub const MEASURE_TABLES: [(&str, Measure); 4] = [
    (name::COVERAGE, Measure::Coverage),
    (name::CRITICAL_FORCE, Measure::Puncture),
    (name::PENETRATION, Measure::Puncture),
    (name::COMPLIANCE, Measure::Flexure),
];

/// The command that makes a file of a results folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Maker {
    /// `squama run`, `rerun` and `merge`.
    Run,
    /// `squama rank`.
    Ranking,
    /// `squama compare`.
    Comparison,
    /// `squama design`.
    Design,
    /// `squama optimise`.
    Search,
    /// `squama tolerance`.
    Tolerance,
    /// `squama sensitivity`.
    Sensitivity,
    /// `squama fit`.
    Fit,
}

impl Maker {
    /// Returns the name of the record in `derived/` that lists the files of this maker.
    pub fn key(self) -> &'static str {
        self.names().0
    }

    /// Returns the name of the record in `derived/`, and the command.
    pub(crate) fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Run => ("run", "squama run"),
            Self::Ranking => (ResultsFolder::RANKING_RECORD, "squama rank"),
            Self::Comparison => ("comparison", "squama compare"),
            Self::Design => ("design", "squama design"),
            Self::Search => ("search", "squama optimise"),
            Self::Tolerance => ("tolerance", "squama tolerance"),
            Self::Sensitivity => ("sensitivity", "squama sensitivity"),
            Self::Fit => ("fit", "squama fit"),
        }
    }
}

/// Role of a file in a results folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Lines from which all other files of the maker are written.
    Journal,
    /// The file with the checksums of the other files.
    Statement,
    /// A table that workbooks include.
    Table,
    /// Any other file: definitions, records, and tables that workbooks do not include.
    Record,
}

/// A file of a results folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileEntry {
    /// Name of the file.
    pub name: &'static str,
    /// Command that makes the file.
    pub maker: Maker,
    /// Role of the file.
    pub role: Role,
    /// Whether the maker records the SHA-256 of the file, which every reader verifies.
    pub is_stated: bool,
}

/// Creates the entry of a file with a recorded SHA-256.
const fn stated(name: &'static str, maker: Maker, role: Role) -> FileEntry {
    FileEntry { name, maker, role, is_stated: true }
}

/// Creates the entry of a file without a recorded SHA-256.
const fn plain(name: &'static str, maker: Maker, role: Role) -> FileEntry {
    FileEntry { name, maker, role, is_stated: false }
}

/// Every file with a fixed name in a results folder, in reading order.
pub static FILES: [FileEntry; 49] = [
    // The journal grows, so it has no recorded SHA-256; each of its lines has a checksum.
    plain(ResultsFolder::JOURNAL, Maker::Run, Role::Journal),
    stated(ResultsFolder::DESIGNS, Maker::Run, Role::Table),
    stated("coverage.csv", Maker::Run, Role::Table),
    stated("critical_force.csv", Maker::Run, Role::Table),
    stated("penetration.csv", Maker::Run, Role::Table),
    stated("compliance.csv", Maker::Run, Role::Table),
    stated(ResultsFolder::SENSITIVITY, Maker::Run, Role::Table),
    stated(ResultsFolder::FAILURES, Maker::Run, Role::Table),
    stated(ResultsFolder::RERUNS, Maker::Run, Role::Table),
    stated(ResultsFolder::RUN_INFO, Maker::Run, Role::Record),
    // Users complete the metadata before they publish the folder, so its SHA-256 is not recorded.
    plain(ResultsFolder::METADATA, Maker::Run, Role::Record),
    plain(ResultsFolder::CONTENTS, Maker::Run, Role::Statement),
    stated(ResultsFolder::RANKING[0], Maker::Ranking, Role::Table),
    stated(ResultsFolder::RANKING[1], Maker::Ranking, Role::Table),
    stated(ResultsFolder::RANKING[2], Maker::Ranking, Role::Table),
    stated(ResultsFolder::RANKING[3], Maker::Ranking, Role::Table),
    // Workbook and page show the criteria in this file, so its SHA-256 is recorded.
    stated(ResultsFolder::PREFERENCES, Maker::Ranking, Role::Record),
    stated(ResultsFolder::COMPARISON[0], Maker::Comparison, Role::Table),
    stated(ResultsFolder::COMPARISON[1], Maker::Comparison, Role::Table),
    plain(ResultsFolder::EVALUATIONS, Maker::Search, Role::Journal),
    stated("goal.toml", Maker::Search, Role::Record),
    stated("history.csv", Maker::Search, Role::Record),
    stated("optimum.csv", Maker::Search, Role::Record),
    stated("optimum.toml", Maker::Search, Role::Record),
    stated("nearest.toml", Maker::Search, Role::Record),
    stated("front.csv", Maker::Search, Role::Record),
    stated("tolerance.csv", Maker::Tolerance, Role::Record),
    stated("tolerance_sources.csv", Maker::Tolerance, Role::Record),
    stated("yield.csv", Maker::Tolerance, Role::Record),
    stated("sobol.csv", Maker::Sensitivity, Role::Record),
    stated("fit.csv", Maker::Fit, Role::Record),
    stated("residuals.csv", Maker::Fit, Role::Record),
    stated("mean_curves.csv", Maker::Fit, Role::Record),
    stated("residuals.svg", Maker::Fit, Role::Record),
    stated("fitted.toml", Maker::Fit, Role::Record),
    plain("design.toml", Maker::Design, Role::Record),
    plain(ResultsFolder::MEASURES, Maker::Design, Role::Record),
    // A run also makes a file with this name. `FileEntry::named` returns the entry of the run,
    // which comes first and has a recorded SHA-256.
    plain(ResultsFolder::SENSITIVITY, Maker::Design, Role::Record),
    plain(ResultsFolder::PUNCTURE[0], Maker::Design, Role::Record),
    plain(ResultsFolder::PUNCTURE[1], Maker::Design, Role::Record),
    plain(ResultsFolder::PUNCTURE[2], Maker::Design, Role::Record),
    plain(ResultsFolder::PUNCTURE[3], Maker::Design, Role::Record),
    plain(ResultsFolder::FLEXURE[0], Maker::Design, Role::Record),
    plain(ResultsFolder::FLEXURE[1], Maker::Design, Role::Record),
    plain(ResultsFolder::FLEXURE[2], Maker::Design, Role::Record),
    plain(ResultsFolder::FLEXURE[3], Maker::Design, Role::Record),
    plain(ResultsFolder::UNLOADING[0], Maker::Design, Role::Record),
    plain(ResultsFolder::UNLOADING[1], Maker::Design, Role::Record),
    plain(ResultsFolder::PLACES, Maker::Design, Role::Record),
];

impl FileEntry {
    /// Returns the entry of the file `name`.
    ///
    /// If several makers share the name, returns the entry of the run.
    pub fn named(name: &str) -> Option<&'static Self> {
        FILES.iter().find(|file| file.name == name)
    }

    /// Returns all files of `maker` except its journal.
    pub(crate) fn products(maker: Maker) -> impl Iterator<Item = &'static Self> {
        FILES.iter().filter(move |file| file.maker == maker && file.role != Role::Journal)
    }
}

/// The folder of a run.
///
/// The constants are the names of the files that squama writes to the folder and reads back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ResultsFolder {
    path: PathBuf,
}

impl ResultsFolder {
    /// Journal of the finished designs, from which the tables are written.
    pub const JOURNAL: &'static str = "journal.jsonl";
    /// Journal of a search.
    pub const EVALUATIONS: &'static str = "evaluations.jsonl";
    /// Record of the run: program, counts, definition.
    pub const RUN_INFO: &'static str = "run.toml";
    /// Checksums of the files in the folder, written last.
    pub const CONTENTS: &'static str = "contents.toml";
    /// Metadata of the folder as an RO-Crate.
    pub const METADATA: &'static str = "ro-crate-metadata.json";
    /// Folder with a record of each product that was derived from the tables.
    pub const DERIVED: &'static str = "derived";
    /// Name of the record of a ranking in `derived/`.
    pub const RANKING_RECORD: &'static str = "ranking";
    /// Table of all designs.
    pub const DESIGNS: &'static str = "designs.csv";
    /// Table of measures without a value.
    pub const FAILURES: &'static str = "failures.csv";
    /// Table of the derivatives of the measures.
    pub const SENSITIVITY: &'static str = "sensitivity.csv";
    /// Table of the changes made by reruns.
    pub const RERUNS: &'static str = "reruns.csv";
    /// Tables of a ranking: fitness, Pareto front, winners, winner at every weight.
    pub const RANKING: [&'static str; 4] =
        ["ranking.csv", "pareto.csv", "winners.csv", "quaternary.csv"];
    /// Preferences of a ranking: requirements, criteria, weights, scale.
    pub const PREFERENCES: &'static str = "ranking.toml";
    /// Tables of a comparison: by column and by cell.
    pub const COMPARISON: [&'static str; 2] = ["compare.csv", "differences.csv"];
    /// Table of the measures of one design.
    pub const MEASURES: &'static str = "measures.csv";
    /// Tables of the puncture of one design: path, events, scales, iterations.
    pub const PUNCTURE: [&'static str; 4] = ["path.csv", "events.csv", "scales.csv", "steps.csv"];
    /// Tables of the bending of one design: path, events, scales, iterations.
    pub const FLEXURE: [&'static str; 4] =
        ["flexure_path.csv", "flexure_events.csv", "flexure_scales.csv", "flexure_steps.csv"];
    /// Tables of the unloading paths of one design, for puncture and bending.
    pub const UNLOADING: [&'static str; 2] = ["way_back.csv", "flexure_way_back.csv"];
    /// Table of the evaluated load positions of one design.
    pub const PLACES: &'static str = "places.csv";

    /// Returns the folder at `path`, which need not exist.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into() }
    }

    /// Returns the name of the table of a measured value, e.g. `coverage.csv`.
    pub fn measure_table(value: &str) -> String {
        format!("{value}.csv")
    }

    /// Returns the names of all tables of a run, its ranking and its comparison, in reading order.
    pub fn tables() -> impl Iterator<Item = &'static str> {
        FILES.iter().filter(|file| file.role == Role::Table).map(|file| file.name)
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the path of the file `name` in this folder.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Returns the path of the journal.
    pub fn journal(&self) -> PathBuf {
        self.file(Self::JOURNAL)
    }

    /// Returns true if the file `name` exists.
    pub fn holds(&self, name: &str) -> bool {
        self.file(name).is_file()
    }

    /// Returns the CSV format of this folder, or of the run that it belongs to.
    ///
    /// Results of `design` and `tolerance` are one or two levels below their run. Without tables
    /// the format is [`CsvFormat::Plain`].
    pub fn csv_format(&self) -> CsvFormat {
        for folder in self.path.ancestors().take(3) {
            for table in [Self::DESIGNS, "optimum.csv"] {
                let Ok(file) = File::open(folder.join(table)) else { continue };
                if let Ok(start) = BufReader::new(file).fill_buf() {
                    return CsvFormat::detect(start).0;
                }
            }
        }
        CsvFormat::default()
    }

    /// Creates the folder and removes partial files of killed processes.
    ///
    /// # Errors
    ///
    /// If the folder cannot be created.
    pub fn make(&self) -> Result<(), OutputError> {
        make_folder(&self.path)
    }

    /// Starts to write the file `name`, which appears in the folder when it is complete.
    ///
    /// # Errors
    ///
    /// If the folder cannot be written.
    pub fn create(&self, name: &str) -> Result<AtomicFile, OutputError> {
        AtomicFile::create(&self.path, name)
    }

    /// Writes `text` as the file `name` and returns its SHA-256.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_text(&self, name: &str, text: &str) -> Result<String, OutputError> {
        write_text(&self.path, name, text)
    }

    /// Flushes the entries (file names) of the folder to the disk.
    pub fn sync(&self) {
        sync_folder(&self.path);
    }

    /// Checks that `maker` may write its files into this folder.
    ///
    /// # Errors
    ///
    /// If the folder contains the journal of another maker. For a run also if the folder contains
    /// files with names of its results but no journal; [`Start::Fresh`] accepts such files, because
    /// a fresh run discards them.
    pub fn require_own(&self, maker: Maker, start: Start) -> Result<(), JournalError> {
        // Test for links without following them, because a dangling link would be replaced too.
        let exists = |file: &&FileEntry| fs::symlink_metadata(self.file(file.name)).is_ok();
        let mut journals = FILES.iter().filter(|file| file.role == Role::Journal).filter(exists);
        if let Some(other) = journals.clone().find(|file| file.maker != maker) {
            let what = if other.maker == Maker::Run { "a run" } else { "a search" };
            return Err(JournalError::Holds { folder: self.path.clone(), what });
        }
        // `Claim` checks the files of other makers.
        if maker != Maker::Run || start == Start::Fresh || journals.next().is_some() {
            return Ok(());
        }
        let stray = FileEntry::products(maker).find(exists);
        stray.map_or(Ok(()), |stray| {
            let (folder, file) = (self.path.clone(), stray.name.to_owned());
            Err(JournalError::NoJournal { folder, file })
        })
    }

    /// Removes the tables of an earlier run, except the tables named in `files`.
    pub fn remove_tables_but(&self, files: &[String]) {
        // Keep the record and the contents of the run, which are overwritten after the tables.
        let tables = FileEntry::products(Maker::Run).filter(|file| file.role == Role::Table);
        let removed = tables.filter(|file| files.iter().all(|kept| kept != file.name));
        removed.for_each(|file| self.remove(file.name));
    }

    /// Removes the tables and the contents of an earlier run, but not its journal.
    pub fn remove_results(&self) {
        // Remove the contents first: without the contents no reader accepts the remaining tables
        // as complete.
        self.remove(Self::CONTENTS);
        FileEntry::products(Maker::Run).for_each(|file| self.remove(file.name));
    }

    /// Removes the file `name`, if it exists.
    pub fn remove(&self, name: &str) {
        // Ignore the error, because usually the file does not exist.
        let _ = fs::remove_file(self.file(name));
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_file_has_one_entry() {
        let names: BTreeSet<_> = FILES.iter().map(|file| (file.maker.key(), file.name)).collect();
        assert_eq!(names.len(), FILES.len());
        for (value, _) in MEASURE_TABLES {
            let file = FileEntry::named(&ResultsFolder::measure_table(value)).expect("an entry");
            assert_eq!((file.maker, file.role), (Maker::Run, Role::Table));
        }
        for name in ResultsFolder::RANKING.into_iter().chain([ResultsFolder::PREFERENCES]) {
            assert!(FileEntry::named(name).is_some_and(|file| file.maker == Maker::Ranking));
        }
    }

    #[test]
    fn a_run_refuses_to_overwrite_a_foreign_file() {
        for file in FileEntry::products(Maker::Run) {
            let place = tempfile::tempdir().expect("a folder");
            let folder = ResultsFolder::new(place.path());
            fs::write(folder.file(file.name), "a stranger's").expect("writable");
            let refused = folder.require_own(Maker::Run, Start::Resume).expect_err(file.name);
            assert!(refused.to_string().contains(file.name), "{refused}");
            folder.require_own(Maker::Run, Start::Fresh).expect("a fresh start discards the file");
            folder.remove_results();
            assert!(!folder.holds(file.name), "{}", file.name);
        }
    }

    #[test]
    fn a_folder_with_the_journal_of_another_maker_is_refused() {
        for (maker, journal) in
            [(Maker::Run, ResultsFolder::EVALUATIONS), (Maker::Search, ResultsFolder::JOURNAL)]
        {
            let place = tempfile::tempdir().expect("a folder");
            let folder = ResultsFolder::new(place.path());
            fs::write(folder.file(journal), "").expect("writable");
            let refused = folder.require_own(maker, Start::Fresh).expect_err("a foreign journal");
            assert!(refused.to_string().contains("holds the results of a"), "{refused}");
        }
    }
}
