//! Tests of the bundle method on textbook problems of nonsmooth optimisation with known minima.
//!
//! Sources: Mäkelä & Neittaanmäki, *Nonsmooth optimization* (1992), and Lewis & Overton 2013 (doi
//! 10.1007/s10107-012-0514-2) for Rosenbrock's nonsmooth valley.

use std::cell::RefCell;
use std::convert::Infallible;

use super::{BundleOptions, Piece, Pieces, PiecewiseSmooth, descend};

/// A smooth function with its gradient.
type Smooth = fn(&[f64]) -> (f64, Vec<f64>);

/// Problem over a cube: cost and limits are each the maximum of smooth functions.
struct Textbook {
    /// Lower end of each coordinate.
    from: f64,
    /// Upper end of each coordinate.
    to: f64,
    cost: Vec<Smooth>,
    limits: Vec<Vec<Smooth>>,
    best: RefCell<Best>,
}

/// Best evaluated feasible point, and the smallest excess of all evaluated points.
#[derive(Clone, Debug)]
struct Best {
    cost: f64,
    excess: f64,
    x: Vec<f64>,
}

impl Textbook {
    fn new([from, to]: [f64; 2], cost: &[Smooth], limits: &[&[Smooth]]) -> Self {
        let limits = limits.iter().map(|limit| limit.to_vec()).collect();
        let best = Best { cost: f64::INFINITY, excess: f64::INFINITY, x: Vec::new() };
        Self { from, to, cost: cost.to_vec(), limits, best: RefCell::new(best) }
    }

    /// Returns the maximum of `functions` at `x`, with its gradient; without gradient at a kink.
    fn largest(&self, functions: &[Smooth], x: &[f64]) -> Piece {
        let length = self.to - self.from;
        let values: Vec<(f64, Vec<f64>)> = functions.iter().map(|smooth| smooth(x)).collect();
        let (value, gradient) =
            values.iter().max_by(|a, b| a.0.total_cmp(&b.0)).expect("a function");
        let at_kink = values.iter().filter(|other| value - other.0 < 1e-9).count() > 1;
        let gradient = (!at_kink).then(|| gradient.iter().map(|g| g * length).collect());
        Piece { value: *value, gradient }
    }

    /// Runs the bundle method from `start` with at most `points` evaluations.
    ///
    /// Returns the best evaluated point.
    fn minimum(&self, start: &[f64], points: usize) -> Best {
        let start = start.iter().map(|x| (x - self.from) / (self.to - self.from));
        let start: Vec<f64> = start.collect();
        let options = BundleOptions { reach: 0.06, smallest: 1e-8, points };
        let Ok(()) = descend(self, &start, options);
        self.best.borrow().clone()
    }

    /// Asserts that the bundle method finds the `known` minimum with at most `points` evaluations.
    fn check(&self, name: &str, start: &[f64], points: usize, known: (f64, &[f64])) {
        let Best { cost, x, .. } = self.minimum(start, points);
        let off = cost - known.0;
        // The cost may be slightly below the known minimum, because limits may be exceeded by 1e-9.
        assert!(off > -1e-7 && off < 1e-6, "{name}: {off:.2e} above {} at {x:?}", known.0);
        let apart = x.iter().zip(known.1).map(|(x, known)| (x - known).abs()).fold(0.0, f64::max);
        assert!(apart < 3e-3, "{name}: {x:?} instead of {:?}", known.1);
    }
}

impl PiecewiseSmooth for Textbook {
    type Error = Infallible;

    fn pieces(&self, point: &[f64]) -> Result<Option<Pieces>, Infallible> {
        let x: Vec<f64> =
            point.iter().map(|share| self.from + share * (self.to - self.from)).collect();
        let cost = self.largest(&self.cost, &x);
        let limits: Vec<Piece> = self.limits.iter().map(|limit| self.largest(limit, &x)).collect();
        let excess = limits.iter().map(|limit| limit.value).fold(0.0, f64::max);
        let met = excess <= 1e-9;
        let mut best = self.best.borrow_mut();
        best.excess = best.excess.min(excess);
        if met && cost.value < best.cost {
            *best = Best { cost: cost.value, excess, x };
        }
        Ok(Some(Pieces { cost, limits, met }))
    }
}

#[test]
fn bundle_method_follows_rosenbrocks_nonsmooth_valley() {
    // The cost is 8|x² − y| + (1 − x)².
    let pieces: [Smooth; 2] = [
        |x| (8.0 * (x[0] * x[0] - x[1]) + (1.0 - x[0]).powi(2), vec![18.0 * x[0] - 2.0, -8.0]),
        |x| (8.0 * (x[1] - x[0] * x[0]) + (1.0 - x[0]).powi(2), vec![-14.0 * x[0] - 2.0, 8.0]),
    ];
    let problem = Textbook::new([-2.0, 2.0], &pieces, &[]);
    problem.check("Rosenbrock", &[-1.2, 1.0], 500, (0.0, &[1.0, 1.0]));
}

