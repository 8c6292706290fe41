//! Points of a path at which measures are evaluated: start, end, first contact, maxima.

use solver::{
    AnchoredPoint, Change, Continuation, Equilibrium, Event, Newton, PathAnchor, Settings, State,
    Summit, System,
};

use crate::contacts::{SkinPoint, SkinState};
use crate::record::{PathFunction, Skin};

/// Magnitude below which a guard (N5) counts as zero.
const VANISHED: f64 = 1e-8;

/// Returns the start of a path, the state of rest.
pub(crate) fn rest<S: System>(system: &S) -> AnchoredPoint<S::Mode> {
    let control = system.controls()[0];
    let mut direction = vec![0.0; system.size()];
    // This direction only defines the section; the linearisation computes the path direction.
    direction[control.index] = control.scale;
    AnchoredPoint { state: State::at_rest(system), direction, anchor: PathAnchor::Still }
}

/// Returns the end of a path that reached its target.
pub(crate) fn end<S: System>(path: &Continuation<S>) -> AnchoredPoint<S::Mode> {
    let Equilibrium { state, leaving, .. } = path.point().clone();
    AnchoredPoint { state, direction: leaving, anchor: PathAnchor::Target }
}

/// Returns the state at first contact, with all contacts still open.
///
/// `None` if no contact closes at `point`, or if the needle also changes its state at `point`.
pub(crate) fn first_contact<S: Skin>(
    system: &S,
    point: &SkinPoint,
) -> Option<AnchoredPoint<S::Mode>> {
    let Some(Event::Changed(changes)) = &point.event else { return None };
    let contacts = &system.contacts().forces;
    // The guard of one closing contact anchors the point. Other contacts that close simultaneously
    // are found as violated constraints.
    let constraint = changes.iter().find(|change| change.activated)?.constraint;
    if changes.iter().any(|change| change.constraint >= contacts.len()) {
        // The state of the needle before the event is unknown, because `point` has the state after
        // the event.
        return None;
    }
    // The recorded point has the state after the event. Restore the state before the event: all
    // contacts are open, and the guard of the closing contact is its gap.
    let mut state = SkinState::at_rest(system);
    state.z.clone_from(&point.state.z);
    for &force in contacts {
        state.z[force] = 0.0;
    }
    // Only contacts between scales are reset; the needle keeps its state.
    state.mode.needle = point.state.mode.needle.clone();
    state.active[contacts.len()..].copy_from_slice(&point.state.active[contacts.len()..]);
    let direction = point.arriving.clone();
    Some(AnchoredPoint { state, direction, anchor: PathAnchor::Guard(constraint) })
}

/// Returns the point at which a function `f` has its maximum on a path, with its anchor.
///
/// `None` if `summit` is `None` or the point cannot be anchored.
pub(crate) fn summit<S: Skin>(
    summit: Option<&Summit<S::Mode>>,
    path: &mut Continuation<S>,
    f: PathFunction<S>,
    settings: &Settings,
) -> Option<AnchoredPoint<S::Mode>> {
    let summit = summit?;
    let Equilibrium { state, arriving, leaving, event } = &*summit.point;
    let control = path.system().controls()[0];
    // A maximum at the target of the path is anchored by the target, not by a vanishing slope.
    let is_target = *event == Some(Event::Target)
        || ((state.z[control.index] / control.scale).abs() - 1.0).abs() < VANISHED;
    let still = AnchoredPoint::arriving(&summit.point, PathAnchor::Still);
    match (event, &summit.before) {
        // Between points the function is smooth, so refine the point until its slope vanishes.
        _ if summit.is_inside => still.stationary(path.system(), &f, settings),
        // A point without a previous point is the start of the path.
        (_, None) => Some(AnchoredPoint { direction: leaving.clone(), ..still }),
        _ if is_target => Some(AnchoredPoint { anchor: PathAnchor::Target, ..still }),
        (Some(Event::Changed(changes)), Some(before)) => {
            let [arrives, leaves] = [arriving, leaving].map(|v| f(path.system(), state, v));
            // The outgoing direction gives the larger value, so use the state after the event.
            if leaves >= arrives {
                let anchor = PathAnchor::Guard(vanished(path.system(), state, changes)?);
                return Some(AnchoredPoint { direction: leaving.clone(), anchor, ..still });
            }
            // The incoming direction gives the larger value. The recorded point has the active set
            // after the event, so solve for the equilibrium with the active set before the event.
            let Equilibrium { state, arriving, .. } = path.between(before, &summit.point, 1.0)?;
            let anchor = PathAnchor::Guard(vanished(path.system(), &state, changes)?);
            Some(AnchoredPoint { state, direction: arriving, anchor })
        }
        _ => still.stationary(path.system(), &f, settings),
    }
}

/// Returns the point of a path at which a quantity has an extremum, with its anchor.
///
/// If a contact changes at the point, the anchor is the guard of this contact. Otherwise the anchor
/// is the vanishing [rate](System::rate) with this `number`.
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

/// Returns true if the position of a point on the path is fixed by a condition.
///
/// Conditions are the target, a marker, a vanishing rate or a contact change. Returns false for a
/// point that only stays in its section.
pub(crate) fn is_held<S: Skin>(system: &S, point: &AnchoredPoint<S::Mode>) -> bool {
    match point.anchor {
        PathAnchor::Still => false,
        PathAnchor::Target | PathAnchor::Marker(_) | PathAnchor::Stationary(_) => true,
        // A guard that is not zero at the point does not fix the position of the point. It only
        // defines a section through the path.
        PathAnchor::Guard(constraint) => {
            Newton::guards(system, &point.state)[constraint].abs() < VANISHED
        }
    }
}

/// Finds a constraint with a vanishing guard among the contacts that changed at an event.
pub(crate) fn vanished<S: Skin>(
    system: &S,
    state: &SkinState,
    changes: &[Change],
) -> Option<usize> {
    if let [change] = changes
        && !change.activated
        && system.monotone().contains(&change.constraint)
    {
        // A contact stops slipping where its slip rate vanishes, and this rate is not a guard.
        return None;
    }
    let guards = Newton::guards(system, state);
    let contacts = system.contacts();
    let vanished = (0..guards.len())
        .filter(|&constraint| {
            let (contact, _) = contacts.contact_of(constraint);
            // The vanishing guard may belong to another force of a contact that changed.
            changes.iter().any(|change| contacts.contact_of(change.constraint).0 == contact)
        })
        .filter(|&c| guards[c].abs() < VANISHED);
    // Skip a slip distance: it is measured from the event, so its guard is zero at any position of
    // the event.
    let known = vanished.filter(|&c| !contacts.slips(state, c));
    known.min_by(|&a, &b| {
        let friction_last = contacts.is_friction(a).cmp(&contacts.is_friction(b));
        friction_last.then(guards[a].abs().total_cmp(&guards[b].abs()))
    })
}
