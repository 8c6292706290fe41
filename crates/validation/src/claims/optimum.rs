//! Claims about the best designs.

use super::named;
use super::statement::{Measured, Statement};
use super::verdict::{DesignRange, Limits, Optimum};
use super::words::{INTERMEDIATE_GAP, LARGE_GAP, LARGE_SLANT, SMALL_LENGTH, covered};

pub(super) const LEAST_PENETRATION: [Statement; 1] = [Statement::best(
    "",
    "designs with the largest 1/penetration, of those with λ > 0",
    |evidence| evidence.best(covered, |d| d.penetration.map(f64::recip)),
    Optimum::at(DesignRange { gap: LARGE_GAP, ..DesignRange::ANY }),
)];

pub(super) const BALANCED: [Statement; 1] = [Statement::best(
    "",
    "design with the largest fitness",
    |evidence| Some(evidence.balanced?.into()),
    Optimum {
        printed: DesignRange::design(0.7, 0.1, 60.0),
        words: DesignRange { gap: INTERMEDIATE_GAP, length: SMALL_LENGTH, slant: LARGE_SLANT },
    },
)];

pub(super) const SHARE_OF_PRINTED: [Statement; 1] = [Statement::number(
    "",
    "share of the weights that (0.7, 0.1, 60°) wins, %",
    |evidence| {
        let balanced = evidence.balanced?;
        let ours = format!("{}, wins {:.1} %", named(&balanced.best), balanced.share);
        let value = balanced.share_of_printed;
        Some(Measured { value, shown: format!("{value:.1} %; ours, {ours}") })
    },
    Limits::at_least(20.0, 10.0),
)];
