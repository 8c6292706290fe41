//! Tests of paths and equilibria against known solutions.

mod events;
mod folds;
mod friction;
mod obstacle;
mod peaks;
mod problems;
mod scaled;
mod stops;
mod tangents;
mod walls;
mod work;

use scaled::Scaled;
use solver::{Continuation, Equilibrium, Event, Settings, State, System, Termination};

/// Returns settings in which the first and the largest step have the length `largest`.
fn steps(largest: f64) -> Settings {
    Settings { first_step: largest, max_step: largest, ..Settings::default() }
}

/// Follows the path of a system without modes, and returns its points and its termination.
///
/// The path starts at rest, which is not among the returned points.
fn follow(
    system: impl System<Mode = ()> + 'static,
    settings: Settings,
) -> (Vec<Equilibrium>, Termination) {
    follow_modes(Scaled::by_one(system), settings)
}

/// Follows the path of a system with modes, otherwise like [`follow`].
fn follow_modes<S: System>(
    system: S,
    settings: Settings,
) -> (Vec<Equilibrium<S::Mode>>, Termination) {
    let rest = State::at_rest(&system);
    let mut path = Continuation::new(system, rest, settings);
    let points = path.by_ref().collect();
    (points, path.termination().expect("an ended path has a termination"))
}

/// Returns the unknowns at each load extremum of a path.
fn extrema(points: &[Equilibrium]) -> Vec<&[f64]> {
    let extrema = points.iter().filter(|point| point.event == Some(Event::LoadExtremum));
    extrema.map(|point| point.state.z.as_slice()).collect()
}

/// Returns the points of a path at which constraints become active or inactive.
///
/// For each point, lists number and new state (true if active) of the changed constraints.
fn changes(points: &[Equilibrium]) -> Vec<(&Equilibrium, Vec<(usize, bool)>)> {
    let changes = points.iter().filter_map(|point| match &point.event {
        Some(Event::Changed(changes)) => {
            Some((point, changes.iter().map(|c| (c.constraint, c.activated)).collect()))
        }
        _ => None,
    });
    changes.collect()
}
