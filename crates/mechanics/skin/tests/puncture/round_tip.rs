//! Tests of a guided needle with a round tip.

use approx::assert_relative_eq;
use skin::puncture::{self, CriticalEvent, Needle, Puncture, PunctureParameters, RowLength};
use skin::{Base, Common, Design, Status};
use solver::{Settings, Termination};
use substrate::{Calibrations, Coupling, RowStiffness};

use crate::samples::{design, in_small_steps, solve_as, springs};
use crate::{complete, end};

const SMOOTH: Needle = Needle::Guided { friction: 0.0 };

/// Tuples `(d, L, α)`. In some of these designs a sharp needle slides from the top into a notch.
const DESIGNS: [(f64, f64, f64); 7] = [
    (0.1, 1.0, 0.0),
    (0.5, 1.0, 0.0),
    (0.1, 0.2, 0.0),
    (0.3, 0.5, 45.0),
    (0.1, 1.0, 45.0),
    (0.1, 1.0, 60.0),
    (0.1, 1.0, 75.0),
];

fn parameters(radius: Option<f64>) -> PunctureParameters {
    PunctureParameters { needle: SMOOTH, needle_radius: radius, ..PunctureParameters::default() }
}

fn solve(design: &Design, parameters: &PunctureParameters) -> Puncture {
    solve_as(&Calibrations::default(), design, &Common::default(), parameters)
}

/// The difference from a sharp tip is proportional to the radius.
#[test]
fn small_radii_converge_to_a_sharp_tip() {
    for (gap, length, slant) in DESIGNS {
        let design = design(gap, length, slant, Base::L);
        let sharp = complete(&solve(&design, &parameters(None))).critical_force.unwrap();
        let off = [0.01, 0.001, 0.0001].map(|radius| {
            let round = complete(&solve(&design, &parameters(Some(radius))));
            (round.critical_force.unwrap() / sharp - 1.0) / radius
        });
        assert_relative_eq!(off[1], off[2], max_relative = 0.02);
        assert_relative_eq!(off[0], off[2], max_relative = 0.2);
        assert!(off[2].abs() < 3.0, "{off:?} {design:?}");
    }
}

/// In these designs the tip sticks, slides in both directions, and passes into a notch.
#[test]
fn small_radii_converge_to_a_sharp_tip_with_friction() {
    for ((gap, length, slant), friction, inside) in [
        ((0.5, 1.0, 0.0), 0.1, 0.05),
        ((0.1, 0.2, 0.0), 0.3, 0.05),
        ((0.3, 0.7, 60.0), 0.3, 0.05),
        ((0.2, 0.8, 30.0), 0.3, 0.05),
        ((0.1, 1.0, 75.0), 0.3, 0.0),
    ] {
        let design = design(gap, length, slant, Base::L);
        let [sharp, larger, smaller] = [None, Some(0.01), Some(0.001)].map(|radius| {
            let load_position = 1.0 - inside / length;
            let needle = Needle::Guided { friction };
            let parameters = PunctureParameters { needle, load_position, ..parameters(radius) };
            complete(&solve(&design, &parameters)).critical_force.unwrap()
        });
        let off = [(larger / sharp - 1.0) / 0.01, (smaller / sharp - 1.0) / 0.001];
        assert!(off.iter().all(|off| off.abs() < 3.0), "{off:?} {design:?}");
        assert_relative_eq!(off[0], off[1], max_relative = 0.2, epsilon = 0.02);
    }
}

