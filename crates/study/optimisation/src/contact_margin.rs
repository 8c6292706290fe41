//! Slack of a strip in bending before its scales touch (O2).

use skin::flexure::{contact_curvature, gaps};
use sweep::{Case, Parameter};

use crate::slopes::Slopes;

/// Slack of a strip that has no contact at any curvature, and maximum slack of other strips.
const AMPLE: f64 = 1.0;

/// Step of the finite differences, relative to the size of the parameter.
const STEP: f64 = 1e-5;

/// Returns the slack before contact, `ln(κ₁*/κ_e*)` (O2).
///
/// `κ₁*` is the curvature of first contact in closed form (F5), and `κ_e*` is the curvature at the
/// end of bending. If the slack is negative, scales touch in bending.
pub(crate) fn contact_margin(case: &Case) -> f64 {
    finite_contact_margin(case).unwrap_or(AMPLE)
}

/// Returns the slack before contact; `None` for a strip without contact at any curvature.
fn finite_contact_margin(case: &Case) -> Option<f64> {
    let touching = contact_curvature(&case.design, &case.flexure).ok()??;
    let row = case.design.row().ok()?;
    let length = gaps(&row, &case.flexure) * row.pitch();
    let whole = 2.0 * case.flexure.max_end_rotation_deg.to_radians().abs();
    Some((touching * length / whole).ln().min(AMPLE))
}

/// Returns the one-sided derivatives of the slack with respect to `parameter`.
pub(crate) fn contact_margin_slopes(case: &Case, parameter: &Parameter) -> Slopes {
    if finite_contact_margin(case).is_none_or(|margin| margin >= AMPLE) {
        return Slopes::FLAT;
    }
    Slopes {
        left: one_sided_slope(case, parameter, -STEP),
        right: one_sided_slope(case, parameter, STEP),
    }
}

/// Returns a one-sided derivative of the slack by finite differences of second order.
///
/// `relative_step` is relative to the size of the parameter; its sign selects the side.
fn one_sided_slope(case: &Case, parameter: &Parameter, relative_step: f64) -> Option<f64> {
    let step = relative_step * parameter.size(case)?;
    let near = finite_contact_margin(&parameter.moved(case, step)?)?;
    let far = finite_contact_margin(&parameter.moved(case, 2.0 * step)?)?;
    Some((4.0 * near - far - 3.0 * contact_margin(case)) / (2.0 * step))
}
