//! Slack before contact of a strip in bending.

use skin::flexure::{contact_curvature, gaps};
use sweep::{Case, Parameter};

use crate::slopes::Slopes;

/// Slack of a strip without contact at any curvature.
const AMPLE: f64 = 1.0;

/// Step of the finite differences, relative to the size of the parameter.
const STEP: f64 = 1e-5;

/// Returns the slack before contact.
///
/// It is the logarithm of the contact curvature over the final curvature. The contact curvature is
/// in closed form (F5). A negative slack means contact in bending.
pub(crate) fn contact_margin(case: &Case) -> f64 {
    finite_contact_margin(case).unwrap_or(AMPLE)
}

fn finite_contact_margin(case: &Case) -> Option<f64> {
    let touching = contact_curvature(&case.design, &case.flexure).ok()??;
    let row = case.design.row().ok()?;
    let length = gaps(&row, &case.flexure) * row.pitch();
    let whole = 2.0 * case.flexure.max_end_rotation_deg.to_radians().abs();
    Some((touching * length / whole).ln().min(AMPLE))
}

/// Returns the one-sided derivatives of the slack.
pub(crate) fn contact_margin_slopes(case: &Case, parameter: &Parameter) -> Slopes {
    let here = contact_margin(case);
    let on = |sign: f64| {
        let step = sign * STEP * parameter.size(case)?;
        let at = |by| finite_contact_margin(&parameter.moved(case, by)?);
        // One-sided difference of second order.
        Some((4.0 * at(step)? - at(2.0 * step)? - 3.0 * here) / (2.0 * step))
    };
    let known = finite_contact_margin(case).is_some_and(|margin| margin < AMPLE);
    if known { Slopes { left: on(-1.0), right: on(1.0) } } else { Slopes::FLAT }
}
