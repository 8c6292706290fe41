//! Quadrature, differentiation and interpolation of polynomials at Gauss–Lobatto–Legendre points.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::{DMatrix, DVector};

/// Gauss–Lobatto–Legendre rule of order `n` on the interval from 0 to 1.
///
/// The rule has `n + 1` points `ξᵢ = (1 + xᵢ)/2`, including both ends. `x₀ = −1`, `xₙ = 1`, and the
/// other `xᵢ` are the roots of the derivative `Pₙ'` of the Legendre polynomial `Pₙ`. `ℓᵢ` is the
/// polynomial of degree `n` that is 1 at `ξᵢ` and 0 at the other points.
///
/// ```text
/// wᵢ = 1/(n (n+1) Pₙ(xᵢ)²)                              weights, exact to degree 2n − 1   (M15)
/// Dᵢⱼ = 2 Pₙ(xᵢ)/[Pₙ(xⱼ) (xᵢ − xⱼ)],   Dᵢᵢ = −Σⱼ Dᵢⱼ     derivative ℓⱼ' at ξᵢ              (M16)
/// Kᵢⱼ = Σₖ wₖ Dₖᵢ Dₖⱼ = ∫ ℓᵢ' ℓⱼ' dξ                      stiffness matrix                 (M17)
/// ```
///
/// Source: C. Canuto, M. Y. Hussaini, A. Quarteroni, T. A. Zang, *Spectral Methods: Fundamentals in
/// Single Domains*, Springer (2006), §2.3, doi 10.1007/978-3-540-30726-6.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lobatto {
    /// Points `ξᵢ`, ascending from 0 to 1.
    pub(crate) points: DVector<f64>,
    /// Weights `wᵢ`, with the sum 1.
    pub(crate) weights: DVector<f64>,
    /// Matrix `D` (M16), which maps values at the points to derivatives at the points.
    pub(crate) derivative: DMatrix<f64>,
    /// Stiffness matrix `K` (M17).
    pub(crate) stiffness: DMatrix<f64>,
    /// `Pₙ(xᵢ)` at each point; its inverse is proportional to the barycentric weight of the point.
    legendre: DVector<f64>,
}

/// Rules computed so far, with the order as key.
static SHARED: Mutex<BTreeMap<usize, Arc<Lobatto>>> = Mutex::new(BTreeMap::new());

impl Lobatto {
    /// Returns the shared rule of order `n ≥ 1`.
    pub(crate) fn shared(n: usize) -> Arc<Self> {
        // A panic of another thread leaves the map intact, so a poisoned lock is usable.
        let mut rules = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
        // The rule is computed under the lock, so that other threads wait instead of repeating the
        // computation.
        Arc::clone(rules.entry(n).or_insert_with(|| Arc::new(Self::new(n))))
    }

    /// Computes the rule of order `n ≥ 1`.
    pub(crate) fn new(n: usize) -> Self {
        let x = DVector::from_iterator(n + 1, (0..=n).map(|i| point(n, i)));
        let legendre = x.map(|x| legendre(n, x)[1]);
        let weights = legendre.map(|p| 1.0 / ((n * (n + 1)) as f64 * p * p));
        let mut derivative = DMatrix::from_fn(n + 1, n + 1, |i, j| {
            if i == j { 0.0 } else { 2.0 * legendre[i] / (legendre[j] * (x[i] - x[j])) }
        });
        for i in 0..=n {
            // The negative sum of the row makes the derivative of a constant exactly zero.
            derivative[(i, i)] = -derivative.row(i).sum();
        }
        let mut stiffness = derivative.transpose() * DMatrix::from_diagonal(&weights) * &derivative;
        // Symmetrise, because round-off breaks the symmetry in the last digits.
        stiffness.fill_upper_triangle_with_lower_triangle();
        Self { points: x.map(|x| 0.5 * (1.0 + x)), weights, derivative, stiffness, legendre }
    }

    /// Returns the order `n`.
    pub(crate) fn order(&self) -> usize {
        self.points.len() - 1
    }

