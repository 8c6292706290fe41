//! Status of a search: numbers of solved designs, and whether it is complete.

use std::path::Path;

use journal::{JournalError, Records as _};
use results::{Completeness, Derivation, Maker, ResultsFolder, VerifiedFolder};

use crate::evaluations::read_journal;
use crate::goal::DesignGoal;

/// Status of a search.
#[derive(Clone, Debug)]
pub struct SearchStatus {
    /// Name of the goal.
    pub goal: String,
    /// True if a process is writing to the journal.
    pub in_use: bool,
    /// True if the results of the search are written.
    pub is_complete: bool,
    /// Number of solved designs, including samples that are solved with derivatives.
    pub designs: usize,
    /// Number of sets of samples.
    pub sample_sets: usize,
    /// Version and revision of the program.
    pub program: String,
    /// SHA-256 of the goal.
    pub goal_sha256: String,
    /// Problems with the files of the search, one line each.
    pub problems: Vec<String>,
}

impl SearchStatus {
    /// Returns true if `folder` holds the journal of a search.
    pub fn is_search(folder: &Path) -> bool {
        folder.join(ResultsFolder::EVALUATIONS).is_file()
    }

    /// Reads the status of the search in `folder`, which may be in progress.
    ///
    /// # Errors
    ///
    /// If there is no search, or its journal is damaged.
    pub fn read(folder: &Path) -> Result<Self, JournalError> {
        let folder = ResultsFolder::new(folder);
        let path = folder.file(ResultsFolder::EVALUATIONS);
        // Query the lock before reading. If the search ends in between, it is reported as in
        // progress.
        let in_use = journal::in_use(&path);
        let known = read_journal(&path)?;
        let known = known.ok_or_else(|| JournalError::Missing(folder.path().to_owned()))?;
        let header = known.header();
        let goal = DesignGoal::parse(header.definition(), "the goal", &[]);
        let goal = goal.map_or_else(|_| "search".to_owned(), |goal| goal.name().to_owned());
        let made = Derivation::read(&folder, Maker::Search.key());
        // A command records empty checksums before it writes its files.
        let mut digests = made.iter().flat_map(|made| made.files.values());
        let is_complete = !in_use && made.is_some() && digests.all(|digest| !digest.is_empty());
        let names = made.iter().filter(|_| is_complete).flat_map(|made| made.files.keys());
        let problems = match VerifiedFolder::open(folder.path(), Completeness::Partial) {
            Ok(verified) => names.filter_map(|name| verified.file(name).err()).collect(),
            Err(problem) => vec![problem],
        };
        Ok(Self {
            goal,
            in_use,
            is_complete,
            designs: known.solved.len(),
            sample_sets: known.sampled.len(),
            program: header.program(),
            goal_sha256: header.definition_sha256().to_owned(),
            problems: problems.iter().map(ToString::to_string).collect(),
        })
    }
}
