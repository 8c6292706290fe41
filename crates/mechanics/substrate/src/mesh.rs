//! Cells of a rectangle, graded towards its edges, where the tractions are singular.
//!
//! Under a rigid rectangle the traction grows like `s^(−1/2)` with decreasing distance `s` from an
//! edge. If another rectangle lies beyond a gap `ε`, this holds only for `s` below about `ε`, and
//! the traction grows like `1/s` at larger distances. Cells that have equal widths in
//!
//! ```text
//! U(s) = ∫ ds/√(s (s + ε)) = 2 asinh √(s/ε)      (S4)
//! ```
//!
//! from both edges therefore carry approximately equal loads. Cell widths decrease quadratically
//! towards an edge, as with Chebyshev points, and geometrically at distances between a small `ε`
//! and the length of the side.

use std::f64::consts::PI;

use crate::Footprint;

/// Cells along one side of a rectangle: their edges, and one collocation point in each.
#[derive(Clone, Debug, PartialEq)]
pub struct GradedAxis {
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl GradedAxis {
    /// Creates `cells` cells on the interval between `ends`.
    ///
    /// `layers` holds the length `ε` of (S4) at each end, to which the cells are graded.
    pub fn graded(ends: [f64; 2], layers: [f64; 2], cells: usize) -> Self {
        Self::between(&Grading::new(ends, layers), 0.0, cells)
    }

    /// Creates `cells` cells on `0..half_length`: the upper half of an axis graded at both ends.
    pub fn upper_half(half_length: f64, layer: f64, cells: usize) -> Self {
        let grading = Grading::new([-half_length, half_length], [layer; 2]);
        let mut axis = Self::between(&grading, 0.5, cells);
        // Sets the edge on the symmetry plane to exactly 0.
        axis.edges[0] = 0.0;
        axis
    }

    /// Creates cells on the part of the graded interval beyond the fraction `start` of the range of
    /// `U`.
    ///
    /// Collocation points lie at the middle of a cell in `U`, as in cosine-spaced vortex lattices.
    /// Points at the middle of the length of a cell would give an error ten times as large, of
    /// second order only.
    fn between(grading: &Grading, start: f64, cells: usize) -> Self {
        let [edges, points] = [(0.0, cells + 1), (0.5, cells)].map(|(shift, count)| {
            let fractions = (0..count).map(|k| (1.0 - start) * (k as f64 + shift) / cells as f64);
            fractions.map(|fraction| grading.at(start + fraction)).collect()
        });
        Self { edges, points }
    }

    /// Returns the edges of the cells in ascending order, one more than there are cells.
    pub fn edges(&self) -> &[f64] {
        &self.edges
    }

    /// Returns the collocation points, one in each cell.
    pub fn points(&self) -> &[f64] {
        &self.points
    }

    /// Returns the number of cells.
    pub fn cells(&self) -> usize {
        self.points.len()
    }

    /// Returns the width of cell `k`.
    pub fn width(&self, k: usize) -> f64 {
        self.edges[k + 1] - self.edges[k]
    }

    /// Returns the middle of cell `k`, where the resultant of its uniform traction acts.
    pub fn middle(&self, k: usize) -> f64 {
        f64::midpoint(self.edges[k], self.edges[k + 1])
    }

    /// Returns the edges of this axis and of its mirror image below 0.
    ///
    /// The edges ascend and contain 0 once. If this axis is an upper half, they are the whole axis.
    pub fn mirrored_edges(&self) -> impl Iterator<Item = f64> + Clone + '_ {
        self.edges.iter().skip(1).rev().map(|e| -e).chain(self.edges.iter().copied())
    }
}

/// Mesh of a quarter of a row with an odd number of equal rectangles, lengths in units of `a`.
///
/// Symmetry reduces the row to the half `x > 0` of the middle rectangle and to its right
/// neighbours, and all rectangles to their half `z > 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Cells of the middle rectangle along `x`, from its centre to its right edge.
    pub middle: GradedAxis,
    /// Cells of the neighbours on the right along `x`, the nearest neighbour first.
    pub neighbours: Vec<GradedAxis>,
    /// Cells of all rectangles along `z`, from the centre line to the edge.
    pub depth: GradedAxis,
}

