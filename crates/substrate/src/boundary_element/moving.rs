//! The influence of cells that move.

use std::f64::consts::PI;

use faer::{ColRef, Mat};
use pulp::{Arch, NullaryFnOnce};

use super::Tractions;
use crate::half_space::{CornerLine, LANES, ln_or_zero};
use crate::mesh::{Mesh, MeshMotion};

/// The motion of a mesh, and of Poisson's ratio with it.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub(super) mesh: MeshMotion,
    pub(super) poisson_ratio: f64,
}

impl Motion {
    /// Rates of the corners of a line, from mirror image to mirror image.
    fn corners(&self) -> Vec<f64> {
        let edges = &self.mesh.depth.edges;
        let mirrored = edges.iter().skip(1).rev().map(|rate| -rate);
        mirrored.chain(edges.iter().copied()).collect()
    }
}

/// The logarithms of all lines of corners as each field point sees them, kept from the assembly of (S5): those on the right of each
/// rectangle and then their mirror images, rectangle by rectangle.
#[derive(Debug)]
pub(super) struct SeenLines {
    /// Numbers of a line: logarithms for the offset `X`, for `Z`, and zeros that fill the last block of these.
    stride: usize,
    numbers: Vec<f64>,
}

impl SeenLines {
    /// Nothing yet, with room for what a mesh sees.
    pub(super) fn of(mesh: &Mesh) -> Self {
        let corners = 2 * mesh.depth.cells() + 1;
        let stride = corners + corners.next_multiple_of(CORNERS);
        let lines: usize = mesh.across().map(|axis| 2 * axis.edges().len()).sum();
        Self { stride, numbers: Vec::with_capacity(mesh.unknowns() * lines * stride) }
    }

