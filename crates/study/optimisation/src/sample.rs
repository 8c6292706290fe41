//! The judgement of samples: how far each is within the bounds, and the statistics over all of them.

use ranking::{Relation, Requirement};
use results::{DesignRow, QUANTILES, quantile_places};
use serde::{Deserialize, Serialize};

use crate::column::NumberColumn;
use crate::requirement_bounds::Bounds;
use crate::statistic::Statistic;

/// What is known of the samples of a design: of each the values in the columns of the bounds, then a value for every statistic, which of
/// a yield does not exist.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Samples(pub Vec<Vec<Option<f64>>>);

/// A statistic as a goal uses it.
pub(crate) struct UsedStatistic {
    pub name: String,
    pub statistic: Statistic,
    /// The column of a quantile.
    pub column: Option<NumberColumn>,
    /// Whether large values are good: a sample without a value counts as the worst.
    pub large: bool,
}

/// Judges the samples of designs.
pub(crate) struct SampleJudge {
    /// The bounds that samples are to keep.
    pub bounds: Bounds,
    pub statistics: Vec<UsedStatistic>,
    /// The number of samples of each design.
    pub count: usize,
}

/// A sample whose place in the order makes a statistic, and the part that it has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OrderStatistic {
    /// Number of the sample, from 1.
    pub sample: u64,
    pub part: f64,
}

impl UsedStatistic {
    pub fn is_yield(&self) -> bool {
        self.statistic == Statistic::Yield
    }

    /// The name and the share of the quantile that keeps as many surfaces open as the quantiles among `others` count on; `None` if there
    /// are none.
    pub fn of_soundness(column: &str, others: &[Self]) -> Option<(String, Statistic)> {
        let share = |used: &Self| match used.statistic {
            Statistic::Quantile { share, .. } => Some(share.min(1.0 - share)),
            Statistic::Yield => None,
        };
        // By the quantile farthest out: who counts on the worst 5 % wants their surfaces open, too.
        let least = others.iter().filter_map(share).reduce(f64::min)?;
        let (ending, share) = QUANTILES.into_iter().find(|(_, share)| *share >= least - 1e-9)?;
        let statistic = Statistic::Quantile { column: column.to_owned(), share };
        Some((format!("{column}_{ending}"), statistic))
    }
}

impl SampleJudge {
    /// The values of a sample; none if its surface folded and is open again.
    pub fn values(&self, row: &DesignRow) -> Vec<Option<f64>> {
        if self.bounds.has_reopened(row) {
            return self.no_values();
        }
        let of = |used: &UsedStatistic| used.column.as_ref().and_then(|column| column.value(row));
        self.bounds.values(row).chain(self.statistics.iter().map(of)).collect()
    }

    /// The values of a sample that cannot be made.
    pub fn no_values(&self) -> Vec<Option<f64>> {
        vec![None; self.bounds.all.len() + self.statistics.len()]
    }

    /// Whether a nominal design keeps the bounds of its samples, and is worth sampling.
    pub fn admits(&self, row: &DesignRow) -> bool {
        row.result.failures.is_empty() && self.margin(&self.values(row)) >= 0.0
    }

    /// How far a sample is within its bounds: below 0 if it keeps one not.
    fn margin(&self, values: &[Option<f64>]) -> f64 {
        self.bounds.margin(values.iter().copied())
    }

    /// The number that a sample is put in order by for statistic `q`: its value, or its margin.
    fn key(&self, q: usize, values: &[Option<f64>]) -> f64 {
        let used = &self.statistics[q];
        // A sample without a value stands where it harms most: it may not make a quantile better than it is.
        let worst = if used.large { f64::NEG_INFINITY } else { f64::INFINITY };
        let value = || values[self.bounds.all.len() + q].unwrap_or(worst);
        if used.is_yield() { self.margin(values) } else { value() }
    }

    /// The numbers of the samples for statistic `q`.
    pub fn keys(&self, q: usize, samples: &Samples) -> Vec<f64> {
        samples.0.iter().map(|values| self.key(q, values)).collect()
    }

