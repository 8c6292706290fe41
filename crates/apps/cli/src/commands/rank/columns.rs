//! Lists the columns that a ranking depends on.

use ranking::Preferences;
use results::Results;
use results::columns::{measures_among, name};

/// Returns the columns of the criteria, then the columns of the requirements.
pub fn preferred_columns(preferences: &Preferences) -> impl Iterator<Item = &str> {
    let criteria = preferences.criteria.iter().map(|criterion| criterion.column.as_ref());
    criteria.chain(preferences.requirements.iter().map(|requirement| &*requirement.column))
}

/// Returns the columns of criteria and requirements that are not parameters, without duplicates.
pub fn measured_columns(preferences: &Preferences) -> Vec<&str> {
    measures_among(preferred_columns(preferences))
}

/// Returns true if the substrate of the design in `row` folds before its puncture ends.
pub fn is_folded(results: &Results, row: usize) -> bool {
    results.column(name::FOLD_FORCE).is_ok_and(|fold| !results.table().is_empty(row, fold))
}
