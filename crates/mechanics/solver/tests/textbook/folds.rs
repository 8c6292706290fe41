//! Paths with extrema of the load and reversals of the control parameter.

use approx::assert_relative_eq;
use solver::{Continuation, Settings, State, Termination};
use std::f64::consts::TAU;

use crate::problems::{Bratu, SPRING, arch, arch_on_spring, circle};
use crate::scaled::Scaled;
use crate::{extrema, follow, steps};

#[test]
fn the_load_extrema_of_an_arch_agree_with_the_closed_form() {
    let (points, stop) = follow(arch(), Settings::default());
    assert_eq!(stop, Termination::Reached);
    let extrema = extrema(&points);
    let (offset, load) = (3.0_f64.sqrt().recip(), 2.0 / 27.0_f64.sqrt());
    assert_eq!(extrema.len(), 2);
    for (found, sign) in extrema.iter().zip([-1.0, 1.0]) {
        assert_relative_eq!(found[0], 1.0 + sign * offset, max_relative = 1e-8);
        assert_relative_eq!(found[1], -sign * load, max_relative = 1e-12);
    }
    let end = &points.last().unwrap().state.z;
    assert_relative_eq!(end[0], 2.5, max_relative = 1e-12);
    assert_relative_eq!(end[1], 1.875, max_relative = 1e-12);
}

#[test]
fn the_path_is_followed_through_reversals_of_the_control_parameter() {
    let (points, stop) = follow(arch_on_spring(), steps(0.05));
    assert_eq!(stop, Termination::Reached);
    let mut before = 0.0;
    for point in &points {
        let [w, d, p] = point.state.z[..] else { unreachable!() };
        assert_relative_eq!(p, w * (1.0 - w) * (2.0 - w), epsilon = 1e-9);
        assert_relative_eq!(d, w + p / SPRING, epsilon = 1e-9);
        // The displacement of the arch increases continuously.
        assert!(before < w && w < before + 0.2, "from w = {before} to {w}");
        before = w;
    }
    let positions: Vec<f64> = points.iter().map(|point| point.state.z[1]).collect();
    let turns = positions.windows(3).filter(|d| (d[1] - d[0]) * (d[2] - d[1]) < 0.0).count();
    assert_eq!(turns, 2);
    assert_eq!(extrema(&points).len(), 2);
}

#[test]
fn extrema_and_end_of_a_snap_back_do_not_depend_on_the_step_size() {
    let ends = [0.05, 0.005].map(|step| {
        let (points, stop) = follow(arch_on_spring(), steps(step));
        assert_eq!(stop, Termination::Reached);
        let mut ends: Vec<f64> = extrema(&points).concat();
        ends.extend(&points.last().unwrap().state.z);
        ends
    });
    assert_eq!(ends[0].len(), 9);
    for (coarse, fine) in ends[0].iter().zip(&ends[1]) {
        assert_relative_eq!(coarse, fine, max_relative = 1e-8);
    }
}

/// The path starts at the lowest point of the circle and returns to this point.
///
/// Near the reversals of `x` the solver measures steps by the arc length.
#[test]
fn a_circle_is_followed_for_a_full_turn() {
    let start = State { z: vec![0.0, -1.0], active: Vec::new(), mode: () };
    let mut path = Continuation::new(Scaled::by_one(circle()), start, Settings::default());
    let (mut turned, mut before) = (0.0, path.point().clone());
    loop {
        let point = path.next().unwrap();
        let [x, y] = point.state.z[..] else { unreachable!() };
        assert_relative_eq!(x.hypot(y), 1.0, max_relative = 1e-12);
        let [u, v] = before.state.z[..] else { unreachable!() };
        let angle = (u * y - v * x).atan2(u * x + v * y);
        assert!(angle > 0.0);
        if turned + angle >= TAU {
            // The segment is measured by x, which is zero at the start of the path.
            let fraction = u / (u - x);
            let end = path.between(&before, &point, fraction).unwrap();
            assert_relative_eq!(end.state.z[0], 0.0, epsilon = 1e-12);
            assert_relative_eq!(end.state.z[1], -1.0, epsilon = 1e-12);
            break;
        }
        turned += angle;
        before = point;
    }
}