    /// Returns the value at `ξ` of the polynomial with `values` at the points.
    ///
    /// Uses the barycentric formula.
    pub(crate) fn interpolate(&self, values: &DVector<f64>, xi: f64) -> f64 {
        let (mut numerator, mut denominator) = (0.0, 0.0);
        for i in 0..values.len() {
            let distance = xi - self.points[i];
            // At one of the points the formula would divide infinity by infinity.
            if distance == 0.0 {
                return values[i];
            }
            let weight = 1.0 / (self.legendre[i] * distance);
            numerator += weight * values[i];
            denominator += weight;
        }
        numerator / denominator
    }
}

/// Returns `Pₙ₋₁(x)` and `Pₙ(x)` for `n ≥ 1`, computed by the three-term recurrence.
fn legendre(n: usize, x: f64) -> [f64; 2] {
    (2..=n).map(|k| k as f64).fold([1.0, x], |[before, last], k| {
        [last, ((2.0 * k - 1.0) * x * last - (k - 1.0) * before) / k]
    })
}

/// Computes the point `xᵢ` by Newton's method, starting from the Chebyshev point.
///
/// The points are the zeros of `(1 − x²) Pₙ' = n (Pₙ₋₁ − x Pₙ)`, with the derivative
/// `−n (n+1) Pₙ`. Points in the right half are mirror images of points in the left half.
fn point(n: usize, i: usize) -> f64 {
    match (2 * i).cmp(&n) {
        // The middle point is exactly zero, but Newton's method would return about 1e-17.
        std::cmp::Ordering::Equal => return 0.0,
        std::cmp::Ordering::Greater => return -point(n, n - i),
        std::cmp::Ordering::Less => {}
    }
    let mut x = -(std::f64::consts::PI * i as f64 / n as f64).cos();
    for _ in 0..NEWTON {
        let [before, last] = legendre(n, x);
        x += (before - x * last) / ((n + 1) as f64 * last);
    }
    x
}

/// Number of Newton iterations after which the error of every point is below round-off.
///
/// The starting values have two correct digits, and each iteration doubles the number of digits.
const NEWTON: usize = 6;

#[cfg(test)]
mod tests {
    use super::Lobatto;

    #[test]
    fn the_rule_of_order_4_agrees_with_its_closed_form() {
        let rule = Lobatto::new(4);
        let inner = 0.5 * (1.0 - (3.0_f64 / 7.0).sqrt());
        let points = [0.0, inner, 0.5, 1.0 - inner, 1.0];
        let weights = [1.0 / 20.0, 49.0 / 180.0, 16.0 / 45.0, 49.0 / 180.0, 1.0 / 20.0];
        for i in 0..5 {
            assert!((rule.points[i] - points[i]).abs() < 1e-15);
            assert!((rule.weights[i] - weights[i]).abs() < 1e-15);
        }
    }

    #[test]
    fn the_rule_integrates_and_differentiates_polynomials_exactly() {
        for n in 1..=64 {
            let rule = Lobatto::new(n);
            assert_eq!(rule.order(), n);
            let degree = 2 * n as i32 - 1;
            let integral = rule.points.map(|x| x.powi(degree)).dot(&rule.weights);
            assert!((integral * f64::from(degree + 1) - 1.0).abs() < 1e-13, "{n}: {integral}");
            let values = rule.points.map(|x| x.powi(n as i32));
            let slope = &rule.derivative * &values;
            let exact = rule.points.map(|x| n as f64 * x.powi(n as i32 - 1));
            assert!((slope - exact).amax() < 1e-12 * (n * n) as f64, "{n}");
            assert!((rule.interpolate(&values, 0.7) - 0.7_f64.powi(n as i32)).abs() < 1e-14);
            let energy = values.dot(&(&rule.stiffness * &values));
            let exact = (n * n) as f64 / (2 * n - 1) as f64;
            assert!((energy - exact).abs() < 1e-11 * exact, "{n}: {energy}");
        }
    }
}
