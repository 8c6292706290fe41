//! Events at which constraints become active or inactive.

use approx::assert_relative_eq;
use solver::{Continuation, Settings, State, System, Termination};

use crate::problems::{StringOverFloor, arch, arch_on_spring, bump, corner};
use crate::scaled::Scaled;
use crate::walls::Walls;
use crate::{changes, extrema, follow, follow_modes, steps};

#[test]
fn a_bump_activates_its_constraint_and_then_deactivates_it() {
    let (points, stop) = follow(bump(), Settings::default());
    assert_eq!(stop, Termination::Reached);
    let changes = changes(&points);
    let [(on, activated), (off, released)] = &changes[..] else { panic!("{changes:?}") };
    assert_eq!((&activated[..], &released[..]), (&[(0, true)][..], &[(0, false)][..]));
    assert_relative_eq!(on.state.z[0], 1.0, max_relative = 1e-10);
    assert_relative_eq!(off.state.z[0], 3.0, max_relative = 1e-10);
    for point in &points {
        let [u, c, p] = point.state.z[..] else { unreachable!() };
        let push = (1.0 - (u - 2.0).powi(2)).max(0.0);
        assert_relative_eq!(c, push, epsilon = 1e-9);
        assert_relative_eq!(p, 0.5 * u + 2.0 * push * (2.0 - u), epsilon = 1e-9);
    }
}

/// Compares incoming and outgoing directions at both events with the closed form.
#[test]
fn the_path_has_a_kink_at_both_ends_of_a_bump() {
    let (points, _) = follow(bump(), Settings::default());
    let slopes = changes(&points).into_iter().map(|(point, _)| {
        [&point.arriving, &point.leaving].map(|direction| direction[2] / direction[0])
    });
    // p′ = 1/2 − 2c + 2 (2 − u) c′ with c′ = 2 (2 − u) on the bump.
    for (slopes, expected) in slopes.zip([[0.5, 4.5], [4.5, 0.5]]) {
        assert_relative_eq!(slopes[0], expected[0], max_relative = 1e-9);
        assert_relative_eq!(slopes[1], expected[1], max_relative = 1e-9);
    }
}

#[test]
fn a_bump_within_one_step_is_not_missed() {
    let (points, stop) = follow(bump(), steps(1.0));
    assert_eq!(stop, Termination::Reached);
    let positions: Vec<f64> = changes(&points).iter().map(|(point, _)| point.state.z[0]).collect();
    assert_eq!(positions.len(), 2);
    assert_relative_eq!(positions[0], 1.0, max_relative = 1e-10);
    assert_relative_eq!(positions[1], 3.0, max_relative = 1e-10);
}

/// Starts paths at different points with steps of different lengths.
#[test]
fn a_bump_is_found_from_any_start_and_with_any_step() {
    for (start, step) in [(0.4, 1.0), (0.9, 0.7), (0.7, 0.6)] {
        let rest = State { z: vec![start, 0.0, 0.5 * start], active: vec![false], mode: () };
        let mut path = Continuation::new(Scaled::by_one(bump()), rest, steps(step));
        let points: Vec<_> = path.by_ref().collect();
        assert_eq!(path.termination(), Some(Termination::Reached));
        let changes = changes(&points);
        let positions: Vec<f64> = changes.iter().map(|(point, _)| point.state.z[0]).collect();
        assert_eq!(positions.len(), 2);
        assert_relative_eq!(positions[0], 1.0, max_relative = 1e-10);
        assert_relative_eq!(positions[1], 3.0, max_relative = 1e-10);
        assert!(points.len() <= 6, "{}", points.len());
    }
}

/// The wall is in contact only between `u = 0.69` and `u = 0.71`, within a single step.
///
/// The guard is a parabola, so the minimum of the cubic that predicts the contact is exact.
#[test]
fn a_thin_wall_within_one_step_is_not_missed() {
    let wall: fn(f64) -> [f64; 2] = |u| [(u - 0.7).powi(2) - 1e-4, 2.0 * (u - 0.7)];
    for system in [Walls::new(vec![wall]), Walls::measured_by_the_load(vec![wall])] {
        for start in [0.0, 0.1, 0.35] {
            let rest = State { z: vec![start, 0.0, start], active: vec![false], mode: () };
            let points: Vec<_> =
                Continuation::new(Scaled::by_one(system.clone()), rest, steps(2.0)).collect();
            let positions =
                changes(&points).iter().map(|(point, _)| point.state.z[0]).collect::<Vec<_>>();
            assert_eq!(positions.len(), 2, "from {start}: {positions:?}");
            assert_relative_eq!(positions[0], 0.69, max_relative = 1e-9);
            assert_relative_eq!(positions[1], 0.71, max_relative = 1e-9);
        }
    }
}

