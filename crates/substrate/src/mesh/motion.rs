//! How fast the places of a mesh move with the footprint.

use super::{GradedAxis, Grading, Mesh};
use crate::Footprint;

/// Rates of the lengths over `a` that make a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeshChange {
    /// Of the gap.
    pub gap: f64,
    /// Of the width.
    pub width: f64,
    /// Of the layers at free edges, which grade the mesh there: the smaller of width and base.
    pub free: f64,
    /// Of the layers at edges that face another base: the smaller of the gap and the layers at free edges.
    pub facing: f64,
}

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
    /// The change of the mesh where gap and width have these rates. Where two of the lengths that grade it are equal the smaller rate is
    /// that of the side to which the change leads, so that the numerical reactions have a kink there.
    pub fn mesh_change(&self, gap: f64, width: f64) -> MeshChange {
        let free = smaller([self.width_over_a(), width], [2.0, 0.0]);
        let [_, facing] = smaller([self.gap_over_a(), gap], free);
        MeshChange { gap, width, free: free[1], facing }
    }

    /// The rate of the length that changes fastest, as a part of itself.
    pub(crate) fn fastest(&self, change: &MeshChange) -> f64 {
        let MeshChange { gap, width, free, facing } = *change;
        let at_free = self.width_over_a().min(2.0);
        let at_facing = self.gap_over_a().min(at_free);
        let rates = [gap / self.gap_over_a(), width / self.width_over_a(), free / at_free];
        rates.into_iter().fold((facing / at_facing).abs(), |most, rate| most.max(rate.abs()))
    }
}

impl Mesh {
    /// The motion of the mesh where the lengths that make it change: the derivatives of the places that (S4) gives.
    pub fn motion(&self, change: &MeshChange) -> MeshMotion {
        let MeshChange { gap, width, free, facing } = *change;
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
    fn check(gap: f64, width: f64, [gap_rate, width_rate]: [f64; 2]) {
        let footprint = Footprint::new(gap, width, 0.4).unwrap();
        let mesh = |by: f64| {
            let (gap, width) = (gap + by * gap_rate, width + by * width_rate);
            Mesh::row(&Footprint::new(gap, width, 0.4).unwrap(), 2, 5)
        };
        let step = 1e-5 * gap.min(width);
        let places = |mesh: &Mesh| -> Vec<f64> {
            let axes = [&mesh.middle, &mesh.depth].into_iter().chain(&mesh.neighbours);
            axes.flat_map(|axis| axis.edges.iter().chain(&axis.points).copied()).collect()
        };
        let motion = mesh(0.0).motion(&footprint.mesh_change(gap_rate, width_rate));
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
        for (gap, width) in
            [(0.2, 1.7), (0.5, 3.1), (4.0, 0.6), (1.3, 40.0), (2.0, 2.0), (0.8, 0.8)]
        {
            for change in [[1.0, 0.0], [0.0, 1.0], [-0.3, -0.7]] {
                check(gap, width, change);
            }
        }
    }
}
