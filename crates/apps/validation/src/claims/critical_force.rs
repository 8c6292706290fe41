//! Claims about critical force and puncture stiffness.

use super::digits;
use super::evidence::Evidence;
use super::measured_number::Measured;
use super::statistics::{DesignValue, GAP, LENGTH, SLANT, explained};
use crate::study::MeasuredDesign;

pub(super) const FORCE: DesignValue = |design| design.critical_force;
pub(super) const LARGEST_STIFFNESS: DesignValue = |design| design.max_stiffness;
pub(super) const INITIAL_STIFFNESS: DesignValue = |design| design.initial_stiffness;

/// Returns the rank correlation of a stiffness with the critical force.
pub(super) fn correlation(evidence: &Evidence, stiffness: DesignValue) -> Option<Measured> {
    let pairs: Vec<_> = evidence
        .designs
        .iter()
        .filter(|d| d.is_in_figures())
        .filter_map(|d| Some([stiffness(d)?, FORCE(d)?]))
        .collect();
    Some(ranking::rank_correlation(&pairs)?.into())
}

/// Returns the effect of the slant on a value, divided by the larger effect of gap and length.
///
/// Effects are fractions of the variance of the logarithm.
pub(super) fn slant_effect(
    evidence: &Evidence,
    among: fn(&MeasuredDesign) -> bool,
    value: DesignValue,
) -> Option<Measured> {
    // Values span decades, so without the logarithm the largest values would dominate the variance.
    let designs: Vec<_> = evidence
        .designs
        .iter()
        .filter(|d| among(d))
        .filter_map(|d| Some((d, value(d)?.ln())))
        .collect();
    if designs.is_empty() {
        return None;
    }
    let [gap, length, slant] = [GAP, LENGTH, SLANT].map(|p| 100.0 * explained(&designs, p));
    // The slant has the largest effect if this ratio is at least 1.
    let value = slant / gap.max(length);
    let shown = format!("{}: d/t {gap:.0} %, L/t {length:.0} %, slant {slant:.0} %", digits(value));
    Some(Measured { value, shown })
}
