//! Selects the designs that can be ranked, and counts the excluded designs for each reason.

use std::collections::BTreeMap;
use std::slice::ChunksExact;

use results::columns::name;
use results::round_off::merge_equal;
use results::{InvalidResults, Results};
use text::number::same;

use crate::filter::RequirementFilter;
use crate::fitness::rescaled;
use crate::front::front_of;
use crate::preferences::Preferences;
use crate::weights::MOST_CRITERIA;

/// Designs that can be ranked.
///
/// Only data that every choice of weights needs are stored. Storing all values that can be computed
/// from the rows would take 200 MB for a million designs.
#[derive(Clone, Debug)]
pub(super) struct Contenders {
    /// Rows of the designs in the results.
    pub rows: Vec<usize>,
    /// Indices of the columns of the criteria in the results.
    pub columns: Vec<usize>,
    /// True for designs on the Pareto front.
    pub on_front: Vec<bool>,
    /// Smallest and largest value of each criterion; `None` if both are equal up to round-off.
    pub spans: Vec<Option<Span>>,
    /// Term of each criterion in the score, design after design.
    terms: Vec<f64>,
}

/// Smallest (first) and largest (second) of several numbers.
pub(super) type Span = (f64, f64);

/// Reason to exclude a design. If several reasons apply, the first one counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Exclusion {
    /// The design does not meet a requirement, given by index.
    Unmet(usize),
    /// The coverage is 0, so the design leaves the substrate exposed.
    Exposed,
    /// A criterion, given by index, has no value.
    Missing(usize),
    /// The value for a criterion, given by index, has no inverse or logarithm.
    NotPositive(usize),
}

impl Exclusion {
    /// Returns true if the reason is a requirement.
    pub fn is_unmet(self) -> bool {
        matches!(self, Self::Unmet(_))
    }

    /// Describes the reason, for messages.
    pub fn description(self, preferences: &Preferences) -> String {
        match self {
            Self::Unmet(index) => format!("not {}", preferences.requirements[index]),
            Self::Exposed => "coverage is 0".to_owned(),
            Self::Missing(c) => format!("no {}", preferences.criteria[c].column),
            Self::NotPositive(c) => format!("{} is not above 0", preferences.criteria[c].column),
        }
    }
}

/// Designs that can be ranked, and the number of excluded designs for each reason.
type Selection = (Contenders, BTreeMap<Exclusion, usize>);

/// Selects the designs that can be ranked, and counts the excluded designs.
pub(super) fn select(
    results: &Results,
    preferences: &Preferences,
) -> Result<Selection, InvalidResults> {
    let filter = RequirementFilter::new(results, &preferences.requirements)?;
    let columns = preferences.criteria.iter().map(|criterion| results.column(&criterion.column));
    let columns: Vec<usize> = columns.collect::<Result<_, _>>()?;
    // `excluded` is a tree, so that the order of reasons does not depend on the order of rows.
    let (mut rows, mut values, mut excluded) = (Vec::new(), Vec::new(), BTreeMap::new());
    for row in 0..results.len() {
        let unmet = filter.first_unmet(row)?.map(Exclusion::Unmet);
        let mut found = [None; MOST_CRITERIA];
        if unmet.is_none() {
            for (value, &column) in found.iter_mut().zip(&columns) {
                *value = results.number(row, column)?;
            }
        }
        if let Some(why) = unmet.or_else(|| exclusion(&found, preferences)) {
            *excluded.entry(why).or_insert(0) += 1;
        } else {
            rows.push(row);
            values.extend(found.iter().flatten());
        }
    }
    Ok((Contenders::new(rows, columns, values, preferences), excluded))
}

