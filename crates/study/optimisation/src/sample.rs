//! Judges samples: computes their margins to requirements, and statistics over samples.

use ranking::{Relation, Requirement};
use results::{DesignRow, QUANTILES, quantile_positions};
use serde::{Deserialize, Serialize};

use crate::column::NumberColumn;
use crate::requirement_bounds::{Bound, Bounds};
use crate::statistic::Statistic;

/// Values of the samples of a design, a list for each sample.
///
/// A list contains a value for each requirement on a column, then a value for each statistic. The
/// value of a quantile is the value of its column, and the value of a yield is `None`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Samples(pub Vec<Vec<Option<f64>>>);

/// A statistic over samples that a goal uses.
pub(crate) struct UsedStatistic {
    /// Name in the goal, e.g. `critical_force_p05`.
    pub name: String,
    pub statistic: Statistic,
    /// Column of a quantile; `None` for a yield.
    pub column: Option<NumberColumn>,
    /// True if large values are better. A sample without a value counts as the worst.
    pub large: bool,
}

/// Judges the samples of designs.
pub(crate) struct SampleJudge {
    /// Requirements on columns, which apply to each sample.
    pub bounds: Bounds,
    /// Statistics that the goal uses, and the yield if columns have requirements.
    pub statistics: Vec<UsedStatistic>,
    /// Number of samples of each design.
    pub count: usize,
}

/// Fraction of the samples of a design that miss a requirement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MissedRequirement {
    /// Missed requirement; `None` for samples without values.
    pub requirement: Option<Requirement>,
    /// Fraction of the samples that miss the requirement, from 0 to 1.
    pub share: f64,
}

/// A sample that contributes to a statistic, with its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OrderStatistic {
    /// Number of the sample, from 1.
    pub sample: u64,
    /// Weight of the value of the sample, at most 1.
    pub part: f64,
}

impl UsedStatistic {
    /// Returns true if the statistic is a yield.
    pub fn is_yield(&self) -> bool {
        self.statistic == Statistic::Yield
    }

    /// Returns name and definition of the quantile for the requirement of an unfolded surface.
    ///
    /// `column` is the column of this requirement. The quantile is as far from the median as the
    /// outermost quantile among the statistics `others`. `None` if these contain no quantile.
    pub fn of_soundness(column: &str, others: &[Self]) -> Option<(String, Statistic)> {
        let shares = others.iter().filter_map(|used| match used.statistic {
            Statistic::Quantile { share, .. } => Some(share.min(1.0 - share)),
            Statistic::Yield => None,
        });
        // For example, a goal with a 5 % quantile requires that at most 5 % of the samples fold.
        let least = shares.reduce(f64::min)?;
        let (ending, share) = QUANTILES.into_iter().find(|(_, share)| *share >= least - 1e-9)?;
        let statistic = Statistic::Quantile { column: column.to_owned(), share };
        Some((format!("{column}_{ending}"), statistic))
    }
}

impl SampleJudge {
    /// Returns the values of a sample in the order of [`Samples`].
    ///
    /// All values are `None` if the surface folded along the path but is unfolded again at the end.
    pub fn values(&self, row: &DesignRow) -> Vec<Option<f64>> {
        if self.bounds.has_reopened(row) {
            return self.no_values();
        }
        self.bounds
            .values(row)
            .chain(
                self.statistics
                    .iter()
                    .map(|used| used.column.as_ref().and_then(|column| column.value(row))),
            )
            .collect()
    }

    /// Returns the values of a sample that does not exist: all are `None`.
    pub fn no_values(&self) -> Vec<Option<f64>> {
        vec![None; self.bounds.all.len() + self.statistics.len()]
    }

    /// Returns true if a nominal design itself meets the requirements that apply to each sample.
    ///
    /// Only such designs are sampled.
    pub fn admits(&self, row: &DesignRow) -> bool {
        row.result.failures.is_empty() && self.margin(&self.values(row)) >= 0.0
    }

    /// Returns the smallest margin of a sample; negative if the sample misses a requirement.
    fn margin(&self, values: &[Option<f64>]) -> f64 {
        self.bounds.margin(values.iter().copied())
    }

    /// Returns the requirements that samples miss, the largest fraction of samples first.
    pub fn missed(&self, samples: &Samples) -> Vec<MissedRequirement> {
        let bounds = &self.bounds.all;
        let mut valid: Vec<&Vec<Option<f64>>> = samples.0.iter().collect();
        // Count samples without values only once, not for each requirement.
        valid.retain(|v| bounds.is_empty() || v[..bounds.len()].iter().any(Option::is_some));
        let mut counts = vec![(None, samples.0.len() - valid.len())];
        for (k, Bound { requirement, .. }) in bounds.iter().enumerate() {
            let missed = valid.iter().filter(|v| !v[k].is_some_and(|v| requirement.is_met(v)));
            counts.push((Some(requirement.clone()), missed.count()));
        }
        counts.retain(|(_, count)| *count > 0);
        // The sort is stable: requirements with equal counts keep the order of the goal.
        counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        let missed = counts.into_iter().map(|(requirement, count)| MissedRequirement {
            requirement,
            share: count as f64 / samples.0.len() as f64,
        });
        missed.collect()
    }

    /// Returns the number by which samples are sorted for statistic `q`.
    ///
    /// For a quantile this is the value of its column, for a yield the smallest margin.
    fn key(&self, q: usize, values: &[Option<f64>]) -> f64 {
        let used = &self.statistics[q];
        if used.is_yield() {
            return self.margin(values);
        }
        // A sample without a value counts as the worst sample, so it cannot improve a quantile.
        let worst = if used.large { f64::NEG_INFINITY } else { f64::INFINITY };
        values[self.bounds.all.len() + q].unwrap_or(worst)
    }

