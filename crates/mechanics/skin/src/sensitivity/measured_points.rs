//! Points of a path at which measures are taken.

use solver::{
    AnchoredPoint, Change, Continuation, Equilibrium, Event, Newton, PathAnchor, Settings, State,
    Summit, System,
};

use crate::contacts::{SkinPoint, SkinState};
use crate::record::{PathFunction, Skin};

/// Guards (N5) smaller than this have vanished.
const VANISHED: f64 = 1e-8;

/// Returns the start of a path.
pub(crate) fn rest<S: System>(system: &S) -> AnchoredPoint<S::Mode> {
    let control = system.controls()[0];
    let mut direction = vec![0.0; system.size()];
    // The direction only chooses the section; the linearisation computes the actual one.
    direction[control.index] = control.scale;
    AnchoredPoint { state: State::at_rest(system), direction, anchor: PathAnchor::Still }
}

/// Returns the end of a path that reached its target.
pub(crate) fn end<S: System>(path: &Continuation<S>) -> AnchoredPoint<S::Mode> {
    let Equilibrium { state, leaving, .. } = path.point().clone();
    AnchoredPoint { state, direction: leaving, anchor: PathAnchor::Target }
}

/// Returns the first contact.
///
/// It ends the part of the path with all contacts open.
pub(crate) fn first_contact<S: Skin>(
    system: &S,
    point: &SkinPoint,
) -> Option<AnchoredPoint<S::Mode>> {
    let Some(Event::Changed(changes)) = &point.event else { return None };
    let contacts = &system.contacts().forces;
    // One guard anchors the point; contacts that close simultaneously show up as violated.
    let constraint = changes.iter().find(|change| change.activated)?.constraint;
    if changes.iter().any(|change| change.constraint >= contacts.len()) {
        // The needle changes together with the contact, and its previous state is unknown here.
        return None;
    }
    // The recorded point has the state after the event. Restore the state before it: all contacts
    // open, with the gap as guard.
    let mut state = SkinState::at_rest(system);
    state.z.clone_from(&point.state.z);
    for &force in contacts {
        state.z[force] = 0.0;
    }
    // Only contacts between scales are undone; the needle keeps its state.
    state.mode.needle = point.state.mode.needle.clone();
    state.active[contacts.len()..].copy_from_slice(&point.state.active[contacts.len()..]);
    let direction = point.arriving.clone();
    Some(AnchoredPoint { state, direction, anchor: PathAnchor::Guard(constraint) })
}

/// Returns the point of the largest value of a function on a path.
///
/// `None` if its location is unknown.
pub(crate) fn summit<S: Skin>(
    summit: Option<&Summit<S::Mode>>,
    path: &mut Continuation<S>,
    f: PathFunction<S>,
    settings: &Settings,
) -> Option<AnchoredPoint<S::Mode>> {
    let summit = summit?;
    let Equilibrium { state, arriving, leaving, event } = &*summit.point;
    let control = path.system().controls()[0];
    // At the end of the path the target, or a constraint that ends it, anchors the point instead of
    // an extremum.
    let is_target = *event == Some(Event::Target)
        || ((state.z[control.index] / control.scale).abs() - 1.0).abs() < VANISHED;
    let still = AnchoredPoint::arriving(&summit.point, PathAnchor::Still);
    match (event, &summit.before) {
        // Between points the function is smooth, so refine the point until it is stationary.
        _ if summit.is_inside => still.stationary(path.system(), &f, settings),
        // Only the start of a path has no previous point.
        (_, None) => Some(AnchoredPoint { direction: leaving.clone(), ..still }),
        _ if is_target => Some(AnchoredPoint { anchor: PathAnchor::Target, ..still }),
        (Some(Event::Changed(changes)), Some(before)) => {
            let [arrives, leaves] = [arriving, leaving].map(|v| f(path.system(), state, v));
            // The larger value is after the event, so use the outgoing state.
            if leaves >= arrives {
                let anchor = PathAnchor::Guard(vanished(path.system(), state, changes)?);
                return Some(AnchoredPoint { direction: leaving.clone(), anchor, ..still });
            }
            // The larger value is before the event. The recorded point has lost that active set, so
            // solve for the equilibrium again.
            let Equilibrium { state, arriving, .. } = path.between(before, &summit.point, 1.0)?;
            let anchor = PathAnchor::Guard(vanished(path.system(), &state, changes)?);
            Some(AnchoredPoint { state, direction: arriving, anchor })
        }
        _ => still.stationary(path.system(), &f, settings),
    }
}

/// Returns the point at which a quantity turns back.
///
/// It is anchored to the contact that changes there, or else to the vanishing rate with this
/// `number`.
pub(crate) fn turn<S: Skin>(
    system: &S,
    point: &SkinPoint,
    number: usize,
) -> Option<AnchoredPoint<S::Mode>> {
    let Equilibrium { state, leaving, event, .. } = point;
    let anchor = match event {
        Some(Event::Changed(changes)) => PathAnchor::Guard(vanished(system, state, changes)?),
        _ => PathAnchor::Stationary(number),
    };
    Some(AnchoredPoint { state: state.clone(), direction: leaving.clone(), anchor })
}

/// Returns true if the target or a contact change fixes a point.
///
/// Otherwise the point is a smooth maximum, which a parameter moves along the path.
pub(crate) fn is_held<S: Skin>(system: &S, point: &AnchoredPoint<S::Mode>) -> bool {
    match point.anchor {
        PathAnchor::Still => false,
        PathAnchor::Target | PathAnchor::Marker(_) | PathAnchor::Stationary(_) => true,
        // A nonzero guard is only a section through the path.
        PathAnchor::Guard(constraint) => {
            Newton::guards(system, &point.state)[constraint].abs() < VANISHED
        }
    }
}

/// Finds the vanishing guard at an event, among the changed contacts.
pub(crate) fn vanished<S: Skin>(
    system: &S,
    state: &SkinState,
    changes: &[Change],
) -> Option<usize> {
    if let [change] = changes
        && !change.activated
        && system.monotone().contains(&change.constraint)
    {
        // Slip stops where its rate vanishes, which is no guard.
        return None;
    }
    let guards = Newton::guards(system, state);
    let contacts = system.contacts();
    let vanished = (0..guards.len())
        .filter(|&constraint| {
            let (contact, _) = contacts.contact_of(constraint);
            // A change of one force may make another force of the same contact vanish.
            changes.iter().any(|change| contacts.contact_of(change.constraint).0 == contact)
        })
        .filter(|&c| guards[c].abs() < VANISHED);
    // A slip distance that starts at the event has an origin that moves with the event.
    let known = vanished.filter(|&c| !contacts.slips(state, c));
    known.min_by(|&a, &b| {
        let friction_last = contacts.is_friction(a).cmp(&contacts.is_friction(b));
        friction_last.then(guards[a].abs().total_cmp(&guards[b].abs()))
    })
}