/// The force on a single scale with a circle of radius `R` on its top has a closed form.
///
/// The normal force `N` is the root of a quadratic equation, and `x` is the arm at rest:
///
/// ```text
/// N² sin φ / k_x − N (x + (1 + R) sin φ) − k_φ φ cos φ = 0                F = N cos φ
/// ```
#[test]
fn an_isolated_scale_matches_the_closed_form() {
    let known = Calibrations::default();
    for (slant, load_position, radius) in [(0.0, 1.0, 0.1), (0.0, 0.9, 1.0), (10.0, 0.9, 0.5)] {
        let design = design(0.1, 1.0, slant, Base::L);
        let parameters = PunctureParameters {
            scales: RowLength::Scales(1),
            load_position,
            ..parameters(Some(radius))
        };
        let a = design.half_base();
        let [along, _, turn] = springs(&design, &parameters, &known).direct;
        let (along, turn) = (a * along, a.powi(3) * turn);
        let puncture = solve_as(&known, &design, &in_small_steps(), &parameters);
        assert_eq!(puncture.measures.passage.critical_event, Some(CriticalEvent::Tilt));
        let arm = slant.to_radians().tan() - a + 2.0 * a * load_position;
        for (point, forces) in puncture.path.iter().zip(&puncture.tip_forces) {
            let phi = -point.tilt_deg.to_radians();
            let (sin, cos) = phi.sin_cos();
            let b = arm + (1.0 + radius) * sin;
            let [two_a, c] = [2.0 * sin / along, -turn * phi * cos];
            let root = (b * b - 2.0 * two_a * c).sqrt();
            // Use the root that remains finite at zero tilt.
            let expected = 2.0 * c / (b + root) * cos / design.length;
            assert_relative_eq!(point.force, expected, max_relative = 1e-8, epsilon = 1e-12);
            let on_scale = point.force / point.tilt_deg.to_radians().cos();
            assert_relative_eq!(forces[0].1, on_scale, max_relative = 1e-8);
        }
    }
}

/// Compares tips at mirrored positions on an upright scale; large tips touch several scales.
#[test]
fn needles_at_mirrored_positions_have_mirrored_results() {
    for (radius, friction) in [(0.2, 0.0), (1.0, 0.0), (0.2, 0.1), (1.0, 0.3)] {
        let upright = design(0.3, 0.6, 0.0, Base::L);
        let [left, right] = [0.1, 0.9].map(|load_position| {
            let needle = Needle::Guided { friction };
            let parameters =
                PunctureParameters { load_position, needle, ..parameters(Some(radius)) };
            end(&solve(&upright, &parameters))
        });
        assert_relative_eq!(left.force, right.force, max_relative = 1e-8);
        assert_relative_eq!(left.displacement, right.displacement, max_relative = 1e-8);
        assert_relative_eq!(left.lateral_force, -right.lateral_force, max_relative = 1e-8);
        assert_relative_eq!(left.tilt_deg, -right.tilt_deg, max_relative = 1e-8);
    }
}

#[test]
fn a_tip_between_two_scales_loads_both_equally() {
    let upright = design(0.3, 0.6, 0.0, Base::L);
    let between = PunctureParameters { load_position: 1.25, ..parameters(Some(0.5)) };
    let puncture = solve(&upright, &between);
    let (end, scale) = (end(&puncture), |number: i64| {
        puncture.scales.iter().find(|scale| scale.scale == number).unwrap()
    });
    assert!(end.force > 0.05 && end.lateral_force.abs() < 1e-9 * end.force, "{end:?}");
    assert_relative_eq!(scale(0).rotation_deg, -scale(1).rotation_deg, max_relative = 1e-8);
    assert_relative_eq!(scale(0).displacement[1], scale(1).displacement[1], max_relative = 1e-8);
    assert_eq!(puncture.tip_forces.len(), puncture.path.len());
    for (point, forces) in puncture.path.iter().zip(&puncture.tip_forces) {
        let [(0, left), (1, right)] = forces[..] else { panic!("{forces:?}") };
        assert_relative_eq!(left, right, max_relative = 1e-8);
        assert!(2.0 * left >= point.force);
    }
}

