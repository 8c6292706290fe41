//! One perturbed scale in a row of equal scales.

use geometry::{OutOfRange, Parallelogram, Row, UnevenRow};

use super::row_layout::RowLayout;

/// Deviations of one scale in a row of equal scales.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PerturbedScale {
    /// Number of scales from the punctured scale to this scale; positive to the right.
    pub offset: i32,
    /// Change of the gap on the right of the scale, in units of `t`.
    pub gap: f64,
    /// Change of the slant of the scale, degrees.
    pub slant_deg: f64,
}

impl PerturbedScale {
    /// Returns the scales of `layout` as in `row`, with the deviations of this perturbed scale.
    ///
    /// # Errors
    /// If the scale would overlap its neighbours.
    pub(super) fn within(self, row: &Row, layout: RowLayout) -> Result<UnevenRow, OutOfRange> {
        let mut scales = vec![*row.scale(); layout.scales()];
        let mut gaps = vec![row.gap(); layout.scales() - 1];
        let index = usize::try_from(layout.left as i64 + i64::from(self.offset));
        // A perturbed scale beyond the solved part changes nothing.
        let index = index.unwrap_or(usize::MAX);
        if let Some(scale) = scales.get_mut(index) {
            let slant = scale.slant().to_degrees() + self.slant_deg;
            *scale = Parallelogram::leaning(scale.half_base(), slant)?;
        }
        if let Some(gap) = gaps.get_mut(index) {
            *gap += self.gap;
        }
        UnevenRow::new(scales, gaps)
    }
}
