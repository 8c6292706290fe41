//! The solids of a patch.

use std::f64::consts::TAU;

use geometry::{Body, Frame, Row, Vec2};

/// Maximum number of scales, at which files reach some 100 MB.
const MOST_SCALES: usize = 20_000;

/// Valid range of each length of a patch, mm.
// STL files have single-precision numbers, in which these lengths are neither zero nor infinite.
pub(crate) const LENGTHS: [f64; 2] = [1e-6, 1e6];

/// A patch of skin: equal scales in rows on a membrane.
///
/// All lengths are in millimetres.
///
/// `x` runs along a row, `y` across the rows, `z` upwards. The origin is the lowest corner of the
/// membrane. The bases of the scales lie on the upper face of the membrane, which extends by one
/// gap beyond the bases on every side.
///
/// On a curved body, the rows lie on the arc of the body, with the middle of the membrane at the
/// top. The nodes of the scales have equal distances along the arc. The upper face of the membrane
/// is plane under each base and in each gap. The origin is then the lowest corner of the bounding
/// box.
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
    body: Body,
}

/// Error of a patch that cannot be created.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PatchError {
    /// A length is out of range.
    #[error("{0} is {1} mm, expected a length from {low:e} to {high:e}", low = LENGTHS[0], high = LENGTHS[1])]
    Length(&'static str, f64),
    /// The number of scales is zero or too large.
    #[error("{0}x{1} scales: out of range, expected at least 1x1 and at most {MOST_SCALES} in all")]
    Scales(usize, usize),
    /// The rows are longer than the circumference of the body.
    #[error(
        "the membrane is {0:.4} mm long, but the body has a circumference of {1:.4} mm: choose fewer scales along"
    )]
    Circumference(f64, f64),
    /// Neighbours overlap on a concave body.
    #[error("neighbouring scales overlap on a body with a radius of {0:.4} mm")]
    Overlap(f64),
    /// The membrane is thicker than the radius of the body.
    #[error("the membrane is {0} mm thick, but the body has a radius of only {1:.4} mm")]
    Membrane(f64, f64),
}

/// A solid between two parallel faces.
///
/// The outline lies in the x–z plane and is extruded along `y`. It has an even number `n` of
/// corners. Straight lines between the corners `k` and `n − 1 − k`, the *rungs*, divide the outline
/// into convex quadrilaterals.
#[derive(Clone, Debug, PartialEq)]
pub struct Prism {
    /// Corners of the outline, `[x, z]`, mm, counter-clockwise seen along `y`.
    pub outline: Vec<[f64; 2]>,
    /// Start and end of the extrusion in `y`, mm.
    pub across: [f64; 2],
}

/// The solids of a patch.
#[derive(Clone, Debug, PartialEq)]
pub struct Solids {
    /// The membrane: one prism, or one for each row of a brick-laid patch on a curved body.
    pub membrane: Vec<Prism>,
    /// The scales, row by row.
    pub scales: Vec<Prism>,
}

impl Patch {
    /// Creates a flat patch of parallel rows with the scales and gaps of `row`.
    ///
    /// `scales` contains the numbers of scales along and across. The lengths of `row` are in units
    /// of the `thickness` of the scales. The array contains the width of the scales, the thickness
    /// of the membrane and the gap across. It is in mm, like `thickness`.
    ///
    /// # Errors
    /// If a length or the number of scales is out of range.
    pub fn new(
        row: Row,
        thickness: f64,
        [width, membrane, gap_across]: [f64; 3],
        scales: [usize; 2],
    ) -> Result<Self, PatchError> {
        let [along, across] = scales;
        // `checked_mul` refuses large counts that would otherwise overflow to a small product.
        match along.checked_mul(across) {
            Some(1..=MOST_SCALES) => {}
            _ => return Err(PatchError::Scales(along, across)),
        }
        let [low, high] = LENGTHS;
        let (is_brick, body) = (false, Body::default());
        let patch = Self { row, thickness, width, membrane, scales, gap_across, is_brick, body };
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
        // The condition is negated so that it also refuses NaN.
        if let Some(&(name, length)) = lengths.iter().find(|(_, l)| !(low..=high).contains(l)) {
            return Err(PatchError::Length(name, length));
        }
        Ok(patch)
    }

