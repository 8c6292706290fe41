//! Solves the best designs of a ranking with other gaps and with full substrate coupling.

use ranking::{RankedDesign, Ranking, Requirement, Weights};
use rayon::prelude::*;
use results::Results;
use run::{CouplingChange, GapChange, MeasureChange, Patience};

use super::columns::measured_columns;

/// Smallest ratio of two values that is printed as a factor, and not in percent.
const LARGE: f64 = 2.0;

/// Solves the best designs of a ranking again with smaller and larger gaps.
///
/// The solved designs are the best by the weights, the design `passing` that passes the checks, the
/// best without a fold, and the best by each criterion. The list is empty if the results have no
/// definition.
pub fn gap_changes(
    results: &Results,
    ranking: &Ranking<'_>,
    passing: Option<RankedDesign<'_>>,
) -> Vec<GapChange> {
    let Some(sweep) = results.definition() else { return Vec::new() };
    let criteria = &ranking.preferences().criteria;
    let columns = measured_columns(ranking.preferences());
    let alone = Weights::alone_among(criteria.len()).map(|weights| ranking.winner(weights));
    let winner = ranking.winner(ranking.preferences().weights);
    let best = [Some(winner), passing, ranking.best_unfolded()];
    // Remove duplicates, because a design is often the best by several criteria, and each design is
    // solved several times.
    let mut numbers: Vec<&str> = Vec::new();
    for number in best.iter().flatten().chain(&alone.collect::<Vec<_>>()).map(RankedDesign::design)
    {
        if !numbers.contains(&number) {
            numbers.push(number);
        }
    }
    numbers
        .par_iter()
        .filter_map(|number| GapChange::solve(sweep, number, &columns, Patience::Milliseconds))
        .collect()
}

/// Solves up to three designs again with full substrate coupling.
///
/// The solved designs are the best by the weights, the design `passing` that passes the checks, and
/// the best without a fold. The list is empty if the results have no definition.
pub fn couplings(
    results: &Results,
    ranking: &Ranking<'_>,
    passing: Option<RankedDesign<'_>>,
) -> Vec<CouplingChange> {
    let Some(sweep) = results.definition() else { return Vec::new() };
    let columns = measured_columns(ranking.preferences());
    let winner = ranking.winner(ranking.preferences().weights);
    let mut numbers = vec![winner.design()];
    for design in [passing, ranking.best_unfolded()].iter().flatten() {
        if !numbers.contains(&design.design()) {
            numbers.push(design.design());
        }
    }
    let patience = Patience::Milliseconds;
    numbers.iter().filter_map(|n| CouplingChange::solve(sweep, n, &columns, patience)).collect()
}

/// Formats the changes of a measure for a smaller and a larger gap.
pub fn cell(measure: &MeasureChange) -> String {
    let [smaller, larger] = measure.changed.map(|changed| change_text(measure.value, changed));
    format!("{smaller} / {larger}")
}

/// Formats the change from `value` to `changed` in percent, or a large change as a factor.
pub fn change_text(value: f64, changed: Option<f64>) -> String {
    let Some(changed) = changed else { return "no value".to_owned() };
    let ratio = changed / value;
    match ratio {
        // A smaller change would be printed as 0.0 %.
        _ if (ratio - 1.0).abs() < 5e-4 => "unchanged".to_owned(),
        _ if !ratio.is_finite() => format!("from {value} to {}", crate::print::rounded(changed)),
        _ if ratio >= LARGE => format!("× {ratio:.1}"),
        _ if ratio > 0.0 && ratio <= LARGE.recip() => format!("÷ {:.1}", ratio.recip()),
        _ => crate::print::change(100.0 * (ratio - 1.0), 1),
    }
}

/// Returns a phrase for each requirement that a design misses with a smaller or larger gap.
pub fn missed(change: &GapChange, requirements: &[Requirement]) -> Vec<String> {
    let mut phrases = Vec::new();
    for requirement in requirements {
        let measures = change.measures.iter().filter(|m| m.column == requirement.column);
        for (side, changed) in
            measures.flat_map(|m| ["smaller", "larger"].into_iter().zip(m.changed))
        {
            // A design without a value meets no requirement.
            if changed.is_none_or(|changed| !requirement.is_met(changed)) {
                phrases.push(format!("misses {requirement} if the gap is 10 % {side}"));
            }
        }
    }
    phrases
}
