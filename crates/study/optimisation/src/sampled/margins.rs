//! Margins of the nominal limits that deviations of a design need.
//!
//! The lightest nominal design lies at its limits, so about half of its samples miss each of them,
//! and a local search from there need not reach a high yield. A nominal search with margins starts
//! closer:
//!
//! ```text
//! l ← l + v − q                                                                         (O11)
//! ```
//!
//! Here `l` is the limit of a column, `v` its nominal value, and `q` its quantile over the samples
//! for the fraction `(1 − y)/n` on the bad side, with the required yield `y` and `n` requirements.

use crate::best::BestDesign;
use crate::evaluations::Halt;
use crate::goal::DesignGoal;
use crate::local::Search;
use crate::statistic::Statistic;

/// Returns `goal` with margins for the deviations of `best`, judged by the samples of `search`.
///
/// `None` if the goal requires no yield, or if the samples of `best` meet it.
pub(crate) fn with_margins(
    search: &Search<'_>,
    goal: &DesignGoal,
    best: &BestDesign,
) -> Result<Option<DesignGoal>, Halt> {
    let Some(judge) = search.judge.samples() else { return Ok(None) };
    let mut required = goal.requirements.iter();
    let required = required.find(|r| goal.statistic(&r.column) == Some(Statistic::Yield));
    let Some(required) = required else {
        return Ok(None);
    };
    let samples = search.evaluations.samples(&best.candidate.point, 1, judge.count, judge)?;
    let met = samples.0.iter().filter(|values| judge.bounds.margin(values.iter().copied()) >= 0.0);
    if required.is_met(met.count() as f64 / samples.0.len() as f64) {
        return Ok(None);
    }
    let mut safer = goal.clone();
    let limits = safer.requirements.iter_mut().filter(|r| goal.statistic(&r.column).is_none());
    // The bounds begin with these requirements, in the same order.
    let bounds = judge.bounds.values(&best.row).enumerate();
    let share = (1.0 - required.limit) / judge.bounds.all.len() as f64;
    for (requirement, (k, nominal)) in limits.zip(bounds) {
        let mut values: Vec<f64> = samples.0.iter().filter_map(|values| values[k]).collect();
        values.sort_by(f64::total_cmp);
        let direction = requirement.direction();
        let share = if direction > 0.0 { share } else { 1.0 - share };
        if let (Some(nominal), Some(bad)) = (nominal, results::quantile(&values, share)) {
            requirement.limit += direction * (direction * (nominal - bad)).max(0.0);
        }
    }
    Ok(Some(safer))
}