/// Positions of a round tip include the gap, and a tip that is moved by one pitch gives the same
/// force.
#[test]
fn load_positions_of_a_round_tip_cover_one_pitch() {
    let known = Calibrations::default();
    let design = design(0.4, 0.8, 45.0, Base::L);
    let parameters = PunctureParameters { places: Some(3), ..parameters(Some(0.5)) };
    let springs = springs(&design, &parameters, &known);
    let common = Common::default();
    let places = puncture::load_positions(&design, &springs, &common, &parameters).unwrap();
    let positions: Vec<_> = places.iter().map(|place| place.position).collect();
    assert_eq!(positions, [0.0, 0.5, 1.0]);
    let parameters = PunctureParameters { places: Some(4), ..parameters };
    let between = puncture::load_positions(&design, &springs, &common, &parameters).unwrap()[3];
    assert_relative_eq!(between.position, 1.125);
    let [single, repeated] = [1.125, 1.5].map(|load_position| {
        let parameters = PunctureParameters { load_position, places: None, ..parameters };
        complete(&solve(&design, &parameters)).critical_force.unwrap()
    });
    assert_eq!(between.force, Some(single));
    assert_relative_eq!(places[0].force.unwrap(), repeated, max_relative = 1e-8);
}

/// The path ends when the lowest point of the tip touches the soft surface: the line from the right
/// corner of one base to the left corner of the next.
#[test]
fn a_tip_between_two_scales_ends_at_the_surface_between_their_bases() {
    let open = design(1.0, 1.0, 60.0, Base::L);
    let radius = 0.2;
    let between = PunctureParameters {
        load_position: 1.3,
        critical_tilt_deg: 60.0,
        ..parameters(Some(radius))
    };
    let puncture = solve(&open, &between);
    assert_eq!(puncture.status, Status::Complete);
    assert_eq!(puncture.measures.passage.critical_event, Some(CriticalEvent::Through));
    let (a, shift) = (open.half_base(), 60.0_f64.to_radians().tan());
    let [from, to] = [(0, a), (1, -a)].map(|(number, x)| {
        let scale = puncture.scales.iter().find(|scale| scale.scale == number).unwrap();
        let (sin, cos) = scale.rotation_deg.to_radians().sin_cos();
        let node = number as f64 * (2.0 * a + open.gap);
        [node + scale.displacement[0] + x * cos, scale.displacement[1] + x * sin]
    });
    // At rest the circle touches the left face of the next scale. The normal of this face is
    // (−cos 60°, sin 60°).
    let x = shift - a + 1.3 * 2.0 * a;
    let along = x - (a + open.gap);
    let height = (2.0 * radius + along) / 3.0_f64.sqrt();
    let centre = [x, height - end(&puncture).displacement];
    let line = [to[0] - from[0], to[1] - from[1]];
    let area = line[0] * (centre[1] - from[1]) - line[1] * (centre[0] - from[0]);
    assert_relative_eq!(area / line[0].hypot(line[1]), radius, max_relative = 1e-7);
}

/// A scale that the needle does not touch may exceed the critical tilt. The path ends as soon as
/// the needle touches such a scale.
#[test]
fn touching_a_scale_beyond_the_critical_tilt_ends_the_path() {
    let blocks = design(0.1, 0.4, 0.0, Base::L);
    let stiffness = RowStiffness::compute(&blocks.footprint(0.5).unwrap(), Coupling::Full).unwrap();
    let parameters = parameters(Some(0.5));
    let puncture = puncture::solve(&blocks, stiffness, &Common::default(), &parameters).unwrap();
    assert_eq!(puncture.status, Status::Complete);
    assert_eq!(puncture.measures.passage.critical_event, Some(CriticalEvent::Tilt));
    let touched = puncture.tip_forces.last().unwrap();
    let next = touched.last().unwrap().0 + 1;
    for scale in &puncture.scales {
        let is_touched = touched.iter().any(|(touched, _)| *touched == scale.scale);
        assert!(!is_touched || scale.rotation_deg.abs() < 10.0);
        assert!(scale.scale != next || scale.rotation_deg.abs() > 14.0);
    }
    assert!(puncture.scales.iter().any(|scale| scale.scale == next));
}

