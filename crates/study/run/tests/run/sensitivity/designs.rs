//! Random designs with random settings.

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use skin::Base;
use sweep::{Case, DesignNumber, Sweep};

/// Returns a design number for designs that are not part of a grid.
pub fn number() -> DesignNumber {
    Sweep::parse("name = 'x'", "x.toml", &[]).unwrap().grid().number(0)
}

/// Returns the random design with the seed `number`.
///
/// The base, the contact law and the substrate law alternate with `number`.
pub fn random_case(number: u64) -> Case {
    let mut random = ChaCha8Rng::seed_from_u64(number);
    let mut between = |low: f64, high: f64| random.random_range(low..high);
    let mut case = Case::default();
    case.design.base = [Base::L, Base::TwoL][(number % 2) as usize];
    let exchanged = number / 2 % 2 == 1;
    let law = &mut case.common.law;
    (law.c1, law.c2) = if exchanged { (0.23, 1.1) } else { (1.1, 0.23) };
    if number % 3 == 2 {
        case.puncture.substrate_law = substrate::SubstrateLaw::NeoHookean;
    }
    case.design.gap = between(-3.0, 0.0).exp();
    case.design.length = between(-2.3, 0.3).exp();
    case.design.slant_deg = between(2.0, 78.0);
    case.design.width = between(-0.7, 1.1).exp();
    case.puncture.poisson_ratio = between(0.1, 0.45);
    case.puncture.contact_modulus_over_substrate = between(3.0, 9.0).exp();
    case.puncture.load_position = between(0.6, 0.99);
    case.puncture.critical_tilt_deg = between(4.0, 18.0);
    case.flexure.contact_modulus_over_membrane = between(2.0, 7.0).exp();
    case.flexure.membrane_thickness = between(0.05, 0.3);
    case.flexure.membrane_axis_offset = between(-0.05, 0.1);
    case.flexure.membrane_length = between(10.0, 40.0);
    case.flexure.max_end_rotation_deg = between(90.0, 179.0);
    case
}