    /// Adds a line.
    pub(super) fn push(&mut self, logarithms: &[f64]) {
        let end = self.numbers.len() + self.stride;
        self.numbers.extend_from_slice(logarithms);
        self.numbers.resize(end, 0.0);
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
/// whose inverse hyperbolic sines are those of the functions (S3) themselves, which the assembly of (S5) has `seen`. A corner belongs to
/// four cells and to their mirror images: its weight is the second difference of their tractions, the same for every field point. So a
/// line of corners is looked at once for all motions and problems, and the influence of a single cell is never formed.
pub(super) fn products(
    mesh: &Mesh,
    poisson_ratio: f64,
    motions: &[Motion],
    tractions: &Tractions,
    seen: &SeenLines,
) -> Vec<Tractions> {
    let mut moving = Moving::new(mesh, poisson_ratio, motions, tractions);
    let mut products: Vec<_> = motions.iter().map(|_| tractions.zeros()).collect();
    let (points, depth) = (moving.points.len(), mesh.depth.cells());
    let views = seen.numbers.chunks_exact(seen.stride * moving.lines.len());
    for (view, seen) in views.enumerate() {
        let (k, i) = (view / points, view % points);
        if i == 0 {
            moving.look_from(k);
        }
        let sums = moving.sums(i, seen);
        for (motion, product) in products.iter_mut().enumerate() {
            let rates = sums.iter().skip(motion).step_by(motions.len());
            product.set_row(i * depth + k, rates.map(|sum| sum.iter().sum::<f64>() / PI));
        }
    }
    products
}

impl Tractions {
    /// These without the columns of displaced neighbours.
    pub(super) fn without_moments(mut self) -> Self {
        self.rotation.resize_with(self.rotation.nrows(), 1, |_, _| 0.0);
        self
    }

    /// As many columns of zeros.
    pub(super) fn zeros(&self) -> Self {
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

/// Numbers of as many corners as a vector takes.
type Lanes = [f64; LANES];

/// Vectors in a block: those of a line of the finest mesh that springs are solved on, a number that the compiler knows.
const VECTORS: usize = 5;

/// Numbers of a block of corners.
type Block = [Lanes; VECTORS];

/// Corners of a block.
const CORNERS: usize = VECTORS * LANES;

/// Weights of the corners of a line, filled up with zeros to whole blocks.
struct LineWeights {
    weights: Vec<Block>,
    /// Weights times the rates of the corners along `z`, for each motion; none where these rest.
    moved: Vec<Vec<Block>>,
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

    /// The lines of corners in the order in which the assembly sees them.
    fn line_places(&self, motions: &[Motion]) -> Vec<LinePlace> {
        let (mut lines, mut before) = (Vec::new(), 0);
        for (body, axis) in self.across().enumerate() {
            for is_image in [false, true] {
                let side = if is_image { -1.0 } else { 1.0 };
                lines.extend(axis.edges().iter().enumerate().map(|(k, edge)| {
                    let rates = motions.iter().map(|m| side * m.mesh.across[body].edges[k]);
                    LinePlace {
                        number: before + k,
                        x: side * edge,
                        is_image,
                        rates: rates.collect(),
                    }
                }));
            }
            before += axis.edges().len();
        }
        lines
    }

    /// The field points at one depth.
    fn point_places(&self, motions: &[Motion]) -> Vec<PointPlace> {
        let across = self.across().enumerate();
        let places = across.flat_map(|(body, axis)| {
            axis.points().iter().enumerate().map(move |(k, &x)| {
                let rates = motions.iter().map(|m| m.mesh.across[body].points[k]);
                PointPlace { x, rates: rates.collect() }
            })
        });
        places.collect()
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
            if rests { Vec::new() } else { filled(&products.collect::<Vec<_>>()) }
        });
        Self { moved: moved.collect(), weights: filled(&weights) }
    }
}

/// The numbers and as many zeros as fill the last block.
fn filled(numbers: &[f64]) -> Vec<Block> {
    let block = |numbers: &[f64]| {
        let mut block = [[0.0; LANES]; VECTORS];
        block.as_flattened_mut()[..numbers.len()].copy_from_slice(numbers);
        block
    };
    numbers.chunks(CORNERS).map(block).collect()
}

/// The place of a line of corners along `x`, or of its mirror image on the left.
struct LinePlace {
    /// Which of the lines it is; a mirror image has the number of its line.
    number: usize,
    x: f64,
    is_image: bool,
    /// Rates of `x` in each motion.
    rates: Vec<f64>,
}

/// The place of a field point along `x`.
struct PointPlace {
    x: f64,
    /// Rates of `x` in each motion.
    rates: Vec<f64>,
}

/// Contributions of a block of corners, differentiated with respect to `X`, `Z`, `κ` (S15).
#[derive(Clone, Copy, Default)]
struct CornerSlopes {
    normal_by_x: Block,
    normal_by_z: Block,
    shear_by_x: Block,
    shear_by_z: Block,
    /// `B`.
    shear_by_softness: Block,
}

/// A line of corners, seen from one field point.
struct Line {
    corners: usize,
    /// `Z` and `ln|Z|` of each corner.
    z: Vec<Block>,
    ln: Vec<Block>,
    slopes: Vec<CornerSlopes>,
}

impl Line {
    /// Looks at the line at the offset `x`, of which the logarithms are known.
    #[expect(clippy::inline_always, reason = "only what is inlined is compiled for wide vectors")]
    #[inline(always)]
    fn look(&mut self, x: f64, softness: f64, seen: &[f64]) {
        let ln_x = ln_or_zero(x);
        // Corners that fill the last block see the numbers of others, and have no weight.
        let across = seen.as_chunks::<CORNERS>().0;
        let along = seen[self.corners..].as_chunks::<CORNERS>().0;
        let numbers = across.iter().zip(along).zip(self.z.iter().zip(&self.ln));
        for (slopes, ((across, along), (z, ln))) in self.slopes.iter_mut().zip(numbers) {
            let views = across.as_chunks().0.iter().zip(along.as_chunks().0);
            for (vector, (across, along)) in views.enumerate() {
                let view = [across, along, &z[vector], &ln[vector]];
                slopes.look(vector, [x, ln_x, softness], view);
            }
        }
    }
}

impl CornerSlopes {
    /// Looks at the corners of a vector.
    #[expect(clippy::inline_always, reason = "only what is inlined is compiled for wide vectors")]
    #[inline(always)]
    fn look(
        &mut self,
        vector: usize,
        [x, ln_x, softness]: [f64; 3],
        [across, along, z, ln]: [&Lanes; 4],
    ) {
        for lane in 0..LANES {
            let across = (across[lane] - ln_x).copysign(z[lane]);
            let along = (along[lane] - ln[lane]).copysign(x);
            let inverse = (x * x + z[lane] * z[lane]).sqrt().recip();
            self.normal_by_x[vector][lane] = across;
            self.normal_by_z[vector][lane] = along;
            self.shear_by_x[vector][lane] = across + softness * (z[lane] * inverse);
            self.shear_by_z[vector][lane] = along + softness * (along - x * inverse);
            self.shear_by_softness[vector][lane] = z[lane] * along;
        }
    }
}

/// The rates of the influence of all tractions on one field point after the other.
struct Moving<'a> {
    mesh: &'a Mesh,
    motions: &'a [Motion],
    points: Vec<PointPlace>,
    lines: Vec<LinePlace>,
    weights: Vec<Weights>,
    line: Line,
    /// `κ`, and its rate in each motion.
    softness: f64,
    softer: Vec<f64>,
    /// Rates of the depth of the field point in each motion.
    deeper: Vec<f64>,
    arch: Arch,
    /// The rates of the influences, of each column for all motions, in parts that add up.
    sums: Vec<Lanes>,
}

impl<'a> Moving<'a> {
    fn new(
        mesh: &'a Mesh,
        poisson_ratio: f64,
        motions: &'a [Motion],
        tractions: &Tractions,
    ) -> Self {
        let corners = 2 * mesh.depth.cells() + 1;
        let slopes = vec![CornerSlopes::default(); corners.div_ceil(CORNERS)];
        let weights = tractions.weights(mesh, motions);
        let by_ratio = (1.0 - poisson_ratio).powi(-2);
        Self {
            mesh,
            motions,
            points: mesh.point_places(motions),
            lines: mesh.line_places(motions),
            line: Line { corners, z: Vec::new(), ln: Vec::new(), slopes },
            softness: poisson_ratio / (1.0 - poisson_ratio),
            softer: motions.iter().map(|motion| by_ratio * motion.poisson_ratio).collect(),
            deeper: Vec::new(),
            arch: Arch::new(),
            sums: vec![[0.0; LANES]; weights.len() * motions.len()],
            weights,
        }
    }

