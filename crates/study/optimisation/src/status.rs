//! Status of a search: number of solved designs, best design so far, completeness.

use std::path::Path;
use std::time::Duration;

use journal::{JournalError, Records as _};
use results::{Completeness, Derivation, DesignRow, Maker, ResultsFolder, VerifiedFolder};

use crate::evaluations::{JournalContent, read_journal};
use crate::goal::DesignGoal;
use crate::judge::Judge;
use crate::judgement::Judgement;

/// Status of a search, read from its files.
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
    /// Number of sampled designs; a design counts once for each set of its samples.
    pub sample_sets: usize,
    /// Time from the creation of the journal to its last entry, including interruptions.
    ///
    /// `None` if unknown.
    pub time: Option<Duration>,
    /// Goal for nominal designs; `None` if this version of squama cannot read the goal.
    pub definition: Option<DesignGoal>,
    /// Nominal designs in the order in which they were solved.
    ///
    /// Empty if the goal uses the fitness, or if a variable only changes the scale of the results.
    pub evaluations: Vec<EvaluatedDesign>,
    /// Version and revision of the program that wrote the journal.
    pub program: String,
    /// SHA-256 of the goal.
    pub goal_sha256: String,
    /// Descriptions of problems with the files of the search, one line each.
    pub problems: Vec<String>,
}

/// A nominal design that a search has solved, judged without samples.
#[derive(Clone, Debug)]
pub struct EvaluatedDesign {
    /// Values of the variables; `None` for a value that is not a number.
    pub variables: Vec<Option<f64>>,
    /// Values of the objectives, then of the columns of the requirements.
    pub values: Vec<f64>,
    /// True if the design meets each requirement on nominal designs.
    pub is_met: bool,
    /// Largest shortfall relative to the limit.
    pub shortfall: f64,
}

impl SearchStatus {
    /// Returns the index of the best design so far in [`Self::evaluations`].
    ///
    /// Feasible designs are compared by the first objective. If no design is feasible, the design
    /// with the smallest shortfall is the best.
    pub fn best(&self) -> Option<usize> {
        let goal = self.definition.as_ref()?;
        let sign = if goal.objectives[0].goal == ranking::Goal::Maximize { 1.0 } else { -1.0 };
        let mut best: Option<(usize, (i32, f64))> = None;
        for (index, design) in self.evaluations.iter().enumerate() {
            let rank =
                if design.is_met { (1, sign * design.values[0]) } else { (0, -design.shortfall) };
            if best.is_none_or(|(_, other)| rank > other) {
                best = Some((index, rank));
            }
        }
        best.map(|(index, _)| index)
    }

    /// Returns true if `folder` contains the journal of a search.
    pub fn is_search(folder: &Path) -> bool {
        folder.join(ResultsFolder::EVALUATIONS).is_file()
    }

    /// Reads the status of the search in `folder`, which may be in progress.
    ///
    /// # Errors
    ///
    /// If the folder contains no search, or if the journal is damaged.
    pub fn read(folder: &Path) -> Result<Self, JournalError> {
        let folder = ResultsFolder::new(folder);
        let path = folder.file(ResultsFolder::EVALUATIONS);
        // Test the lock before reading the journal. A search that ends between these two steps is
        // then reported as in progress, not as stopped.
        let in_use = journal::in_use(&path);
        let known = read_journal(&path)?;
        let known = known.ok_or_else(|| JournalError::Missing(folder.path().to_owned()))?;
        let header = known.header();
        let definition = DesignGoal::parse(header.definition(), "the goal", &[]).ok();
        let goal = definition.as_ref().map_or("search", DesignGoal::name).to_owned();
        let evaluations =
            definition.as_ref().map_or_else(Vec::new, |goal| evaluations(&goal.nominal(), &known));
        let definition = definition.map(|goal| goal.nominal());
        let derivation = Derivation::read(&folder, Maker::Search.key());
        // A checksum is empty if the command was interrupted before it wrote the file.
        let mut digests = derivation.iter().flat_map(|derivation| derivation.files.values());
        let is_complete =
            !in_use && derivation.is_some() && digests.all(|digest| !digest.is_empty());
        let names = derivation
            .iter()
            .filter(|_| is_complete)
            .flat_map(|derivation| derivation.files.keys());
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

/// Judges the solved nominal designs of a search by `goal`, the goal for nominal designs.
fn evaluations(goal: &DesignGoal, known: &JournalContent) -> Vec<EvaluatedDesign> {
    // A fitness needs worst and best values of its criteria, which the journal lacks. With a
    // variable that only changes the scale of the results, the journal has one entry for many
    // designs.
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

/// Returns the time from the creation of a file to its last change; `None` if unknown.
fn time(path: &Path) -> Option<Duration> {
    let file = path.metadata().ok()?;
    file.modified().ok()?.duration_since(file.created().ok()?).ok()
}
