//! Derivatives of the stiffness of a row with respect to the parameters of its footprint.

use std::sync::OnceLock;

use crate::table::{self, Differentiated};
use crate::{Bases, Coupling, Footprint, FootprintParameter, RowStiffness, Unresolved, layered};

/// Stiffness of a row with its derivatives with respect to the parameters of the footprint.
///
/// A derivative is computed when it is first requested, because outside the table and on a layer it
/// needs several boundary-element solutions.
#[derive(Clone, Debug)]
pub struct StiffnessSlopes {
    /// Stiffness of the row, bitwise equal to the result of [`RowStiffness::compute`].
    pub stiffness: RowStiffness,
    footprint: Footprint,
    coupling: Coupling,
    /// Values on the half-space with their derivatives; `None` outside the range of the table.
    table: Option<Vec<Differentiated>>,
    slopes: [OnceLock<Result<RowStiffness, Unresolved>>; 5],
}

impl StiffnessSlopes {
    /// Computes the stiffness of a row; derivatives are computed later on request.
    ///
    /// # Errors
    /// If the gap or a cell vanishes by rounding.
    pub fn compute(footprint: &Footprint, coupling: Coupling) -> Result<Self, Unresolved> {
        Ok(Self {
            stiffness: RowStiffness::compute(footprint, coupling)?,
            footprint: *footprint,
            coupling,
            table: table::row(footprint, coupling),
            slopes: [const { OnceLock::new() }; 5],
        })
    }

    /// Returns the derivative of the stiffness with respect to a parameter.
    ///
    /// Within the range of the table the polynomials are differentiated, outside it
    /// boundary-element solutions by finite differences. The contribution of a layer is always
    /// differentiated by finite differences. On a half-space the derivative with respect to the
    /// thickness is 0.
    ///
    /// # Errors
    /// If the gap or a cell vanishes by rounding.
    pub fn by(&self, parameter: FootprintParameter) -> Result<&RowStiffness, Unresolved> {
        let slope = &self.slopes[parameter as usize];
        slope.get_or_init(|| self.differentiated(parameter)).as_ref().map_err(|error| *error)
    }

    fn differentiated(&self, parameter: FootprintParameter) -> Result<RowStiffness, Unresolved> {
        let Self { footprint, coupling, .. } = self;
        let on_half_space = match (&self.table, parameter) {
            (_, FootprintParameter::Size) => return self.by_size(),
            (_, FootprintParameter::Thickness) => None,
            // Derivatives of the polynomials are exact; finite differences would lose digits.
            (Some(row), _) => Some(RowStiffness::from_table(row, 1 + parameter as usize)),
            (None, _) => Some(difference(footprint, *coupling, parameter)?),
        };
        let of_layer = footprint
            .is_on_layer()
            .then(|| layered::slope(footprint, *coupling, parameter))
            .transpose()?;
        let sum = on_half_space.into_iter().chain(of_layer).reduce(|sum, more| sum + more);
        Ok(sum.unwrap_or_else(|| self.stiffness.clone() * 0.0))
    }

    fn by_size(&self) -> Result<RowStiffness, Unresolved> {
        use FootprintParameter::{Gap, Thickness, Width};
        let Self { footprint, .. } = self;
        let by_size = self.by(Gap)?.clone() * footprint.gap_over_a()
            + self.by(Width)?.clone() * footprint.width_over_a();
        if !footprint.is_on_layer() {
            return Ok(by_size);
        }
        Ok(by_size + self.by(Thickness)?.clone() * footprint.thickness_over_a())
    }

    /// Extrapolates the stiffness linearly from the bases `from` of this object to nearby bases
    /// `to`.
    ///
    /// # Errors
    /// If the gap or a cell vanishes by rounding.
    pub fn moved(&self, from: &Bases, to: &Bases) -> Result<RowStiffness, Unresolved> {
        use FootprintParameter::{Gap, PoissonRatio, Size, Thickness, Width};
        let a = from.half_width;
        // Use differences of lengths: differences of ratios lose digits if the change is small.
        let changes = [
            (Gap, (to.gap - from.gap) / a),
            (Width, (to.width - from.width) / a),
            (Size, 1.0 - to.half_width / a),
            (PoissonRatio, to.poisson_ratio - from.poisson_ratio),
            (Thickness, (to.thickness.unwrap_or(0.0) - from.thickness.unwrap_or(0.0)) / a),
        ];
        let mut sum = self.stiffness.clone();
        for (parameter, by) in changes {
            if by != 0.0 {
                sum = sum + self.by(parameter)?.clone() * by;
            }
        }
        Ok(sum)
    }
}

/// Step of the finite differences, relative to the parameter (absolute for Poisson's ratio).
///
/// Both the rounding of a solution, about 1e-13, and the fifth-order terms of the differences stay
/// below 1e-9 of the derivative.
const STEP: f64 = 2e-3;

/// Differentiates boundary-element solutions with respect to gap, width or Poisson's ratio.
///
/// Uses the difference formula `(8 (f₁ − f₋₁) − (f₂ − f₋₂))/12 h` with the step `h`.
fn difference(
    footprint: &Footprint,
    coupling: Coupling,
    parameter: FootprintParameter,
) -> Result<RowStiffness, Unresolved> {
    let step = footprint.step(parameter, STEP);
    // All four points use boundary elements, also within the range of the table, because the
    // difference between table and boundary elements would appear in the derivative.
    let [near, far] = [8.0 / (12.0 * step), -1.0 / (12.0 * step)];
    let terms = [(1.0, near), (-1.0, -near), (2.0, far), (-2.0, -far)];
    let [first, second, third, fourth] = terms.map(|(steps, factor)| {
        let footprint = footprint.moved(parameter as usize, steps * step);
        RowStiffness::solved(&footprint, coupling).map(|row| row * factor)
    });
    Ok(first? + second? + third? + fourth?)
}
