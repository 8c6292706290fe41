//! Checks the best designs of a search with independent samples.

use ranking::Requirement;
use serde::Serialize;
use uncertainty::{Proportion, SampledQuantile};

use crate::evaluated_row::StatisticUse;
use crate::evaluations::Halt;
use crate::local::Search;
use crate::sample::{MissedRequirement, SampleJudge, Samples};
use crate::space::SpacePoint;
use crate::statistic::Statistic;

/// Number of independent samples for the check of a design.
pub(crate) const FRESH: usize = 1000;

/// Statistics of a best design, estimated from two sets of samples.
///
/// The search selected the design by its own samples, so their statistics are biased. The
/// independent samples are drawn only for this check.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Confirmation {
    /// Number of samples of the search for each design.
    pub seen: usize,
    /// Number of independent samples of this design.
    pub fresh: usize,
    /// Statistics of the design, each name once.
    pub estimates: Vec<Estimate>,
    /// Requirements on statistics that the independent samples miss.
    pub broken: Vec<Requirement>,
    /// Requirements on columns, with the fraction of independent samples that miss them.
    pub missed: Vec<MissedRequirement>,
}

/// Statistic of a best design, estimated from two sets of samples.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Name of the statistic.
    #[serde(rename = "quantity")]
    pub name: String,
    /// Estimate from the samples of the search.
    pub seen: Option<f64>,
    /// Estimate from the independent samples.
    pub value: Option<f64>,
    /// 95 % confidence interval from the independent samples; an end is `None` if it is unknown.
    pub interval: [Option<f64>; 2],
}

impl Confirmation {
    /// Returns the estimate of the statistic `name`.
    pub fn estimate(&self, name: &str) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.name == name)
    }

    /// Returns true if an end of the 95 % interval meets the requirement.
    ///
    /// The independent samples then cannot decide whether the requirement is missed.
    pub fn is_open(&self, requirement: &Requirement) -> bool {
        let estimate = self.estimate(&requirement.column);
        let mut ends = estimate.into_iter().flat_map(|of| of.interval).flatten();
        ends.any(|end| requirement.is_met(end))
    }
}

/// Checks the design at `point` with independent samples.
///
/// `None` if the goal contains no statistics over samples.
pub(crate) fn confirm(
    search: &Search<'_>,
    point: &SpacePoint,
) -> Result<Option<Confirmation>, Halt> {
    let Some(judge) = search.judge.samples() else { return Ok(None) };
    let seen = search.evaluations.samples(point, 1, judge.count, judge)?;
    // The independent samples are numbered after the samples of the search.
    let first = judge.count as u64 + 1;
    let fresh = search.evaluations.samples(point, first, FRESH, judge)?;
    let all: Vec<Estimate> =
        (0..judge.statistics.len()).map(|q| estimate(judge, q, &seen, &fresh)).collect();
    let required: Vec<&Requirement> = search.judge.requirements().collect();
    let broken = search.judge.uses().filter_map(|(of, q)| {
        let StatisticUse::Requirement(k) = of else { return None };
        let is_kept = all[q].value.is_some_and(|value| required[k].is_met(value));
        (!is_kept).then(|| Requirement { column: all[q].name.clone(), ..required[k].clone() })
    });
    let broken = broken.collect();
    let mut estimates: Vec<Estimate> = Vec::new();
    for estimate in all {
        if !estimates.iter().any(|known| known.name == estimate.name) {
            estimates.push(estimate);
        }
    }
    let missed = judge.missed(&fresh);
    Ok(Some(Confirmation { seen: seen.0.len(), fresh: FRESH, estimates, broken, missed }))
}

/// Estimates statistic `q` from the samples of the search and from independent samples.
fn estimate(judge: &SampleJudge, q: usize, seen: &Samples, fresh: &Samples) -> Estimate {
    let used = &judge.statistics[q];
    let keys = judge.keys(q, fresh);
    let (value, interval) = match used.statistic {
        Statistic::Yield => {
            let met = keys.into_iter().filter(|margin| *margin >= 0.0).count();
            let proportion = Proportion { met, of: fresh.0.len() };
            (Some(proportion.share()), proportion.interval().map(Some))
        }
        Statistic::Quantile { share, .. } => {
            let quantile = SampledQuantile::of(keys, share);
            (quantile.value, quantile.interval)
        }
    };
    Estimate { name: used.name.clone(), seen: judge.value(q, seen), value, interval }
}
