//! How much farther a strip could bend before its scales touch.

use skin::flexure::{contact_curvature, gaps};
use sweep::{Case, Parameter};

use crate::slopes::Slopes;

/// Room of a strip whose gap never closes.
const AMPLE: f64 = 1.0;

/// Step of the differences, relative to the size of the parameter.
const STEP: f64 = 1e-5;

/// The logarithm of the curvature at which scales first touch, in closed form (F5), over that at the end of bending: below 0, bending
/// brings them into contact.
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

/// The derivatives of the room.
pub(crate) fn contact_margin_slopes(case: &Case, parameter: &Parameter) -> Slopes {
    let here = contact_margin(case);
    let on = |sign: f64| {
        let step = sign * STEP * parameter.size(case)?;
        let at = |by| finite_contact_margin(&parameter.moved(case, by)?);
        // Of the second order, from one side.
        Some((4.0 * at(step)? - at(2.0 * step)? - 3.0 * here) / (2.0 * step))
    };
    let known = finite_contact_margin(case).is_some_and(|margin| margin < AMPLE);
    if known { Slopes { left: on(-1.0), right: on(1.0) } } else { Slopes::FLAT }
}
