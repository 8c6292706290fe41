//! Moduli and strengths in `MPa` and a force in N, and the ratios that follow from them.
//!
//! The solvers read only the contact ratios `E_ct/E_s` and `E_ct/E_m` of Eq. (5), the strengths
//! divided by `E_s`, and the force divided by `E_s t²`. The stiffness and the strength of a scale
//! are properties of its material, not of its substrate. If they are given in `MPa`, the ratios
//! therefore follow from them, also when another modulus varies.

use super::{Parameter, key};
use crate::case::Case;

/// Keys of each ratio, of its numerator, and of the modulus in its denominator.
///
/// The denominator of the force is `E_s t²`, all others are moduli.
const RATIOS: [[&str; 3]; 5] = [
    [key::CONTACT_OVER_SUBSTRATE, key::SCALE_MODULUS, key::SUBSTRATE_MODULUS],
    [key::CONTACT_OVER_MEMBRANE, key::SCALE_MODULUS, key::MEMBRANE_MODULUS],
    [key::SCALE_STRENGTH_OVER_SUBSTRATE, key::SCALE_STRENGTH, key::SUBSTRATE_MODULUS],
    [key::BOND_STRENGTH_OVER_SUBSTRATE, key::BOND_STRENGTH, key::SUBSTRATE_MODULUS],
    [key::NEEDLE_FORCE, key::NEEDLE_FORCE_N, key::SUBSTRATE_MODULUS],
];

impl Parameter {
    /// Returns true if one of `self` and `other` is a ratio and the other one its numerator.
    pub(super) fn excludes(&self, other: &Self) -> bool {
        let keys = [self.key, other.key];
        RATIOS.iter().any(|&[ratio, above, _]| keys == [ratio, above] || keys == [above, ratio])
    }

    /// Returns true if this parameter is a ratio and `case` gives its numerator in `MPa` or N.
    pub(super) fn follows_modulus(&self, case: &Case) -> bool {
        RATIOS
            .iter()
            .any(|[ratio, above, _]| *ratio == self.key && numerator(case, above).is_some())
    }

    /// Returns the ratios with this parameter as numerator.
    ///
    /// Each item also has the key of the modulus in the denominator.
    pub(crate) fn ratios(&self) -> impl Iterator<Item = (&'static Self, &'static str)> {
        let of_this = RATIOS.into_iter().filter(|[_, above, _]| *above == self.key);
        of_this.filter_map(|[ratio, _, below]| Some((Self::named(ratio)?, below)))
    }

    /// Returns true if ratios follow from this parameter.
    pub(super) fn is_modulus(&self) -> bool {
        RATIOS.iter().any(|[_, above, below]| [*above, *below].contains(&self.key))
    }
}

fn numerator(case: &Case, key: &str) -> Option<f64> {
    let material = &case.material;
    match key {
        key::SCALE_MODULUS => material.scale_modulus_mpa,
        key::SCALE_STRENGTH => material.scale_strength_mpa,
        key::BOND_STRENGTH => material.bond_strength_mpa,
        key::NEEDLE_FORCE_N => case.needle_force_n,
        _ => None,
    }
}

/// Returns `above/below` if both numbers are given.
///
/// A number may be missing: a sweep of bending alone needs no modulus of the substrate.
fn ratio(above: Option<f64>, below: Option<f64>) -> Option<f64> {
    Some(above? / below?)
}

/// Computes the ratios from the moduli, the strengths and the force.
pub(super) fn settle(case: &mut Case) {
    let material = case.material;
    let below = material.substrate_modulus_mpa;
    // Every ratio needs one of these two moduli. Return early, because searches call this function
    // very often.
    if below.is_none() && material.membrane_modulus_mpa.is_none() {
        return;
    }
    if let Some(ratio) = ratio(material.scale_modulus_mpa, below) {
        case.puncture.contact_modulus_over_substrate = ratio;
    }
    if let Some(ratio) = ratio(material.scale_modulus_mpa, material.membrane_modulus_mpa) {
        case.flexure.contact_modulus_over_membrane = ratio;
    }
    let strengths = &mut case.strengths;
    strengths.scale = ratio(material.scale_strength_mpa, below).or(strengths.scale);
    strengths.bond = ratio(material.bond_strength_mpa, below).or(strengths.bond);
    let force = ratio(case.needle_force_n, force_unit(case));
    case.needle_force = force.or(case.needle_force);
}

/// Returns `E_s t²`, in N.
fn force_unit(case: &Case) -> Option<f64> {
    Some(case.material.substrate_modulus_mpa? * case.material.thickness_mm?.powi(2))
}

/// Updates the numerator in `MPa` or N after a change of the ratio `moved`.
pub(super) fn restate(case: &mut Case, moved: &Parameter) {
    if !moved.follows_modulus(case) {
        return;
    }
    let below = match moved.key {
        key::CONTACT_OVER_MEMBRANE => case.material.membrane_modulus_mpa,
        key::NEEDLE_FORCE => force_unit(case),
        _ => case.material.substrate_modulus_mpa,
    };
    let (Some(ratio), Some(below)) = (moved.get(case).number(), below) else { return };
    let material = &mut case.material;
    let above = match moved.key {
        key::SCALE_STRENGTH_OVER_SUBSTRATE => &mut material.scale_strength_mpa,
        key::BOND_STRENGTH_OVER_SUBSTRATE => &mut material.bond_strength_mpa,
        key::NEEDLE_FORCE => &mut case.needle_force_n,
        _ => &mut material.scale_modulus_mpa,
    };
    *above = Some(ratio * below);
}
