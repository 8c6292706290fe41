//! Verification of the derivatives of a [`System`] by finite differences.

use crate::linear::BandMatrix;
use crate::system::{Residual, State, System};

/// Relative step of an unknown in a difference quotient.
const STEP: f64 = 1e-5;

/// Lower limit of the magnitude of an unknown in the computation of its step.
///
/// The limit does not apply to unknowns of constraints, such as contact forces, because a power law
/// of a force changes its slope at arbitrarily small forces.
const SMALL: f64 = 0.01;

/// Error for a derivative that differs from the difference quotient of the residual.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the derivative of equation {row} with respect to unknown {column} is {derivative}, \
     differences of the residual give {difference}"
)]
pub struct WrongDerivative {
    /// Index of the equation.
    pub row: usize,
    /// Index of the unknown.
    pub column: usize,
    /// Derivative according to [`System::tangent`] or [`System::slope`].
    pub derivative: f64,
    /// Central difference quotient of the residual.
    pub difference: f64,
}

/// Compares the tangent and the slopes of a system at a state with central differences.
///
/// Checks the entries that the solver uses: the tangent without rows and columns of inactive
/// constraints, and [`System::slope`] of all constraints. `tolerance` is relative to the largest
/// derivative of an equation. The unknowns of active constraints must not be zero.
///
/// # Errors
/// Returns the first derivative that differs by more than the tolerance.
pub fn check_tangent<S: System>(
    system: &S,
    state: &State<S::Mode>,
    tolerance: f64,
) -> Result<(), WrongDerivative> {
    let mut tangent = BandMatrix::new(system.size(), system.half_bandwidth());
    system.tangent(state, &mut tangent);
    let columns = used(system, state);
    let differences: Vec<Vec<f64>> =
        columns.iter().map(|&column| difference(system, state, column)).collect();
    let largest =
        |row: usize| differences.iter().fold(0.0_f64, |max, column| max.max(column[row].abs()));
    let sizes: Vec<f64> = (0..system.size()).map(largest).collect();
    for (&column, differences) in columns.iter().zip(&differences) {
        // Row and derivative of each entry that the solver uses.
        let mut derivatives = Vec::new();
        for &row in columns.iter().filter(|&&row| row != system.load()) {
            let inside = tangent.columns(row).contains(&column);
            derivatives.push((row, if inside { tangent.get(row, column) } else { 0.0 }));
        }
        let mut direction = vec![0.0; system.size()];
        direction[column] = 1.0;
        for (constraint, &row) in system.constraints().iter().enumerate() {
            derivatives.push((row, system.slope(state, constraint, &direction)));
        }
        for (row, derivative) in derivatives {
            let difference = differences[row];
            let deviation = (derivative - difference).abs();
            let is_close = deviation <= tolerance * sizes[row].max(derivative.abs());
            if !is_close {
                return Err(WrongDerivative { row, column, derivative, difference });
            }
        }
    }
    Ok(())
}

/// Returns the unknowns that do not belong to inactive constraints.
fn used<S: System>(system: &S, state: &State<S::Mode>) -> Vec<usize> {
    let constraints = system.constraints().iter().zip(&state.active);
    let vanish: Vec<usize> = constraints.filter(|(_, active)| !**active).map(|(&c, _)| c).collect();
    (0..system.size()).filter(|index| !vanish.contains(index)).collect()
}

/// Returns the central difference quotients of all equations with respect to unknown `column`.
fn difference<S: System>(system: &S, state: &State<S::Mode>, column: usize) -> Vec<f64> {
    let is_constraint = system.constraints().contains(&column);
    let size = state.z[column].abs();
    let step = STEP * if is_constraint { size } else { size.max(SMALL) };
    let [high, low] = [step, -step].map(|step| {
        let mut state = state.clone();
        state.z[column] += step;
        let mut residual = Residual::new(system.size());
        system.residual(&state, &mut residual);
        let mut conditions = Vec::new();
        system.conditions(&state, &mut conditions);
        let constraints = system.constraints().iter().zip(&state.active).zip(conditions);
        for ((&index, active), condition) in constraints {
            if !active {
                residual.value[index] = condition;
            }
        }
        residual.value
    });
    high.iter().zip(low).map(|(high, low)| (high - low) / (2.0 * step)).collect()
}
