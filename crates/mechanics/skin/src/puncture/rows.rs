//! Sources of the row of scales of a puncture: equal, one perturbed, or a random sample.

use geometry::{OutOfRange, Row};

use super::row_layout::RowLayout;
use super::single_scale::PerturbedScale;
use crate::Sample;
use crate::arrangement::Arrangement;

/// Source of rows of any length.
#[derive(Clone, Copy)]
pub(super) enum Rows<'a> {
    /// Equal scales at equal gaps.
    Even(Row),
    /// Equal scales at equal gaps, except one perturbed scale.
    Perturbed(Row, PerturbedScale),
    /// Scales with random gaps and slants.
    Sample(&'a Sample),
}

impl Rows<'_> {
    /// Returns the scales of the part of the row with this `layout`.
    pub(super) fn row(self, layout: RowLayout) -> Result<Arrangement, OutOfRange> {
        Ok(match self {
            Self::Even(row) => Arrangement::Even(row),
            Self::Perturbed(row, scale) => Arrangement::Uneven(scale.within(&row, layout)?),
            Self::Sample(sample) => Arrangement::Uneven(sample.row(layout.left, layout.right)?),
        })
    }
}
