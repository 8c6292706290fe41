//! The influence of cells that move.

use std::f64::consts::PI;

use faer::{ColRef, Mat};
use pulp::{Arch, NullaryFnOnce};

use super::Tractions;
use crate::Footprint;
use crate::half_space::{CornerLine, LANES};
use crate::mesh::{GradedAxis, Mesh};

/// Rates of the edges and of the points of an axis.
#[derive(Clone, Debug)]
struct AxisMotion {
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl AxisMotion {
    fn at_rest(axis: &GradedAxis) -> Self {
        Self { edges: vec![0.0; axis.edges().len()], points: vec![0.0; axis.cells()] }
    }

    fn add(&mut self, axis: &GradedAxis, weight: f64) {
        let add = |rates: &mut [f64], places: &[f64]| {
            rates.iter_mut().zip(places).for_each(|(rate, place)| *rate += weight * place);
        };
        add(&mut self.edges, axis.edges());
        add(&mut self.points, axis.points());
    }
}

/// The motion of a mesh, and of Poisson's ratio with it.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    /// Of the axes along `x`, the middle rectangle's first.
    across: Vec<AxisMotion>,
    depth: Option<AxisMotion>,
    poisson_ratio: f64,
}

impl Motion {
    /// A motion of `mesh` that does not move it yet.
    pub(super) fn of(mesh: &Mesh, poisson_ratio: f64) -> Self {
        let across = mesh.across().map(AxisMotion::at_rest).collect();
        Self { across, depth: Some(AxisMotion::at_rest(&mesh.depth)), poisson_ratio }
    }

    /// Adds the places of a mesh to the rates.
    pub(super) fn add(&mut self, mesh: &Mesh, weight: f64) {
        let axes = self.across.iter_mut().zip(mesh.across());
        axes.for_each(|(motion, axis)| motion.add(axis, weight));
        if let Some(depth) = &mut self.depth {
            depth.add(&mesh.depth, weight);
        }
    }

    /// Rates of the corners of a line, from mirror image to mirror image.
    fn corners(&self) -> Vec<f64> {
        let Some(depth) = &self.depth else { return Vec::new() };
        let mirrored = depth.edges.iter().skip(1).rev().map(|rate| -rate);
        mirrored.chain(depth.edges.iter().copied()).collect()
    }
}

/// Returns `dG p` of the three problems for each motion.
///
/// With `κ = ν/(1 − ν)`, or 0 for normal tractions, a corner at the offset `(X, Z)` counts by `A + (1 + κ) B` (S1, S2), and
/// where it moves by `(dX, dZ)` that changes by
///
/// ```text
/// (asinh(Z/|X|) + κ Z/r) dX + (asinh(X/|Z|) + κ (asinh(X/|Z|) − X/r)) dZ + B dκ                (S15)
/// ```
///
/// whose inverse hyperbolic sines are those of the functions (S3) themselves. A corner belongs to four cells and to their mirror
/// images: its weight is the second difference of their tractions, the same for every field point. So a line of corners is
/// evaluated once for all motions and problems, and the influence of a single cell is never formed.
pub(super) fn products(
    mesh: &Mesh,
    footprint: &Footprint,
    motions: &[Motion],
    tractions: &Tractions,
) -> Vec<Tractions> {
    let mut moving = Moving::new(mesh, footprint.poisson_ratio(), motions, tractions);
    let mut products: Vec<_> = motions.iter().map(|_| tractions.zeros()).collect();
    let fields: Vec<f64> = mesh.across().flat_map(GradedAxis::points).copied().collect();
    let depth = mesh.depth.cells();
    for k in 0..depth {
        moving.look_from(k);
        for (i, &x) in fields.iter().enumerate() {
            let sums = moving.sums(i, x);
            for (motion, product) in products.iter_mut().enumerate() {
                let rates = sums.iter().skip(motion).step_by(motions.len());
                product.set_row(i * depth + k, rates.map(|sum| sum / PI));
            }
        }
    }
    products
}

impl Tractions {
    /// As many columns of zeros.
    fn zeros(&self) -> Self {
        let zeros = |of: &Mat<f64>| Mat::zeros(of.nrows(), of.ncols());
        let Self { shear, normal, rotation } = self;
        Self { shear: zeros(shear), normal: zeros(normal), rotation: zeros(rotation) }
    }

    /// Sets a row of all columns.
    fn set_row(&mut self, row: usize, mut numbers: impl Iterator<Item = f64>) {
        for matrix in [&mut self.shear, &mut self.normal, &mut self.rotation] {
            for column in 0..matrix.ncols() {
                matrix[(row, column)] = numbers.next().unwrap_or_default();
            }
        }
    }

