//! The modulus of the scales, and the two contact ratios that follow from it.
//!
//! The solvers read only `E_ct/E_s` and `E_ct/E_m` of Eq. (5). The stiffness of a scale is a
//! property of its material, not of its substrate. With `E_ct` in `MPa`, both ratios therefore
//! follow from it, also when another modulus varies.

use super::{Parameter, key};
use crate::case::Case;

impl Parameter {
    /// Returns the key of the modulus in the denominator of a contact ratio.
    fn below_contact(&self) -> Option<&'static str> {
        match self.key {
            key::CONTACT_OVER_SUBSTRATE => Some(key::SUBSTRATE_MODULUS),
            key::CONTACT_OVER_MEMBRANE => Some(key::MEMBRANE_MODULUS),
            _ => None,
        }
    }

    /// Returns true for a pair of the modulus of the scales and a contact ratio.
    pub(super) fn excludes(&self, other: &Self) -> bool {
        let follows = |one: &Self, other: &Self| {
            one.below_contact().is_some() && other.key == key::SCALE_MODULUS
        };
        follows(self, other) || follows(other, self)
    }

    /// Returns true for a contact ratio that follows from the modulus of the scales.
    pub(super) fn follows_modulus(&self, case: &Case) -> bool {
        self.below_contact().is_some() && case.material.scale_modulus_mpa.is_some()
    }

    /// Returns the contact ratios, each with the key of its denominator.
    pub(crate) fn ratios() -> impl Iterator<Item = (&'static Self, &'static str)> {
        super::PARAMETERS.iter().filter_map(|ratio| Some((ratio, ratio.below_contact()?)))
    }

    /// Returns true if contact ratios follow from this parameter.
    pub(super) fn is_modulus(&self) -> bool {
        let below = [key::SUBSTRATE_MODULUS, key::MEMBRANE_MODULUS];
        self.key == key::SCALE_MODULUS || below.contains(&self.key)
    }
}

/// Returns the contact ratios with the moduli in their denominators.
fn ratios(case: &mut Case) -> [(&mut f64, Option<f64>); 2] {
    let material = case.material;
    [
        (&mut case.puncture.contact_modulus_over_substrate, material.substrate_modulus_mpa),
        (&mut case.flexure.contact_modulus_over_membrane, material.membrane_modulus_mpa),
    ]
}

/// Computes the contact ratios from the modulus of the scales.
pub(super) fn settle(case: &mut Case) {
    let Some(scales) = case.material.scale_modulus_mpa else { return };
    for (ratio, below) in ratios(case) {
        // A sweep of bending alone may leave out the modulus of the substrate.
        *ratio = below.map_or(*ratio, |below| scales / below);
    }
}

/// Updates the modulus of the scales after a change of the ratio `moved`.
pub(super) fn restate(case: &mut Case, moved: &Parameter) {
    let k = usize::from(moved.key == key::CONTACT_OVER_MEMBRANE);
    let (&mut ratio, below) = ratios(case)[k];
    if let (true, Some(below)) = (moved.follows_modulus(case), below) {
        case.material.scale_modulus_mpa = Some(ratio * below);
    }
}