    /// Returns the patch with every second row shifted by half a pitch, like bricks.
    #[must_use]
    pub fn brick_laid(self) -> Self {
        Self { is_brick: true, ..self }
    }

    /// Returns the patch on a curved body.
    ///
    /// # Errors
    /// If the rows are longer than the circumference, neighbours overlap, or the membrane is
    /// thicker than the radius.
    pub fn on_body(self, body: Body) -> Result<Self, PatchError> {
        let patch = Self { body, ..self };
        let Some(radius) = patch.radius() else { return Ok(patch) };
        let ([length, ..], around) = (patch.membrane_size(), TAU * radius.abs());
        if length >= around {
            return Err(PatchError::Circumference(length, around));
        }
        // Only a convex body limits the thickness of the membrane.
        if (0.0..=patch.membrane).contains(&radius) {
            return Err(PatchError::Membrane(patch.membrane, radius));
        }
        let [left, right] = patch.neighbours();
        if !are_apart(&left, &right) {
            return Err(PatchError::Overlap(radius));
        }
        Ok(patch)
    }

    /// Returns the radius of the body, mm: negative for a concave body, `None` for a flat patch.
    pub fn radius(&self) -> Option<f64> {
        (!self.body.is_flat()).then(|| self.thickness / self.body.curvature)
    }

    /// Returns the angle between the ends of the membrane, degrees.
    pub fn arc_deg(&self) -> f64 {
        self.radius().map_or(0.0, |radius| (self.membrane_size()[0] / radius.abs()).to_degrees())
    }

    /// Returns the shortest distance between two neighbouring scales of a row.
    pub fn clearance(&self) -> f64 {
        self.row.clearance_on(self.body) * self.thickness
    }

    /// Returns the corners of two neighbouring scales in the frame of the left scale.
    ///
    /// Lengths are in units of the thickness.
    fn neighbours(&self) -> [[Vec2; 4]; 2] {
        let (corners, frame) = (self.row.scale().corners(), self.body.frame(self.row.pitch()));
        [corners, corners.map(|corner| frame.origin + frame.outward(corner))]
    }

    /// Returns the distance by which a row is shifted along itself.
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
        // In a brick-laid patch the second row ends farthest to the right.
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

    /// Returns the lower left corners of the bases (`x`, `y`), row by row.
    pub fn base_corners(&self) -> impl Iterator<Item = [f64; 2]> {
        let ([gx, gy], [px, py], [nx, ny]) = (self.gaps(), self.pitches(), self.scales);
        (0..ny).flat_map(move |j| {
            let first = gx + self.row_shift(j);
            (0..nx).map(move |i| [first + i as f64 * px, gy + j as f64 * py])
        })
    }

    /// Returns membrane and scales.
    pub fn solids(&self) -> Solids {
        if self.body.is_flat() { self.flat_solids() } else { self.curved_solids() }
    }

    fn flat_solids(&self) -> Solids {
        let ([length, breadth, h], profile) = (self.membrane_size(), self.profile());
        let outline = vec![[0.0, 0.0], [length, 0.0], [length, h], [0.0, h]];
        let scales = self.base_corners().map(|[x, y]| Prism {
            outline: profile.iter().map(|[along, up]| [x + along, h + up]).collect(),
            across: [y, y + self.width],
        });
        Solids {
            membrane: vec![Prism { outline, across: [0.0, breadth] }],
            scales: scales.collect(),
        }
    }

