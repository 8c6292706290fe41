//! Checks the results of a search with independent samples.

use ranking::Requirement;
use serde::Serialize;
use uncertainty::{Proportion, SampledQuantile};

use crate::evaluated_row::StatisticUse;
use crate::evaluations::Halt;
use crate::local::Search;
use crate::sample::{MissedRequirement, SampleJudge, Samples};
use crate::space::SpacePoint;
use crate::statistic::Statistic;

/// Number of independent samples for each check.
pub(crate) const FRESH: usize = 1000;

/// Statistics of a best design, by seen and by independent samples.
///
/// Seen samples are the samples of the search.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Confirmation {
    /// Number of samples per design in the search.
    pub seen: usize,
    /// Number of independent samples of this design.
    pub fresh: usize,
    /// Statistics, with unique names.
    pub estimates: Vec<Estimate>,
    /// Requirements on statistics that the independent samples violate.
    pub broken: Vec<Requirement>,
    /// Requirements that single independent samples miss.
    pub missed: Vec<MissedRequirement>,
}

/// Statistic over the samples of a best design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Name of the statistic.
    #[serde(rename = "quantity")]
    pub name: String,
    /// Value by the samples of the search.
    pub seen: Option<f64>,
    /// Value by the independent samples.
    pub value: Option<f64>,
    /// 95 % confidence interval.
    pub interval: [Option<f64>; 2],
}

impl Confirmation {
    /// Returns the estimate with this name.
    pub fn estimate(&self, name: &str) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.name == name)
    }

    /// Returns true if the 95 % interval reaches values that meet the requirement.
    pub fn is_open(&self, requirement: &Requirement) -> bool {
        let estimate = self.estimate(&requirement.column);
        let mut ends = estimate.into_iter().flat_map(|of| of.interval).flatten();
        ends.any(|end| requirement.is_met(end))
    }
}

/// Checks the design at `point` with independent samples.
///
/// `None` if the goal is not about samples.
pub(crate) fn confirm(
    search: &Search<'_>,
    point: &SpacePoint,
) -> Result<Option<Confirmation>, Halt> {
    let Some(judge) = search.judge.samples() else { return Ok(None) };
    let seen = search.evaluations.samples(point, 1, judge.count, judge)?;
    // Start after the samples of the search: selection by those samples biases them.
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
