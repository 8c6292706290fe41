//! What a search has found, put to the test with other skins than those that it saw.

use ranking::Requirement;
use tolerance::{Proportion, SampledQuantile};

use super::FRESH;
use super::judge::{MadeJudge, Skins, Stake};
use super::quantity::MadeQuantity;
use crate::evaluations::Halt;
use crate::local::Search;
use crate::search::BestDesign;

/// The quantities over the skins of a best design: what the search saw, and what other skins say.
#[derive(Clone, Debug, PartialEq)]
pub struct MadeReport {
    /// Skins that the search saw of each design.
    pub seen: usize,
    /// Skins with other random numbers that were made of this one.
    pub fresh: usize,
    /// The quantities, each name once.
    pub estimates: Vec<MadeEstimate>,
    /// The requirements of quantities that those skins do not keep.
    pub broken: Vec<Requirement>,
}

/// A quantity over the skins of a best design.
#[derive(Clone, Debug, PartialEq)]
pub struct MadeEstimate {
    /// The name of the quantity.
    pub name: String,
    /// The value that the search saw.
    pub seen: Option<f64>,
    /// The value of other skins.
    pub value: Option<f64>,
    /// The 95 % interval that those leave.
    pub interval: [Option<f64>; 2],
}

impl MadeReport {
    /// The estimate of that name.
    pub fn estimate(&self, name: &str) -> Option<&MadeEstimate> {
        self.estimates.iter().find(|estimate| estimate.name == name)
    }

    /// Whether a requirement that those skins do not keep may be kept all the same: an end of the 95 % interval meets it.
    pub fn is_open(&self, requirement: &Requirement) -> bool {
        let estimate = self.estimate(&requirement.column);
        let mut ends = estimate.into_iter().flat_map(|of| of.interval).flatten();
        ends.any(|end| requirement.is_met(end))
    }
}

/// Adds what other skins say to a design that was found.
pub(super) fn report(search: &Search<'_>, best: &mut BestDesign) -> Result<(), Halt> {
    let Some(judge) = search.judge.made() else { return Ok(()) };
    let point = &best.candidate.point;
    let seen = search.evaluations.skins(point, 1, judge.skins, judge)?;
    let first = judge.skins as u64 + 1;
    let fresh = search.evaluations.skins(point, first, FRESH, judge)?;
    let of_quantity = |q| estimate(judge, q, &seen, &fresh);
    let all: Vec<MadeEstimate> = (0..judge.quantities.len()).map(of_quantity).collect();
    let required: Vec<&Requirement> = search.judge.requirements().collect();
    let broken = search.judge.stakes().filter_map(|(stake, q)| {
        let Stake::Requirement(k) = stake else { return None };
        let is_kept = all[q].value.is_some_and(|value| required[k].is_met(value));
        (!is_kept).then(|| Requirement { column: all[q].name.clone(), ..required[k].clone() })
    });
    let broken = broken.collect();
    let mut estimates: Vec<MadeEstimate> = Vec::new();
    for estimate in all {
        if !estimates.iter().any(|known| known.name == estimate.name) {
            estimates.push(estimate);
        }
    }
    best.made = Some(MadeReport { seen: seen.0.len(), fresh: FRESH, estimates, broken });
    Ok(())
}

fn estimate(judge: &MadeJudge, q: usize, seen: &Skins, fresh: &Skins) -> MadeEstimate {
    let used = &judge.quantities[q];
    let (value, interval) = match used.quantity {
        MadeQuantity::Yield => {
            let met = judge.keys(q, fresh).into_iter().filter(|margin| *margin >= 0.0).count();
            let proportion = Proportion { met, of: fresh.0.len() };
            (Some(proportion.share()), proportion.interval().map(Some))
        }
        MadeQuantity::Quantile { share, .. } => {
            let quantile = SampledQuantile::of(judge.keys(q, fresh), share);
            (quantile.value, quantile.interval)
        }
    };
    MadeEstimate { name: used.name.clone(), seen: judge.value(q, seen), value, interval }
}
