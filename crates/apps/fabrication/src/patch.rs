//! The solids of a patch.

use geometry::Row;

/// Maximum number of scales, at which files reach some 100 MB.
const MOST_SCALES: usize = 20_000;

/// Range of every length of a patch, mm.
// Single-precision numbers of an STL file keep lengths of this range apart from zero and infinity.
pub(crate) const LENGTHS: [f64; 2] = [1e-6, 1e6];

/// A patch of skin: equal scales in rows on a membrane.
///
/// All lengths are in millimetres.
///
/// `x` runs along a row, `y` across the rows, `z` upwards. The origin is the lowest corner of the
/// membrane. The bases of the scales stand on its upper face, which extends a gap beyond them on
/// every side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    row: Row,
    thickness: f64,
    width: f64,
    membrane: f64,
    scales: [usize; 2],
    gap_across: f64,
    /// True if every second row is shifted by half a pitch.
    is_brick: bool,
}

/// Errors of a patch.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoPatch {
    /// A length is out of range.
    #[error("{0} is {1} mm, expected a length from {low:e} to {high:e}", low = LENGTHS[0], high = LENGTHS[1])]
    Length(&'static str, f64),
    /// No scale, or too many.
    #[error("{0}x{1} scales: out of range, expected at least 1x1 and at most {MOST_SCALES} in all")]
    Scales(usize, usize),
}

/// A solid between two parallel faces.
///
/// The outline lies in the x–z plane and is extruded along `y`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prism {
    /// Corners of the outline, `[x, z]`, mm, counter-clockwise seen along `y`.
    pub outline: [[f64; 2]; 4],
    /// Start and end of the extrusion in `y`, mm.
    pub across: [f64; 2],
}

impl Patch {
    /// Creates a patch from rows like `row` (lengths over `thickness`), with `scales` along and
    /// across.
    ///
    /// # Errors
    /// If a length is out of range, or the number of scales is out of range.
    pub fn new(
        row: Row,
        thickness: f64,
        [width, membrane, gap_across]: [f64; 3],
        scales: [usize; 2],
    ) -> Result<Self, NoPatch> {
        let [along, across] = scales;
        // Checked, because two large counts could overflow to a small product.
        match along.checked_mul(across) {
            Some(1..=MOST_SCALES) => {}
            _ => return Err(NoPatch::Scales(along, across)),
        }
        let [low, high] = LENGTHS;
        let patch = Self { row, thickness, width, membrane, scales, gap_across, is_brick: false };
        let [length, breadth, _] = patch.membrane_size();
        let lengths = [
            ("the length of the membrane", length),
            ("the width of the membrane", breadth),
            ("the thickness of the scales", thickness),
            ("the width of the scales", width),
            ("the thickness of the membrane", membrane),
            ("the gap across", gap_across),
            ("the gap along", patch.gaps()[0]),
            ("the base of the scales", patch.base()),
            // Upright scales have no shift.
            ("the shift of the top of the scales", patch.shift().abs().max(low)),
        ];
        // Written so that NaN is refused.
        if let Some(&(name, length)) = lengths.iter().find(|(_, l)| !(low..=high).contains(l)) {
            return Err(NoPatch::Length(name, length));
        }
        Ok(patch)
    }

    /// Returns the patch with every second row shifted by half a pitch, like bricks.
    #[must_use]
    pub fn brick_laid(self) -> Self {
        Self { is_brick: true, ..self }
    }

    /// Returns the shift of a row along itself.
    fn row_shift(&self, row: usize) -> f64 {
        if self.is_brick && row % 2 == 1 { self.pitches()[0] / 2.0 } else { 0.0 }
    }

    /// Returns the number of scales along and across.
    pub fn scales(&self) -> [usize; 2] {
        self.scales
    }

    /// Returns the length of a scale's base along the row.
    pub fn base(&self) -> f64 {
        2.0 * self.row.scale().half_base() * self.thickness
    }

    /// Returns the thickness of the scales.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Returns the width of the scales across the row.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Returns the slant of the scales from the vertical, degrees.
    pub fn slant_deg(&self) -> f64 {
        self.row.scale().slant().to_degrees()
    }

    /// Returns the horizontal shift of the top of a scale relative to its base.
    pub fn shift(&self) -> f64 {
        self.row.scale().shift() * self.thickness
    }

    /// Returns the gaps between bases, along and across.
    pub fn gaps(&self) -> [f64; 2] {
        [self.row.gap() * self.thickness, self.gap_across]
    }

    /// Returns the pitches of the scales, along and across.
    pub fn pitches(&self) -> [f64; 2] {
        let [along, across] = self.gaps();
        [self.base() + along, self.width + across]
    }

    /// Returns length, width and thickness of the membrane.
    pub fn membrane_size(&self) -> [f64; 3] {
        let ([along, across], [nx, ny]) = (self.gaps(), self.scales.map(|n| n as f64));
        let [px, py] = self.pitches();
        // The second row ends farthest to the right.
        let shift = if self.scales[1] > 1 { self.row_shift(1) } else { 0.0 };
        [nx * px + along + shift, ny * py + across, self.membrane]
    }

