//! Estimates the discretisation error of the measures of a bent strip.

use membrane::GapEnergies;
use solver::{Newton, Settings};

use super::gap_curve::Knot;
use super::strip::Strip;
use crate::contacts::SkinState;
use crate::record::Skin;

/// Smallest denominator of a relative change; smaller values are round-off.
const NEGLIGIBLE: f64 = 1e-9;

/// The compared quantities of a state.
///
/// They are the moment, its slope, the axial fraction of the energy, and the largest strain.
pub(super) type Quantities = [f64; 4];

/// Returns the largest relative change from the quantities `ours` to those on a `finer` membrane.
///
/// `None` if it is not finite.
pub(super) fn largest_change(ours: Quantities, finer: Quantities) -> Option<f64> {
    let changes = ours
        .into_iter()
        .zip(finer)
        .map(|(ours, theirs)| (ours - theirs).abs() / theirs.abs().max(NEGLIGIBLE));
    changes.reduce(f64::max).filter(|largest| largest.is_finite())
}

/// Solves the strip at the end rotation and with the contacts of `state`, and evaluates it.
///
/// `None` if Newton's method fails.
fn quantities(strip: &Strip, mut state: SkinState, settings: &Settings) -> Option<Quantities> {
    let condition = strip.same_rotation(&state);
    let direction = Newton::new(strip).solve(strip, &mut state, &condition, settings).ok()?;
    let (moment, stiffness) = (strip.moment(&state.z), strip.stiffness(&state, &direction));
    Some([moment, stiffness, strip.axial_energy_share(&state), strip.largest_strain(&state)])
}

/// Returns the largest relative change of the [`Quantities`] between a strip and a `finer` one.
///
/// Both are evaluated at the end rotation and with the contacts of `state`. `None` if one of them
/// cannot be solved there.
pub(crate) fn change(
    strip: &Strip,
    finer: &Strip,
    state: &SkinState,
    settings: &Settings,
) -> Option<f64> {
    // Solve `strip` again, too, so that both slopes refer to the contacts of `state`.
    let ours = quantities(strip, state.clone(), settings)?;
    let theirs = quantities(finer, strip.transferred(state, finer)?, settings)?;
    largest_change(ours, theirs)
}

/// Sums of quantities of all gaps under one moment; the strain is the largest of all gaps.
#[derive(Default)]
pub(super) struct Sums {
    pub(super) rotation: f64,
    pub(super) compliance: f64,
    pub(super) axial_energy: f64,
    pub(super) energy: f64,
    strain: f64,
}

impl Sums {
    /// Adds the quantities of one gap.
    pub(super) fn add(&mut self, strip: &Strip, knot: &Knot) {
        let state = &knot.point.state;
        let GapEnergies { axial, bending } = strip.membrane_energy(state);
        self.rotation += knot.rotation;
        self.compliance += knot.compliance();
        self.axial_energy += axial;
        self.energy += axial + bending + strip.contacts.energy(state);
        self.strain = self.strain.max(strip.largest_strain(state));
    }

    /// Returns the compared quantities of the strip.
    pub(super) fn quantities(&self, moment: f64) -> Quantities {
        [moment, self.compliance.recip(), self.axial_energy / self.energy, self.strain]
    }
}
