//! Derivatives of the stiffness of a row with respect to its footprint.

use crate::{Bases, Coupling, Footprint, RowStiffness, Unresolved, layered, table};

/// Stiffness of a row with its derivatives by the parameters of the footprint.
#[derive(Clone, Debug, PartialEq)]
pub struct StiffnessSlopes {
    /// Stiffness itself, bit-identical to [`RowStiffness::compute`].
    pub stiffness: RowStiffness,
    /// Derivative with respect to `d/a`.
    pub by_gap: RowStiffness,
    /// Derivative with respect to `b/a`.
    pub by_width: RowStiffness,
    /// Derivative by the logarithm of all lengths over `a`, as for shrinking bases.
    pub by_size: RowStiffness,
    /// Derivative with respect to `ν`.
    pub by_poisson_ratio: RowStiffness,
    /// Derivative by the thickness `h/a` of a layer; `None` for the half-space.
    pub by_thickness: Option<RowStiffness>,
}

impl StiffnessSlopes {
    /// Returns the stiffness of a row with its derivatives.
    ///
    /// Within the range of the table these are derivatives of its polynomials, otherwise
    /// differences of solutions. The contribution of a layer is always differentiated by
    /// differences.
    ///
    /// # Errors
    /// As [`RowStiffness::compute`].
    pub fn compute(footprint: &Footprint, coupling: Coupling) -> Result<Self, Unresolved> {
        let stiffness = RowStiffness::compute(footprint, coupling)?;
        // Differentiate polynomials exactly: differences would lose digits.
        let [mut by_gap, mut by_width, mut by_poisson_ratio] = match table::row(footprint, coupling)
        {
            Some(row) => [1, 2, 3].map(|k| RowStiffness::from_table(&row, k)),
            None => differences(footprint, coupling)?,
        };
        let mut by_thickness = None;
        if footprint.is_on_layer() {
            let [gap, width, ratio, thickness] = layered::slopes(footprint, coupling)?;
            (by_gap, by_width) = (by_gap + gap, by_width + width);
            by_poisson_ratio = by_poisson_ratio + ratio;
            by_thickness = Some(thickness);
        }
        // For a shrinking base, all other lengths grow in the same ratio.
        let mut by_size =
            by_gap.clone() * footprint.gap_over_a() + by_width.clone() * footprint.width_over_a();
        if let Some(by_thickness) = &by_thickness {
            by_size = by_size + by_thickness.clone() * footprint.thickness_over_a();
        }
        Ok(Self { stiffness, by_gap, by_width, by_size, by_poisson_ratio, by_thickness })
    }

    /// Extrapolates the stiffness linearly from bases `from` to nearby bases `to`.
    pub fn moved(&self, from: &Bases, to: &Bases) -> RowStiffness {
        let a = from.half_width;
        // Uses lengths instead of ratios: differences of ratios would lose digits for a small step.
        let mut ways = vec![
            (&self.by_gap, (to.gap - from.gap) / a),
            (&self.by_width, (to.width - from.width) / a),
            (&self.by_size, 1.0 - to.half_width / a),
            (&self.by_poisson_ratio, to.poisson_ratio - from.poisson_ratio),
        ];
        if let (Some(by), Some(to), Some(from)) = (&self.by_thickness, to.thickness, from.thickness)
        {
            ways.push((by, (to - from) / a));
        }
        let ways = ways.into_iter().filter(|(_, by)| *by != 0.0);
        ways.fold(self.stiffness.clone(), |sum, (slope, by)| sum + slope.clone() * by)
    }
}

/// Relative step of the differences.
///
/// The rounding of a solution, about 1e-13, and the fifth-order terms are balanced; both are below
/// 1e-9 of the derivative.
const STEP: f64 = 2e-3;

/// Differentiates boundary-element solutions by gap, width and Poisson's ratio.
///
/// Uses `(8 (f₁ − f₋₁) − (f₂ − f₋₂))/12 h`.
fn differences(footprint: &Footprint, coupling: Coupling) -> Result<[RowStiffness; 3], Unresolved> {
    let along = |number: usize, step: f64| {
        // Solve points within the table too: mixing both would difference their errors.
        let at =
            |steps: f64| RowStiffness::solved(&footprint.moved(number, steps * step), coupling);
        let [near, far] = [8.0 / (12.0 * step), -1.0 / (12.0 * step)];
        let slope = at(1.0)? * near + at(-1.0)? * -near;
        Ok(slope + at(2.0)? * far + at(-2.0)? * -far)
    };
    let [gap, width] = [footprint.gap_over_a(), footprint.width_over_a()];
    Ok([along(0, STEP * gap)?, along(1, STEP * width)?, along(2, STEP)?])
}
