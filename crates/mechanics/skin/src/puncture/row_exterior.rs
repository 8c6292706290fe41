//! The scales of a row beyond its solved part.

use std::array;

use geometry::{Body, Corner, OutOfRange};
use substrate::{FarField, Relief};

use super::row_layout::RowLayout;
use super::rows::Rows;

/// Number of scales beyond each end of the solved part with gaps that are checked.
///
/// Gaps farther away hardly change.
const CHECKED_SCALES: usize = 12;

/// Far field of the scales beyond one end, and their number.
#[derive(Clone, Debug)]
pub(super) struct Beyond {
    /// Motion of the scales beyond the end, in closed form.
    pub(super) far: FarField,
    /// Number of scales beyond the end; `None` for an infinite row.
    pub(super) scales: Option<usize>,
}

/// The scales of a row beyond its solved part.
///
/// Empty for a row that is solved as a whole.
#[derive(Clone, Debug, Default)]
pub(crate) struct RowExterior {
    /// Far field and gaps beyond the left and the right end.
    pub(super) sides: [Option<ExteriorSide>; 2],
    /// Reduction of the substrate stiffness by the motion of the scales beyond the ends.
    ///
    /// Each entry holds row and column of a block of the tangent, and its values.
    pub(super) relief: Vec<(usize, usize, [[f64; 3]; 3])>,
    /// Distance of the farthest corner of a scale from its node, in units of `t`.
    pub(super) arm: f64,
}

/// Far field and gaps beyond one end.
#[derive(Clone, Debug)]
pub(super) struct ExteriorSide {
    pub(super) beyond: Beyond,
    /// Widths of the checked gaps, the nearest first.
    pub(super) gaps: Vec<f64>,
    /// Clearances between the scales on both sides of these gaps.
    pub(super) clearances: Vec<f64>,
}

/// Mirrors a displacement if `side` is 0 (left), so that one far field serves both ends.
pub(super) fn mirrored([x, y, rotation]: [f64; 3], side: usize) -> [f64; 3] {
    if side == 0 { [-x, y, -rotation] } else { [x, y, rotation] }
}

impl RowExterior {
    /// Sets up the scales beyond the part of `rows` with this `layout`.
    ///
    /// # Errors
    /// If the scales of a random sample cannot be drawn without overlap.
    pub(super) fn new(
        rows: Rows,
        layout: RowLayout,
        beyond: [Option<Beyond>; 2],
        body: Body,
    ) -> Result<Self, OutOfRange> {
        let [left, right] = beyond.each_ref().map(|side| {
            let scales = side.as_ref().map_or(Some(0), |beyond| beyond.scales);
            scales.map_or(CHECKED_SCALES, |scales| scales.min(CHECKED_SCALES))
        });
        // A longer row has the same scales in its middle, so its additional scales are those beyond
        // the ends.
        let row = rows.row(RowLayout {
            left: layout.left + left,
            right: layout.right + right,
            ..layout
        })?;
        let end = left + layout.scales() - 1;
        let [first, last] = beyond;
        let sides: [(_, Vec<_>); 2] =
            [(first, (0..left).rev().collect()), (last, (end..end + right).collect())];
        let sides = sides.map(|(beyond, pairs)| {
            Some(ExteriorSide {
                beyond: beyond?,
                gaps: pairs.iter().map(|&pair| row.gap(pair)).collect(),
                clearances: pairs.iter().map(|&pair| row.clearance(pair, body)).collect(),
            })
        });
        let relief = relief(layout, &sides);
        // The corner farthest from the node is a top corner, whether the scale leans left or right.
        let scale = row.scale(left);
        let arm = [Corner::TopLeft, Corner::TopRight].map(|corner| scale.corner(corner).norm());
        Ok(Self { sides, relief, arm: arm[0].max(arm[1]) })
    }

    /// Counts the scales of a finite row beyond its left and its right end.
    pub(super) fn scales_to_ends(&self) -> [usize; 2] {
        let sides = self.sides.each_ref();
        sides.map(|side| side.as_ref().and_then(|side| side.beyond.scales).unwrap_or(0))
    }
}

/// Returns the stiffness reductions at both ends, with rows and columns of the tangent.
fn relief(
    layout: RowLayout,
    sides: &[Option<ExteriorSide>; 2],
) -> Vec<(usize, usize, [[f64; 3]; 3])> {
    let last = layout.scales() - 1;
    sides
        .iter()
        .enumerate()
        .flat_map(|(number, side)| {
            let parts = side.as_ref().map_or(&[][..], |side| &side.beyond.far.relief);
            let unknown =
                move |scale: usize| layout.scale(if number == 0 { scale } else { last - scale });
            // Mirroring changes the sign of entries that couple `y` with `x` or `φ`.
            let signs = mirrored([1.0; 3], number);
            parts
                .iter()
                .map(move |Relief { force, displacement, by }: &Relief| {
                    let by =
                        array::from_fn(|k| array::from_fn(|l| -signs[k] * signs[l] * by[k][l]));
                    (unknown(*force), unknown(*displacement), by)
                })
                .collect::<Vec<_>>()
        })
        .collect()
}
