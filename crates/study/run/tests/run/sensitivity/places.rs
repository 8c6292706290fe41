//! The weakest of several load positions.

use results::ParameterDerivative;
use skin::puncture::Needle;
use sweep::{Case, Parameter, Scalar};

use super::designs::random_case;
use super::differences::Differences;
use super::{TOLERANCE, compare_components, derivatives};

fn of_weakest(case: &Case) -> Vec<ParameterDerivative> {
    let mut derivatives = derivatives(case);
    derivatives.retain(|derivative| derivative.measure == "weakest_force");
    derivatives
}

/// Free needles and guided needles with friction, on both substrates.
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
        // The weakest position does not depend on the nominal load position.
        let by_place = derivatives.iter().find(|d| d.parameter == "load_position");
        assert_eq!(by_place.and_then(ParameterDerivative::derivative), Some(0.0), "{case:?}");
        let compared = compare_components(&case, &derivatives, &Differences::of(&case));
        assert!(compared >= 8, "{compared} {case:?}");
    }
}

/// Both corners of an upright scale are equally weak.
///
/// If the scale leans, one of them is weaker. Other parameters change both equally.
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
