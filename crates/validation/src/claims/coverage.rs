//! Claims about coverage.

use super::evidence::Evidence;
use super::statement::{Measured, Statement};
use super::verdict::{DesignRange, Limits, Optimum};
use super::words::{LARGE_LENGTH, SMALL_GAP, any};
use super::{digits, named};

pub(super) const UNSLANTED: [Statement; 1] = [Statement::number(
    "",
    "largest λ of the designs with no slant",
    |evidence| Some(evidence.best(|d| d.slant == 0.0, |d| d.coverage)?.value.into()),
    Limits::exactly(0.0),
)];

pub(super) const BEST: [Statement; 2] = [
    Statement::best(
        "small gap, large L/t, 45° (sec. 5)",
        "designs with the largest λ",
        |evidence| evidence.best(any, |d| d.coverage),
        Optimum::at(DesignRange { gap: SMALL_GAP, length: LARGE_LENGTH, slant: [45.0; 2] }),
    ),
    Statement::number(
        "the smallest gap and the largest L/t (sec. 6)",
        "λ at (0.1, 1, 45°) over the largest λ",
        smallest_gap_largest_length,
        Limits::at_least(1.0, 1.0),
    ),
];

fn smallest_gap_largest_length(evidence: &Evidence) -> Option<Measured> {
    let there = evidence.design(0.1, 1.0, 45.0)?;
    let best = evidence.best(any, |d| d.coverage)?;
    // One among equals has the largest, too.
    let equal = best.designs.iter().any(|design| named(design) == named(there));
    let ratio = if equal { 1.0 } else { there.coverage? / best.value };
    Some(Measured { value: ratio, shown: digits(ratio) })
}