    /// Every column as weights of corners.
    fn weights(&self, mesh: &Mesh, motions: &[Motion]) -> Vec<Weights> {
        let Self { shear, normal, rotation } = self;
        let problems =
            [(shear, true, -1.0), (normal, false, -1.0), (rotation, false, 1.0)].into_iter();
        let columns = problems.flat_map(|(matrix, is_shear, image)| {
            let lines = |column: ColRef<'_, f64>| mesh.line_weights(column, motions);
            matrix.col_iter().map(move |column| Weights { is_shear, image, lines: lines(column) })
        });
        columns.collect()
    }
}

/// A column of tractions as weights of corners.
struct Weights {
    is_shear: bool,
    /// How much the mirror image in `x` counts. Its corners descend, which turns the sign.
    image: f64,
    /// The lines of corners, those of the middle rectangle first.
    lines: Vec<LineWeights>,
}

/// Weights of the corners of a line, filled up with zeros to whole vectors.
struct LineWeights {
    weights: Vec<f64>,
    /// Weights times the rates of the corners along `z`, for each motion; none where these rest.
    moved: Vec<Vec<f64>>,
}

impl Mesh {
    /// A column of tractions as weights of the corners of each line.
    fn line_weights(&self, column: ColRef<'_, f64>, motions: &[Motion]) -> Vec<LineWeights> {
        let depth = self.depth.cells();
        let corners: Vec<_> = motions.iter().map(Motion::corners).collect();
        let (mut lines, mut first) = (Vec::new(), 0);
        for axis in self.across() {
            let cells = axis.cells();
            // No cells lie before the first line of a rectangle and behind its last one.
            let traction = |x: usize, k: usize| match x.checked_sub(1) {
                Some(x) if x < cells => column[first + x * depth + k],
                _ => 0.0,
            };
            let decrease = |line, k| traction(line, k) - traction(line + 1, k);
            let decreases =
                (0..=cells).map(|line| (0..depth).map(|k| decrease(line, k)).collect::<Vec<_>>());
            lines.extend(decreases.map(|decrease| LineWeights::new(&decrease, &corners)));
            first += cells * depth;
        }
        lines
    }
}

impl LineWeights {
    /// The weights of the corners of a line across which the tractions of the cells, the innermost first, decrease by `decrease`.
    fn new(decrease: &[f64], corners: &[Vec<f64>]) -> Self {
        let outer = decrease.iter().skip(1).chain([&0.0]);
        let outwards: Vec<_> =
            decrease.iter().zip(outer).map(|(inner, outer)| inner - outer).collect();
        // On the centre line a cell and its mirror image share their corner, and nothing is left.
        let mirrored = outwards.iter().rev().map(|weight| -weight).chain([0.0]);
        let weights: Vec<_> = mirrored.chain(outwards.iter().copied()).collect();
        let moved = corners.iter().map(|rates| {
            let products = weights.iter().zip(rates).map(|(weight, rate)| weight * rate);
            let rests = rates.iter().all(|&rate| rate == 0.0);
            if rests { Vec::new() } else { filled(products.collect()) }
        });
        Self { moved: moved.collect(), weights: filled(weights) }
    }
}

/// The numbers and as many zeros as fill the last vector.
fn filled(mut numbers: Vec<f64>) -> Vec<f64> {
    numbers.resize(numbers.len().next_multiple_of(LANES), 0.0);
    numbers
}

/// Contributions of the corners of a line, differentiated with respect to `X`, `Z` (S15).
struct Slopes {
    by_x: Vec<f64>,
    by_z: Vec<f64>,
}

impl Slopes {
    fn new(corners: usize) -> Self {
        Self { by_x: filled(vec![0.0; corners]), by_z: filled(vec![0.0; corners]) }
    }
}

/// A line of corners, seen from one field point.
struct Line {
    corners: CornerLine,
    normal: Slopes,
    shear: Slopes,
    /// `B`, the derivative with respect to `κ`.
    by_softness: Vec<f64>,
}

impl Line {
    /// Looks at the line at the offset `x`.
    fn look(&mut self, x: f64, softness: f64) {
        let Self { corners, normal, shear, by_softness } = self;
        let normal = normal.by_x.iter_mut().zip(&mut normal.by_z);
        let shear = shear.by_x.iter_mut().zip(&mut shear.by_z);
        let numbers = normal.zip(shear).zip(by_softness);
        for (angles, ((normal, shear), by_softness)) in corners.angles(x).zip(numbers) {
            let inverse = (x * x + angles.z * angles.z).sqrt().recip();
            (*normal.0, *normal.1) = (angles.across, angles.along);
            *shear.0 = angles.across + softness * (angles.z * inverse);
            *shear.1 = angles.along + softness * (angles.along - x * inverse);
            *by_softness = angles.z * angles.along;
        }
    }
}

/// How a line moves against the field point in one motion.
struct LineRate {
    /// Rate of the offset `X`.
    x: f64,
    /// Rate of the depth of the field point.
    depth: f64,
    /// Rate of `κ`.
    softness: f64,
}

