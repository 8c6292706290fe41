//! One scale of a row that differs from all others.

use geometry::{OutOfRange, Parallelogram, Row, UnevenRow};

use super::system::RowLayout;

/// One scale of a row, and by how much it differs from all others.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PerturbedScale {
    /// Its place, from the punctured scale to the right.
    pub place: i32,
    /// Difference of the gap on its right, over `t`.
    pub gap: f64,
    /// Difference of its slant, degrees.
    pub slant_deg: f64,
}

impl PerturbedScale {
    /// The scales of a `layout` cut out of an endless `row` in which one scale is odd.
    ///
    /// # Errors
    /// If it does not stand clear of its neighbours.
    pub(super) fn within(self, row: &Row, layout: RowLayout) -> Result<UnevenRow, OutOfRange> {
        let mut scales = vec![*row.scale(); layout.scales()];
        let mut gaps = vec![row.gap(); layout.scales() - 1];
        let place = usize::try_from(layout.left as i64 + i64::from(self.place));
        // An odd scale beyond those that are solved for changes none of them.
        let place = place.unwrap_or(usize::MAX);
        if let Some(scale) = scales.get_mut(place) {
            let slant = scale.slant().to_degrees() + self.slant_deg;
            *scale = Parallelogram::leaning(scale.half_base(), slant)?;
        }
        if let Some(gap) = gaps.get_mut(place) {
            *gap += self.gap;
        }
        UnevenRow::new(scales, gaps)
    }
}
