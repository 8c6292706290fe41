//! Refuses requirements that exceed bounds known in closed form.
//!
//! For gap `d` and pitch `p`, scales occupy the fraction `1 − d/p` of the pitch, and only the gaps
//! bend. So the coverage is at most `1 − d/p`, and the compliance at most `d/p` (O8).

use ranking::Requirement;
use results::columns::name;
use sweep::InvalidDefinition;
use text::number;

use super::refusal::not_accepted;
use super::section::GoalSection;
use crate::coverage_piece::{COMPLIANCES, open_share};
use crate::space::{DesignSpace, SpacePoint};

/// Maximum number of continuous variables for which all corners of the space are evaluated.
const CORNERED: usize = 12;

/// Returns true if `requirement` is a lower bound on one of `columns`.
fn is_lower_bound(requirement: &Requirement, columns: &[&str]) -> bool {
    columns.contains(&requirement.column.as_str()) && requirement.direction() > 0.0
}

/// Returns errors for requirements on coverage and compliance that no design in `space` can meet.
pub(super) fn out_of_bounds(goal: &GoalSection, space: &DesignSpace) -> Vec<InvalidDefinition> {
    let Some((least, most)) = open_shares(space) else { return Vec::new() };
    let mut refused = Vec::new();
    for (requirement, location) in &goal.requirements {
        let is_on_coverage = is_lower_bound(requirement, &[name::COVERAGE]);
        let (bound, why) = if is_on_coverage {
            (
                1.0 - least,
                "coverage is at most 1 - d/p, the fraction of the pitch that scales occupy",
            )
        } else if is_lower_bound(requirement, &COMPLIANCES) {
            (most, "compliance is at most d/p, the fraction of the pitch that gaps occupy")
        } else {
            continue;
        };
        let mut beside = goal.requirements.iter().map(|(other, _)| other).filter(|other| {
            is_lower_bound(other, &COMPLIANCES) && requirement.limit + other.limit > 1.0
        });
        let expected = if !requirement.is_met(bound) {
            format!("at most {} within the ranges of the variables: {why}", number::text(bound))
        } else if let Some(other) = beside.next()
            && is_on_coverage
            && !requirement.is_met(1.0 - other.limit)
        {
            let remaining = number::text(rounded(1.0 - other.limit));
            format!(
                "at most {remaining} together with {other}: coverage is at most 1 - d/p and compliance at most d/p, the fractions of the pitch that scales and gaps occupy"
            )
        } else {
            continue;
        };
        refused.push(not_accepted(location, "goal.require", requirement, expected));
    }
    refused
}

/// Rounds a difference of limits to 12 decimals, which removes round-off.
fn rounded(value: f64) -> f64 {
    (value * 1e12).round() * 1e-12
}

/// Returns the smallest and the largest `d/p` of the designs in `space`.
///
/// Both values are at corners of the space, because `d/p` is monotonic in gap and length. `None` if
/// there are too many corners.
fn open_shares(space: &DesignSpace) -> Option<(f64, f64)> {
    let intervals = space.intervals().len();
    if intervals > CORNERED || space.combinations() > 1 << CORNERED {
        return None;
    }
    let shares = (0..space.combinations()).flat_map(|combination| {
        (0..1_usize << intervals).filter_map(move |corner| {
            let fractions =
                (0..intervals).map(|j| if corner >> j & 1 == 1 { 1.0 } else { 0.0 }).collect();
            open_share(
                &space.case(&SpacePoint { fractions, chosen: space.combination(combination) }),
            )
        })
    });
    shares.map(|share| (share, share)).reduce(|(a, b), (c, d)| (a.min(c), b.max(d)))
}