/// The rates of the influence of all tractions on one field point after the other.
struct Moving<'a> {
    mesh: &'a Mesh,
    poisson_ratio: f64,
    motions: &'a [Motion],
    weights: Vec<Weights>,
    line: Line,
    arch: Arch,
    rates: Vec<LineRate>,
    /// The rates of the influences, of each column for all motions.
    sums: Vec<f64>,
    /// Which point of the depth is looked from.
    depth: usize,
}

impl<'a> Moving<'a> {
    fn new(
        mesh: &'a Mesh,
        poisson_ratio: f64,
        motions: &'a [Motion],
        tractions: &Tractions,
    ) -> Self {
        let corners = 2 * mesh.depth.cells() + 1;
        let line = Line {
            corners: CornerLine::new([], 0.0),
            normal: Slopes::new(corners),
            shear: Slopes::new(corners),
            by_softness: filled(vec![0.0; corners]),
        };
        let weights = tractions.weights(mesh, motions);
        let sums = vec![0.0; weights.len() * motions.len()];
        let rates = Vec::with_capacity(motions.len());
        let arch = Arch::new();
        Self { mesh, poisson_ratio, motions, weights, line, arch, rates, sums, depth: 0 }
    }

    /// Takes the depth of point `k` for that of the field points.
    fn look_from(&mut self, k: usize) {
        self.depth = k;
        let depth = &self.mesh.depth;
        self.line.corners = CornerLine::new(depth.mirrored_edges(), depth.points()[k]);
    }

    /// The sums over all lines of corners, and over their mirror images on the left, seen from the field point `i`, at `x`.
    fn sums(&mut self, i: usize, x: f64) -> &[f64] {
        self.sums.fill(0.0);
        let mesh = self.mesh;
        let edges = mesh.across().enumerate().flat_map(|(body, axis)| {
            axis.edges().iter().enumerate().map(move |(column, edge)| (body, column, edge))
        });
        for (number, (body, column, edge)) in edges.enumerate() {
            for is_image in [false, true] {
                let side = if is_image { -1.0 } else { 1.0 };
                self.set_rates(i, side, [body, column]);
                self.arch.dispatch(AddLine {
                    x: side * edge - x,
                    softness: self.poisson_ratio / (1.0 - self.poisson_ratio),
                    line: &mut self.line,
                    weights: &self.weights,
                    rates: &self.rates,
                    number,
                    is_image,
                    sums: &mut self.sums,
                });
            }
        }
        &self.sums
    }

    /// Sets the rates at which the line at an edge of a rectangle, or its image, moves against the field point `i`.
    fn set_rates(&mut self, i: usize, side: f64, [body, column]: [usize; 2]) {
        self.rates.clear();
        let cells = self.mesh.depth.cells();
        self.rates.extend(self.motions.iter().map(|motion| {
            let points = &motion.across[i / cells].points;
            let depth = motion.depth.as_ref().map_or(0.0, |depth| depth.points[self.depth]);
            let softness = motion.poisson_ratio / (1.0 - self.poisson_ratio).powi(2);
            let x = side * motion.across[body].edges[column] - points[i % cells];
            LineRate { x, depth, softness }
        }));
    }
}

/// Adds a line of corners at the offset `x` to the sums.
struct AddLine<'a> {
    x: f64,
    softness: f64,
    line: &'a mut Line,
    weights: &'a [Weights],
    rates: &'a [LineRate],
    number: usize,
    is_image: bool,
    sums: &'a mut [f64],
}

impl NullaryFnOnce for AddLine<'_> {
    type Output = ();

    #[expect(clippy::inline_always, reason = "only what is inlined is compiled for wide vectors")]
    #[inline(always)]
    fn call(self) {
        self.line.look(self.x, self.softness);
        let Line { normal, shear, by_softness, .. } = &*self.line;
        let columns = self.weights.iter().zip(self.sums.chunks_mut(self.rates.len()));
        for (column, sums) in columns {
            let slopes = if column.is_shear { shear } else { normal };
            let LineWeights { weights, moved } = &column.lines[self.number];
            let by_x = dot(weights, &slopes.by_x);
            let by_depth = dot(weights, &slopes.by_z);
            let by_softness = if column.is_shear { dot(weights, by_softness) } else { 0.0 };
            let factor = if self.is_image { column.image } else { 1.0 };
            for ((sum, rate), moved) in sums.iter_mut().zip(self.rates).zip(moved) {
                let by_z = dot(moved, &slopes.by_z) - rate.depth * by_depth;
                *sum += factor * (rate.x * by_x + by_z + rate.softness * by_softness);
            }
        }
    }
}

/// The scalar product of numbers that fill whole vectors.
#[expect(clippy::inline_always, reason = "only what is inlined is compiled for wide vectors")]
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    for (a, b) in a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum()
}
