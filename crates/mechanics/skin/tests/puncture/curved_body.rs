//! Rows on convex and concave bodies.

use approx::assert_relative_eq;
use skin::puncture::{self, Needle, Puncture, PunctureParameters, RowLength};
use skin::{Base, Common, Design, Status};

fn design(gap: f64, length: f64, slant_deg: f64) -> Design {
    Design { gap, length, slant_deg, base: Base::L, width: 1.0 }
}

fn solve(design: &Design, parameters: &PunctureParameters) -> Puncture {
    let footprint = design.footprint(parameters.poisson_ratio).unwrap();
    let springs = substrate::calibrate(&footprint).unwrap();
    puncture::solve(design, &springs, &Common::default(), parameters).unwrap()
}

fn on_body(curvature: f64) -> PunctureParameters {
    PunctureParameters { curvature, ..PunctureParameters::default() }
}

fn critical_force(design: &Design, parameters: &PunctureParameters) -> f64 {
    let puncture = solve(design, parameters);
    assert_eq!(puncture.status, Status::Complete, "{design:?} {parameters:?}");
    puncture.measures.critical_force.unwrap()
}

#[test]
fn forces_agree_with_two_independent_programs() {
    // A path follower and energy minimisation agree on these values.
    let radii = [f64::INFINITY, 32.0, 16.0, 8.0, 4.0];
    for (design, expected) in [
        (design(0.1, 1.0, 0.0), [0.118, 0.105, 0.092, 0.076, 0.076]),
        (design(0.3, 1.0, 60.0), [0.392, 0.119, 0.047, 0.021, 0.020]),
        (design(0.2, 0.6, 60.0), [0.577, 0.101, 0.041, 0.021, 0.012]),
    ] {
        for (radius, expected) in radii.into_iter().zip(expected) {
            let force = critical_force(&design, &on_body(1.0 / radius));
            assert!((force - expected).abs() < 5.1e-4, "{design:?} R = {radius}: {force}");
        }
    }
    // On a concave body the faces close like a fist.
    let design = design(0.1, 0.2, 60.0);
    let [flat, concave] = [0.0, -1.0 / 16.0].map(|at| critical_force(&design, &on_body(at)));
    assert!((flat - 0.22).abs() < 5e-3, "{flat}");
    assert!((concave - 3.5).abs() < 5e-2, "{concave}");
}