/// A secant of the curved guard of the nearer wall would predict contact behind the farther wall.
#[test]
fn the_nearer_of_two_walls_becomes_active_first() {
    let near: fn(f64) -> [f64; 2] =
        |u| [1.0 - (1.0 + 18.0 * u).log10(), -18.0 / (1.0 + 18.0 * u) / 10.0_f64.ln()];
    let far: fn(f64) -> [f64; 2] = |u| [0.6 - u, -1.0];
    for (walls, first) in [(vec![near, far], 0), (vec![far, near], 1)] {
        let (points, stop) = follow(Walls::new(walls), steps(1.0));
        assert_eq!(stop, Termination::Reached);
        let changes = changes(&points);
        assert_eq!(changes.len(), 2);
        for ((point, changed), (wall, position)) in
            changes.iter().zip([(first, 0.5), (1 - first, 0.6)])
        {
            assert_eq!(changed[..], [(wall, true)]);
            assert_relative_eq!(point.state.z[0], position, max_relative = 1e-10);
        }
        assert_eq!(points.len(), 3);
    }
}

/// Both walls are at the same position, but the shielding wall carries all of the force.
///
/// The result must not depend on the order of the walls.
#[test]
fn a_shielded_wall_stays_inactive() {
    let wall: fn(f64) -> [f64; 2] = |u| [0.5 - u, -1.0];
    for (shielded, by) in [(0, 1), (1, 0)] {
        let walls = Walls::shielded(vec![wall, wall], shielded, by);
        let (points, stop) = follow(walls, steps(0.2));
        assert_eq!(stop, Termination::Reached);
        let changes = changes(&points);
        assert_eq!(changes.len(), 1);
        let (point, changed) = &changes[0];
        assert_eq!(changed[..], [(by, true)]);
        assert_relative_eq!(point.state.z[0], 0.5, max_relative = 1e-12);
        let end = &points.last().unwrap().state;
        assert_relative_eq!(end.z[by + 1], 0.5, max_relative = 1e-12);
        assert_eq!((end.z[shielded + 1], end.active[shielded]), (0.0, false));
    }
}

/// Compares the points of paths of the same system in different units.
#[test]
fn a_path_does_not_depend_on_the_units_of_its_unknowns() {
    fn compare(
        system: impl System<Mode = ()> + Clone + 'static,
        factors: Vec<f64>,
        settings: Settings,
    ) {
        let (ours, stop) = follow(system.clone(), settings);
        let scaled = Scaled::new(system, factors);
        let (theirs, same) = follow_modes(scaled.clone(), settings);
        assert_eq!((stop, ours.len()), (same, theirs.len()));
        for (ours, theirs) in ours.iter().zip(&theirs) {
            assert_eq!(ours.event, theirs.event);
            for (a, b) in ours.state.z.iter().zip(scaled.unscaled(&theirs.state.z)) {
                assert_relative_eq!(*a, b, epsilon = 1e-9);
            }
        }
    }
    for settings in [Settings::default(), steps(0.3)] {
        compare(arch(), vec![-8.0, 3.0], settings);
        compare(arch_on_spring(), vec![0.3, -8.0, 5.0], settings);
        compare(bump(), vec![-8.0, 2.0, 0.25], settings);
        compare(corner(), vec![-8.0, 4.0, 0.5], settings);
        let string = StringOverFloor::halved(20, 10.0);
        let mut factors = vec![1.0; string.size()];
        factors[string.load()] = 7.0;
        compare(string, factors, settings);
    }
}

#[test]
fn a_path_on_which_the_control_parameter_reverses_at_an_event_continues() {
    let (points, stop) = follow(corner(), Settings::default());
    assert_eq!(stop, Termination::Reached);
    let changes = changes(&points);
    assert_eq!(changes.len(), 1);
    let turn = changes[0].0;
    assert_relative_eq!(turn.state.z[0], 1.0, max_relative = 1e-10);
    assert!(turn.arriving[0] > 0.0 && turn.leaving[0] < 0.0 && turn.leaving[1] > 0.0);
    let least = points.iter().filter(|point| point.state.active[0]).map(|point| point.state.z[0]);
    assert_relative_eq!(least.reduce(f64::min).unwrap(), 0.75, epsilon = 1e-3);
    let end = &points.last().unwrap().state.z;
    assert_relative_eq!(end[0], 2.0, max_relative = 1e-12);
    assert_relative_eq!(end[1], 0.5 * (1.0 + 5.0_f64.sqrt()), max_relative = 1e-9);
}

/// After the reversal of the control parameter `u = 1 − c + c²`, the load `p = u + 3c` increases.
#[test]
fn a_reversal_of_the_control_parameter_at_an_event_is_not_a_load_extremum() {
    let (points, _) = follow(corner(), Settings::default());
    assert_eq!(extrema(&points).len(), 0);
}