/// In this design a contact closes while another contact is about to open. Because of round-off,
/// the solver may reverse the path at this event. It must detect that the path returns to rest.
#[test]
fn a_path_that_returns_to_rest_is_repeated_with_smaller_steps() {
    let steep = design(0.0258, 0.248, 57.8, Base::L);
    let stiffness = RowStiffness::compute(&steep.footprint(0.5).unwrap(), Coupling::Full).unwrap();
    let parameters = PunctureParameters { scales: RowLength::Auto, ..parameters(Some(0.221)) };
    for max_step in [0.2, 0.1, 0.02] {
        let solver = Settings { max_step, ..Settings::default() };
        let common = Common { solver, ..Common::default() };
        let puncture = puncture::solve(&steep, stiffness.clone(), &common, &parameters).unwrap();
        let force = puncture.measures.critical_force.expect("the path reaches the critical tilt");
        assert_relative_eq!(force, 4.351_706_525_75, max_relative = 1e-10);
    }
}

/// In this notch the tip with friction stops sliding on one face, and can then neither stick nor
/// slide in equilibrium.
#[test]
fn a_tip_without_an_outgoing_branch_in_a_notch_ends_as_a_jump() {
    let notched = design(0.1, 0.9, 60.0, Base::TwoL);
    for radius in [0.001, 0.01, 0.03] {
        let needle = Needle::Guided { friction: 0.3 };
        let parameters = PunctureParameters { needle, ..parameters(Some(radius)) };
        let puncture = solve(&notched, &parameters);
        assert_eq!(puncture.status, Status::Stopped(Termination::Jumps));
        assert!((end(&puncture).tilt_deg - 8.1).abs() < 0.2);
    }
}

/// The radius of the tip is 20 times the pitch of the row.
#[test]
fn a_large_tip_touches_several_scales() {
    let dense = design(0.1, 0.05, 30.0, Base::L);
    let puncture = solve(&dense, &parameters(Some(3.0)));
    let most = puncture.tip_forces.iter().map(Vec::len).max();
    assert!(most > Some(3), "{most:?}");
    assert_eq!(puncture.status, Status::Complete);
}

#[test]
fn a_radius_is_rejected_for_a_free_needle_or_if_it_covers_too_many_scales() {
    let known = Calibrations::default();
    let design = design(0.1, 1.0, 45.0, Base::L);
    let pitch = design.row().expect("a valid design").pitch();
    let refusals = [
        (Needle::Free, 0.5, "needle radius", 0.5),
        (SMOOTH, 100.0, puncture::TIP_REACH, 100.0 / pitch),
    ];
    for (needle, radius, quantity, value) in refusals {
        let parameters = PunctureParameters { needle, ..parameters(Some(radius)) };
        let springs = springs(&design, &parameters, &known);
        let refused = puncture::solve(&design, &springs, &Common::default(), &parameters);
        let refused = refused.unwrap_err();
        assert_eq!((refused.quantity, refused.value), (quantity, value));
    }
}

/// A position above the gap is then the weakest load position, with and without friction.
#[test]
fn a_tip_narrower_than_the_gap_passes_without_force() {
    let wide = design(0.8612, 0.2262, 0.34, Base::L);
    for friction in [0.0, 0.3] {
        let needle = Needle::Guided { friction };
        let tip = PunctureParameters { needle, ..parameters(Some(0.2)) };
        let between =
            PunctureParameters { load_position: 2.5, unload: true, depth: Some(0.1), ..tip };
        let puncture = solve(&wide, &between);
        let measures = complete(&puncture);
        assert_eq!(
            (measures.critical_force, measures.critical_displacement),
            (Some(0.0), Some(0.0))
        );
        assert_eq!(measures.passage.critical_event, Some(CriticalEvent::Through));
        assert_eq!((measures.secant_stiffness, measures.force_at_depth), (None, Some(0.0)));
        let unloading = puncture.unloading.as_ref().unwrap();
        assert_eq!((unloading.stop, unloading.loop_work), (Termination::Unloaded, Some(0.0)));

        let places = solve(&wide, &PunctureParameters { places: Some(11), ..tip });
        let weakest = places.measures.weakest;
        assert_eq!((weakest.force, weakest.position), (Some(0.0), Some(places.places[5].position)));
        assert!(places.places.iter().all(|place| place.status == Status::Complete));
    }
}