/// Returns the reason to exclude a design with these `values` of the criteria, if there is one.
fn exclusion(
    values: &[Option<f64>; MOST_CRITERIA],
    preferences: &Preferences,
) -> Option<Exclusion> {
    let criteria = &preferences.criteria;
    // Designs with a coverage of 0 are ranked if coverage is not a criterion.
    let coverage = criteria.iter().position(|criterion| criterion.column == name::COVERAGE);
    if coverage.and_then(|c| values[c]).is_some_and(|coverage| coverage <= 0.0) {
        return Some(Exclusion::Exposed);
    }
    criteria.iter().zip(values).enumerate().find_map(|(c, (criterion, value))| match value {
        None => Some(Exclusion::Missing(c)),
        Some(value) => {
            let exists = preferences.scale.criterion(criterion.goal, *value).is_some();
            (!exists).then_some(Exclusion::NotPositive(c))
        }
    })
}

impl Contenders {
    /// Computes Pareto front, spans and terms of the designs in `rows`.
    ///
    /// `values` contains the values of these designs in `columns`, design after design.
    fn new(
        rows: Vec<usize>,
        columns: Vec<usize>,
        mut values: Vec<f64>,
        preferences: &Preferences,
    ) -> Self {
        let count = columns.len();
        // Test the values for ties, not the criteria: values near 1 that are equal up to round-off
        // have logarithms near 0, which may differ by a large factor.
        let is_tie = spans(&values, count).map(|(low, high)| same(low, high));
        // Merge equal values, so that round-off affects neither dominance nor scores. Otherwise
        // only one of two designs of equal rank might be on the front.
        for (c, of) in preferences.criteria.iter().enumerate() {
            merge_equal(values.iter_mut().skip(c).step_by(count), of.goal);
        }
        // Overwrite the values by criteria to save memory; the table still contains the values.
        for (index, value) in values.iter_mut().enumerate() {
            *value = criterion(preferences, index % count, *value);
        }
        // Dominance needs neither weights nor rescaling of the criteria.
        let on_front = front_of(&values, count);
        let spans = spans(&values, count).into_iter().zip(is_tie).take(count);
        let spans = spans.map(|(span, is_tie)| (!is_tie).then_some(span)).collect();
        let mut contenders = Self { rows, columns, on_front, spans, terms: Vec::new() };
        for (index, value) in values.iter_mut().enumerate() {
            *value = preferences.scale.term(contenders.rescaled(index % count, *value));
        }
        contenders.terms = values;
        contenders
    }

    /// Returns the terms of the score of each design, one per criterion.
    pub fn terms(&self) -> ChunksExact<'_, f64> {
        self.terms.chunks_exact(self.columns.len())
    }

    /// Rescales criterion `c` from 0, the worst, to 1, the best.
    pub fn rescaled(&self, c: usize, criterion: f64) -> f64 {
        // Round-off may put a value slightly outside the span.
        self.spans[c].map_or(1.0, |span| rescaled(criterion, span).clamp(0.0, 1.0))
    }
}

/// Returns criterion `c` for a value of its column (R1).
pub(super) fn criterion(preferences: &Preferences, c: usize, value: f64) -> f64 {
    // The criterion of a ranked design always exists.
    preferences.scale.criterion(preferences.criteria[c].goal, value).unwrap_or(f64::NAN)
}

/// Returns the sum of the rescaled criteria of each design of a front (R9).
///
/// Criteria are rescaled from 0, the worst on the front, to 1, the best.
pub(super) fn sums_of_rescaled(criteria: &[f64], count: usize) -> Vec<f64> {
    // Rescale on the front only: dominated designs must not move the knee.
    let spans = spans(criteria, count);
    criteria
        .chunks_exact(count)
        .map(|criteria| {
            criteria.iter().zip(spans).map(|(value, span)| rescaled(*value, span)).sum::<f64>()
        })
        .collect()
}

/// Returns the smallest and the largest of each of the `count` numbers per design.
fn spans(numbers: &[f64], count: usize) -> [Span; MOST_CRITERIA] {
    let mut spans = [(f64::INFINITY, f64::NEG_INFINITY); MOST_CRITERIA];
    for (index, number) in numbers.iter().enumerate() {
        let (low, high) = &mut spans[index % count];
        (*low, *high) = (low.min(*number), high.max(*number));
    }
    spans
}
