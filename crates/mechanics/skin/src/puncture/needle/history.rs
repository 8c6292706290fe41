//! What a row keeps of its way, and how that changes with a parameter.
//!
//! Where the tip of a needle or a contact sticks it does so at an anchor, and in a notch a needle is held with a ratio of forces. All were
//! set at an event of the path, and a parameter moves them as it moves that event:
//!
//! ```text
//! da/dq = ∂a/∂q + ∂a/∂z dz/dq   at the event,     dz/dq = −J⁻¹ (∂r/∂q + ∂r/∂a da/dq) + s v   behind it      (L6)
//! ```
//!
//! The second is (D2) of systems for `q ± h` whose own history is that of their paths, to first order.

use std::borrow::Cow;

use solver::{AnchoredPoint, Linearisation, Neighbours, Path, PathAnchor};

use super::GuidedNeedle;
use super::mode::{TipState, Touch};
use crate::contacts::{Contacts, SkinMode, SkinPoint, SkinState};
use crate::puncture::adaptive_row::Segment;
use crate::puncture::system::Chain;
use crate::sensitivity::vanished;

/// What the equations keep of the way to a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::puncture) enum HistoryVariable {
    /// Where a touch of the needle sticks, or how it is held.
    Touch(Touch),
    /// Where a contact, by its number, sticks, or how it is held.
    Contact(usize, f64),
}

/// The segments of a path at whose ends the row comes to keep something of its way.
#[derive(Debug, Default)]
pub(in crate::puncture) struct HistoryObserver {
    pub(in crate::puncture) segments: Vec<[SkinPoint; 2]>,
}

impl HistoryObserver {
    pub(in crate::puncture) fn follow(&mut self, Segment { from, to, .. }: &Segment) {
        // What is kept is copied bit by bit along the path, so that equality tells what is new.
        if history(&to.state).iter().any(|kept| !history(&from.state).contains(kept)) {
            self.segments.push([(**from).clone(), to.clone()]);
        }
    }
}

/// Something that is kept, and its rates of change with each parameter; `None` where that is not known.
pub(in crate::puncture) struct Anchor {
    kept: HistoryVariable,
    rates: Vec<Option<f64>>,
}

/// The anchors of a path with their rates of change, in order.
pub(in crate::puncture) fn anchors(
    path: &mut Path<Chain>,
    segments: &[[SkinPoint; 2]],
    variations: &[Neighbours<Chain>],
) -> Vec<Anchor> {
    let rest = path.system().at_rest();
    let mut anchors: Vec<Anchor> = Vec::new();
    for kept in history(&rest) {
        // The needle is set down: its first anchor is a matter of the design alone.
        let of = |neighbours: &Neighbours<Chain>| {
            let at = |chain: &Chain| chain.history_value(&rest, kept, &rest);
            let (below, above) = (at(&neighbours.below)?, at(&neighbours.above)?);
            Some((above - below) / (2.0 * neighbours.step))
        };
        anchors.push(Anchor { kept, rates: variations.iter().map(of).collect() });
    }
    for [from, to] in segments {
        let place = event_before(path, [from, to]);
        // Earlier anchors move this event, too: the segments are in the order of the path.
        let varied = place.as_ref().and_then(|place| with(&anchors, &place.state, variations));
        let mut here = place.and_then(|place| Linearisation::new(path.system(), place).ok());
        let new =
            history(&to.state).into_iter().filter(|kept| !history(&from.state).contains(kept));
        // The equilibria of neighbours at the event serve all that is kept from there on.
        let unknown = || vec![None; variations.len()];
        let moved: Vec<_> =
            here.as_mut().zip(varied.as_ref()).map_or_else(unknown, |(here, varied)| {
                varied.iter().map(|q| moved_to(path.system(), here, q)).collect()
            });
        for kept in new {
            let rate = |(at, neighbours): (&Option<[SkinState; 2]>, &Neighbours<Chain>)| {
                let [below, above] = at.as_ref()?;
                let value = |chain: &Chain, state| chain.history_value(state, kept, &to.state);
                let rise = value(&neighbours.above, above)? - value(&neighbours.below, below)?;
                Some(rise / (2.0 * neighbours.step)).filter(|rate| rate.is_finite())
            };
            let rates = moved.iter().zip(variations).map(rate).collect();
            anchors.push(Anchor { kept, rates });
        }
    }
    anchors
}

