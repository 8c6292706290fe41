//! Status of a search: numbers of solved designs, and whether it is complete.

use std::path::Path;
use std::time::Duration;

use journal::{JournalError, Records as _};
use results::{Completeness, Derivation, DesignRow, Maker, ResultsFolder, VerifiedFolder};

use crate::evaluations::{Known, read_journal};
use crate::goal::DesignGoal;
use crate::judge::Judge;
use crate::judgement::Judgement;

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
    /// Time from the first to the last entry of the journal, with pauses.
    ///
    /// `None` if unknown.
    pub time: Option<Duration>,
    /// The goal, if this version reads it.
    pub definition: Option<DesignGoal>,
    /// Nominal designs in the order in which they were solved.
    ///
    /// Empty for a search for a fitness, and if a variable only scales the results.
    pub evaluations: Vec<EvaluatedDesign>,
    /// Version and revision of the program.
    pub program: String,
    /// SHA-256 of the goal.
    pub goal_sha256: String,
    /// Problems with the files of the search, one line each.
    pub problems: Vec<String>,
}

/// A nominal design that a search has solved, judged without samples.
#[derive(Clone, Debug)]
pub struct EvaluatedDesign {
    /// Values of the variables; `None` for words.
    pub variables: Vec<Option<f64>>,
    /// Values of the objectives and of the requirements.
    pub values: Vec<f64>,
    /// True if the design meets every requirement on nominal designs.
    pub is_met: bool,
    /// Largest shortfall, relative to the limit.
    pub shortfall: f64,
}

impl SearchStatus {
    /// Returns the index of the best design so far.
    ///
    /// The best by the first objective, or if none is feasible the nearest to the limits.
    pub fn best(&self) -> Option<usize> {
        let goal = self.definition.as_ref()?;
        let sign = if goal.objectives[0].goal == ranking::Goal::Maximize { 1.0 } else { -1.0 };
        let mut best: Option<(usize, (i32, f64))> = None;
        for (index, design) in self.evaluations.iter().enumerate() {
            let own =
                if design.is_met { (1, sign * design.values[0]) } else { (0, -design.shortfall) };
            if best.is_none_or(|(_, other)| own > other) {
                best = Some((index, own));
            }
        }
        best.map(|(index, _)| index)
    }

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
        let definition = DesignGoal::parse(header.definition(), "the goal", &[]).ok();
        let goal = definition.as_ref().map_or("search", DesignGoal::name).to_owned();
        let evaluations =
            definition.as_ref().map_or_else(Vec::new, |goal| evaluations(&goal.nominal(), &known));
        let definition = definition.map(|goal| goal.nominal());
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
            time: time(&path),
            definition,
            evaluations,
            program: header.program(),
            goal_sha256: header.definition_sha256().to_owned(),
            problems: problems.iter().map(ToString::to_string).collect(),
        })
    }
}

/// Judges the solved designs of a search, without samples.
fn evaluations(goal: &DesignGoal, known: &Known) -> Vec<EvaluatedDesign> {
    // The journal has one entry for all designs that differ by scaling only.
    if goal.fitness.is_some() || !goal.space.scaling_intervals().is_empty() {
        return Vec::new();
    }
    let judge = Judge::new(goal);
    let number = goal.space.sweep().grid().number(0);
    let mut evaluations = Vec::new();
    for (point, result) in &known.order {
        let case = goal.space.case(point);
        let row = DesignRow { number, case, result: result.as_ref().clone() };
        if let Judgement::Judged(worth) = judge.verdict(&row) {
            evaluations.push(EvaluatedDesign {
                variables: goal.space.parameters().map(|p| p.get(&case).number()).collect(),
                values: goal.values(&worth).map(|(_, value)| value).collect(),
                is_met: worth.met,
                shortfall: worth.shortfall(),
            });
        }
    }
    evaluations
}

/// Returns the time from the creation to the last change of a file.
fn time(path: &Path) -> Option<Duration> {
    let file = path.metadata().ok()?;
    file.modified().ok()?.duration_since(file.created().ok()?).ok()
}