    /// Returns the solids on the arc of the body.
    fn curved_solids(&self) -> Solids {
        let (mut membrane, mut scales) = (Vec::new(), Vec::new());
        let ([length, breadth, _], corners) =
            (self.membrane_size(), self.base_corners().collect::<Vec<_>>());
        for (j, row) in corners.chunks(self.scales[0]).enumerate() {
            // From left to right, each rung joins a point on the upper face of the membrane to the
            // point below it on the lower face.
            let mut rungs = vec![self.rung(&self.frame(0.0), 0.0)];
            for [x, y] in row {
                let frame = self.frame(x + 0.5 * self.base());
                let outline = self.row.scale().corners().map(|corner| self.placed(&frame, corner));
                scales.push(Prism { outline: outline.to_vec(), across: [*y, y + self.width] });
                let half_base = self.row.scale().half_base();
                rungs.extend([-half_base, half_base].map(|along| self.rung(&frame, along)));
            }
            rungs.push(self.rung(&self.frame(length), 0.0));
            // A shifted row bends the membrane at different positions than its neighbours, so each
            // row of a brick-laid patch has its own strip.
            let rows = if self.is_brick { self.scales[1] } else { 1 };
            if j < rows {
                let from = if j == 0 { 0.0 } else { self.middle_before(j) };
                let to = if j + 1 == rows { breadth } else { self.middle_before(j + 1) };
                let below = rungs.iter().map(|[_, lower]| *lower);
                let outline = below.chain(rungs.iter().rev().map(|[upper, _]| *upper)).collect();
                membrane.push(Prism { outline, across: [from, to] });
            }
        }
        let mut solids = Solids { membrane, scales };
        solids.move_to_origin();
        solids
    }

    /// Returns the `y` coordinate of the middle of the gap before a row.
    fn middle_before(&self, row: usize) -> f64 {
        0.5 * self.gap_across + row as f64 * self.pitches()[1]
    }

    /// Returns the tangent frame at the arc length `x`, in mm, from the left end of the membrane.
    fn frame(&self, x: f64) -> Frame {
        self.body.frame((x - 0.5 * self.membrane_size()[0]) / self.thickness)
    }

    /// Converts a point of a tangent frame, in units of the thickness, to a position in mm.
    fn placed(&self, frame: &Frame, point: Vec2) -> [f64; 2] {
        ((frame.origin + frame.outward(point)) * self.thickness).into()
    }

    /// Returns a point on the upper face of the membrane, and the point below it on the lower face.
    ///
    /// `along` is the coordinate along the tangent, in units of the thickness. The two points lie
    /// on one radius of the body.
    fn rung(&self, frame: &Frame, along: f64) -> [[f64; 2]; 2] {
        let upper = Vec2::new(along, 0.0);
        let outwards = Vec2::new(along * self.body.curvature, 1.0).normalize();
        let lower = upper - outwards * (self.membrane / self.thickness);
        [upper, lower].map(|point| self.placed(frame, point))
    }
}

/// Returns true if two convex polygons neither touch nor overlap.
///
/// In this case an edge of one polygon separates the polygons.
fn are_apart(one: &[Vec2; 4], other: &[Vec2; 4]) -> bool {
    [(one, other), (other, one)].into_iter().any(|(polygon, points)| {
        (0..4).any(|k| {
            let edge = polygon[(k + 1) % 4] - polygon[k];
            // Corners are counter-clockwise, so the right side of an edge is outside.
            points.iter().all(|point| edge.perp(&(point - polygon[k])) < 0.0)
        })
    })
}

impl Solids {
    /// Returns all solids, the scales first.
    pub fn all(&self) -> impl Iterator<Item = &Prism> {
        self.scales.iter().chain(&self.membrane)
    }

    /// Moves all solids in `x` and `z`, so that the lowest corner of the bounding box is the
    /// origin.
    fn move_to_origin(&mut self) {
        let corners = self.all().flat_map(|prism| &prism.outline);
        let lowest = corners
            .fold([f64::INFINITY; 2], |lowest, at| [lowest[0].min(at[0]), lowest[1].min(at[1])]);
        for prism in self.membrane.iter_mut().chain(&mut self.scales) {
            for at in &mut prism.outline {
                *at = [at[0] - lowest[0], at[1] - lowest[1]];
            }
        }
    }
}

impl Prism {
    /// Returns the corners: first the face at the smaller `y`, then the opposite face.
    pub fn corners(&self) -> Vec<[f64; 3]> {
        let mut corners = Vec::new();
        for y in self.across {
            corners.extend(self.outline.iter().map(|[x, z]| [*x, y, *z]));
        }
        corners
    }

