//! The paper's words in numbers, and the designs that it speaks of.

use super::verdict::Interval;
use crate::study::MeasuredDesign;

// Small, intermediate and large: the lowest, the middle and the highest third of the values of the study. The paper
// itself calls a gap of 0.7 and a slant of 45° intermediate, a length of 0.1 small, and a slant of 60° large.
pub(super) const SMALL_GAP: Interval = [0.1, 0.3];
pub(super) const INTERMEDIATE_GAP: Interval = [0.4, 0.7];
pub(super) const LARGE_GAP: Interval = [0.8, 1.0];
pub(super) const SMALL_LENGTH: Interval = [0.025, 0.2];
pub(super) const LARGE_LENGTH: Interval = [0.7, 1.0];
pub(super) const LARGE_SLANT: Interval = [60.0, 75.0];

/// Sections 3 and 4 call a length of 0.1 the smallest; the two smaller ones occur in section 5 only.
pub(super) fn in_figures(design: &MeasuredDesign) -> bool {
    design.length >= 0.1
}

/// Section 5 leaves out the designs that leave the substrate exposed.
pub(super) fn covered(design: &MeasuredDesign) -> bool {
    design.coverage > Some(0.0)
}

pub(super) fn any(_: &MeasuredDesign) -> bool {
    true
}
