//! How fast the places of a mesh move with the footprint.

use super::{GradedAxis, Grading, Mesh};
use crate::Footprint;
use crate::boundary_element::FootprintChange;

/// Rates of the edges and of the points of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisMotion {
    /// Of the edges.
    pub edges: Vec<f64>,
    /// Of the points.
    pub points: Vec<f64>,
}

/// Rates of the places of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshMotion {
    /// Of the axes along `x`, the middle rectangle's first.
    pub across: Vec<AxisMotion>,
    /// Of the axis along `z`.
    pub depth: AxisMotion,
}

/// Rates of the ends of a graded interval and of its two layers.
#[derive(Clone, Copy)]
struct GradingChange {
    ends: [f64; 2],
    layers: [f64; 2],
}

/// Lengths that are equal to this part count as equal.
const TIED: f64 = 3e-5;

/// Whether two lengths are equal, or nearly.
fn are_tied(a: f64, b: f64) -> bool {
    (a - b).abs() <= TIED * a
}

/// The smaller of two lengths with its rate, on the side to which they change: of two equal ones the smaller rate.
fn smaller([a, a_rate]: [f64; 2], [b, b_rate]: [f64; 2]) -> [f64; 2] {
    let rate = match (are_tied(a, b), a < b) {
        (true, _) => a_rate.min(b_rate),
        (false, true) => a_rate,
        (false, false) => b_rate,
    };
    [a.min(b), rate]
}

impl Footprint {
    /// Whether lengths that grade the mesh are equal: where one takes the place of another as the smaller, the numerical
    /// reactions have a kink.
    pub fn is_tied(&self) -> bool {
        let [gap, width] = [self.gap_over_a(), self.width_over_a()];
        are_tied(width, 2.0) || are_tied(gap, width.min(2.0))
    }
}

impl Mesh {
    /// The motion of the mesh where its footprint changes: the derivatives of the places that (S4) gives. Where two of the lengths
    /// that grade it are equal they are those of the side to which the change leads.
    pub fn motion(&self, footprint: &Footprint, change: &FootprintChange) -> MeshMotion {
        let FootprintChange { gap_over_a: gap, width_over_a: width, .. } = *change;
        let free = smaller([footprint.width_over_a(), width], [2.0, 0.0]);
        let [_, facing] = smaller([footprint.gap_over_a(), gap], free);
        let [_, free] = free;
        let count = self.neighbours.len();
        let neighbour = |(k, axis): (usize, &GradedAxis)| {
            let outer = if k + 1 == count { free } else { facing };
            let ends = [(k + 1) as f64 * gap; 2];
            axis.motion(GradingChange { ends, layers: [facing, outer] })
        };
        let middle = GradingChange { ends: [0.0; 2], layers: [facing; 2] };
        let depth = GradingChange { ends: [-0.5 * width, 0.5 * width], layers: [free; 2] };
        let neighbours = self.neighbours.iter().enumerate().map(neighbour);
        MeshMotion {
            across: [self.middle.motion(middle)].into_iter().chain(neighbours).collect(),
            depth: self.depth.motion(depth),
        }
    }

    /// The mesh whose places have moved for so long.
    pub(crate) fn moved(&self, motion: &MeshMotion, by: f64) -> Self {
        let mut across = motion.across.iter();
        let mut moved = |axis: &GradedAxis| {
            across.next().map_or_else(|| axis.clone(), |motion| axis.moved(motion, by))
        };
        Self {
            middle: moved(&self.middle),
            neighbours: self.neighbours.iter().map(moved).collect(),
            depth: self.depth.moved(&motion.depth, by),
        }
    }
}

impl GradedAxis {
    fn motion(&self, change: GradingChange) -> AxisMotion {
        let cells = self.cells() as f64;
        let rate = |(place, k): (&f64, f64)| {
            let t = self.start + (1.0 - self.start) * k / cells;
            self.grading.rate(*place, t, change)
        };
        let edges = self.edges.iter().zip((0..).map(f64::from));
        let points = self.points.iter().zip((0..).map(|k| f64::from(k) + 0.5));
        AxisMotion { edges: edges.map(rate).collect(), points: points.map(rate).collect() }
    }

