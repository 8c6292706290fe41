//! Cutting-plane model; its best step solves a linear program, by SLSQP.

use std::convert::Infallible;

use basin::{
    BoxBounds, ConstraintDescription, ConstraintSet, Constraints, CostFunction, DenseMatrix,
    Executor, Gradient, LinearBlock, LinearBlocks, NoLinearBlock, NoNonlinearConstraints,
    SelectedFirstOrderState, Slsqp, State as _,
};

/// Weight of the linear cost against the quadratic term with which SLSQP starts.
const WEIGHT: f64 = 1e3;

/// Margin of steps to limits, so that residual curvature does not violate them.
const MARGIN: f64 = 1e-10;

/// Maximum iterations for the linear program.
const ITERATIONS: u64 = 20;

/// Value with gradient; the gradient is `None` at a kink.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub value: f64,
    pub gradient: Option<Vec<f64>>,
}

/// Function to which a tangent belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// The cost, or the excess over limits while the centre is infeasible.
    Cost,
    /// A limit.
    Limit,
}

/// Cutting-plane model around a centre: constraints `slope·u ≤ right + s` on the step `u`.
///
/// `u` is relative to the trust radius.
pub(super) struct Model<'c> {
    centre: &'c [f64],
    radius: f64,
    /// Cost or excess at the centre.
    worst: f64,
    cuts: Vec<(Cut, Vec<f64>, f64)>,
}

impl<'c> Model<'c> {
    pub fn new(centre: &'c [f64], radius: f64, worst: f64) -> Self {
        Self { centre, radius, worst, cuts: Vec::new() }
    }

    /// Adds the tangent of a function at `point`.
    ///
    /// It is limited to the value `here` of the function at the centre.
    pub fn add(&mut self, cut: Cut, piece: &Piece, here: f64, point: &[f64]) {
        let Some(gradient) = &piece.gradient else { return };
        let along =
            gradient.iter().zip(self.centre.iter().zip(point)).map(|(g, (x, y))| g * (x - y));
        // For a non-convex function the tangent may exceed the value at the centre, and exclude the
        // centre.
        let value = (piece.value + along.sum::<f64>()).min(here);
        // An undefined value gives an infinite excess, which no tangent describes.
        if !(value.is_finite() && self.worst.is_finite()) {
            return;
        }
        let right = match cut {
            Cut::Cost => self.worst - value,
            // Not below 0: a zero step must remain feasible, also on a limit.
            Cut::Limit => (-MARGIN - value).max(0.0),
        };
        self.push(cut, gradient, right);
    }

    /// Adds the constraint `gradient·d ≤ right + s` on the step `d`, without `s` for a limit.
    pub fn push(&mut self, cut: Cut, gradient: &[f64], right: f64) {
        let slope = gradient.iter().map(|g| g * self.radius).collect();
        self.cuts.push((cut, slope, right));
    }

    /// Returns the end of the best step, and the gain predicted by the tangents.
    pub fn step(&self) -> Option<(Vec<f64>, f64)> {
        let scale = self.costs().map(|(_, slope, _)| absolute_sum(slope)).fold(0.0, f64::max);
        // All tangents are flat, so no step predicts a gain.
        if scale <= 0.0 {
            return None;
        }
        let step = self.solve(scale)?;
        let rises = self.costs().map(|(_, slope, right)| {
            slope.iter().zip(&step).map(|(g, u)| g * u).sum::<f64>() - right
        });
        // Computed from the tangents, because the last variable of the linear program is scaled and
        // only as accurate as its solver.
        let gain = -rises.fold(f64::NEG_INFINITY, f64::max);
        let moved =
            self.centre.iter().zip(&step).map(|(x, u)| (x + self.radius * u).clamp(0.0, 1.0));
        Some((moved.collect(), gain))
    }

    fn costs(&self) -> impl Iterator<Item = &(Cut, Vec<f64>, f64)> {
        self.cuts.iter().filter(|(cut, ..)| *cut == Cut::Cost)
    }

    fn solve(&self, scale: f64) -> Option<Vec<f64>> {
        let n = self.centre.len();
        let mut rows = Vec::new();
        let mut right = Vec::new();
        for (cut, slope, limit) in &self.cuts {
            // Tangents of the cost need a common scale to keep their order; limits can be scaled
            // individually.
            let size = match cut {
                Cut::Cost => scale,
                Cut::Limit => absolute_sum(slope),
            };
            if size > 0.0 {
                rows.extend(slope.iter().map(|x| x / size));
                rows.push(if *cut == Cut::Cost { -1.0 } else { 0.0 });
                right.push(limit / size);
            }
        }
        // Bounds of the cube in radii, where they are nearer than the border of the ball.
        let ends = self
            .centre
            .iter()
            .map(|x| [(-x / self.radius).max(-1.0), ((1.0 - x) / self.radius).min(1.0)]);
        let ends: Vec<[f64; 2]> = ends.collect();
        let program = LinearProgram {
            rows: DenseMatrix::from_row_slice(right.len(), n + 1, &rows),
            right,
            lower: ends.iter().map(|e| e[0]).chain([-2.0]).collect(),
            upper: ends.iter().map(|e| e[1]).chain([2.0]).collect(),
        };
        let start = SelectedFirstOrderState::new(vec![0.0; n + 1]);
        let solver = Slsqp::new().with_absolute_accuracy_tolerance(1e-9);
        let solved = Executor::new(program, solver, start).max_iter(ITERATIONS).run().ok()?;
        let step = solved.state.param()[..n].to_vec();
        step.iter().all(|u| u.is_finite()).then_some(step)
    }
}

fn absolute_sum(slope: &[f64]) -> f64 {
    slope.iter().map(|x| x.abs()).sum()
}

/// Linear program: minimise the last coordinate under rows and bounds.
struct LinearProgram {
    rows: DenseMatrix,
    right: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl CostFunction for LinearProgram {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;

    fn cost(&self, x: &Vec<f64>) -> Result<f64, Infallible> {
        Ok(WEIGHT * x[x.len() - 1])
    }
}

impl Gradient for LinearProgram {
    type Gradient = Vec<f64>;

    fn gradient(&self, x: &Vec<f64>) -> Result<Vec<f64>, Infallible> {
        let mut gradient = vec![0.0; x.len()];
        gradient[x.len() - 1] = WEIGHT;
        Ok(gradient)
    }
}

impl Constraints for LinearProgram {
    type Set = ConstraintSet<
        BoxBounds<Vec<f64>>,
        LinearBlocks<NoLinearBlock, LinearBlock<DenseMatrix, Vec<f64>>>,
        NoNonlinearConstraints,
    >;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new()
            .with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
            .with_linear_inequalities(LinearBlock::new(&self.rows, &self.right))
    }
}
