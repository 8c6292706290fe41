//! Checks the best designs of a ranking, and finds the best design that passes all checks.

use ranking::{Preferences, RankedDesign, Ranking, Requirement};
use results::Results;
use results::columns::is_invalid_after_fold;
use run::{CouplingChange, GapChange, Patience};

use super::columns::{is_folded, measured_columns};

/// Maximum number of designs that are checked, which limits the waiting time.
const MOST: usize = 50;

/// Designs that fail a check, and the best design that passes all checks.
///
/// A design fails if its surface folds, with the coupling of the run or with full coupling, or if
/// it misses a requirement with full coupling or with a gap 10 % smaller or larger.
#[derive(Debug, Default)]
pub struct Checks<'a> {
    /// Numbers of the designs that fail, in the order of the ranking.
    pub failed: Vec<String>,
    /// The best design that passes all checks, if a better design fails a check.
    ///
    /// `None` if the first design of the ranking passes, if no checked design passes, or if no
    /// design is checked.
    pub best: Option<RankedDesign<'a>>,
}

impl<'a> Checks<'a> {
    /// Checks designs in the order of the ranking until a design passes.
    ///
    /// Checks no design if there are no requirements, or if the results have no definition.
    pub fn new(results: &Results, ranking: &'a Ranking<'a>) -> Self {
        let preferences = ranking.preferences();
        let mut checks = Self::default();
        if preferences.requirements.is_empty() || results.definition().is_none() {
            return checks;
        }
        for design in ranking.by_fitness(preferences.weights).take(MOST) {
            if passes(results, preferences, &design) {
                checks.best = Some(design).filter(|_| !checks.failed.is_empty());
                break;
            }
            checks.failed.push(design.design().to_owned());
        }
        checks
    }

    /// Returns true if a design fails a check.
    pub fn fails(&self, design: &str) -> bool {
        self.failed.iter().any(|failed| failed == design)
    }
}

/// Returns true if a design passes all checks.
fn passes(results: &Results, preferences: &Preferences, design: &RankedDesign<'_>) -> bool {
    let columns = measured_columns(preferences);
    let depends_on_fold = columns.iter().any(|column| is_invalid_after_fold(column));
    if depends_on_fold && is_folded(results, design.row()) {
        return false;
    }
    // Without a definition the design cannot be solved again, and passes. A design that is slow to
    // solve passes as well, because both functions `solve` return `None`.
    let Some(sweep) = results.definition() else { return true };
    let coupled = CouplingChange::solve(sweep, design.design(), &columns, Patience::Milliseconds);
    let is_coupled = coupled.is_none_or(|change| {
        let mut requirements = preferences.requirements.iter();
        !(depends_on_fold && change.folds) && requirements.all(|r| is_met_coupled(&change, r))
    });
    is_coupled
        && GapChange::solve(sweep, design.design(), &columns, Patience::Milliseconds).is_none_or(
            |change| {
                preferences
                    .requirements
                    .iter()
                    .all(|requirement| is_met_nearby(&change, requirement))
            },
        )
}

/// Returns true if a requirement is met with full substrate coupling, or concerns no measure.
fn is_met_coupled(change: &CouplingChange, requirement: &Requirement) -> bool {
    let mut measures = change.measures.iter().filter(|m| m.column == requirement.column);
    measures.all(|measure| measure.full.is_some_and(|full| requirement.is_met(full)))
}

/// Returns true if a requirement is met with a smaller and a larger gap, or concerns no measure.
fn is_met_nearby(change: &GapChange, requirement: &Requirement) -> bool {
    let measures = change.measures.iter().filter(|m| m.column == requirement.column);
    measures
        .flat_map(|measure| measure.changed)
        .all(|changed| changed.is_some_and(|changed| requirement.is_met(changed)))
}