    /// Those numbers in their order, each with the index of its sample.
    fn sorted(&self, q: usize, samples: &Samples) -> Vec<(f64, usize)> {
        let mut sorted: Vec<(f64, usize)> = self.keys(q, samples).into_iter().zip(0..).collect();
        sorted.sort_by(|one, other| one.0.total_cmp(&other.0));
        sorted
    }

    /// The value of statistic `q`; `None` if it falls on a sample without one.
    pub fn value(&self, q: usize, samples: &Samples) -> Option<f64> {
        let sorted: Vec<f64> = self.sorted(q, samples).into_iter().map(|(key, _)| key).collect();
        match self.statistics[q].statistic {
            Statistic::Yield => Some(met(&sorted) as f64 / sorted.len() as f64),
            Statistic::Quantile { share, .. } => results::quantile(&sorted, share),
        }
    }

    /// The value of statistic `q` as designs are compared by it: of a yield with a part of a step more, the nearer the best of the
    /// samples that fall short is to its bounds (O7), or, where none falls short, the farther the worst is within.
    pub fn compared(&self, q: usize, samples: &Samples) -> Option<f64> {
        if !self.statistics[q].is_yield() {
            return self.value(q, samples);
        }
        let sorted: Vec<f64> = self.sorted(q, samples).into_iter().map(|(key, _)| key).collect();
        let met = met(&sorted);
        // Less than a step in both cases, so that a yield of one sample more is always the better.
        let part = match (sorted.len() - met).checked_sub(1) {
            Some(next) => 1.0 / (1.0 - sorted[next]),
            None => 1.0 - 1.0 / (1.0 + sorted[0]),
        };
        Some((met as f64 + part) / sorted.len() as f64)
    }

    /// How far statistic `q` is within a requirement, relative to the limits; of a yield by the sample that is to meet (O6).
    pub fn requirement_margin(
        &self,
        q: usize,
        requirement: &Requirement,
        samples: &Samples,
    ) -> Option<f64> {
        if !self.statistics[q].is_yield() {
            return Some(requirement.margin(self.value(q, samples)?));
        }
        let sorted = self.sorted(q, samples);
        Some(sorted[needed(requirement, sorted.len())].0)
    }

    /// The samples that make statistic `q`, of a requirement that of a yield; none of a yield as an objective, which is a staircase.
    pub fn order_statistics(
        &self,
        q: usize,
        requirement: Option<&Requirement>,
        samples: &Samples,
    ) -> Vec<OrderStatistic> {
        let sorted = self.sorted(q, samples);
        let at = |place: usize, part| OrderStatistic { sample: sorted[place].1 as u64 + 1, part };
        match (&self.statistics[q].statistic, requirement) {
            (Statistic::Yield, None) => Vec::new(),
            (Statistic::Yield, Some(requirement)) => {
                vec![at(needed(requirement, sorted.len()), 1.0)]
            }
            (Statistic::Quantile { share, .. }, _) => {
                let places = quantile_places(sorted.len(), *share);
                let both =
                    places.map(|([below, above], part)| [at(below, 1.0 - part), at(above, part)]);
                both.into_iter().flatten().filter(|of| of.part > 0.0).collect()
            }
        }
    }

    /// The column whose derivatives on a sample are those of statistic `q`, with the factor that makes them so.
    pub fn moving(&self, q: usize, values: &[Option<f64>]) -> Option<(&NumberColumn, f64)> {
        if let Some(column) = &self.statistics[q].column {
            return Some((column, 1.0));
        }
        let (bound, _) = self.bounds.tightest(values.iter().copied())?;
        Some((&bound.column, bound.requirement.margin_rate()))
    }
}

/// How many of these margins are not below 0.
fn met(margins: &[f64]) -> usize {
    margins.iter().filter(|margin| **margin >= 0.0).count()
}

/// The place, among `count` samples in the order of their margins, of the worst that has to meet for a yield to be as required.
fn needed(requirement: &Requirement, count: usize) -> usize {
    let wanted = requirement.limit * count as f64;
    // The product of a share and a count is a whole number but for round-off where it is meant to be one.
    let needed = match requirement.relation {
        Relation::Above => (wanted + 1e-9).floor() + 1.0,
        _ => (wanted - 1e-9).ceil(),
    };
    count - (needed as usize).clamp(1, count)
}