    /// Returns the plane faces as corner indices, counter-clockwise seen from outside.
    pub fn faces(&self) -> Vec<[usize; 4]> {
        let n = self.outline.len();
        let mut faces = Vec::new();
        for k in 0..n / 2 - 1 {
            faces.push([k, k + 1, n - 2 - k, n - 1 - k]);
        }
        for k in 0..n / 2 - 1 {
            faces.push([n + n - 1 - k, n + n - 2 - k, n + k + 1, n + k]);
        }
        for k in 0..n {
            let next = (k + 1) % n;
            faces.push([k, n + k, n + next, next]);
        }
        faces
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use geometry::Parallelogram;

    use super::*;

    /// Creates a patch of 5 by 4 scales of 60° with a thickness of 2 mm and a base of 1.6 mm.
    pub fn patch() -> Patch {
        let row = Row::new(Parallelogram::new(0.4, 60.0).expect("a valid scale"), 0.3)
            .expect("a valid row");
        Patch::new(row, 2.0, [3.0, 0.25, 0.6], [5, 4]).expect("a valid patch")
    }

    #[test]
    fn scales_lie_on_the_membrane_at_their_pitch() {
        let patch = patch();
        let scales = patch.solids().scales;
        assert_eq!(scales.len(), 20);
        let [first, second, sixth] = [&scales[0], &scales[1], &scales[5]];
        assert_eq!(first.outline[0], [0.6, 0.25], "one gap from the rim, on the membrane");
        assert!((second.outline[0][0] - first.outline[0][0] - 2.2).abs() < 1e-12);
        assert!((second.outline[0][0] - first.outline[1][0] - 0.6).abs() < 1e-12, "the gap along");
        assert!((sixth.across[0] - first.across[1] - 0.6).abs() < 1e-12, "the gap across");
        let [length, width, _] = patch.membrane_size();
        assert!((length - scales[19].outline[1][0] - 0.6).abs() < 1e-12);
        assert!((width - scales[19].across[1] - 0.6).abs() < 1e-12);
    }

    #[test]
    fn every_second_row_of_a_brick_laid_patch_is_shifted_by_half_a_pitch() {
        let patch = patch().brick_laid();
        let corners: Vec<_> = patch.base_corners().collect();
        let half = patch.pitches()[0] / 2.0;
        assert!((corners[5][0] - corners[0][0] - half).abs() < 1e-12);
        assert_eq!(corners[10][0], corners[0][0]);
        let end = corners[9][0] + patch.base();
        assert!((patch.membrane_size()[0] - end - 0.6).abs() < 1e-12, "one gap from the rim");
    }

    /// Returns patches on a convex body of radius 10 mm and on a concave body of radius 40 mm.
    fn curved() -> [Patch; 2] {
        [10.0, -40.0]
            .map(|radius| patch().on_body(Body { curvature: 2.0 / radius }).expect("a valid patch"))
    }

    #[test]
    fn scales_on_a_curved_body_are_aligned_with_its_normals() {
        for patch in curved() {
            let radius = patch.radius().expect("a curved patch");
            let solids = patch.solids();
            let nodes: Vec<_> = solids.scales[..5]
                .iter()
                .map(|scale| [0, 1].map(|k| 0.5 * (scale.outline[0][k] + scale.outline[1][k])))
                .collect();
            // The third of five scales is in the middle, where the normal is vertical.
            let [_, _, top, next, _] = nodes[..] else { panic!("{nodes:?}") };
            let centre = [top[0], top[1] - radius];
            for (node, scale) in nodes.iter().zip(&solids.scales) {
                let normal = [node[0] - centre[0], node[1] - centre[1]];
                assert!((normal[0].hypot(normal[1]) - radius.abs()).abs() < 1e-12);
                let [from, to] = [scale.outline[0], scale.outline[1]];
                let along = (to[0] - from[0]) * normal[0] + (to[1] - from[1]) * normal[1];
                assert!(along.abs() < 1e-12, "the base lies along the tangent");
            }
            // Nodes have equal distances along the arc; the chord of a pitch is 2 R sin(p/2R).
            let chord = 2.0 * radius * (patch.pitches()[0] / (2.0 * radius)).sin();
            assert!(((next[0] - top[0]).hypot(next[1] - top[1]) - chord).abs() < 1e-12);
        }
    }

    #[test]
    fn the_clearance_on_a_curved_body_equals_the_gap_of_the_contact_model() {
        use contact::{CornerEdge, Pair, Pose};
        use geometry::polygon_distance;
        for patch in curved() {
            let frame = patch.body.frame(patch.row.pitch());
            let pair = Pair::between([*patch.row.scale(); 2], frame.origin);
            let (left, right) = (Pose::new(0.0, 0.0, 0.0), Pose::new(0.0, 0.0, -frame.angle));
            let sides = [CornerEdge::TopRightOnLeftEdge, CornerEdge::BottomLeftOnRightEdge];
            let gaps = sides.map(|of| pair.gap(of, &left, &right));
            let on_edge = gaps.iter().filter(|gap| (0.0..=1.0).contains(&gap.foot));
            let least = on_edge.map(|gap| gap.value).fold(f64::INFINITY, f64::min);
            assert!((patch.clearance() / (2.0 * least) - 1.0).abs() < 1e-12, "{least}");
            // The outlines of two neighbouring solids have the same distance.
            let solids = patch.solids();
            let [left, right] = [1, 2].map(|k| -> [Vec2; 4] {
                std::array::from_fn(|c| Vec2::from(solids.scales[k].outline[c]))
            });
            let written = polygon_distance(&left, &right);
            assert!((written / patch.clearance() - 1.0).abs() < 1e-12, "{written}");
        }
    }

    #[test]
    fn bases_on_a_curved_body_coincide_with_the_membrane() {
        for patch in curved().map(Patch::brick_laid) {
            let solids = patch.solids();
            assert_eq!(solids.membrane.len(), 4, "one strip per row");
            for (row, strip) in solids.scales.chunks(5).zip(&solids.membrane) {
                let n = strip.outline.len();
                for corner in row.iter().flat_map(|scale| &scale.outline[..2]) {
                    let k = strip.outline.iter().position(|at| at == corner).expect("a corner");
                    let [x, z] = strip.outline[n - 1 - k];
                    assert!(((x - corner[0]).hypot(z - corner[1]) - 0.25).abs() < 1e-12);
                }
            }
            for pair in solids.membrane.windows(2) {
                assert_eq!(pair[0].across[1], pair[1].across[0]);
            }
        }
    }

    #[test]
    fn a_nearly_flat_body_gives_the_flat_patch() {
        let nearly = patch().on_body(Body { curvature: 1e-9 }).expect("a valid patch").solids();
        let flat = patch().solids();
        let lowest = flat.all().flat_map(|p| &p.outline).fold(f64::INFINITY, |x, at| x.min(at[0]));
        assert_eq!(lowest, 0.0);
        for (one, other) in nearly.scales.iter().zip(&flat.scales) {
            for (a, b) in one.outline.iter().zip(&other.outline) {
                assert!((a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-6, "{a:?} {b:?}");
            }
        }
        assert_eq!(nearly.membrane[0].across, flat.membrane[0].across);
    }

    #[test]
    fn patches_that_do_not_fit_a_body_are_refused() {
        let [convex, concave] = [1.8, -4.0]
            .map(|radius| patch().on_body(Body { curvature: 2.0 / radius }).unwrap_err());
        // The length is five pitches of 2.2 mm and a gap of 0.6 mm.
        assert!(
            matches!(convex, PatchError::Circumference(length, _) if (length - 11.6).abs() < 1e-9)
        );
        assert!(matches!(concave, PatchError::Overlap(_)));
        let thick = Patch { membrane: 3.0, ..patch() };
        let refused = thick.on_body(Body { curvature: 2.0 / 2.5 }).unwrap_err();
        assert_eq!(refused, PatchError::Membrane(3.0, 2.5));
    }

    #[test]
    fn lengths_and_counts_out_of_range_are_refused() {
        let row = patch().row;
        let refused = |lengths, scales| Patch::new(row, 2.0, lengths, scales).unwrap_err();
        assert_eq!(
            refused([3.0, 0.0, 0.6], [5, 4]),
            PatchError::Length("the thickness of the membrane", 0.0)
        );
        assert_eq!(refused([3.0, 0.2, 0.6], [0, 4]), PatchError::Scales(0, 4));
        assert_eq!(refused([3.0, 0.2, 0.6], [usize::MAX, 2]), PatchError::Scales(usize::MAX, 2));
    }
}
