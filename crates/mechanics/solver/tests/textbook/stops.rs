//! Tests of the reasons for the end of a path.

use approx::assert_relative_eq;
use solver::{Condition, Continuation, Event, Newton, NewtonFailure, Settings, State, Termination};

use crate::problems::{
    InactiveKink, Stiff, arch, circle, column, jump, kink, parabola, pushed_arch, root, step,
};
use crate::scaled::Scaled;
use crate::{extrema, follow, steps};

#[test]
fn a_path_ends_at_its_target() {
    let (points, stop) = follow(arch(), Settings::default());
    assert_eq!(stop, Termination::Reached);
    assert_relative_eq!(points.last().unwrap().state.z[0], 2.5, max_relative = 1e-12);
}

#[test]
fn a_path_under_a_load_that_can_only_push_ends_at_zero_load() {
    for step in [0.01, 0.1, 0.5] {
        let (points, stop) = follow(pushed_arch(), steps(step));
        let last = points.last().unwrap();
        assert_eq!((stop, &last.event), (Termination::Unloaded, &Some(Event::Unloaded)));
        assert_relative_eq!(last.state.z[0], 1.0, max_relative = 1e-12);
        assert!(last.state.z[1].abs() < 1e-15);
        assert_relative_eq!(extrema(&points)[0][1], 2.0 / 27.0_f64.sqrt(), max_relative = 1e-12);
    }
}

#[test]
fn a_path_ends_without_convergence_at_a_discontinuity() {
    let (points, stop) = follow(jump(), Settings::default());
    assert_eq!(stop, Termination::NoConvergence);
    assert_relative_eq!(points.last().unwrap().state.z[0], 0.5, max_relative = 1e-6);
}

#[test]
fn the_tangent_is_singular_where_the_control_parameter_is_stationary() {
    let (points, stop) = follow(parabola(), Settings::default());
    assert_eq!((points.len(), stop), (0, Termination::Singular));
}

/// The column may buckle at the load 1; the path must follow the straight column.
#[test]
fn a_path_keeps_its_branch_at_a_bifurcation() {
    let mut path =
        Continuation::new(Scaled::by_one(column()), State::at_rest(&column()), Settings::default());
    assert!(path.by_ref().all(|point| point.state.z[1] == 0.0));
    assert_eq!((path.termination(), path.is_unique()), (Some(Termination::Reached), false));
}

#[test]
fn a_path_without_end_stops_at_the_largest_number_of_points() {
    let start = State { z: vec![0.0, -1.0], active: Vec::new(), mode: () };
    let settings = Settings { max_points: 50, ..Settings::default() };
    let mut path = Continuation::new(Scaled::by_one(circle()), start, settings);
    assert_eq!(path.by_ref().count(), 50);
    assert_eq!(path.termination(), Some(Termination::TooManyPoints));
}

/// With steps a thousand times smaller than the default, the limit is a thousand times larger.
#[test]
fn smaller_steps_raise_the_limit_on_work() {
    let (first_step, max_step, max_work) = (2e-4, 2e-4, 3000);
    let settings = Settings { first_step, max_step, max_work, ..Settings::default() };
    let (points, stop) = follow(step(), settings);
    assert!(points.len() > 3000, "{}", points.len());
    assert_eq!(stop, Termination::Reached);
}

/// The path on a circle passes both load extrema again and again.
#[test]
fn a_path_that_returns_to_the_same_events_stops_without_progress() {
    let start = State { z: vec![0.0, -1.0], active: Vec::new(), mode: () };
    let mut path = Continuation::new(Scaled::by_one(circle()), start, Settings::default());
    let points = path.by_ref().count();
    assert_eq!(path.termination(), Some(Termination::NoProgress));
    assert!((100..10_000).contains(&points), "{points}");
}

#[test]
fn a_path_ends_as_not_finite_at_the_end_of_the_domain_of_its_equations() {
    let start = State { z: vec![0.0, 0.5_f64.sqrt()], active: Vec::new(), mode: () };
    let mut path = Continuation::new(Scaled::by_one(root()), start, Settings::default());
    let last = path.by_ref().last().unwrap();
    assert_eq!(path.termination(), Some(Termination::NotFinite));
    assert_relative_eq!(last.state.z[0], 0.5, max_relative = 1e-6);
}

#[test]
fn a_path_ends_as_cycling_if_both_directions_violate_a_constraint() {
    let (points, stop) = follow(InactiveKink::Violated(kink::<5>()), Settings::default());
    assert_eq!(stop, Termination::Cycling);
    assert!(points.last().unwrap().state.z[0] < 0.5);
}

#[test]
fn a_path_ends_as_singular_if_the_transition_of_a_constraint_fails() {
    let (points, stop) = follow(InactiveKink::NoTransition(kink::<5>()), Settings::default());
    assert_eq!(stop, Termination::Singular);
    assert!(points.last().unwrap().state.z[0] < 0.5);
}

/// Equations with large terms have large round-off errors, which must not prevent convergence.
#[test]
fn equations_are_satisfied_relative_to_their_terms() {
    let mut path =
        Continuation::new(Scaled::by_one(Stiff), State::at_rest(&Stiff), Settings::default());
    let end = path.by_ref().last().unwrap();
    assert_eq!(path.termination(), Some(Termination::Reached));
    assert_relative_eq!(end.state.z[1], 1.0_f64.sin(), max_relative = 1e-12);
    let residuals = path.take_history();
    assert!(residuals.iter().all(|residual| *residual <= 1.0), "{residuals:?}");
    assert!(residuals.iter().any(|residual| *residual > 1e-10));
}

#[test]
fn failures_of_newtons_method_state_their_reason() {
    let settings = Settings::default();
    let impatient = Settings { max_iterations: 0, ..Settings::default() };
    let failures =
        [(parabola(), 0.3, &settings), (root(), 0.7, &settings), (arch(), 0.3, &impatient)].map(
            |(system, value, settings)| {
                let mut state = State { z: vec![0.0, 0.0], active: Vec::new(), mode: () };
                let condition = Condition::new(vec![(0, 1.0)], value);
                Newton::new(&system).solve(&system, &mut state, &condition, settings).unwrap_err()
            },
        );
    assert!(matches!(failures[0], NewtonFailure::Singular(_)));
    assert_eq!(failures[1..], [NewtonFailure::NotFinite, NewtonFailure::TooManyIterations]);
}

#[test]
fn terminations_are_displayed_by_their_names() {
    let stops = [
        Termination::Reached,
        Termination::Unloaded,
        Termination::NoConvergence,
        Termination::Singular,
        Termination::TooManyPoints,
        Termination::TooMuchWork,
        Termination::Cycling,
        Termination::Jumps,
        Termination::NotFinite,
    ];
    let names = stops.map(|stop| stop.to_string());
    assert_eq!(
        names,
        [
            "reached",
            "unloaded",
            "no convergence",
            "singular tangent",
            "too many points",
            "too much work",
            "cycling constraints",
            "jumps",
            "not finite"
        ]
    );
}
