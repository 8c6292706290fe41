//! Pressure of a needle on tissue without scales, to compare with the pressure under a skin.

use results::{DesignRow, Quantity};

/// Pressure of a round needle that acts on the tissue without scales.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BareNeedle {
    /// Mean pressure, kPa.
    pub pressure_kpa: f64,
    /// Mean pressure divided by the largest pressure under the skin.
    pub reduction: f64,
}

/// Computes the mean pressure of the needle of a design on a half-space without scales.
///
/// The tip is a rigid frictionless sphere of radius `r`. Its contact circle has the radius
/// `a = (3 F r/4E*)^(1/3)` (Hertz; Johnson, *Contact Mechanics*, 1985, equation 4.22), limited to
/// the radius `r` of the shaft. `F` is the needle force in the definition or, if there is none, the
/// force at the critical tilt. Returns `None` without a round tip, a modulus, or a pressure under
/// the skin.
pub fn bare_needle(row: &DesignRow) -> Option<BareNeedle> {
    let case = &row.case;
    let radius = case.punctured().needle_radius.filter(|radius| *radius > 0.0)?;
    let measures = row.result.puncture?.measures;
    // `E* = E_s/(1 − ν²)`.
    let plane_strain = 1.0 - case.puncture.poisson_ratio.powi(2);
    // Forces are in units of `E* t²`, lengths in `t`.
    let (force, under_skin) = match case.needle_force {
        Some(force) => (force * plane_strain, measures.tissue_pressure_at_force?),
        None => (measures.critical_force? * case.design.length, measures.failure.tissue_pressure?),
    };
    let contact_radius = (0.75 * force * radius).cbrt().min(radius);
    let over_modulus = force / (std::f64::consts::PI * contact_radius.powi(2));
    let pressure = over_modulus / plane_strain;
    let pressure_kpa = Quantity::Pressure.physical(pressure, case)?;
    Some(BareNeedle { pressure_kpa, reduction: pressure / under_skin })
}
