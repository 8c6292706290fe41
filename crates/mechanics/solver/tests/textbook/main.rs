//! Paths and equilibria with known answers.

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

/// Returns settings with a largest step.
fn steps(largest: f64) -> Settings {
    Settings { first_step: largest, max_step: largest, ..Settings::default() }
}

/// Returns all points of a path from rest, and the reason of its end.
fn follow(
    system: impl System<Mode = ()> + 'static,
    settings: Settings,
) -> (Vec<Equilibrium>, Termination) {
    follow_modes(Scaled::by_one(system), settings)
}

/// Follows the path of a system with any modes, see [`follow`].
fn follow_modes<S: System>(
    system: S,
    settings: Settings,
) -> (Vec<Equilibrium<S::Mode>>, Termination) {
    let rest = State::at_rest(&system);
    let mut path = Continuation::new(system, rest, settings);
    let points = path.by_ref().collect();
    (points, path.termination().expect("an ended path has a termination"))
}

/// Returns the states at the load extrema of a path.
fn extrema(points: &[Equilibrium]) -> Vec<&[f64]> {
    let extrema = points.iter().filter(|point| point.event == Some(Event::LoadExtremum));
    extrema.map(|point| point.state.z.as_slice()).collect()
}

/// Returns the constraints that change sides along a path, with their points.
fn changes(points: &[Equilibrium]) -> Vec<(&Equilibrium, Vec<(usize, bool)>)> {
    let changes = points.iter().filter_map(|point| match &point.event {
        Some(Event::Changed(changes)) => {
            Some((point, changes.iter().map(|c| (c.constraint, c.activated)).collect()))
        }
        _ => None,
    });
    changes.collect()
}
