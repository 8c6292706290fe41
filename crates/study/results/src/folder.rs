//! The folder of results: every file that squama writes there, an entry each, and how files get there.

use std::fs::{self, File};
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};

use journal::{AtomicFile, JournalError, OutputError, Start, make_folder, sync_folder, write_text};
use sweep::Measure;

use crate::columns::name;
use crate::tables::csv_format::CsvFormat;

/// The tables of one measure, named by the value that they are about.
pub const MEASURE_TABLES: [(&str, Measure); 4] = [
    (name::COVERAGE, Measure::Coverage),
    (name::CRITICAL_FORCE, Measure::Puncture),
    (name::PENETRATION, Measure::Puncture),
    (name::COMPLIANCE, Measure::Flexure),
];

/// What makes a file of a results folder.
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
    /// The name of its record.
    pub(crate) fn key(self) -> &'static str {
        self.names().0
    }

    /// The names of its record and of its command.
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

/// What a file of a results folder is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The lines that everything else of its maker is written from.
    Journal,
    /// The statement of what the others are.
    Statement,
    /// A table, which stands in workbooks too.
    Table,
    /// A text about the tables.
    Record,
}

/// A file of a results folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileEntry {
    /// Its name.
    pub name: &'static str,
    /// What makes it.
    pub maker: Maker,
    /// What it is for.
    pub role: Role,
    /// Whether its maker states its SHA-256, so that it is not read before that is checked.
    pub is_stated: bool,
}

/// An entry of a file whose maker states its SHA-256.
const fn stated(name: &'static str, maker: Maker, role: Role) -> FileEntry {
    FileEntry { name, maker, role, is_stated: true }
}

/// An entry of a file of which nobody states anything.
const fn plain(name: &'static str, maker: Maker, role: Role) -> FileEntry {
    FileEntry { name, maker, role, is_stated: false }
}

/// Every file of a fixed name that squama leaves in a folder of results, in the order in which people read them.
pub static FILES: [FileEntry; 47] = [
    // A journal grows behind what is stated of it: each of its lines bears a checksum instead.
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
    plain(ResultsFolder::CONTENTS, Maker::Run, Role::Statement),
    stated(ResultsFolder::RANKING[0], Maker::Ranking, Role::Table),
    stated(ResultsFolder::RANKING[1], Maker::Ranking, Role::Table),
    stated(ResultsFolder::RANKING[2], Maker::Ranking, Role::Table),
    stated(ResultsFolder::RANKING[3], Maker::Ranking, Role::Table),
    // Workbook and page read from it what the ranking goes by: a changed one would lie about it.
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
    stated("residuals.svg", Maker::Fit, Role::Record),
    stated("fitted.toml", Maker::Fit, Role::Record),
    plain("design.toml", Maker::Design, Role::Record),
    plain(ResultsFolder::MEASURES, Maker::Design, Role::Record),
    // A name that runs have too: who looks it up finds the entry of the run, which stands first and is checked.
    plain(ResultsFolder::SENSITIVITY, Maker::Design, Role::Record),
    plain(ResultsFolder::PUNCTURE[0], Maker::Design, Role::Record),
    plain(ResultsFolder::PUNCTURE[1], Maker::Design, Role::Record),
    plain(ResultsFolder::PUNCTURE[2], Maker::Design, Role::Record),
    plain(ResultsFolder::PUNCTURE[3], Maker::Design, Role::Record),
    plain(ResultsFolder::FLEXURE[0], Maker::Design, Role::Record),
    plain(ResultsFolder::FLEXURE[1], Maker::Design, Role::Record),
    plain(ResultsFolder::FLEXURE[2], Maker::Design, Role::Record),
    plain(ResultsFolder::FLEXURE[3], Maker::Design, Role::Record),
    plain(ResultsFolder::WAY_BACK[0], Maker::Design, Role::Record),
    plain(ResultsFolder::WAY_BACK[1], Maker::Design, Role::Record),
    plain(ResultsFolder::PLACES, Maker::Design, Role::Record),
];

impl FileEntry {
    /// The entry of the file `name`, if it is one of squama's; of several makers, that of the run.
    pub fn named(name: &str) -> Option<&'static Self> {
        FILES.iter().find(|file| file.name == name)
    }

    /// The files that a maker writes from its journal, and its statement.
    pub(crate) fn products(maker: Maker) -> impl Iterator<Item = &'static Self> {
        FILES.iter().filter(move |file| file.maker == maker && file.role != Role::Journal)
    }
}

