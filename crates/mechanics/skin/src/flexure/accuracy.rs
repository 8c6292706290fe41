//! Discretisation error of the measures of a bent strip.

use solver::{Newton, Settings};

use super::strip::Strip;
use crate::contacts::SkinState;
use crate::record::Skin;

/// Floor of the denominator of relative changes; smaller values are round-off.
const NEGLIGIBLE: f64 = 1e-9;

/// The quantities of a state that a finer membrane may change.
///
/// Moment, its slope, axial fraction of the energy, and largest strain.
pub(super) type Quantities = [f64; 4];

/// Returns the largest relative change against a finer membrane.
///
/// `None` if not finite.
pub(super) fn largest_change(ours: Quantities, finer: Quantities) -> Option<f64> {
    let changes = ours
        .into_iter()
        .zip(finer)
        .map(|(ours, theirs)| (ours - theirs).abs() / theirs.abs().max(NEGLIGIBLE));
    changes.reduce(f64::max).filter(|largest| largest.is_finite())
}

/// Solves the strip at the rotation and with the contacts of `state`.
///
/// `None` if Newton's method fails.
fn quantities(strip: &Strip, mut state: SkinState, settings: &Settings) -> Option<Quantities> {
    let condition = strip.same_rotation(&state);
    let direction = Newton::new(strip).solve(strip, &mut state, &condition, settings).ok()?;
    let (moment, stiffness) = (strip.moment(&state.z), strip.stiffness(&state, &direction));
    Some([moment, stiffness, strip.axial_energy_share(&state), strip.largest_strain(&state)])
}

/// Returns the largest relative change of the quantities with a finer membrane.
///
/// Moment, slope of the moment, axial energy fraction and strain are compared at the same end
/// rotation and with the same contacts. `None` if the state cannot be solved again.
pub(crate) fn change(
    strip: &Strip,
    finer: &Strip,
    state: &SkinState,
    settings: &Settings,
) -> Option<f64> {
    // Solve on both meshes by the same method, so that both slopes are taken with the contacts of
    // `state`.
    let ours = quantities(strip, state.clone(), settings)?;
    let theirs = quantities(finer, strip.transferred(state, finer)?, settings)?;
    largest_change(ours, theirs)
}
