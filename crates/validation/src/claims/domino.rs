//! Claims about the distribution of the load over the scales (Fig. 9).

use super::digits;
use super::evidence::{Evidence, LoadedRow};
use super::statement::Measured;

pub(super) fn row(
    evidence: &Evidence,
    which: usize,
    count: fn(&LoadedRow) -> usize,
) -> Option<Measured> {
    let row = evidence.loaded.as_ref()?.get(which)?;
    let count = count(row);
    let [force, displacement] = [row.force, row.displacement].map(digits);
    Some(Measured {
        value: count as f64,
        shown: format!("{count}, at F* = {force} and u* = {displacement}"),
    })
}
