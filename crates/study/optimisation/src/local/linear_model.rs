//! Cutting-plane model. The best step is the solution of a linear program.

use std::convert::Infallible;

use basin::{
    BoxBounds, ConstraintDescription, ConstraintSet, Constraints, CostFunction, DenseMatrix,
    Executor, Gradient, LinearBlock, LinearBlocks, NoLinearBlock, NoNonlinearConstraints,
    SelectedFirstOrderState, Slsqp, State as _,
};

/// Weight of the linear cost relative to the quadratic term of the first SLSQP iteration.
const WEIGHT: f64 = 1e3;

/// Margin to a limit at which steps end, so that a small curvature does not violate the limit.
const MARGIN: f64 = 1e-10;

/// Maximum number of SLSQP iterations for the linear program.
const ITERATIONS: u64 = 20;

/// Value and gradient of a function at a point. The gradient is `None` at a kink.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub value: f64,
    pub gradient: Option<Vec<f64>>,
}

/// Kind of function to which a tangent belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// The function to minimise: the cost, or the excess over a limit if the centre is infeasible.
    Cost,
    /// The excess over a limit, which must not exceed 0.
    Limit,
}

/// Cutting-plane model around a centre.
///
/// The model contains constraints `slope·u ≤ right + s` on the step `u`, which is divided by the
/// trust radius. `s` is the cost relative to the centre; constraints of limits do not contain `s`.
pub(super) struct Model<'c> {
    centre: &'c [f64],
    radius: f64,
    /// Cost or largest excess at the centre.
    worst: f64,
    /// Kind, `slope` and `right` of each constraint.
    cuts: Vec<(Cut, Vec<f64>, f64)>,
}

impl<'c> Model<'c> {
    /// Creates a model without constraints.
    ///
    /// `worst` is the cost, or the largest excess, at the centre.
    pub fn new(centre: &'c [f64], radius: f64, worst: f64) -> Self {
        Self { centre, radius, worst, cuts: Vec::new() }
    }

    /// Adds the tangent at `point` of a function with the value `here` at the centre.
    ///
    /// `piece` is value and gradient of the function at `point`. A tangent above `here` at the
    /// centre is lowered to `here`.
    pub fn add(&mut self, cut: Cut, piece: &Piece, here: f64, point: &[f64]) {
        let Some(gradient) = &piece.gradient else { return };
        let along =
            gradient.iter().zip(self.centre.iter().zip(point)).map(|(g, (x, y))| g * (x - y));
        // A tangent of a non-convex function may exceed the function at the centre. Without `min`
        // the tangent would then exclude the centre.
        let value = (piece.value + along.sum::<f64>()).min(here);
        // Skip infinite values: the excess is infinite if a value is undefined.
        if !(value.is_finite() && self.worst.is_finite()) {
            return;
        }
        let right = match cut {
            Cut::Cost => self.worst - value,
            // At least 0, so that a step of length 0 remains feasible if the centre is on a limit.
            Cut::Limit => (-MARGIN - value).max(0.0),
        };
        self.push(cut, gradient, right);
    }

    /// Adds the constraint `gradient·d ≤ right + s` on the step `d`; without `s` for a limit.
    pub fn push(&mut self, cut: Cut, gradient: &[f64], right: f64) {
        let slope = gradient.iter().map(|g| g * self.radius).collect();
        self.cuts.push((cut, slope, right));
    }

    /// Returns the end point of the best step, and the gain that the tangents predict.
    ///
    /// `None` if all tangents of the cost are flat, or the linear program has no solution.
    pub fn step(&self) -> Option<(Vec<f64>, f64)> {
        let scale = self.costs().map(|(_, slope, _)| absolute_sum(slope)).fold(0.0, f64::max);
        if scale <= 0.0 {
            return None;
        }
        let step = self.solve(scale)?;
        let rises = self.costs().map(|(_, slope, right)| {
            slope.iter().zip(&step).map(|(g, u)| g * u).sum::<f64>() - right
        });
        // Compute the gain from the tangents. The last variable of the linear program also states
        // it, but less accurately.
        let gain = -rises.fold(f64::NEG_INFINITY, f64::max);
        let moved =
            self.centre.iter().zip(&step).map(|(x, u)| (x + self.radius * u).clamp(0.0, 1.0));
        Some((moved.collect(), gain))
    }

    /// Returns the tangents of the cost.
    fn costs(&self) -> impl Iterator<Item = &(Cut, Vec<f64>, f64)> {
        self.cuts.iter().filter(|(cut, ..)| *cut == Cut::Cost)
    }

    /// Solves the linear program, and returns the step divided by the radius.
    ///
    /// Tangents of the cost are divided by `scale`.
    fn solve(&self, scale: f64) -> Option<Vec<f64>> {
        let n = self.centre.len();
        let mut rows = Vec::new();
        let mut right = Vec::new();
        for (cut, slope, limit) in &self.cuts {
            // Tangents of the cost need a common scale, because the largest of them counts. Limits
            // can be scaled individually.
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
        // Ends of each coordinate of the step: the border of the ball, or the face of the cube if
        // it is nearer.
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

/// Returns the sum of the absolute values.
fn absolute_sum(slope: &[f64]) -> f64 {
    slope.iter().map(|x| x.abs()).sum()
}

/// Linear program: minimise the last coordinate of `x` under `rows·x ≤ right` and bounds on `x`.
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