    fn moved(&self, motion: &AxisMotion, by: f64) -> Self {
        let moved = |places: &[f64], rates: &[f64]| {
            places.iter().zip(rates).map(|(place, rate)| place + by * rate).collect()
        };
        Self {
            edges: moved(&self.edges, &motion.edges),
            points: moved(&self.points, &motion.points),
            ..self.clone()
        }
    }
}

impl Grading {
    /// How fast the point at the fraction `t` of the range of `U` moves: with `s` the place in the interval of the length `l`, and the
    /// steepness `k₁`, `k₂` at its ends, `U(θ) = 2 asinh(k₁ sin ½θ) − 2 asinh(k₂ cos ½θ)` keeps its part of the range.
    fn rate(&self, place: f64, t: f64, change: GradingChange) -> f64 {
        let [low, high] = self.ends;
        let length = high - low;
        let sin = ((place - low) / length).max(0.0).sqrt();
        let cos = ((high - place) / length).max(0.0).sqrt();
        let stretch = change.ends[1] - change.ends[0];
        let steeper = |end: usize| {
            let layer = length / self.steepness[end].powi(2);
            0.5 * self.steepness[end] * (stretch / length - change.layers[end] / layer)
        };
        let steeper = [steeper(0), steeper(1)];
        // dU/dk at each end, for the sine or the cosine there.
        let by = |end: usize, part: f64| part / (self.steepness[end] * part).hypot(1.0);
        let range = t * by(0, 1.0) * steeper[0] - (1.0 - t) * by(1, 1.0) * steeper[1];
        let here = by(0, sin) * steeper[0] - by(1, cos) * steeper[1];
        let by_half_angle = self.steepness[0] * cos / (self.steepness[0] * sin).hypot(1.0)
            + self.steepness[1] * sin / (self.steepness[1] * cos).hypot(1.0);
        // U, its parts and its range are twice these numbers, and θ is twice the half angle.
        let turn = 2.0 * (range - here) / by_half_angle;
        change.ends[0] + stretch * sin * sin + length * sin * cos * turn
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both sides of a change, by differences of meshes.
    fn check(gap: f64, width: f64, change: FootprintChange) {
        let footprint = Footprint::new(gap, width, 0.4).unwrap();
        let mesh = |by: f64| {
            let (gap, width) = (gap + by * change.gap_over_a, width + by * change.width_over_a);
            Mesh::row(&Footprint::new(gap, width, 0.4).unwrap(), 2, 5)
        };
        let step = 1e-5 * gap.min(width);
        let places = |mesh: &Mesh| -> Vec<f64> {
            let axes = [&mesh.middle, &mesh.depth].into_iter().chain(&mesh.neighbours);
            axes.flat_map(|axis| axis.edges.iter().chain(&axis.points).copied()).collect()
        };
        let motion = mesh(0.0).motion(&footprint, &change);
        let [h0, h1, h2] = [0.0, step, 2.0 * step].map(|by| places(&mesh(by)));
        let exact = places(&mesh(0.0).moved(&motion, 1.0));
        for i in 0..h0.len() {
            let difference = (-1.5 * h0[i] + 2.0 * h1[i] - 0.5 * h2[i]) / step;
            let rate = exact[i] - h0[i];
            assert!((rate - difference).abs() < 1e-8, "{gap} {width} {i}: {rate} {difference}");
        }
    }

    #[test]
    fn places_move_as_differences_of_meshes_say() {
        let change = |gap_over_a, width_over_a| FootprintChange {
            gap_over_a,
            width_over_a,
            poisson_ratio: 0.0,
        };
        for (gap, width) in
            [(0.2, 1.7), (0.5, 3.1), (4.0, 0.6), (1.3, 40.0), (2.0, 2.0), (0.8, 0.8)]
        {
            for change in [change(1.0, 0.0), change(0.0, 1.0), change(-0.3, -0.7)] {
                check(gap, width, change);
            }
        }
    }
}
