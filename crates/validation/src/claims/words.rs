//! The designs that the paper speaks of.

use crate::study::MeasuredDesign;

/// Sections 3 and 4 call a length of 0.1 the smallest; the two smaller ones occur in section 5 only.
pub(super) fn in_figures(design: &MeasuredDesign) -> bool {
    design.length >= 0.1
}

/// Section 5 leaves out the designs that leave the substrate exposed.
pub(super) fn covered(design: &MeasuredDesign) -> bool {
    // `None` is less than any value: a design without a coverage is left out, too.
    design.coverage > Some(0.0)
}

pub(super) fn any(_: &MeasuredDesign) -> bool {
    true
}
