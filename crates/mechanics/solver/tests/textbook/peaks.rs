//! Tests of the search for the maximum slope of a path.

use approx::assert_relative_eq;
use solver::{Continuation, Equilibrium, Peak, State, System};

use crate::problems::{arch, kink, step, two_laws};
use crate::scaled::Scaled;
use crate::steps;

/// Returns the largest slope `dp/du` of a path at its points, and the largest also between them.
fn steepest(system: impl System<Mode = ()> + 'static, largest_step: f64) -> [f64; 2] {
    steepest_of_modes(Scaled::by_one(system), largest_step)
}

/// Returns the largest slopes for a system with modes, otherwise like [`steepest`].
fn steepest_of_modes<S: System>(system: S, largest_step: f64) -> [f64; 2] {
    let load = system.load();
    largest(system, largest_step, |_, direction| direction[load] / direction[0])
}

/// Returns the largest value of `f` on a path at its points, and the largest also between them.
///
/// `f` is a function of state and path direction.
fn largest<S: System>(
    system: S,
    largest_step: f64,
    f: impl Fn(&State<S::Mode>, &[f64]) -> f64,
) -> [f64; 2] {
    let rest = State::at_rest(&system);
    let mut path = Continuation::new(system, rest, steps(largest_step));
    let (mut peak, mut sampled) = (Peak::default(), f64::NEG_INFINITY);
    let mut from = None;
    loop {
        peak.visit(&path, from.as_ref(), |_, state, direction| f(state, direction));
        from = Some(path.point_shared());
        let Equilibrium { state, arriving, leaving, .. } = path.point();
        sampled = sampled.max(f(state, arriving)).max(f(state, leaving));
        if path.next().is_none() {
            break;
        }
    }
    [sampled, peak.summit(&mut path, |_, state, direction| f(state, direction)).unwrap().value]
}

#[test]
fn the_largest_slope_is_located_between_points() {
    for largest_step in [0.13, 0.047, 0.017, 0.0031] {
        let mut system = step();
        // The constant shifts the load so that the state of rest satisfies the equation.
        system.equations = |z| vec![(4.0 * (z[0] - 0.6)).tanh() + 2.4_f64.tanh() - z[1]];
        let [sampled, refined] = steepest(system, largest_step);
        assert!(sampled < 4.0 - 1e-9, "{sampled} at steps of {largest_step}");
        assert_relative_eq!(refined, 4.0, max_relative = 1e-8);
    }
}

#[test]
fn the_largest_slope_is_found_at_the_start_of_the_path() {
    let mut system = arch();
    system.controls[0].scale = 1.0;
    let [sampled, refined] = steepest(system, 0.05);
    assert_relative_eq!(sampled, 2.0, max_relative = 1e-12);
    assert_relative_eq!(refined, 2.0, max_relative = 1e-12);
}

/// Returns the maximum slope of [`kink`] with the decay `k` in closed form.
///
/// The maximum of `(c^1.1 e^(−kc))′` is at the solution of `(kc)² − 2.2 kc + 0.11 = 0`.
fn steepest_behind_the_kink(decay: f64) -> f64 {
    let scaled = 1.1 - (1.1_f64.powi(2) - 0.11).sqrt();
    let c = scaled / decay;
    1.0 + (-scaled).exp() * (1.1 * c.powf(0.1) - decay * c.powf(1.1))
}

#[test]
fn a_maximum_close_behind_a_kink_is_found() {
    for largest_step in [0.1, 0.05, 0.011] {
        let [_, refined] = steepest(kink::<5>(), largest_step);
        assert_relative_eq!(refined, steepest_behind_the_kink(5.0), max_relative = 1e-8);
    }
}

/// The maximum lies within the first thousandth of a segment.
///
/// Far from the kink the slope is 1, so the distance from the kink is subtracted there to exclude
/// other maxima.
#[test]
fn a_maximum_very_close_behind_a_kink_is_found() {
    for largest_step in [0.13, 0.047, 0.011] {
        let [_, refined] =
            largest(Scaled::by_one(kink::<400>()), largest_step, |state, direction| {
                let away = (0.5 - state.z[0]).max(state.z[0] - 0.55).max(0.0);
                direction[2] / direction[0] - away
            });
        assert_relative_eq!(refined, steepest_behind_the_kink(400.0), max_relative = 1e-6);
    }
}

#[test]
fn a_maximum_before_a_change_of_mode_is_evaluated_in_the_earlier_mode() {
    for largest_step in [0.047, 0.031] {
        let [_, refined] = steepest_of_modes(two_laws(), largest_step);
        assert_relative_eq!(refined, 3.0, max_relative = 1e-8);
    }
}
