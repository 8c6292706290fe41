//! How far the measures of a bent strip are from those of a strip that is resolved better.

use membrane::GapEnergies;
use solver::{Newton, Settings};

use super::strip::Strip;
use crate::contacts::SkinState;
use crate::record::Skin;

/// A quantity below this, in its own unit, counts as this much where its relative change is taken: it is round-off.
const NEGLIGIBLE: f64 = 1e-9;

/// Quantities of a state of a strip that a finer membrane may change.
pub(super) struct Quantities {
    pub(super) moment: f64,
    pub(super) stiffness: f64,
    pub(super) axial_energy_share: f64,
    pub(super) strain: f64,
}

impl Quantities {
    /// Solves the strip for the rotation that `state` has, with its contacts. `None` if Newton's method does not get there.
    fn at(strip: &Strip, mut state: SkinState, settings: &Settings) -> Option<Self> {
        let condition = strip.same_rotation(&state);
        let direction = Newton::new(strip).solve(strip, &mut state, &condition, settings).ok()?;
        let GapEnergies { axial, bending } = strip.membrane_energy(&state);
        let contact = strip.contacts.energy(&state);
        Some(Self {
            moment: strip.moment(&state.z),
            stiffness: strip.stiffness(&state, &direction),
            axial_energy_share: axial / (bending + axial + contact),
            strain: strip.largest_strain(&state),
        })
    }

    fn values(&self) -> [f64; 4] {
        [self.moment, self.stiffness, self.axial_energy_share, self.strain]
    }

    /// The largest relative change of any to those of a finer membrane. `None` if one of them is not finite.
    pub(super) fn change_to(&self, finer: &Self) -> Option<f64> {
        let relative =
            |(ours, theirs): (f64, f64)| (ours - theirs).abs() / theirs.abs().max(NEGLIGIBLE);
        let changes = self.values().into_iter().zip(finer.values()).map(relative);
        changes.reduce(f64::max).filter(|largest| largest.is_finite())
    }
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
    let ours = Quantities::at(strip, state.clone(), settings)?;
    let theirs = Quantities::at(finer, strip.transferred(state, finer)?, settings)?;
    ours.change_to(&theirs)
}
