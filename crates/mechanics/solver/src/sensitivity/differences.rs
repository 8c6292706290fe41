//! Derivatives of unknowns and path directions from differences of two neighbouring systems.

use crate::newton::Newton;
use crate::system::{State, System, inactive};

/// Step along the path in difference quotients.
pub(super) const ALONG: f64 = 1e-5;

/// Computes `−J⁻¹ d(J v)/dq` (D3) from two states of neighbouring systems.
///
/// `direction` is `v`, and `newton` contains the factors of `J`. Between the two systems `sides`,
/// which have the states `states`, the parameter `q` differs by `2 step`. With the same system
/// twice and two states of its path, `q` is the distance along the path.
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

/// Returns the solution `x` of `J x = −change` with the factors of `J` in `newton`.
///
/// The entries of `change` for the section and for inactive constraints are replaced by zero.
pub(super) fn rates<S: System>(
    newton: &mut Newton,
    system: &S,
    state: &State<S::Mode>,
    change: Vec<f64>,
) -> Vec<f64> {
    if change.iter().all(|change| *change == 0.0) {
        // A parameter that only enters the function of an anchor does not change the equations.
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

/// Returns the central difference quotient `(above − below)/(2 step)`.
pub(super) fn difference(below: Vec<f64>, mut above: Vec<f64>, step: f64) -> Vec<f64> {
    for (above, below) in above.iter_mut().zip(below) {
        *above = (*above - below) / (2.0 * step);
    }
    above
}

/// Returns `from` plus `step` times `rates`.
pub(super) fn moved(from: &[f64], step: f64, rates: &[f64]) -> Vec<f64> {
    from.iter().zip(rates).map(|(from, rate)| from + step * rate).collect()
}
