//! Rates of unknowns and directions by differences of two neighbouring systems.

use crate::newton::Newton;
use crate::system::{State, System, inactive};

/// Relative step of differences along the path.
pub(super) const ALONG: f64 = 1e-5;

/// Computes `−J⁻¹ d(J v)/dq` between two states of neighbouring systems.
pub(super) fn turning<S: System>(
    newton: &mut Newton,
    sides: [&S; 2],
    states: &[State<S::Mode>; 2],
    direction: &[f64],
    step: f64,
) -> Vec<f64> {
    let [below, above] = [0, 1].map(|side| {
        let mut product = vec![0.0; direction.len()];
        sides[side].tangent(&states[side], &mut |row: usize, column: usize, value: f64| {
            product[row] += value * direction[column];
        });
        product
    });
    let change = difference(below, above, step);
    rates(newton, sides[0], &states[0], change)
}

/// Solves `J x = −change`.
///
/// The change is zero in the section and at inactive constraints.
pub(super) fn rates<S: System>(
    newton: &mut Newton,
    system: &S,
    state: &State<S::Mode>,
    change: Vec<f64>,
) -> Vec<f64> {
    if change.iter().all(|change| *change == 0.0) {
        // A parameter that enters only an anchor leaves the equations unchanged.
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

/// Computes the central difference quotient.
pub(super) fn difference(below: Vec<f64>, mut above: Vec<f64>, step: f64) -> Vec<f64> {
    for (above, below) in above.iter_mut().zip(below) {
        *above = (*above - below) / (2.0 * step);
    }
    above
}

pub(super) fn moved(from: &[f64], step: f64, rates: &[f64]) -> Vec<f64> {
    from.iter().zip(rates).map(|(from, rate)| from + step * rate).collect()
}
