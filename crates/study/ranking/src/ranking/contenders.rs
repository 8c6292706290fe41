//! The designs that can be ranked, and why the others cannot.

use std::collections::BTreeMap;

use results::columns::name;
use results::round_off::{merge_equal, same};
use results::{InvalidResults, Results};

use crate::filter::RequirementFilter;
use crate::fitness::rescaled;
use crate::front::front_of;
use crate::preferences::Preferences;
use crate::weights::MOST_CRITERIA;

/// The designs that can be ranked. Of each is kept what every choice of weights needs: all that can be made from its row again
/// would take 200 MB of a million designs.
#[derive(Clone, Debug)]
pub(super) struct Contenders {
    /// The rows of the designs in the results.
    pub rows: Vec<usize>,
    /// The columns of the criteria in the results.
    pub columns: Vec<usize>,
    /// Whether no other design beats it in every criterion.
    pub on_front: Vec<bool>,
    /// The lowest and the highest of each criterion; `None` where nothing but round-off tells designs apart.
    pub spans: Vec<Option<Span>>,
    /// The part that each criterion adds to the score, design after design.
    terms: Vec<f64>,
}

/// The lowest and the highest of some numbers.
pub(super) type Span = (f64, f64);

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

/// The designs that can be ranked, and why the others cannot.
type SortedOut = (Contenders, BTreeMap<LeftOut, usize>);

/// Sorts out the rows that can be ranked, and compares them.
pub(super) fn sort_out(
    results: &Results,
    preferences: &Preferences,
) -> Result<SortedOut, InvalidResults> {
    let filter = RequirementFilter::new(results, &preferences.requirements)?;
    let columns = preferences.criteria.iter().map(|criterion| results.column(&criterion.column));
    let columns: Vec<usize> = columns.collect::<Result<_, _>>()?;
    // A tree, so that reasons are told in one order, whichever row is met first.
    let (mut rows, mut values, mut left_out) = (Vec::new(), Vec::new(), BTreeMap::new());
    for row in 0..results.len() {
        let unmet = filter.first_unmet(row)?.map(LeftOut::Unmet);
        let mut found = [None; MOST_CRITERIA];
        if unmet.is_none() {
            for (value, &column) in found.iter_mut().zip(&columns) {
                *value = results.number(row, column)?;
            }
        }
        if let Some(why) = unmet.or_else(|| obstacle(&found, preferences)) {
            *left_out.entry(why).or_insert(0) += 1;
        } else {
            rows.push(row);
            values.extend(found.iter().flatten());
        }
    }
    Ok((Contenders::new(rows, columns, values, preferences), left_out))
}

/// The reason why a design with these values cannot be ranked, if there is one.
fn obstacle(values: &[Option<f64>; MOST_CRITERIA], preferences: &Preferences) -> Option<LeftOut> {
    let criteria = &preferences.criteria;
    // Where coverage is no criterion, exposed designs are ranked like any other.
    let coverage = criteria.iter().position(|criterion| criterion.column == name::COVERAGE);
    if coverage.and_then(|c| values[c]).is_some_and(|coverage| coverage <= 0.0) {
        return Some(LeftOut::Exposed);
    }
    criteria.iter().zip(values).enumerate().find_map(|(c, (criterion, value))| match value {
        None => Some(LeftOut::Missing(c)),
        Some(value) => {
            let is_made = preferences.scale.criterion(criterion.goal, *value).is_some();
            (!is_made).then_some(LeftOut::NotPositive(c))
        }
    })
}

impl Contenders {
    /// The designs in `rows` with their `values` in `columns`, design after design.
    fn new(
        rows: Vec<usize>,
        columns: Vec<usize>,
        mut values: Vec<f64>,
        preferences: &Preferences,
    ) -> Self {
        let count = columns.len();
        // Values tell whether anything but round-off tells designs apart: a logarithm may be near 0.
        let is_tie = spans(&values, count).map(|(low, high)| same(low, high));
        // Digits of round-off must not decide on dominance.
        let mut merged = values.clone();
        for (c, of) in preferences.criteria.iter().enumerate() {
            merge_equal(merged.iter_mut().skip(c).step_by(count), of.goal);
        }
        for (place, value) in merged.iter_mut().enumerate() {
            *value = criterion(preferences, place % count, *value);
        }
        // Of criteria as they are: who beats whom needs neither weights nor rescaling.
        let on_front = front_of(&merged, count);
        drop(merged);
        // Criteria, and then terms, take the places of the values, which the table has.
        for (place, value) in values.iter_mut().enumerate() {
            *value = criterion(preferences, place % count, *value);
        }
        let spans = spans(&values, count).into_iter().zip(is_tie).take(count);
        let spans = spans.map(|(span, is_tie)| (!is_tie).then_some(span)).collect();
        let mut contenders = Self { rows, columns, on_front, spans, terms: Vec::new() };
        for (place, value) in values.iter_mut().enumerate() {
            *value = preferences.scale.term(contenders.rescaled(place % count, *value));
        }
        contenders.terms = values;
        contenders
    }

    /// The parts that the criteria of each design add to its score.
    pub fn terms(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.terms.chunks_exact(self.columns.len())
    }

    /// A criterion, named by its place, from 0, the worst, to 1, the best.
    pub fn rescaled(&self, c: usize, criterion: f64) -> f64 {
        self.spans[c].map_or(1.0, |span| rescaled(criterion, span))
    }
}

/// The criterion, named by its place, that a value makes (R1).
pub(super) fn criterion(preferences: &Preferences, c: usize, value: f64) -> f64 {
    // Designs without one are not ranked.
    preferences.scale.criterion(preferences.criteria[c].goal, value).unwrap_or(f64::NAN)
}

/// The sum of the criteria of each design of a front, each from 0, the worst of the front, to 1, the best (R9).
pub(super) fn sums_of_rescaled(criteria: &[f64], count: usize) -> Vec<f64> {
    // Over the front alone: a design that is beaten would move the knee.
    let spans = spans(criteria, count);
    let sum = |criteria: &[f64]| {
        criteria.iter().zip(spans).map(|(value, span)| rescaled(*value, span)).sum::<f64>()
    };
    criteria.chunks_exact(count).map(sum).collect()
}

/// The lowest and the highest of each of `count` numbers, one design after the other.
fn spans(numbers: &[f64], count: usize) -> [Span; MOST_CRITERIA] {
    let mut spans = [(f64::INFINITY, f64::NEG_INFINITY); MOST_CRITERIA];
    for (place, number) in numbers.iter().enumerate() {
        let (low, high) = &mut spans[place % count];
        (*low, *high) = (low.min(*number), high.max(*number));
    }
    spans
}
