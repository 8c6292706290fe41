//! Tests that results do not depend on units, and on redundant parameters.

use approx::assert_relative_eq;
use contact::Law;
use skin::puncture::{self, PunctureMeasures, PunctureParameters};
use skin::{Base, Common, Design};
use substrate::Calibrations;

use crate::complete;
use crate::samples::{LAWS, on_row, settled, solve_as, springs, with_law};

/// Relative difference within which two measures count as equal.
const SAME: f64 = 1e-9;

/// Solves a design with the springs of an incompressible substrate, for any Poisson's ratio.
fn measured(design: &Design, parameters: &PunctureParameters) -> PunctureMeasures {
    let springs = springs(&settled(), &on_row(1), &Calibrations::default());
    complete(&puncture::solve(design, &springs, &Common::default(), parameters).unwrap())
}

/// Forces are in units of `E*`, but stiffnesses and the contact modulus in units of `E_s`.
#[test]
fn results_depend_only_on_the_contact_modulus_divided_by_the_reduced_modulus() {
    let rubber = on_row(41);
    let mut cork = PunctureParameters { poisson_ratio: 0.0, ..rubber };
    cork.contact_modulus_over_substrate *= 0.75;
    let [rubber, cork] = [rubber, cork].map(|parameters| measured(&settled(), &parameters));
    for (rubber, cork, factor) in [
        (rubber.critical_force, cork.critical_force, 1.0),
        (rubber.critical_displacement, cork.critical_displacement, 1.0),
        (rubber.penetration, cork.penetration, 1.0),
        (rubber.initial_stiffness, cork.initial_stiffness, 4.0 / 3.0),
        (rubber.max_stiffness, cork.max_stiffness, 4.0 / 3.0),
        (rubber.secant_stiffness, cork.secant_stiffness, 4.0 / 3.0),
    ] {
        assert_relative_eq!(rubber.unwrap(), factor * cork.unwrap(), max_relative = SAME);
    }
}

/// The width of a scale enters the contact law only as a factor of its modulus.
#[test]
fn a_scale_three_times_as_wide_and_a_third_as_stiff_is_equivalent() {
    let mut softer = on_row(41);
    softer.contact_modulus_over_substrate /= 3.0;
    let wider = Design { width: 3.0, ..settled() };
    let ours = measured(&wider, &softer);
    crate::assert_same_measures(&ours, &measured(&settled(), &on_row(41)), SAME);
}

/// A base of `2L` with half the length is the same geometry as a base of `L`.
///
/// The contact law (Eq. 5) divides the approach by `L`, which another prefactor compensates. `F*`
/// is the force divided by `L`, so it doubles.
#[test]
fn both_meanings_of_the_length_give_equal_results_for_equal_geometry() {
    let (known, ours) = (Calibrations::default(), settled());
    let theirs = Design { length: 0.5 * ours.length, base: Base::TwoL, ..ours };
    for law in LAWS {
        let renamed = Law { c1: law.c1 * 2.0_f64.powf(1.0 - law.c2), ..law };
        let ours = complete(&solve_as(&known, &ours, &with_law(law), &on_row(41)));
        let theirs = complete(&solve_as(&known, &theirs, &with_law(renamed), &on_row(41)));
        let [force, twice] = [ours, theirs].map(|measures| measures.critical_force.unwrap());
        assert_relative_eq!(2.0 * force, twice, max_relative = SAME);
        let [u, v] = [ours, theirs].map(|measures| measures.critical_displacement.unwrap());
        assert_relative_eq!(u, v, max_relative = SAME);
    }
}

#[test]
fn forces_converge_with_increasing_contact_modulus() {
    for law in LAWS {
        let [reference, hard, rigid] = [1.0, 1e4, 1e8].map(|factor| {
            let mut parameters = on_row(41);
            parameters.contact_modulus_over_substrate *= factor;
            let known = Calibrations::default();
            let puncture = solve_as(&known, &settled(), &with_law(law), &parameters);
            complete(&puncture).critical_force.unwrap()
        });
        // With the printed law contacts are nearly rigid even at the reference modulus, so compare
        // the remaining difference with the whole change.
        assert!((hard - rigid).abs() <= 1e-2 * (reference - rigid).abs());
        assert_relative_eq!(hard, rigid, max_relative = 1e-5);
    }
}