    /// Returns the volume of one scale, mm³.
    pub fn scale_volume(&self) -> f64 {
        self.base() * self.thickness * self.width
    }

    /// Returns the profile of a scale, `[x, z]`, counter-clockwise.
    ///
    /// The base begins at the origin and extends to the right.
    pub fn profile(&self) -> [[f64; 2]; 4] {
        let (base, shift, t) = (self.base(), self.shift(), self.thickness);
        [[0.0, 0.0], [base, 0.0], [base + shift, t], [shift, t]]
    }

    /// Returns the membrane.
    pub fn membrane(&self) -> Prism {
        let [length, width, h] = self.membrane_size();
        Prism { outline: [[0.0, 0.0], [length, 0.0], [length, h], [0.0, h]], across: [0.0, width] }
    }

    /// Returns the lower left corners of the bases (`x`, `y`), row by row.
    pub fn places(&self) -> impl Iterator<Item = [f64; 2]> {
        let ([gx, gy], [px, py], [nx, ny]) = (self.gaps(), self.pitches(), self.scales);
        (0..ny).flat_map(move |j| {
            let first = gx + self.row_shift(j);
            (0..nx).map(move |i| [first + i as f64 * px, gy + j as f64 * py])
        })
    }

    /// Returns the scales, row by row.
    pub fn scale_prisms(&self) -> impl Iterator<Item = Prism> {
        let (profile, h, width) = (self.profile(), self.membrane, self.width);
        self.places().map(move |[x, y]| Prism {
            outline: profile.map(|[along, up]| [x + along, h + up]),
            across: [y, y + width],
        })
    }
}

impl Prism {
    /// Returns the corners: first the face at the smaller `y`, then the opposite face.
    pub fn corners(&self) -> [[f64; 3]; 8] {
        std::array::from_fn(|k| {
            let [x, z] = self.outline[k % 4];
            [x, self.across[k / 4], z]
        })
    }

    /// The faces as corner indices, counter-clockwise seen from outside.
    pub const FACES: [[usize; 4]; 6] =
        [[0, 1, 2, 3], [7, 6, 5, 4], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]];
}

#[cfg(test)]
pub(crate) mod tests {
    use geometry::Parallelogram;

    use super::*;

    /// Creates scales 2 mm thick with a base of 1.6 mm and a slant of 60°, 5 along and 4 across.
    pub fn patch() -> Patch {
        let row = Row::new(Parallelogram::new(0.4, 60.0).expect("a scale"), 0.3).expect("a row");
        Patch::new(row, 2.0, [3.0, 0.25, 0.6], [5, 4]).expect("a patch")
    }

    #[test]
    fn scales_stand_on_the_membrane_at_their_pitch() {
        let patch = patch();
        let scales: Vec<_> = patch.scale_prisms().collect();
        assert_eq!(scales.len(), 20);
        let [first, second, sixth] = [scales[0], scales[1], scales[5]];
        assert_eq!(first.outline[0], [0.6, 0.25], "a gap from the rim, on top of the membrane");
        assert!((second.outline[0][0] - first.outline[0][0] - 2.2).abs() < 1e-12);
        assert!((second.outline[0][0] - first.outline[1][0] - 0.6).abs() < 1e-12, "the gap");
        assert!((sixth.across[0] - first.across[1] - 0.6).abs() < 1e-12, "the gap across");
        let [length, width, _] = patch.membrane_size();
        assert!((length - scales[19].outline[1][0] - 0.6).abs() < 1e-12);
        assert!((width - scales[19].across[1] - 0.6).abs() < 1e-12);
    }

    #[test]
    fn every_second_row_of_a_brick_laid_patch_is_shifted_by_half_a_pitch() {
        let patch = patch().brick_laid();
        let places: Vec<_> = patch.places().collect();
        let half = patch.pitches()[0] / 2.0;
        assert!((places[5][0] - places[0][0] - half).abs() < 1e-12);
        assert_eq!(places[10][0], places[0][0]);
        let end = places[9][0] + patch.base();
        assert!((patch.membrane_size()[0] - end - 0.6).abs() < 1e-12, "a gap from the rim");
    }

    #[test]
    fn impossible_patches_are_refused() {
        let row = patch().row;
        let refused = |lengths, scales| Patch::new(row, 2.0, lengths, scales).unwrap_err();
        assert_eq!(
            refused([3.0, 0.0, 0.6], [5, 4]),
            NoPatch::Length("the thickness of the membrane", 0.0)
        );
        assert_eq!(refused([3.0, 0.2, 0.6], [0, 4]), NoPatch::Scales(0, 4));
        assert_eq!(refused([3.0, 0.2, 0.6], [usize::MAX, 2]), NoPatch::Scales(usize::MAX, 2));
    }
}
