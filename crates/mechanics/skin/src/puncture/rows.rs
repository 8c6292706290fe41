//! Rows of scales from which a puncture takes the scales that it solves.

use geometry::{OutOfRange, Row};

use super::row_layout::RowLayout;
use super::single_scale::PerturbedScale;
use crate::Sample;
use crate::arrangement::Arrangement;

/// Source of rows of any length.
#[derive(Clone, Copy)]
pub(super) enum Rows<'a> {
    Even(Row),
    Odd(Row, PerturbedScale),
    Sample(&'a Sample),
}

impl Rows<'_> {
    pub(super) fn row(self, layout: RowLayout) -> Result<Arrangement, OutOfRange> {
        Ok(match self {
            Self::Even(row) => Arrangement::Even(row),
            Self::Odd(row, odd) => Arrangement::Uneven(odd.within(&row, layout)?),
            Self::Sample(sample) => Arrangement::Uneven(sample.row(layout.left, layout.right)?),
        })
    }
}
