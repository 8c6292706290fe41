//! Rates of unknowns and of directions, from differences of the equations of two neighbouring systems.

use crate::newton::Newton;
use crate::system::{State, System, inactive};

/// Part of the way over which the state changes, for derivatives along the path by differences.
pub(super) const ALONG: f64 = 1e-5;

/// `−J⁻¹ d(J v)/dq` between two states of neighbouring systems.
pub(super) fn turning<S: System>(
    newton: &mut Newton,
    sides: [&S; 2],
    states: &[State<S::Mode>; 2],
    direction: &[f64],
    step: f64,
) -> Vec<f64> {
    let product = |side: usize| {
        let mut product = vec![0.0; direction.len()];
        let mut add = |row: usize, column: usize, value: f64| {
            product[row] += value * direction[column];
        };
        sides[side].tangent(&states[side], &mut add);
        product
    };
    let change = difference(product(0), product(1), step);
    rates(newton, sides[0], &states[0], change)
}

/// Solves for minus a change of the equations, which the section and the constraints at rest do not take part in.
pub(super) fn rates<S: System>(
    newton: &mut Newton,
    system: &S,
    state: &State<S::Mode>,
    change: Vec<f64>,
) -> Vec<f64> {
    if change.iter().all(|change| *change == 0.0) {
        // A parameter of an anchor alone leaves the equations as they are.
        return change;
    }
    let mut x: Vec<f64> = change.into_iter().map(|change| -change).collect();
    x[system.load()] = 0.0;
    for index in inactive(system, state) {
        x[index] = 0.0;
    }
    newton.solver.solve(&mut x);
    x
}

/// The derivative of what has these values below and above.
pub(super) fn difference(below: Vec<f64>, mut above: Vec<f64>, step: f64) -> Vec<f64> {
    for (above, below) in above.iter_mut().zip(below) {
        *above = (*above - below) / (2.0 * step);
    }
    above
}

pub(super) fn moved(from: &[f64], step: f64, rates: &[f64]) -> Vec<f64> {
    from.iter().zip(rates).map(|(from, rate)| from + step * rate).collect()
}
