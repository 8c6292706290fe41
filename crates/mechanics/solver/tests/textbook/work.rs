//! Upper bounds for the work of a path: numbers of points and Newton iterations.
//!
//! A search that converges slowly, or a step that is needlessly shortened, leads to the same
//! equilibria, so other tests do not reveal them. Lower the bounds when the solver improves.

use std::sync::atomic::Ordering;

use solver::{Continuation, Control, Peak, Settings, State, System};

use crate::problems::{
    Bratu, StringOverFloor, arch, arch_on_spring, bump, corner, kink, step, two_laws,
};
use crate::scaled::Scaled;
use crate::steps;
use crate::walls::Walls;

/// Returns the numbers of points and Newton iterations of a path from rest.
fn work(system: impl System<Mode = ()> + 'static, settings: Settings) -> [usize; 2] {
    work_of_modes(Scaled::by_one(system), settings)
}

/// Returns the work for a system with modes, otherwise like [`work`].
fn work_of_modes<S: System>(system: S, settings: Settings) -> [usize; 2] {
    let rest = State::at_rest(&system);
    let mut path = Continuation::new(system, rest, settings);
    let (mut points, mut iterations) = (0, 0);
    while path.next().is_some() {
        let history = path.take_history();
        assert!(history.last().is_some_and(|&residual| residual <= settings.tolerance));
        assert!(path.take_history().is_empty());
        points += 1;
        iterations += history.len();
    }
    [points, iterations]
}

/// Checks that no count exceeds its bound.
#[track_caller]
fn assert_at_most(counts: &[usize], most: &[usize]) {
    assert!(
        counts.iter().zip(most).all(|(count, most)| count <= most),
        "{counts:?}, at most {most:?}"
    );
}

#[test]
fn paths_with_extrema_take_few_iterations() {
    assert_at_most(&work(arch(), Settings::default()), &[7, 40]);
    assert_at_most(&work(arch(), steps(0.3)), &[5, 38]);
    assert_at_most(&work(Bratu::new(20), Settings::default()), &[7, 41]);
}

#[test]
fn paths_with_reversals_of_the_control_parameter_take_few_iterations() {
    assert_at_most(&work(arch_on_spring(), Settings::default()), &[45, 411]);
    assert_at_most(&work(arch_on_spring(), steps(0.4)), &[42, 432]);
}

/// The target is at the maximum slope of `p = tanh 4 (u − 0.6)`.
///
/// Steps near the target are measured by the arc length and end beyond the target.
#[test]
fn a_target_on_a_steep_path_takes_few_iterations() {
    let mut steep = step();
    let [progress, load] = [(0, 0.6), (1, 0.03)].map(|(index, scale)| Control { index, scale });
    steep.controls = vec![progress, load];
    steep.equations = |z| vec![(4.0 * (z[0] - 0.6)).tanh() + 2.4_f64.tanh() - z[1]];
    let rest = State::at_rest(&steep);
    let end = Continuation::new(Scaled::by_one(steep.clone()), rest, steps(0.5)).last().unwrap();
    assert!((end.state.z[0] - 0.6).abs() < 1e-12, "{:?}", end.state.z);
    assert_at_most(&work(steep, steps(0.5)), &[57, 163]);
}

#[test]
fn paths_with_constraints_take_few_iterations() {
    assert_at_most(&work(bump(), Settings::default()), &[8, 47]);
    assert_at_most(&work(bump(), steps(1.0)), &[5, 23]);
    assert_at_most(&work(corner(), Settings::default()), &[22, 155]);
    assert_at_most(&work(kink::<5>(), Settings::default()), &[7, 11]);
    assert_at_most(&work_of_modes(two_laws(), Settings::default()), &[7, 12]);
    assert_at_most(&work(StringOverFloor::halved(40, 20.0), Settings::default()), &[20, 37]);
    assert_at_most(&work(StringOverFloor::whole(20, 10.0), steps(0.5)), &[9, 17]);
}

/// Returns the number of samples in the search for the maximum slope.
///
/// Each sample evaluates the slope of the path three times, for a value and a derivative.
fn samples<S: System>(system: S, largest_step: f64) -> usize {
    let load = system.load();
    let count = std::cell::Cell::new(0);
    let slope = |_: &S, _: &State<S::Mode>, direction: &[f64]| {
        count.set(count.get() + 1);
        direction[load] / direction[0]
    };
    let rest = State::at_rest(&system);
    let mut path = Continuation::new(system, rest, steps(largest_step));
    let mut peak = Peak::default();
    let mut from = None;
    while path.next().is_some() {
        peak.visit(&path, from.as_ref(), slope);
        from = Some(path.point_shared());
    }
    count.set(0);
    peak.summit(&mut path, slope).unwrap();
    count.get() / 3
}

#[test]
fn a_maximum_between_points_takes_few_evaluations() {
    let mut tanh = step();
    tanh.equations = |z| vec![(4.0 * (z[0] - 0.6)).tanh() + 2.4_f64.tanh() - z[1]];
    let counts = [0.13, 0.047, 0.017].map(|step| samples(Scaled::by_one(tanh.clone()), step));
    assert_at_most(&counts, &[8, 7, 6]);
    assert_at_most(
        &[0.1, 0.05, 0.011].map(|step| samples(Scaled::by_one(kink::<5>()), step)),
        &[10, 9, 7],
    );
    assert_at_most(&[0.047, 0.031].map(|step| samples(two_laws(), step)), &[8, 7]);
}

/// Walls at one position become active together, without a separate solution for each wall.
#[test]
fn the_number_of_tangents_does_not_depend_on_the_number_of_coincident_walls() {
    let [few, many] = [2, 20].map(|count| {
        let walls = Walls::new(vec![|u| [0.5 - u, -1.0]; count]);
        let counter = walls.tangents.clone();
        work(walls, steps(0.2));
        counter.load(Ordering::Relaxed)
    });
    assert_eq!(few, many);
}
