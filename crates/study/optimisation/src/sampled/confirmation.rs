//! What a search has found, put to the test with other samples than those that it saw.

use ranking::Requirement;
use serde::Serialize;
use uncertainty::{Proportion, SampledQuantile};

use crate::evaluated_row::StatisticUse;
use crate::evaluations::Halt;
use crate::local::Search;
use crate::sample::{SampleJudge, Samples};
use crate::space::SpacePoint;
use crate::statistic::Statistic;

/// Samples with which a search is checked at its end.
const FRESH: usize = 1000;

/// The statistics over the samples of a best design: what the search saw, and what other samples say.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Confirmation {
    /// Samples that the search saw of each design.
    pub seen: usize,
    /// Samples of this one with other random numbers.
    pub fresh: usize,
    /// The statistics, each name once.
    pub estimates: Vec<Estimate>,
    /// The requirements of statistics that the other samples do not keep.
    pub broken: Vec<Requirement>,
}

/// A statistic over the samples of a best design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The name of the statistic.
    #[serde(rename = "quantity")]
    pub name: String,
    /// The value that the search saw.
    pub seen: Option<f64>,
    /// The value of other samples.
    pub value: Option<f64>,
    /// The 95 % interval that those leave.
    pub interval: [Option<f64>; 2],
}

impl Confirmation {
    /// The estimate of that name.
    pub fn estimate(&self, name: &str) -> Option<&Estimate> {
        self.estimates.iter().find(|estimate| estimate.name == name)
    }

    /// Whether a requirement that the other samples do not keep may be kept all the same: an end of the 95 % interval meets it.
    pub fn is_open(&self, requirement: &Requirement) -> bool {
        let estimate = self.estimate(&requirement.column);
        let mut ends = estimate.into_iter().flat_map(|of| of.interval).flatten();
        ends.any(|end| requirement.is_met(end))
    }
}

/// What other samples say of the design at `point`; `None` if the goal is not about them.
pub(super) fn confirm(
    search: &Search<'_>,
    point: &SpacePoint,
) -> Result<Option<Confirmation>, Halt> {
    let Some(judge) = search.judge.samples() else { return Ok(None) };
    let seen = search.evaluations.samples(point, 1, judge.count, judge)?;
    // From the first number that the search has not seen: its own samples flatter what it chose by them.
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
    Ok(Some(Confirmation { seen: seen.0.len(), fresh: FRESH, estimates, broken }))
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
