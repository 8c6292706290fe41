//! Sensitivity of the best designs to their gaps, as text.

use ranking::{Preferences, RankedDesign, Ranking, Requirement, Weights};
use rayon::prelude::*;
use results::Results;
use results::columns::measures_among;
use run::{CouplingChange, GapChange, MeasureChange, Patience};

use crate::print::aligned;

/// Changes by this factor or its inverse are printed as factors.
const LARGE: f64 = 2.0;

/// Solves the best designs with other gaps: by weights, without a fold, by each criterion.
///
/// Returns nothing if the results have no definition.
pub fn gap_changes(results: &Results, ranking: &Ranking<'_>) -> Vec<GapChange> {
    let Some(sweep) = results.definition() else { return Vec::new() };
    let criteria = &ranking.preferences().criteria;
    let columns = measured_columns(ranking.preferences());
    let alone = Weights::alone_among(criteria.len()).map(|weights| ranking.winner(weights));
    let best = [Some(ranking.winner(ranking.preferences().weights)), ranking.best_unfolded()];
    // Remove duplicates: one design is often the best by several criteria, and each is solved three
    // times.
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

/// Solves the best design, and the best without a fold, with full substrate coupling.
pub fn couplings(results: &Results, ranking: &Ranking<'_>) -> Vec<CouplingChange> {
    let Some(sweep) = results.definition() else { return Vec::new() };
    let columns = measured_columns(ranking.preferences());
    let best = [Some(ranking.winner(ranking.preferences().weights)), ranking.best_unfolded()];
    best.iter()
        .flatten()
        .filter_map(|d| CouplingChange::solve(sweep, d.design(), &columns, Patience::Milliseconds))
        .collect()
}

/// Returns the measured columns among the criteria and requirements.
pub fn measured_columns(preferences: &Preferences) -> Vec<&str> {
    let criteria = preferences.criteria.iter().map(|criterion| criterion.column.as_ref());
    measures_among(criteria.chain(preferences.requirements.iter().map(|r| r.column.as_str())))
}

/// Formats a table of the changes, the large changes, and the missed requirements.
pub fn gap_changes_report(changes: &[GapChange], requirements: &[Requirement]) -> String {
    let mut columns: Vec<&str> = Vec::new();
    for measure in changes.iter().flat_map(|change| &change.measures) {
        if !columns.contains(&measure.column.as_str()) {
            columns.push(&measure.column);
        }
    }
    if columns.is_empty() {
        return String::new();
    }
    let header = ["design", "gap_over_t"].iter().chain(&columns).map(ToString::to_string).collect();
    let row = |change: &GapChange| {
        // A design may lack a measure that others have.
        let measure = |column: &&str| change.measures.iter().find(|m| m.column == **column);
        let cells = columns.iter().map(|column| measure(column).map_or_else(String::new, cell));
        [change.design.clone(), change.gap.to_string()].into_iter().chain(cells).collect()
    };
    let rows: Vec<Vec<String>> = std::iter::once(header).chain(changes.iter().map(row)).collect();
    let cliffs: String = changes.iter().flat_map(cliffs).collect();
    let missed: String = changes.iter().flat_map(|change| missed(change, requirements)).collect();
    let title = "Change if the gap is 10 % smaller / 10 % larger";
    format!("\n{title}\n{}{cliffs}{missed}", aligned(&rows))
}

/// Formats both changes of a measure.
fn cell(measure: &MeasureChange) -> String {
    let [smaller, larger] = measure.changed.map(|changed| words(measure.value, changed));
    format!("{smaller} / {larger}")
}

/// Formats a change in percent, or as a factor if it is large.
fn words(value: f64, changed: Option<f64>) -> String {
    let Some(changed) = changed else { return "no value".to_owned() };
    let ratio = changed / value;
    match ratio {
        // Half of the last displayed digit.
        _ if (ratio - 1.0).abs() < 5e-4 => "unchanged".to_owned(),
        _ if !ratio.is_finite() => format!("from {value} to {}", crate::print::rounded(changed)),
        _ if ratio >= LARGE => format!("× {ratio:.1}"),
        _ if ratio > 0.0 && ratio <= LARGE.recip() => format!("÷ {:.1}", ratio.recip()),
        _ => crate::print::change(100.0 * (ratio - 1.0), 1),
    }
}

/// Returns a sentence for each measure that is sensitive to the gap.
fn cliffs(change: &GapChange) -> Vec<String> {
    let sentence = |measure: &MeasureChange, side: usize| {
        let moved = moved(measure.changed[side]? / measure.value);
        let (design, column) = (&change.design, &measure.column);
        let side = ["smaller", "larger"][side];
        Some(format!("  {design} is sensitive to its gap: 10 % {side}, and {column} {moved}\n"))
    };
    let sides = |measure: &MeasureChange| {
        let cliffs = measure.cliffs();
        let sides = (0..2).filter(move |&side| cliffs[side]);
        sides.filter_map(|side| sentence(measure, side)).collect::<Vec<_>>()
    };
    change.measures.iter().flat_map(sides).collect()
}

/// Returns a sentence for each requirement that a design misses with another gap.
fn missed(change: &GapChange, requirements: &[Requirement]) -> Vec<String> {
    let sentence = |requirement: &Requirement, side: &str, changed: Option<f64>| {
        // A design without a value meets no bound.
        let is_missed = changed.is_none_or(|changed| !requirement.is_met(changed));
        is_missed.then(|| {
            format!("  {} misses {requirement} if its gap is 10 % {side}\n", change.design)
        })
    };
    let both = |requirement: &Requirement| {
        let measure = change.measures.iter().find(|measure| measure.column == requirement.column);
        let [smaller, larger] = measure?.changed;
        Some([sentence(requirement, "smaller", smaller), sentence(requirement, "larger", larger)])
    };
    requirements.iter().filter_map(both).flatten().flatten().collect()
}

/// Describes the change of a measure by a factor.
fn moved(ratio: f64) -> String {
    match ratio {
        _ if ratio >= LARGE => format!("is {ratio:.1} times as large"),
        _ if ratio >= 1.0 => format!("rises by {:.0} %", 100.0 * (ratio - 1.0)),
        _ if ratio > LARGE.recip() => format!("falls by {:.0} %", 100.0 * (1.0 - ratio)),
        _ => format!("falls by a factor of {:.1}", ratio.recip()),
    }
}
