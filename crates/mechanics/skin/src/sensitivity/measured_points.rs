//! The places of a path at which measures are taken.

use solver::{
    AnchoredPoint, Change, Event, Newton, Path, PathAnchor, Point, Settings, State, Summit, System,
};

use crate::contacts::{SkinPoint, SkinState};
use crate::record::{PathFunction, Skin};

/// A guard (N5) that is smaller than this at an event belongs to it.
const VANISHED: f64 = 1e-8;

/// The beginning of a path.
pub(crate) fn rest<S: System>(system: &S) -> AnchoredPoint<S::Mode> {
    let control = system.controls()[0];
    let mut direction = vec![0.0; system.size()];
    // This direction only chooses the section: the linearisation finds that of the path.
    direction[control.index] = control.scale;
    AnchoredPoint { state: State::at_rest(system), direction, anchor: PathAnchor::Still }
}

/// The end of a path that has reached its target.
pub(crate) fn end<S: System>(path: &Path<S>) -> AnchoredPoint<S::Mode> {
    let Point { state, leaving, .. } = path.point().clone();
    AnchoredPoint { state, direction: leaving, anchor: PathAnchor::Target }
}

/// The first contact: the end of the part of the path on which all contacts are open.
pub(crate) fn first_contact<S: Skin>(
    system: &S,
    point: &SkinPoint,
) -> Option<AnchoredPoint<S::Mode>> {
    let Some(Event::Changed(changes)) = &point.event else { return None };
    let contacts = &system.contacts().forces;
    // One guard holds the place; a contact that closes with it shows as violated beside it.
    let constraint = changes.iter().find(|change| change.activated)?.constraint;
    if changes.iter().any(|change| change.constraint >= contacts.len()) {
        // The needle changes with the contact: what it did before is not known here.
        return None;
    }
    // The point has the state with which the path goes on, and the place is the one before: all
    // contacts are open there, and the gap is the guard.
    let mut state = SkinState::at_rest(system);
    state.z.clone_from(&point.state.z);
    for &force in contacts {
        state.z[force] = 0.0;
    }
    // Only contacts between scales are undone: the needle does what it did before.
    state.mode.needle = point.state.mode.needle.clone();
    state.active[contacts.len()..].copy_from_slice(&point.state.active[contacts.len()..]);
    let direction = point.arriving.clone();
    Some(AnchoredPoint { state, direction, anchor: PathAnchor::Guard(constraint) })
}

/// The place at which a function is the largest on a path, if it is known where that is.
pub(crate) fn summit<S: Skin>(
    summit: Option<&Summit<S::Mode>>,
    path: &mut Path<S>,
    f: PathFunction<S>,
    settings: &Settings,
) -> Option<AnchoredPoint<S::Mode>> {
    let summit = summit?;
    let Point { state, arriving, leaving, event } = &*summit.point;
    let control = path.system().controls()[0];
    // The largest value may be at the end, where the target holds the place and no extremum.
    let is_target = (state.z[control.index] / control.scale - 1.0).abs() < VANISHED;
    let at = |direction: &Vec<f64>, anchor| {
        Some(AnchoredPoint { state: state.clone(), direction: direction.clone(), anchor })
    };
    match (event, &summit.before) {
        // Between points the function is smooth, so the place is polished until it is stationary.
        _ if summit.is_inside => {
            at(arriving, PathAnchor::Still)?.stationary(path.system(), &f, settings)
        }
        // Only the beginning of a path has no point before it.
        (_, None) => at(leaving, PathAnchor::Still),
        _ if is_target => at(arriving, PathAnchor::Target),
        (Some(Event::Changed(changes)), Some(before)) => {
            let [arrives, leaves] = [arriving, leaving].map(|v| f(path.system(), state, v));
            // The larger value is behind the event, so the place has the state that leaves it.
            if leaves >= arrives {
                let guard = vanished(path.system(), state, changes)?;
                return at(leaving, PathAnchor::Guard(guard));
            }
            // The larger value is before the event, and the point has lost the active set of that
            // side: the equilibrium is solved for again.
            let Point { state, arriving, .. } = path.between(before, &summit.point, 1.0)?;
            let anchor = PathAnchor::Guard(vanished(path.system(), &state, changes)?);
            Some(AnchoredPoint { state, direction: arriving, anchor })
        }
        _ => at(arriving, PathAnchor::Still)?.stationary(path.system(), &f, settings),
    }
}

/// The place at which a quantity turns back, which a contact that changes makes it do or else its vanishing rate, of this `number`.
pub(crate) fn turn<S: Skin>(
    system: &S,
    point: &SkinPoint,
    number: usize,
) -> Option<AnchoredPoint<S::Mode>> {
    let Point { state, leaving, event, .. } = point;
    let anchor = match event {
        Some(Event::Changed(changes)) => PathAnchor::Guard(vanished(system, state, changes)?),
        _ => PathAnchor::Stationary(number),
    };
    Some(AnchoredPoint { state: state.clone(), direction: leaving.clone(), anchor })
}

/// Whether a place is held by the target of the path or by a contact that changes there. That of a smooth maximum is not: a
/// parameter moves it along the path.
pub(crate) fn is_held<S: Skin>(system: &S, place: &AnchoredPoint<S::Mode>) -> bool {
    match place.anchor {
        PathAnchor::Still => false,
        PathAnchor::Target | PathAnchor::Marker(_) | PathAnchor::Stationary(_) => true,
        // Elsewhere the guard is a section through the path.
        PathAnchor::Guard(constraint) => {
            Newton::guards(system, &place.state)[constraint].abs() < VANISHED
        }
    }
}

/// The constraint whose guard vanishes at an event, of those of the contacts that change.
pub(crate) fn vanished<S: Skin>(
    system: &S,
    state: &SkinState,
    changes: &[Change],
) -> Option<usize> {
    if let [change] = changes
        && !change.activated
        && system.growing().contains(&change.constraint)
    {
        // What slips comes to rest where its rate vanishes: no guard does so.
        return None;
    }
    let guards = Newton::guards(system, state);
    let changed = |constraint: &usize| {
        let contact = |constraint: usize| system.contacts().contact_of(constraint).0;
        // A change of one force may make another one of the same contact vanish.
        changes.iter().any(|change| contact(change.constraint) == contact(*constraint))
    };
    let contacts = system.contacts();
    let vanished = (0..guards.len()).filter(changed).filter(|&c| guards[c].abs() < VANISHED);
    // The way of what has begun to slip is counted from a place that moves with the event.
    let known = vanished.filter(|&c| !contacts.slips(state, c));
    known.min_by(|&a, &b| {
        let friction_last = contacts.is_friction(a).cmp(&contacts.is_friction(b));
        friction_last.then(guards[a].abs().total_cmp(&guards[b].abs()))
    })
}