/// Variations of a row of which the neighbours have come to a state, each on its own way; `None` if one of these is not known.
pub(in crate::puncture) fn with<'v>(
    anchors: &[Anchor],
    state: &SkinState,
    variations: &'v [Neighbours<Chain>],
) -> Option<Cow<'v, [Neighbours<Chain>]>> {
    let mut varied = Cow::Borrowed(variations);
    for kept in history(state) {
        // Something may come to the same rest twice: the latest event counts.
        let anchor = anchors.iter().rev().find(|anchor| anchor.kept == kept)?;
        for (neighbours, rate) in varied.to_mut().iter_mut().zip(&anchor.rates) {
            let change = neighbours.step * (*rate)?;
            neighbours.below.shift_anchor(kept, -change);
            neighbours.above.shift_anchor(kept, change);
        }
    }
    Some(varied)
}

/// What the equations of a state keep of the way to it.
pub(in crate::puncture) fn history(state: &SkinState) -> Vec<HistoryVariable> {
    let mode = &state.mode.needle;
    let touches = mode.all().filter(|(_, touch)| touch.has_history());
    let touches = touches.map(|(_, touch)| {
        HistoryVariable::Touch(if mode.is_round() { touch.anywhere() } else { *touch })
    });
    let contacts =
        Contacts::anchors(state).map(|(contact, kept)| HistoryVariable::Contact(contact, kept));
    touches.chain(contacts).collect()
}

/// The event at the end of a segment, seen from before it.
pub(in crate::puncture) fn event_before(
    path: &mut Path<Chain>,
    [from, to]: [&SkinPoint; 2],
) -> Option<AnchoredPoint<SkinMode>> {
    let SkinPoint { state, arriving: direction, .. } = path.between(from, to, 1.0)?;
    let guard = match &to.event {
        Some(solver::Event::Changed(changes)) => vanished(path.system(), &state, changes),
        _ => None,
    };
    // Where sliding turns back smoothly, to move along the path does not change how far the tip has slid.
    let anchor = guard.map_or(PathAnchor::Still, PathAnchor::Guard);
    Some(AnchoredPoint { state, direction, anchor })
}

/// The equilibria of neighbours at an event; `None` where it becomes another one with the parameter.
fn moved_to(
    chain: &Chain,
    here: &mut Linearisation<SkinMode>,
    neighbours: &Neighbours<Chain>,
) -> Option<[SkinState; 2]> {
    let moved = here.moved(chain, neighbours, false);
    let systems = [&neighbours.below, &neighbours.above];
    let mut both = systems.into_iter().zip(&moved);
    if both.any(|(system, moved)| here.violated(system, moved).is_some()) {
        return None;
    }
    Some(moved.map(|moved| moved.state))
}

impl Chain {
    /// What will be kept, in the state `to`, of a state in which it is not yet: a place, or a ratio of forces.
    fn history_value(
        &self,
        state: &SkinState,
        kept: HistoryVariable,
        to: &SkinState,
    ) -> Option<f64> {
        let touch = match kept {
            HistoryVariable::Contact(contact, _) => {
                return self.contacts.anchor_value(state, contact, to);
            }
            HistoryVariable::Touch(touch) => touch,
        };
        let TipState::Locked { .. } = touch.tip_state else {
            // A round tip may roll on after the event: it counts where it touches there.
            let place = to.mode.needle.place(touch.scale).unwrap_or(touch.place);
            return Some(self.meeting(&state.z, touch.scale, place)?.xi());
        };
        let before = &state.mode.needle.touches;
        let is_there = |before: &Touch| (before.scale, before.place) == (touch.scale, touch.place);
        let Some(slot) = before.iter().position(|before| before.as_ref().is_some_and(is_there))
        else {
            // The corner has come to the tip: it is held without a tangential force.
            return Some(0.0);
        };
        let normal_force = self.needle.as_ref()?.normal_force(slot);
        Some(state.z[normal_force + 1] / state.z[normal_force])
    }

    /// Takes what is kept to that of a neighbour.
    fn shift_anchor(&mut self, kept: HistoryVariable, by: f64) {
        match (kept, &mut self.needle) {
            (HistoryVariable::Touch(touch), Some(needle)) => needle.anchor_shifts.push((touch, by)),
            (HistoryVariable::Touch(..), None) => {}
            (HistoryVariable::Contact(contact, _), _) => self.contacts.shift_anchor(contact, by),
        }
    }
}

impl GuidedNeedle {
    /// The anchor of a touch, or its ratio of forces, on the way to this row.
    pub(super) fn shifted_anchor(&self, touch: &Touch, of_mode: f64) -> f64 {
        let touch = if self.is_round() { touch.anywhere() } else { *touch };
        let moved = self.anchor_shifts.iter().find(|(moved, _)| *moved == touch);
        of_mode + moved.map_or(0.0, |(_, by)| *by)
    }
}