/// The angle between successive outgoing directions must be at most 45°.
#[test]
fn steps_on_a_strongly_curved_path_are_shortened() {
    let start = State { z: vec![0.0, -1.0], active: Vec::new(), mode: () };
    let points: Vec<_> =
        Continuation::new(Scaled::by_one(circle()), start, steps(1.0)).take(100).collect();
    let turns = points.windows(2).map(|pair| {
        let [from, to] = [&pair[0], &pair[1]].map(|point| &point.leaving[..]);
        let along = (from[0] * to[0] + from[1] * to[1]) / from[0].hypot(from[1]).powi(2);
        assert!(from[0] * to[1] > from[1] * to[0]);
        along.min(1.0).acos().to_degrees()
    });
    let turns: Vec<f64> = turns.collect();
    let sharpest = turns.iter().copied().fold(0.0, f64::max);
    assert!((30.0..46.0).contains(&sharpest), "{turns:?}");
}

#[test]
fn the_load_extrema_of_a_circle_are_at_the_top_and_at_the_bottom() {
    let start = State { z: vec![0.6, -0.8], active: Vec::new(), mode: () };
    let path = Continuation::new(Scaled::by_one(circle()), start, Settings::default());
    let points: Vec<_> = path.take(300).collect();
    let extrema = extrema(&points);
    assert!(extrema.len() > 4);
    for (found, y) in extrema.iter().zip([1.0, -1.0].into_iter().cycle()) {
        assert_relative_eq!(found[0], 0.0, epsilon = 1e-8);
        assert_relative_eq!(found[1], y, max_relative = 1e-12);
    }
}

/// The critical load is `λ = 2 (2θ/cosh θ)²` with `θ tanh θ = 1`.
///
/// The error of central differences is of second order in the length of the intervals.
#[test]
fn the_fold_of_bratus_problem_converges_to_the_critical_load() {
    let critical = 3.513_830_719_125_16;
    let loads = [10, 20, 40].map(|intervals| {
        let (points, stop) = follow(Bratu::new(intervals), Settings::default());
        assert_eq!(stop, Termination::Reached);
        let extrema = extrema(&points);
        assert_eq!(extrema.len(), 1);
        *extrema[0].last().unwrap()
    });
    let errors = loads.map(|load| load - critical);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.02, "order {order} of the errors {errors:?}");
    }
    let extrapolated = loads[2] + (loads[2] - loads[1]) / 3.0;
    assert_relative_eq!(extrapolated, critical, max_relative = 2e-6);
}

#[test]
fn a_path_is_reproducible() {
    let [first, second] = [(); 2].map(|()| follow(arch_on_spring(), Settings::default()).0);
    assert_eq!(first, second);
}

#[test]
fn equilibria_between_two_points_lie_on_the_path() {
    let mut path =
        Continuation::new(Scaled::by_one(arch()), State::at_rest(&arch()), Settings::default());
    let start = path.point().clone();
    let end = path.nth(1).unwrap();
    for fraction in [0.0, 0.25, 1.0] {
        let point = path.between(&start, &end, fraction).unwrap();
        let u = fraction * end.state.z[0];
        assert_relative_eq!(point.state.z[0], u, epsilon = 1e-15);
        assert_relative_eq!(point.state.z[1], u * (1.0 - u) * (2.0 - u), epsilon = 1e-14);
        let slope = point.arriving[1] / point.arriving[0];
        assert_relative_eq!(slope, 3.0 * u * u - 6.0 * u + 2.0, max_relative = 1e-12);
        assert_eq!(point.arriving, point.leaving);
    }
    assert_relative_eq!(path.point().state.z[0], end.state.z[0]);
}