    /// Takes the depth of point `k` for that of the field points.
    fn look_from(&mut self, k: usize) {
        let depth = &self.mesh.depth;
        let corners = CornerLine::new(depth.mirrored_edges(), depth.points()[k]);
        let [z, ln] = corners.depths();
        (self.line.z, self.line.ln) = (filled(z), filled(ln));
        self.deeper = self.motions.iter().map(|motion| motion.mesh.depth.points[k]).collect();
    }

    /// The sums over all lines of corners, and over their mirror images on the left, as the field point `i` has `seen` them.
    fn sums(&mut self, i: usize, seen: &[f64]) -> &[Lanes] {
        self.sums.fill([0.0; LANES]);
        let arch = self.arch;
        arch.dispatch(AddLines { point: i, seen, to: self });
        &self.sums
    }
}

/// Adds the lines of corners that a field point has seen to its sums.
struct AddLines<'m, 'a> {
    point: usize,
    seen: &'m [f64],
    to: &'m mut Moving<'a>,
}

impl NullaryFnOnce for AddLines<'_, '_> {
    type Output = ();

    #[expect(clippy::inline_always, reason = "only what is inlined is compiled for wide vectors")]
    #[inline(always)]
    fn call(self) {
        let Moving { points, lines, weights, line, softness, softer, deeper, sums, .. } = self.to;
        let point = &points[self.point];
        let seen = self.seen.chunks_exact(self.seen.len() / lines.len());
        for (place, seen) in lines.iter().zip(seen) {
            line.look(place.x - point.x, *softness, seen);
            let columns = weights.iter().zip(sums.chunks_mut(softer.len()));
            for (column, sums) in columns {
                column.add_line(place, &line.slopes, [&point.rates, deeper, softer], sums);
            }
        }
    }
}

impl Weights {
    /// Adds a line to the sums of this column, with the rates of `X`, `Z` and `κ` at the field point in each motion.
    #[expect(clippy::inline_always, reason = "only what is inlined is compiled for wide vectors")]
    #[inline(always)]
    fn add_line<'s>(
        &self,
        place: &LinePlace,
        slopes: &'s [CornerSlopes],
        [across, deeper, softer]: [&[f64]; 3],
        sums: &mut [Lanes],
    ) {
        let LineWeights { weights, moved } = &self.lines[place.number];
        let is_shear = self.is_shear;
        let along_z = |s: &'s CornerSlopes| if is_shear { &s.shear_by_z } else { &s.normal_by_z };
        let by_x = dot(weights, slopes, |s| if is_shear { &s.shear_by_x } else { &s.normal_by_x });
        let by_depth = dot(weights, slopes, along_z);
        let by_softness =
            if is_shear { dot(weights, slopes, |s| &s.shear_by_softness) } else { [0.0; LANES] };
        let factor = if place.is_image { self.image } else { 1.0 };
        for (motion, (sum, moved)) in sums.iter_mut().zip(moved).enumerate() {
            let x = place.rates[motion] - across[motion];
            let (depth, softness) = (deeper[motion], softer[motion]);
            let by_z = dot(moved, slopes, along_z);
            for lane in 0..LANES {
                let by_z = by_z[lane] - depth * by_depth[lane];
                sum[lane] += factor * (x * by_x[lane] + by_z + softness * by_softness[lane]);
            }
        }
    }
}

/// The scalar product of weights and numbers of the corners, in parts that add up.
#[expect(clippy::inline_always, reason = "only what is inlined is compiled for wide vectors")]
#[inline(always)]
fn dot<'s>(
    weights: &[Block],
    slopes: &'s [CornerSlopes],
    of: impl Fn(&'s CornerSlopes) -> &'s Block,
) -> Lanes {
    let mut sums = [0.0; LANES];
    for (weights, slopes) in weights.iter().zip(slopes) {
        for (weights, slopes) in weights.iter().zip(of(slopes)) {
            for lane in 0..LANES {
                sums[lane] += weights[lane] * slopes[lane];
            }
        }
    }
    sums
}