    /// Returns the sort key of each sample for statistic `q`.
    pub fn keys(&self, q: usize, samples: &Samples) -> Vec<f64> {
        samples.0.iter().map(|values| self.key(q, values)).collect()
    }

    /// Returns the sort keys for statistic `q` in ascending order, with the indices of the samples.
    fn sorted(&self, q: usize, samples: &Samples) -> Vec<(f64, usize)> {
        let mut sorted: Vec<(f64, usize)> = self.keys(q, samples).into_iter().zip(0..).collect();
        sorted.sort_by(|one, other| one.0.total_cmp(&other.0));
        sorted
    }

    /// Returns the value of statistic `q`; `None` if a quantile is at a sample without a value.
    pub fn value(&self, q: usize, samples: &Samples) -> Option<f64> {
        let sorted: Vec<f64> = self.sorted(q, samples).into_iter().map(|(key, _)| key).collect();
        match self.statistics[q].statistic {
            Statistic::Yield => Some(met(&sorted) as f64 / sorted.len() as f64),
            Statistic::Quantile { share, .. } => results::quantile(&sorted, share),
        }
    }

    /// Returns the value of statistic `q` by which designs are compared.
    ///
    /// For a yield, a part of a step is added (O7), so that designs with equal yields differ. The
    /// part is larger if the best of the samples that miss a requirement has a smaller shortfall.
    /// If no sample misses a requirement, the part increases with the margin of the worst sample.
    pub fn compared(&self, q: usize, samples: &Samples) -> Option<f64> {
        if !self.statistics[q].is_yield() {
            return self.value(q, samples);
        }
        let sorted: Vec<f64> = self.sorted(q, samples).into_iter().map(|(key, _)| key).collect();
        let met = met(&sorted);
        // The part is less than one step, so a design with one more valid sample is always better.
        let part = match (sorted.len() - met).checked_sub(1) {
            Some(next) => 1.0 / (1.0 - sorted[next]),
            None => 1.0 - 1.0 / (1.0 + sorted[0]),
        };
        Some((met as f64 + part) / sorted.len() as f64)
    }

    /// Returns the margin of statistic `q` to `requirement`, relative to the limit.
    ///
    /// For a yield this is the margin of the sample that decides whether the yield is met (O6).
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
        Some(sorted[deciding_index(requirement, sorted.len())].0)
    }

    /// Returns the numbers of the samples around the sample that decides a required yield.
    ///
    /// Samples are sorted by margin. The result contains up to `spread` samples on each side.
    pub fn near_deciding(
        &self,
        q: usize,
        requirement: &Requirement,
        samples: &Samples,
        spread: usize,
    ) -> Vec<u64> {
        let sorted = self.sorted(q, samples);
        let deciding = deciding_index(requirement, sorted.len());
        let last = (deciding + spread + 1).min(sorted.len());
        let near = &sorted[deciding.saturating_sub(spread)..last];
        near.iter().map(|(_, index)| *index as u64 + 1).collect()
    }

    /// Returns the samples that determine statistic `q`, with their weights.
    ///
    /// `requirement` is the requirement on the statistic; `None` for an objective. The result is
    /// empty for a yield as objective, which is a step function.
    pub fn order_statistics(
        &self,
        q: usize,
        requirement: Option<&Requirement>,
        samples: &Samples,
    ) -> Vec<OrderStatistic> {
        let sorted = self.sorted(q, samples);
        let parts = match (&self.statistics[q].statistic, requirement) {
            (Statistic::Yield, None) => Vec::new(),
            (Statistic::Yield, Some(requirement)) => {
                vec![(deciding_index(requirement, sorted.len()), 1.0)]
            }
            (Statistic::Quantile { share, .. }, _) => {
                let positions = quantile_positions(sorted.len(), *share);
                let both =
                    positions.map(|([below, above], part)| [(below, 1.0 - part), (above, part)]);
                both.into_iter().flatten().filter(|(_, part)| *part > 0.0).collect()
            }
        };
        parts
            .into_iter()
            .map(|(place, part)| OrderStatistic { sample: sorted[place].1 as u64 + 1, part })
            .collect()
    }

    /// Returns the column that determines the derivatives of statistic `q` on a sample.
    ///
    /// Derivatives of the column are to be multiplied by the returned factor. For a yield, this is
    /// the column of the requirement with the smallest margin. `values` are the values of the
    /// sample.
    pub fn moving(&self, q: usize, values: &[Option<f64>]) -> Option<(&NumberColumn, f64)> {
        if let Some(column) = &self.statistics[q].column {
            return Some((column, 1.0));
        }
        let (bound, _) = self.bounds.tightest(values.iter().copied())?;
        Some((&bound.column, bound.requirement.margin_rate()))
    }
}

/// Counts the non-negative margins.
fn met(margins: &[f64]) -> usize {
    margins.iter().filter(|margin| **margin >= 0.0).count()
}

/// Returns the index of the sample that decides whether a required yield is met (O6).
///
/// `requirement` is the requirement on the yield. The `count` samples are sorted by margin, so the
/// index is also the number of samples that may miss a requirement.
pub(crate) fn deciding_index(requirement: &Requirement, count: usize) -> usize {
    let wanted = requirement.limit * count as f64;
    // The product may differ from an integer by round-off.
    let needed = match requirement.relation {
        Relation::Above => (wanted + 1e-9).floor() + 1.0,
        _ => (wanted - 1e-9).ceil(),
    };
    count - (needed as usize).clamp(1, count)
}
