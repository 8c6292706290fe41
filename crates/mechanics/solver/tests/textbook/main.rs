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

use solver::{Continuation, Equilibrium, Event, Settings, State, System, Termination};

/// Steps of a size.
fn steps(largest: f64) -> Settings {
    Settings { first_step: largest, max_step: largest, ..Settings::default() }
}

/// All points of a path from rest, and why it ended.
fn follow<S: System>(system: S, settings: Settings) -> (Vec<Equilibrium<S::Mode>>, Termination) {
    let rest = State::at_rest(&system);
    let mut path = Continuation::new(system, rest, settings);
    let points = path.by_ref().collect();
    (points, path.termination().expect("an iterator that has ended tells why"))
}

/// The loads at the extrema of a path, with the other unknowns.
fn extrema(points: &[Equilibrium]) -> Vec<&[f64]> {
    let extrema = points.iter().filter(|point| point.event == Some(Event::LoadExtremum));
    extrema.map(|point| point.state.z.as_slice()).collect()
}

/// The constraints that change sides along a path, with the point where they do.
fn changes(points: &[Equilibrium]) -> Vec<(&Equilibrium, Vec<(usize, bool)>)> {
    let changes = points.iter().filter_map(|point| match &point.event {
        Some(Event::Changed(changes)) => {
            Some((point, changes.iter().map(|c| (c.constraint, c.activated)).collect()))
        }
        _ => None,
    });
    changes.collect()
}
