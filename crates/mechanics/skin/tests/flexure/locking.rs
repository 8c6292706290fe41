//! Compares the locking of strips by friction with a beam that carries plates on torsional springs.
//!
//! [`analytical::rotating_plates`] models this beam.

use analytical::rotating_plates;
use skin::flexure::{FlexureParameters, solve};
use skin::{Base, Common};

use crate::samples::design;

/// Increasing coefficients of friction; the smallest one is the value of smooth plastic.
const FRICTIONS: [f64; 8] = [0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.5];

/// Checks that more friction locks a strip or beam earlier, as both models predict.
///
/// `locks` are the curvatures (or angles) of locking for [`FRICTIONS`], and `touch` is the value at
/// first contact. Above some coefficient of friction, scales lock at first contact.
#[track_caller]
fn locks_earlier(locks: &[Option<f64>], touch: f64) {
    let found: Vec<f64> = locks.iter().copied().skip_while(Option::is_none).flatten().collect();
    assert!(found.len() > 2, "{locks:?}");
    assert!(found.is_sorted_by(|before, after| after <= before), "{found:?}");
    let sliding = found.iter().take_while(|lock| **lock > touch * (1.0 + 1e-9)).count();
    assert!(sliding > 0 && sliding < found.len(), "{found:?} {touch}");
    assert!(found[sliding..].iter().all(|lock| (lock / touch - 1.0).abs() < 1e-9), "{found:?}");
}

#[test]
fn more_friction_locks_a_strip_earlier_but_not_before_first_contact() {
    for (length, slant) in [(0.3, 75.0), (1.0, 45.0), (1.0, 60.0), (1.0, 75.0)] {
        let strips = FRICTIONS.map(|friction| {
            let common = Common { friction, ..Common::default() };
            let strip =
                solve(&design(0.1, length, slant, Base::L), &common, &FlexureParameters::default());
            strip.expect("a valid design").measures
        });
        let touch = strips[0].first_contact_curvature.expect("scales that touch");
        locks_earlier(&strips.map(|strip| strip.locking_curvature), touch);
    }
}

#[test]
fn more_friction_locks_rotating_plates_earlier() {
    let plates =
        [0.5, 1.0, 2.0, 4.0].map(|friction| rotating_plates::engagement(5.0, 0.8, friction));
    let touch = plates[0].expect("plates that touch").touch;
    locks_earlier(&plates.map(|plates| plates.map(|plates| plates.lock)), touch);
}
