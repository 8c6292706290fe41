//! How far the measures of a bent strip are from those of a strip that is resolved better.

use solver::{Newton, Settings};

use super::strip::Strip;
use crate::contacts::SkinState;
use crate::record::Skin;

/// A quantity below this, in its own unit, counts as this much where its relative change is taken: it is round-off.
const NEGLIGIBLE: f64 = 1e-9;

/// Moment, its slope, axial share of the energy and largest strain of a state of a strip: what a finer membrane may change.
pub(super) type Quantities = [f64; 4];

/// The largest relative change of any to those of a finer membrane. `None` if one of them is not finite.
pub(super) fn largest_change(ours: Quantities, finer: Quantities) -> Option<f64> {
    let relative =
        |(ours, theirs): (f64, f64)| (ours - theirs).abs() / theirs.abs().max(NEGLIGIBLE);
    let changes = ours.into_iter().zip(finer).map(relative);
    changes.reduce(f64::max).filter(|largest| largest.is_finite())
}

/// Solves the strip for the rotation that `state` has, with its contacts. `None` if Newton's method does not get there.
fn quantities(strip: &Strip, mut state: SkinState, settings: &Settings) -> Option<Quantities> {
    let condition = strip.same_rotation(&state);
    let direction = Newton::new(strip).solve(strip, &mut state, &condition, settings).ok()?;
    let (moment, stiffness) = (strip.moment(&state.z), strip.stiffness(&state, &direction));
    Some([moment, stiffness, strip.axial_energy_share(&state), strip.largest_strain(&state)])
}

/// Returns the largest relative change of moment, slope of the moment, axial share of the energy and strain when the state
/// is solved again with a finer membrane, at the same rotation of the ends and with the same contacts. `None` if it cannot be.
pub(crate) fn change(
    strip: &Strip,
    finer: &Strip,
    state: &SkinState,
    settings: &Settings,
) -> Option<f64> {
    // Both are solved in the same way, so that both slopes belong to the contacts of the state.
    let ours = quantities(strip, state.clone(), settings)?;
    let theirs = quantities(finer, strip.transferred(state, finer)?, settings)?;
    largest_change(ours, theirs)
}
