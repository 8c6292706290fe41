//! Claims about coverage.

use super::evidence::Evidence;
use super::statement::Measured;
use super::words::any;
use super::{digits, named};

pub(super) fn smallest_gap_largest_length(evidence: &Evidence) -> Option<Measured> {
    let there = evidence.design(0.1, 1.0, 45.0)?;
    let best = evidence.best(any, |d| d.coverage)?;
    // One among equals has the largest, too.
    let equal = best.designs.iter().any(|design| named(design) == named(there));
    let ratio = if equal { 1.0 } else { there.coverage? / best.value };
    Some(Measured { value: ratio, shown: digits(ratio) })
}
