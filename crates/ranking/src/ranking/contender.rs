//! The designs that can be ranked, and why the others cannot.

use std::collections::BTreeMap;

use results::columns::name;
use results::round_off::same;
use results::{InvalidResults, Results};

use crate::filter::RequirementFilter;
use crate::fitness::rescaled;
use crate::front::front_of;
use crate::preferences::Preferences;
use crate::weights::{Criteria, MOST_CRITERIA};

/// A design that can be ranked.
#[derive(Clone, Debug)]
pub(crate) struct Contender {
    /// The row of the design in the results.
    pub row: usize,
    /// The values that the criteria are made from.
    pub values: Criteria,
    /// The criteria, larger being better (R1).
    pub criteria: Criteria,
    /// The criteria from 0, the worst, to 1, the best.
    pub rescaled: Criteria,
    /// The part that each criterion adds to the score.
    pub terms: Criteria,
    /// Whether no other design beats it in every criterion.
    pub on_front: bool,
    /// Nodes of the grid of weights at which it is the best, and their part of the tetrahedron.
    pub nodes: u64,
    pub won: u64,
}

/// The reason why a design is not ranked: the first of these that holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum LeftOut {
    /// The design does not meet a requirement, named by its place.
    Unmet(usize),
    /// The design leaves the substrate exposed.
    Exposed,
    /// A criterion, named by its place, has no value.
    Missing(usize),
    /// A criterion that is an inverse or a logarithm cannot be formed.
    NotPositive(usize),
}

impl LeftOut {
    /// Whether a requirement is the reason.
    pub fn is_unmet(self) -> bool {
        matches!(self, Self::Unmet(_))
    }

    /// The reason in words.
    pub fn in_words(self, preferences: &Preferences) -> String {
        let column = |c: usize| &preferences.criteria[c].column;
        match self {
            Self::Unmet(place) => format!("not {}", preferences.requirements[place]),
            Self::Exposed => "coverage is 0".to_owned(),
            Self::Missing(c) => format!("no {}", column(c)),
            Self::NotPositive(c) => format!("{} is not above 0", column(c)),
        }
    }
}

/// A row that can be ranked: its values, and the criteria that they make.
pub(super) struct Eligible {
    row: usize,
    values: Criteria,
    criteria: Criteria,
}

/// The rows that can be ranked, and why the others cannot.
type SortedOut = (Vec<Eligible>, BTreeMap<LeftOut, usize>);

/// Sorts out the rows that can be ranked.
pub(super) fn sort_out(
    results: &Results,
    preferences: &Preferences,
) -> Result<SortedOut, InvalidResults> {
    let filter = RequirementFilter::new(results, &preferences.requirements)?;
    let columns = preferences.criteria.iter().map(|criterion| results.column(&criterion.column));
    let columns: Vec<usize> = columns.collect::<Result<_, _>>()?;
    // A tree, so that reasons are told in one order, whichever row is met first.
    let (mut rows, mut left_out) = (Vec::new(), BTreeMap::new());
    for row in 0..results.len() {
        let found = match filter.first_unmet(row)? {
            Some(place) => Err(LeftOut::Unmet(place)),
            None => eligible(row, &values(results, row, &columns)?, preferences),
        };
        match found {
            Ok(eligible) => rows.push(eligible),
            Err(why) => *left_out.entry(why).or_insert(0) += 1,
        }
    }
    Ok((rows, left_out))
}

/// The values of a row in the columns of the criteria.
fn values(
    results: &Results,
    row: usize,
    columns: &[usize],
) -> Result<[Option<f64>; MOST_CRITERIA], InvalidResults> {
    let mut values = [None; MOST_CRITERIA];
    for (value, &column) in values.iter_mut().zip(columns) {
        *value = results.number(row, column)?;
    }
    Ok(values)
}

/// A row that has every value, with its criteria (R1).
fn eligible(
    row: usize,
    found: &[Option<f64>; MOST_CRITERIA],
    preferences: &Preferences,
) -> Result<Eligible, LeftOut> {
    let criteria = &preferences.criteria;
    // Where coverage is no criterion, exposed designs are ranked like any other.
    let coverage = criteria.iter().position(|criterion| criterion.column == name::COVERAGE);
    if coverage.and_then(|c| found[c]).is_some_and(|coverage| coverage <= 0.0) {
        return Err(LeftOut::Exposed);
    }
    let mut eligible =
        Eligible { row, values: [0.0; MOST_CRITERIA], criteria: [0.0; MOST_CRITERIA] };
    for (c, criterion) in criteria.iter().enumerate() {
        let value = found[c].ok_or(LeftOut::Missing(c))?;
        let made = preferences.scale.criterion(criterion.goal, value);
        eligible.values[c] = value;
        eligible.criteria[c] = made.ok_or(LeftOut::NotPositive(c))?;
    }
    Ok(eligible)
}

/// The rows that can be ranked, rescaled against each other.
pub(super) fn contenders(rows: &[Eligible], preferences: &Preferences) -> Vec<Contender> {
    let count = preferences.criteria.len();
    let criteria: Vec<Criteria> = rows.iter().map(|eligible| eligible.criteria).collect();
    // Of criteria as they are: who beats whom needs neither weights nor rescaling.
    let front = front_of(&criteria, count);
    let criteria_spans = spans(criteria.iter());
    // Contenders hold these numbers once more: of a million designs they are 64 MB.
    drop(criteria);
    // Values tell whether anything but round-off tells designs apart: a logarithm may be near 0.
    let is_tie =
        spans(rows.iter().map(|eligible| &eligible.values)).map(|(low, high)| same(low, high));
    let contender = |(eligible, on_front): (&Eligible, bool)| {
        let &Eligible { row, values, criteria } = eligible;
        let one = |c: usize| if is_tie[c] { 1.0 } else { rescaled(criteria[c], criteria_spans[c]) };
        let rescaled: Criteria = std::array::from_fn(one);
        let terms = rescaled.map(|rescaled| preferences.scale.term(rescaled));
        Contender { row, values, criteria, rescaled, terms, on_front, nodes: 0, won: 0 }
    };
    rows.iter().zip(front).map(contender).collect()
}

/// The sum of the criteria of each design of a front, each from 0, the worst of the front, to 1, the best (R9).
pub(super) fn sums_of_rescaled(front: &[&Contender]) -> Vec<f64> {
    let criteria: Vec<Criteria> = front.iter().map(|contender| contender.criteria).collect();
    // Over the front alone: a design that is beaten would move the knee.
    let spans = spans(criteria.iter());
    let sum = |criteria: &Criteria| {
        criteria.iter().zip(spans).map(|(value, span)| rescaled(*value, span)).sum::<f64>()
    };
    criteria.iter().map(sum).collect()
}

/// The lowest and the highest of each criterion.
fn spans<'c>(criteria: impl Iterator<Item = &'c Criteria>) -> [(f64, f64); MOST_CRITERIA] {
    let mut spans = [(f64::INFINITY, f64::NEG_INFINITY); MOST_CRITERIA];
    for values in criteria {
        for ((low, high), value) in spans.iter_mut().zip(values) {
            (*low, *high) = (low.min(*value), high.max(*value));
        }
    }
    spans
}
