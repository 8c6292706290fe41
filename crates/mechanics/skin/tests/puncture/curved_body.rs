//! Rows on convex and concave bodies.

use approx::assert_relative_eq;
use skin::puncture::{self, Needle, Puncture, PunctureInput, PunctureParameters, RowLength};
use skin::{Base, Common, Design, Neighbours, Status};

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
    // On a concave body the faces close. Many scales share the load there, so the force depends on
    // the length of the row: 3.76 with all scales of the body.
    let design = design(0.1, 0.2, 60.0);
    let flat = critical_force(&design, &on_body(0.0));
    let scales = RowLength::Scales(31);
    let concave = critical_force(&design, &PunctureParameters { scales, ..on_body(-1.0 / 16.0) });
    assert!((flat - 0.22).abs() < 5e-3, "{flat}");
    assert!((concave - 3.55).abs() < 5e-2, "{concave}");
}

#[test]
fn an_isolated_scale_does_not_feel_the_curvature() {
    let design = design(0.3, 0.5, 40.0);
    let alone =
        PunctureParameters { scales: RowLength::Scales(1), ..PunctureParameters::default() };
    let flat = critical_force(&design, &alone);
    for curvature in [0.25, -0.05] {
        let force = critical_force(&design, &PunctureParameters { curvature, ..alone });
        assert_relative_eq!(force, flat, max_relative = 1e-12);
    }
}

#[test]
fn a_vanishing_curvature_converges_to_the_flat_row() {
    let guided = Needle::Guided { friction: 0.3 };
    for (design, needle, needle_radius) in [
        (design(0.2, 0.6, 60.0), Needle::Free, None),
        (design(0.3, 0.7, 30.0), guided, None),
        (design(0.2, 0.5, 45.0), guided, Some(0.2)),
    ] {
        let at = |curvature| {
            let position = PunctureParameters { load_position: 0.9, ..on_body(curvature) };
            critical_force(&design, &PunctureParameters { needle, needle_radius, ..position })
        };
        let flat = at(0.0);
        for curvature in [1e-6, -1e-6] {
            assert_relative_eq!(at(curvature), flat, max_relative = 1e-3);
        }
        assert_relative_eq!(at(1e-9), flat, max_relative = 1e-6);
    }
}

#[test]
fn mirrored_loads_need_equal_forces() {
    // An upright row is its own mirror image.
    let design = design(0.1, 0.6, 0.0);
    for needle_radius in [None, Some(0.1)] {
        for curvature in [0.1, -0.02] {
            let forces = [0.2, 0.8].map(|load_position| {
                let needle = Needle::Guided { friction: 0.3 };
                let parameters = PunctureParameters { load_position, needle, ..on_body(curvature) };
                critical_force(&design, &PunctureParameters { needle_radius, ..parameters })
            });
            assert_relative_eq!(forces[0], forces[1], max_relative = 1e-8);
        }
    }
}

#[test]
fn the_work_of_the_load_equals_the_stored_energy() {
    for (design, curvature) in [
        (design(0.1, 1.0, 0.0), 0.1),
        (design(0.3, 1.0, 60.0), 1.0 / 16.0),
        (design(0.2, 0.6, 30.0), -0.05),
    ] {
        for needle in [Needle::Free, Needle::Guided { friction: 0.0 }] {
            let parameters =
                PunctureParameters { needle, load_position: 0.9, ..on_body(curvature) };
            let footprint = design.footprint(parameters.poisson_ratio).unwrap();
            let springs = substrate::calibrate(&footprint).unwrap();
            let solver = solver::Settings {
                first_step: 1e-3,
                max_step: 1e-3,
                ..solver::Settings::default()
            };
            let common = Common { solver, ..Common::default() };
            let puncture = puncture::solve(&design, &springs, &common, &parameters).unwrap();
            let work: f64 = puncture
                .path
                .windows(2)
                .map(|step| {
                    let [from, to] = [step[0], step[1]];
                    0.5 * (from.force + to.force) * (to.displacement - from.displacement)
                })
                .sum::<f64>()
                * design.length;
            let end = puncture.path.last().unwrap();
            let stored = end.substrate_energy + end.contact_energy;
            assert_relative_eq!(work, stored, max_relative = 1e-5);
        }
    }
}

#[test]
fn derivatives_by_curvature_agree_with_differences() {
    let mut checked = 0;
    for (design, curvature, needle, needle_radius) in [
        (design(0.2, 0.6, 60.0), 0.0, Needle::Free, None),
        (design(0.1, 1.0, 0.0), 0.05, Needle::Free, None),
        (design(0.3, 1.0, 60.0), 1.0 / 16.0, Needle::Free, None),
        (design(0.3, 0.7, 30.0), -0.02, Needle::Guided { friction: 0.3 }, None),
        (design(0.2, 0.5, 45.0), 0.03, Needle::Guided { friction: 0.2 }, Some(0.2)),
    ] {
        let input = |curvature| {
            let parameters = PunctureParameters {
                needle,
                needle_radius,
                load_position: 0.9,
                ..on_body(curvature)
            };
            let footprint = design.footprint(parameters.poisson_ratio).unwrap();
            let stiffness = (&substrate::calibrate(&footprint).unwrap()).into();
            PunctureInput { design, stiffness, common: Common::default(), parameters, odd: None }
        };
        let step = 2e-6;
        let neighbours =
            Neighbours { below: input(curvature - step), above: input(curvature + step), step };
        let (_, derivatives) = puncture::differentiate(&input(curvature), &[neighbours]).unwrap();
        let by = 1e-5;
        let [below, above] =
            [-by, by].map(|by| critical_force(&design, &input(curvature + by).parameters));
        let difference = (above - below) / (2.0 * by);
        let of_force = derivatives.iter().find(|of| of.measure == "critical_force").unwrap();
        let Some(derivative) = of_force.left.filter(|_| of_force.kink.is_none()) else { continue };
        assert_relative_eq!(derivative, difference, max_relative = 1e-5);
        checked += 1;
    }
    assert!(checked >= 4, "{checked}");
}
