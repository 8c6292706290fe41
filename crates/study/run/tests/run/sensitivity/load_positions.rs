//! Derivatives with several load positions, and with other positions than the right corner.

use results::ParameterDerivative;
use run::Evaluator;
use skin::puncture::Needle;
use sweep::{Case, Measure, Parameter, Scalar};

use super::designs::{self, random_case};
use super::differences::Differences;
use super::{TOLERANCE, compare, compare_components, derivatives};

fn of_weakest(case: &Case) -> Vec<ParameterDerivative> {
    let mut derivatives = derivatives(case);
    derivatives.retain(|derivative| derivative.measure == "weakest_force");
    derivatives
}

/// Half of the designs have a free needle, half a guided needle with friction.
#[test]
fn derivatives_of_the_weakest_force_match_differences() {
    for number in 0..6 {
        let mut case = random_case(number);
        case.puncture.places = Some(4);
        if number % 2 == 0 {
            case.puncture.needle = Needle::Guided { friction: 0.0 };
            case.needle_friction = Some(Scalar::Number(0.3));
        }
        let derivatives = of_weakest(&case);
        // The positions that are compared do not depend on the load position of the design.
        let by_place = derivatives.iter().find(|d| d.parameter == "load_position");
        assert_eq!(by_place.and_then(ParameterDerivative::derivative), Some(0.0), "{case:?}");
        let compared = compare_components(&case, &derivatives, &Differences::of(&case));
        assert!(compared >= 8, "{compared} {case:?}");
    }
}

/// Both corners of an upright scale are equally weak.
///
/// A slant makes one corner weaker, so there is a kink. Other parameters change both forces
/// equally.
#[test]
fn equally_weak_positions_have_one_sided_derivatives() {
    let mut case = random_case(0);
    (case.design.slant_deg, case.puncture.places) = (0.0, Some(2));
    let differences = Differences::of(&case);
    for derivative in of_weakest(&case) {
        let is_slant = derivative.parameter == "slant_deg";
        assert_eq!(derivative.kink.is_some(), is_slant, "{derivative:?}");
        let parameter = Parameter::named(derivative.parameter).unwrap();
        let size = parameter.size(&case).unwrap();
        let ours = derivative.right.unwrap() * size;
        let off = differences.off_one_sided("weakest_force", &[(parameter, size)], ours);
        assert!(off.unwrap() <= TOLERANCE, "{off:?} {derivative:?}");
        assert!(!is_slant || derivative.left > derivative.right, "{derivative:?}");
    }
}

/// A frictionless round tip has derivatives with respect to all parameters except its friction.
#[test]
fn a_frictionless_round_tip_has_derivatives() {
    let mut case = random_case(4);
    case.puncture.needle = Needle::Guided { friction: 0.0 };
    case.needle_friction = Some(Scalar::Number(0.0));
    for (radius, load_position) in [(0.2, 0.9), (0.05, 1.3)] {
        case.puncture.needle_radius = Some(radius);
        case.puncture.load_position = load_position;
        (case.design.gap, case.design.slant_deg) = (0.8, 0.3);
        let mut of_force = derivatives(&case);
        of_force.retain(|derivative| derivative.measure == "critical_force");
        assert!(of_force.iter().all(|d| d.parameter != "needle_friction"));
        assert!(compare_components(&case, &of_force, &Differences::of(&case)) > 7);
    }
}

/// A load left of the middle of the top tilts an almost upright scale to the left.
#[test]
fn a_load_left_of_the_middle_has_derivatives() {
    let mut case = random_case(0);
    (case.design.slant_deg, case.puncture.load_position) = (3.0, 0.1);
    let solved = Evaluator::new(&[Measure::Puncture]).solve(designs::number(), &case);
    assert!(solved.puncture.unwrap().path.last().unwrap().tilt_deg < -1.0);
    assert!(compare(&case) > 50);
}

/// The position of a free load and of a needle with friction is given by the distance to the
/// corner.
#[test]
fn the_inset_of_the_load_has_derivatives() {
    for number in 0..4 {
        let mut case = random_case(number);
        case.load_inset = Some(0.3 * case.design.half_base());
        if number % 2 == 1 {
            case.puncture.needle = Needle::Guided { friction: 0.0 };
            case.needle_friction = Some(Scalar::Number(0.3));
        }
        let mut of_force = derivatives(&case);
        of_force.retain(|d| ["critical_force", "peak_force"].contains(&d.measure));
        assert!(of_force.iter().all(|d| d.parameter != "load_position"));
        let inset: Vec<_> =
            of_force.iter().filter(|d| d.parameter == "load_inset_over_t").collect();
        assert!(inset.len() == 2 && inset.iter().all(|d| d.derivative() != Some(0.0)), "{inset:?}");
        assert!(compare_components(&case, &of_force, &Differences::of(&case)) > 12);
    }
}
