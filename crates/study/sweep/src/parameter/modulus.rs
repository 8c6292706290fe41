//! The modulus of the scales in `MPa`, and the two ratios of contact that follow from it.
//!
//! What lies behind a case reads `E_ct/E_s` and `E_ct/E_m` of Eq. (5) alone. A scale is stiff because of what it is made of, whatever it is
//! laid on, so that with `E_ct` in `MPa` both follow, and keep following where a modulus varies.

use super::{Parameter, key};
use crate::case::Case;

impl Parameter {
    /// Of a ratio of contact the key of the modulus below the line.
    fn below_contact(&self) -> Option<&'static str> {
        match self.key {
            key::CONTACT_OVER_SUBSTRATE => Some(key::SUBSTRATE_MODULUS),
            key::CONTACT_OVER_MEMBRANE => Some(key::MEMBRANE_MODULUS),
            _ => None,
        }
    }

    /// Whether one of two parameters is the modulus of the scales and the other a ratio that follows from it.
    pub(super) fn excludes(&self, other: &Self) -> bool {
        let follows = |one: &Self, other: &Self| {
            one.below_contact().is_some() && other.key == key::SCALE_MODULUS
        };
        follows(self, other) || follows(other, self)
    }

    /// Whether it is a ratio that follows from the modulus of the scales.
    pub(super) fn follows_modulus(&self, case: &Case) -> bool {
        self.below_contact().is_some() && case.material.scale_modulus_mpa.is_some()
    }

    /// The ratios that the modulus of the scales says in a definition with these moduli, each with the key of the other one.
    pub(crate) fn ratios() -> impl Iterator<Item = (&'static Self, &'static str)> {
        super::PARAMETERS.iter().filter_map(|ratio| Some((ratio, ratio.below_contact()?)))
    }

    /// Whether ratios of contact follow from it.
    pub(super) fn is_modulus(&self) -> bool {
        let below = [key::SUBSTRATE_MODULUS, key::MEMBRANE_MODULUS];
        self.key == key::SCALE_MODULUS || below.contains(&self.key)
    }
}

/// The ratios of contact with the moduli below the line.
fn ratios(case: &mut Case) -> [(&mut f64, Option<f64>); 2] {
    let material = case.material;
    [
        (&mut case.puncture.contact_modulus_over_substrate, material.substrate_modulus_mpa),
        (&mut case.flexure.contact_modulus_over_membrane, material.membrane_modulus_mpa),
    ]
}

/// Has the ratios follow from the modulus of the scales.
pub(super) fn settle(case: &mut Case) {
    let Some(scales) = case.material.scale_modulus_mpa else { return };
    for (ratio, below) in ratios(case) {
        // A sweep of bending alone may leave out the modulus of the substrate.
        *ratio = below.map_or(*ratio, |below| scales / below);
    }
}

/// Has the modulus of the scales say what `moved`, a ratio, says now.
pub(super) fn restate(case: &mut Case, moved: &Parameter) {
    let k = usize::from(moved.key == key::CONTACT_OVER_MEMBRANE);
    let (&mut ratio, below) = ratios(case)[k];
    if let (true, Some(below)) = (moved.follows_modulus(case), below) {
        case.material.scale_modulus_mpa = Some(ratio * below);
    }
}
