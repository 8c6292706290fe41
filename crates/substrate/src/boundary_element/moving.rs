//! The influence of cells that move.

use faer::Mat;

use super::{Tractions, append_cells};
use crate::Footprint;
use crate::half_space::{CornerLine, Influence};
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

    /// Rates of the corners of a line, seen from the depth of point `k`.
    fn corners(&self, k: usize) -> Vec<f64> {
        let Some(depth) = &self.depth else { return Vec::new() };
        let mirrored = depth.edges.iter().skip(1).rev().map(|rate| -rate);
        mirrored.chain(depth.edges.iter().copied()).map(|rate| rate - depth.points[k]).collect()
    }

    fn points(&self) -> Vec<f64> {
        self.across.iter().flat_map(|axis| axis.points.iter().copied()).collect()
    }
}

/// Returns `dG p` of the three problems for each motion.
///
/// A corner at the offset `(X, Z)` that moves by `(dX, dZ)` changes its functions (S3) by
///
/// ```text
/// dA = asinh(Z/|X|) dX + w,   dB = asinh(X/|Z|) dZ − w,   w = (X dZ − Z dX)/r           (S15)
/// ```
///
/// whose inverse hyperbolic sines are those of the functions themselves: one evaluation serves every motion.
pub(super) fn products(
    mesh: &Mesh,
    footprint: &Footprint,
    motions: &[Motion],
    tractions: &Tractions,
) -> Vec<Tractions> {
    let mut moving = Moving::new(mesh, footprint.poisson_ratio(), motions, tractions);
    let fields: Vec<f64> = mesh.across().flat_map(GradedAxis::points).copied().collect();
    for k in 0..mesh.depth.cells() {
        moving.look_from(k);
        for (i, &x) in fields.iter().enumerate() {
            moving.evaluate(i, x);
            moving.add_row(i * mesh.depth.cells() + k);
        }
    }
    moving.products
}

/// Influences on a field point: of the cells on the right and of their mirror images on the left.
type Sides = [Vec<Influence>; 2];

/// The rates of all influences on one field point after the other.
struct Moving<'a> {
    mesh: &'a Mesh,
    poisson_ratio: f64,
    motions: &'a [Motion],
    tractions: &'a Tractions,
    /// Rates of the points along `x`, for each motion.
    points: Vec<Vec<f64>>,
    line: CornerLine,
    /// Offset of the last line from the field point, and of its corners.
    x: f64,
    z: Vec<f64>,
    /// Rates of the corners of the line, for each motion.
    corners: Vec<Vec<f64>>,
    /// Corner functions of the last two lines, and their rates for each motion.
    lines: [Vec<Influence>; 2],
    line_rates: Vec<[Vec<Influence>; 2]>,
    at_rest: Sides,
    rates: Vec<Sides>,
    products: Vec<Tractions>,
}

impl<'a> Moving<'a> {
    fn new(
        mesh: &'a Mesh,
        poisson_ratio: f64,
        motions: &'a [Motion],
        tractions: &'a Tractions,
    ) -> Self {
        let zero = |of: &Mat<f64>| Mat::zeros(of.nrows(), of.ncols());
        let none = || Tractions {
            shear: zero(&tractions.shear),
            normal: zero(&tractions.normal),
            rotation: zero(&tractions.rotation),
        };
        let blank = || vec![Influence::default(); 2 * mesh.depth.cells() + 1];
        Self {
            mesh,
            poisson_ratio,
            motions,
            tractions,
            points: motions.iter().map(Motion::points).collect(),
            line: CornerLine::new([], 0.0),
            x: 0.0,
            z: Vec::new(),
            corners: Vec::new(),
            lines: [blank(), blank()],
            line_rates: motions.iter().map(|_| [blank(), blank()]).collect(),
            at_rest: Sides::default(),
            rates: motions.iter().map(|_| Sides::default()).collect(),
            products: motions.iter().map(|_| none()).collect(),
        }
    }

    /// Takes the depth of point `k` for that of the field points.
    fn look_from(&mut self, k: usize) {
        let z = self.mesh.depth.points()[k];
        self.line = CornerLine::new(self.mesh.depth.mirrored_edges(), z);
        self.z = self.mesh.depth.mirrored_edges().map(|edge| edge - z).collect();
        self.corners = self.motions.iter().map(|motion| motion.corners(k)).collect();
    }

    /// Evaluates the influences on the field point `i`, at `x`, and their rates.
    fn evaluate(&mut self, i: usize, x: f64) {
        self.at_rest.iter_mut().for_each(Vec::clear);
        self.rates.iter_mut().flatten().for_each(Vec::clear);
        for (body, axis) in self.mesh.across().enumerate() {
            for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
                for (column, edge) in axis.edges().iter().enumerate() {
                    self.next_line(sign * edge - x);
                    for motion in 0..self.motions.len() {
                        let edge = self.motions[motion].across[body].edges[column];
                        self.move_line(motion, sign * edge - self.points[motion][i]);
                    }
                    if column > 0 {
                        self.append(side);
                    }
                }
            }
        }
    }

    fn next_line(&mut self, offset: f64) {
        self.x = offset;
        self.lines.swap(0, 1);
        self.line.evaluate(offset, &mut self.lines[1]);
        self.line_rates.iter_mut().for_each(|lines| lines.swap(0, 1));
    }

    /// The rates (S15) of the last line, which moves by `dx` against the field point.
    fn move_line(&mut self, motion: usize, dx: f64) {
        let (x, rates) = (self.x, self.line_rates[motion][1].iter_mut());
        let corners = self.lines[1].iter().zip(&self.z).zip(&self.corners[motion]);
        for (rate, ((corner, &z), &dz)) in rates.zip(corners) {
            let turn = (x * dz - z * dx) / (x * x + z * z).sqrt();
            rate.across = corner.across / x * dx + turn;
            rate.along = corner.along / z * dz - turn;
        }
    }

    fn append(&mut self, side: usize) {
        append_cells(&self.lines[0], &self.lines[1], &mut self.at_rest[side]);
        for ([last, next], rates) in self.line_rates.iter().zip(&mut self.rates) {
            append_cells(last, next, &mut rates[side]);
        }
    }

    /// Adds the influences on a field point, times the tractions, to the products.
    fn add_row(&mut self, row: usize) {
        let Tractions { shear, normal, rotation } = self.tractions;
        let [right, left] = &self.at_rest;
        let motions = self.motions.iter().zip(&self.rates).zip(&mut self.products);
        for ((motion, [right_rate, left_rate]), product) in motions {
            let with_ratio = motion.poisson_ratio / (1.0 - self.poisson_ratio);
            for column in 0..right.len() {
                let even = right_rate[column] - left_rate[column];
                let odd = (right_rate[column] + left_rate[column]).normal();
                // ∂/∂ν of 1/(1 − ν) is its square.
                let along = with_ratio * (right[column] - left[column]).along;
                let stiffer = Influence { across: 0.0, along };
                let tangential = (even + stiffer).tangential(self.poisson_ratio);
                product.shear[(row, 0)] += tangential * shear[(column, 0)];
                product.normal[(row, 0)] += even.normal() * normal[(column, 0)];
                for load in 0..rotation.ncols() {
                    product.rotation[(row, load)] += odd * rotation[(column, load)];
                }
            }
        }
    }
}