#[test]
fn bundle_method_solves_the_crescent_problem() {
    let pieces: [Smooth; 2] = [
        |x| (x[0].powi(2) + (x[1] - 1.0).powi(2) + x[1] - 1.0, vec![2.0 * x[0], 2.0 * x[1] - 1.0]),
        |x| (1.0 + x[1] - x[0].powi(2) - (x[1] - 1.0).powi(2), vec![-2.0 * x[0], 3.0 - 2.0 * x[1]]),
    ];
    let problem = Textbook::new([-2.0, 3.0], &pieces, &[]);
    problem.check("Crescent", &[-1.5, 2.0], 100, (0.0, &[0.0, 0.0]));
}

/// Cost functions of problem CB2 by Charalambous and Conn.
const CB2: [Smooth; 3] = [
    |x| (x[0].powi(2) + x[1].powi(4), vec![2.0 * x[0], 4.0 * x[1].powi(3)]),
    |x| {
        let away = [2.0 - x[0], 2.0 - x[1]];
        (away[0].powi(2) + away[1].powi(2), vec![-2.0 * away[0], -2.0 * away[1]])
    },
    |x| {
        let rise = 2.0 * (x[1] - x[0]).exp();
        (rise, vec![-rise, rise])
    },
];

#[test]
fn bundle_method_solves_the_problem_of_charalambous_and_conn() {
    let problem = Textbook::new([-2.0, 3.0], &CB2, &[]);
    let known = (1.952_224_493_9, &[1.139_04, 0.899_56][..]);
    problem.check("CB2", &[1.0, -0.1], 100, known);
}

#[test]
fn bundle_method_minimises_a_maximum_of_squares() {
    let pieces: [Smooth; 5] = [
        |x| square::<0>(x),
        |x| square::<1>(x),
        |x| square::<2>(x),
        |x| square::<3>(x),
        |x| square::<4>(x),
    ];
    let problem = Textbook::new([-2.0, 5.3], &pieces, &[]);
    problem.check("MAXQ", &[1.0, 2.0, 3.0, -1.5, 0.5], 100, (0.0, &[0.0; 5]));
}

/// Returns the square of coordinate `K`, with its gradient.
fn square<const K: usize>(x: &[f64]) -> (f64, Vec<f64>) {
    let mut slope = vec![0.0; x.len()];
    slope[K] = 2.0 * x[K];
    (x[K] * x[K], slope)
}

#[test]
fn limits_with_kinks_are_satisfied() {
    // Problem QL: minimise x² + y² while the larger of two linear functions is at most 0. The start
    // is the published start.
    let cost: Smooth = |x| (x[0] * x[0] + x[1] * x[1], vec![2.0 * x[0], 2.0 * x[1]]);
    let lines: [Smooth; 2] = [
        |x| (4.0 - 4.0 * x[0] - x[1], vec![-4.0, -1.0]),
        |x| (6.0 - x[0] - 2.0 * x[1], vec![-1.0, -2.0]),
    ];
    let problem = Textbook::new([-3.0, 6.0], &[cost], &[&lines]);
    problem.check("QL", &[-1.0, 5.0], 100, (7.2, &[1.2, 2.4]));
}

#[test]
fn limits_with_curvature_are_satisfied() {
    // Problem LQ: minimise −x − y inside the unit circle. In the published problem the circle is
    // part of the cost.
    let cost: Smooth = |x| (-x[0] - x[1], vec![-1.0, -1.0]);
    let circle: Smooth = |x| (x[0] * x[0] + x[1] * x[1] - 1.0, vec![2.0 * x[0], 2.0 * x[1]]);
    let problem = Textbook::new([-2.0, 2.0], &[cost], &[&[circle]]);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    problem.check("LQ", &[-0.5, -0.5], 150, (-2.0 * half, &[half, half]));
}

#[test]
fn contradictory_limits_give_the_point_of_least_excess() {
    let cost: Smooth = |x| (x[0], vec![1.0, 0.0]);
    let [low, high]: [Smooth; 2] =
        [|x| (x[0] + x[1].powi(2), vec![1.0, 2.0 * x[1]]), |x| (1.0 - x[0], vec![-1.0, 0.0])];
    let problem = Textbook::new([-2.0, 2.0], &[cost], &[&[low], &[high]]);
    let best = problem.minimum(&[-1.0, 1.0], 100);
    assert!((best.excess - 0.5).abs() < 1e-8 && best.cost.is_infinite(), "{best:?}");
}