impl Mesh {
    /// Creates the mesh of a row with `neighbours` rectangles on each side of the middle one.
    ///
    /// Along `x`, half the middle rectangle and each neighbour have `n` cells. Half the depth also
    /// has `n` cells.
    pub fn row(footprint: &Footprint, neighbours: usize, n: usize) -> Self {
        let (gap, width) = (footprint.gap_over_a(), footprint.width_over_a());
        // An edge without a neighbour is graded over the smaller side length of the rectangle.
        let free = width.min(2.0);
        let facing = gap.min(free);
        let neighbours = (1..=neighbours).map(|k| {
            let before = (k - 1) as f64 * footprint.pitch_over_a();
            // No rectangle faces the outer edge of the last neighbour.
            let outer = if k == neighbours { free } else { facing };
            GradedAxis::graded([1.0 + gap + before, 3.0 + gap + before], [facing, outer], n)
        });
        Self {
            middle: GradedAxis::upper_half(1.0, facing, n),
            neighbours: neighbours.collect(),
            depth: GradedAxis::upper_half(0.5 * width, free, n),
        }
    }

    /// Returns true if all gaps and cells have a positive width after rounding.
    pub fn is_resolved(&self) -> bool {
        let along: Vec<f64> = self.axes_along_x().flat_map(GradedAxis::edges).copied().collect();
        [along.as_slice(), &self.depth.edges]
            .into_iter()
            .all(|edges| edges.is_sorted_by(|a, b| a < b))
    }
}

/// Map from `0..1` to an interval, linear in `U` of (S4) added from both ends.
struct Grading {
    ends: [f64; 2],
    /// `√(length/ε)` at the two ends of the interval.
    steepness: [f64; 2],
}

impl Grading {
    fn new(ends: [f64; 2], layers: [f64; 2]) -> Self {
        Self { ends, steepness: layers.map(|layer| ((ends[1] - ends[0]) / layer).sqrt()) }
    }

    /// Returns the point at the fraction `t` of the range of `U`.
    ///
    /// Solves for the angle `θ` of `s = length · sin²(θ/2)`, because `U` is smooth in `θ`. Uses
    /// Newton's method with bisection as a safeguard.
    fn at(&self, t: f64) -> f64 {
        if t <= 0.0 || t >= 1.0 {
            return if t <= 0.0 { self.ends[0] } else { self.ends[1] };
        }
        let target = self.mapped(0.0).0 * (1.0 - t) + self.mapped(PI).0 * t;
        let (mut low, mut high, mut angle) = (0.0, PI, PI * t);
        for _ in 0..MAX_ITERATIONS {
            let (value, slope) = self.mapped(angle);
            *(if value < target { &mut low } else { &mut high }) = angle;
            let step = angle - (value - target) / slope;
            // Bisect if the step leaves the bracket.
            let next = if step > low && step < high { step } else { f64::midpoint(low, high) };
            // Tolerance relative to the angle from the nearer end: `position` measures from that
            // end, and the smallest cells lie there.
            let settled = (next - angle).abs() <= 4.0 * f64::EPSILON * angle.min(PI - angle);
            angle = next;
            if settled {
                break;
            }
        }
        self.position(angle)
    }

    /// Returns `U` and `dU/dθ` at the angle `θ`.
    fn mapped(&self, angle: f64) -> (f64, f64) {
        let (sin, cos) = (0.5 * angle).sin_cos();
        let [lower, upper] = [self.steepness[0] * sin, self.steepness[1] * cos];
        let slope = self.steepness[0] * cos / (1.0 + lower * lower).sqrt()
            + self.steepness[1] * sin / (1.0 + upper * upper).sqrt();
        (2.0 * (lower.asinh() - upper.asinh()), slope)
    }

    /// Returns the point at an angle `θ`, as the nearer end plus or minus the distance from it.
    ///
    /// This keeps the relative accuracy of small cells.
    fn position(&self, angle: f64) -> f64 {
        let [low, high] = self.ends;
        let (sin, cos) = (0.5 * angle).sin_cos();
        if sin < cos { low + (high - low) * sin * sin } else { high - (high - low) * cos * cos }
    }
}

/// Maximum number of iterations, approximately as many as bisection alone would need.
///
/// Newton's method needs four to eight iterations.
const MAX_ITERATIONS: usize = 60;