/// The folder of a run. It owns the names of all files that squama writes there and reads back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ResultsFolder {
    path: PathBuf,
}

impl ResultsFolder {
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
    /// The tables of the way back of one design, of its puncture and of its bending.
    pub const WAY_BACK: [&'static str; 2] = ["way_back.csv", "flexure_way_back.csv"];
    /// The table of the places of the load that were tried.
    pub const PLACES: &'static str = "places.csv";

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
    pub fn tables() -> impl Iterator<Item = &'static str> {
        FILES.iter().filter(|file| file.role == Role::Table).map(|file| file.name)
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

    /// The format of the tables in this folder, or of the run that it belongs to; plain if there are none.
    ///
    /// Results of `design` and `tolerance` stand one or two levels below their run.
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

    /// Makes the folder and those above it, and removes what killed processes have left half-written there.
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

    /// Refuses to write what `maker` makes where another maker's journal stands, or files of its names without a journal: nobody knows
    /// whose they are. To start afresh is to throw those away.
    ///
    /// # Errors
    /// If there are such files.
    pub fn require_own(&self, maker: Maker, start: Start) -> Result<(), JournalError> {
        let folder = || self.path.clone();
        // Asked of a link itself: one that leads nowhere would be replaced all the same.
        let is_there = |file: &&FileEntry| fs::symlink_metadata(self.file(file.name)).is_ok();
        let mut journals = FILES.iter().filter(|file| file.role == Role::Journal).filter(is_there);
        if let Some(other) = journals.clone().find(|file| file.maker != maker) {
            let what = if other.maker == Maker::Run { "a run" } else { "a search" };
            return Err(JournalError::Holds { folder: folder(), what });
        }
        // What other makers have written is told by their records, see `Claim`.
        if maker != Maker::Run || start == Start::Fresh || journals.next().is_some() {
            return Ok(());
        }
        let stray = FileEntry::products(maker).find(is_there);
        stray.map_or(Ok(()), |stray| {
            Err(JournalError::NoJournal { folder: folder(), file: stray.name.to_owned() })
        })
    }

    /// Removes the tables of an earlier run, but for those named in `files`: a folder describes one run.
    pub fn remove_tables_but(&self, files: &[String]) {
        // The record of the run and its statement are written anew whenever the tables are.
        let tables = FileEntry::products(Maker::Run).filter(|file| file.role == Role::Table);
        let gone = tables.filter(|file| files.iter().all(|kept| kept != file.name));
        gone.for_each(|file| self.remove(file.name));
    }

    /// Removes the tables of an earlier run and what it states of itself, but not its journal.
    pub fn remove_results(&self) {
        // Where it is gone nobody takes the others for whole.
        self.remove(Self::CONTENTS);
        FileEntry::products(Maker::Run).for_each(|file| self.remove(file.name));
    }

    /// Removes the file `name`, if it is there.
    pub fn remove(&self, name: &str) {
        // Nearly always there is none.
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
    fn no_run_writes_over_a_file_of_a_stranger() {
        for file in FileEntry::products(Maker::Run) {
            let place = tempfile::tempdir().expect("a folder");
            let folder = ResultsFolder::new(place.path());
            fs::write(folder.file(file.name), "a stranger's").expect("writable");
            let refused = folder.require_own(Maker::Run, Start::Resume).expect_err(file.name);
            assert!(refused.to_string().contains(file.name), "{refused}");
            folder.require_own(Maker::Run, Start::Fresh).expect("what was asked for");
            folder.remove_results();
            assert!(!folder.holds(file.name), "{}", file.name);
        }
    }

    #[test]
    fn a_folder_has_one_maker() {
        for (maker, journal) in
            [(Maker::Run, ResultsFolder::EVALUATIONS), (Maker::Search, ResultsFolder::JOURNAL)]
        {
            let place = tempfile::tempdir().expect("a folder");
            let folder = ResultsFolder::new(place.path());
            fs::write(folder.file(journal), "").expect("writable");
            let refused = folder.require_own(maker, Start::Fresh).expect_err("another's");
            assert!(refused.to_string().contains("holds the results of a"), "{refused}");
        }
    }
}
