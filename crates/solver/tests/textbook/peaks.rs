//! Largest slopes of a path.

use approx::assert_relative_eq;
use solver::{Path, Peak, State, System};

use crate::problems::{DECAY, arch, kink, step, two_laws};
use crate::steps;

/// The largest slope `dp/du` of a path from rest, at its points and between them.
fn steepest<S: System>(system: S, largest_step: f64) -> [f64; 2] {
    let load = system.load();
    let slope = |_: &S, _: &State, direction: &[f64]| direction[load] / direction[0];
    let rest = State::at_rest(&system);
    let mut path = Path::new(system, rest, steps(largest_step));
    let mut peak = Peak::default();
    peak.visit(&path, slope);
    while path.next().is_some() {
        peak.visit(&path, slope);
    }
    [peak.sampled().unwrap(), peak.refined(&path, slope).unwrap()]
}

#[test]
fn the_steepest_place_is_found_between_the_points() {
    for largest_step in [0.13, 0.047, 0.017, 0.0031] {
        let mut system = step();
        // From rest: the equation is satisfied at u = 0 after a shift of the load.
        system.equations = |z| vec![(4.0 * (z[0] - 0.6)).tanh() + 2.4_f64.tanh() - z[1]];
        let [sampled, refined] = steepest(system, largest_step);
        assert!(sampled < 4.0 - 1e-9, "{sampled} at steps of {largest_step}");
        assert_relative_eq!(refined, 4.0, max_relative = 1e-8);
    }
}

#[test]
fn a_largest_slope_at_the_start_stays_there() {
    let mut system = arch();
    system.controls[0].scale = 1.0;
    let [sampled, refined] = steepest(system, 0.05);
    assert_relative_eq!(sampled, 2.0, max_relative = 1e-12);
    assert_relative_eq!(refined, 2.0, max_relative = 1e-12);
}

/// `(c^1.1 e^(−kc))′` is largest where `(kc)² − 2.2 kc + 0.11 = 0`.
#[test]
fn a_maximum_close_behind_a_kink_is_found() {
    let scaled = 1.1 - (1.1_f64.powi(2) - 0.11).sqrt();
    let c = scaled / DECAY;
    let expected = 1.0 + (-scaled).exp() * (1.1 * c.powf(0.1) - DECAY * c.powf(1.1));
    for largest_step in [0.1, 0.05, 0.011] {
        let [_, refined] = steepest(kink(), largest_step);
        assert_relative_eq!(refined, expected, max_relative = 1e-8);
    }
}

#[test]
fn a_peak_before_an_exchange_is_one_of_the_system_before() {
    for largest_step in [0.047, 0.031] {
        let [_, refined] = steepest(two_laws(), largest_step);
        assert_relative_eq!(refined, 3.0, max_relative = 1e-8);
    }
}
