//! History variables of a row, and their derivatives with respect to parameters.
//!
//! A sticking tip or contact has an anchor, and a locked tip or contact keeps its ratio `T/N`. Such
//! a variable `a` is set at an event of the path. A parameter `q` changes it, because it moves this
//! event:
//!
//! ```text
//! da/dq = ∂a/∂q + ∂a/∂z dz/dq                            at the event
//! dz/dq = −J⁻¹ (∂r/∂q + ∂r/∂a da/dq) + s v               after the event                     (L6)
//! ```
//!
//! The second equation is (D2), applied to the rows with the parameters `q ± h`. Each of these rows
//! has its own history variables `a ± h da/dq`.

use std::borrow::Cow;

use solver::{AnchoredPoint, Continuation, Linearisation, Neighbours, PathAnchor};

use super::GuidedNeedle;
use crate::contacts::{Contacts, SkinMode, SkinPoint, SkinState, TipContact, TipState};
use crate::puncture::adaptive_row::Segment;
use crate::puncture::system::Chain;
use crate::sensitivity::vanished;

/// History variable of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::puncture) enum HistoryVariable {
    /// Anchor or locked ratio of a tip contact.
    TipContact(TipContact),
    /// Number of a contact between scales, and its anchor or locked ratio.
    Contact(usize, f64),
}

/// Collects the path segments that end with a new history variable.
#[derive(Debug, Default)]
pub(in crate::puncture) struct HistoryObserver {
    pub(in crate::puncture) segments: Vec<[SkinPoint; 2]>,
}

impl HistoryObserver {
    pub(in crate::puncture) fn follow(&mut self, Segment { from, to, .. }: &Segment) {
        // History variables are copied exactly along the path, so a value that differs in any bit
        // belongs to a new variable.
        if history(&to.state).iter().any(|variable| !history(&from.state).contains(variable)) {
            self.segments.push([(**from).clone(), to.clone()]);
        }
    }
}

/// A history variable and its derivatives.
pub(in crate::puncture) struct Anchor {
    variable: HistoryVariable,
    /// Derivative with respect to each parameter; `None` if it is unknown.
    rates: Vec<Option<f64>>,
}

/// Computes the history variables of a path with their derivatives, in the order of the path.
///
/// Each of the `segments` ends with a new history variable. `variations` holds the rows with one
/// perturbed parameter each.
pub(in crate::puncture) fn anchors(
    path: &mut Continuation<Chain>,
    segments: &[[SkinPoint; 2]],
    variations: &[Neighbours<Chain>],
) -> Vec<Anchor> {
    let rest = path.system().at_rest();
    let mut anchors: Vec<Anchor> = Vec::new();
    for variable in history(&rest) {
        // The anchor of the needle at rest depends on the parameters alone, not on an event.
        anchors.push(Anchor {
            variable,
            rates: variations
                .iter()
                .map(|neighbours| {
                    let at = |chain: &Chain| chain.history_value(&rest, variable, &rest);
                    let (below, above) = (at(&neighbours.below)?, at(&neighbours.above)?);
                    Some((above - below) / (2.0 * neighbours.step))
                })
                .collect(),
        });
    }
    for [from, to] in segments {
        let event = event_before(path, [from, to]);
        // Earlier history variables move this event, too, so process segments in path order.
        let varied = event.as_ref().and_then(|event| with(&anchors, &event.state, variations));
        let mut here = event.and_then(|event| Linearisation::new(path.system(), event).ok());
        let new = history(&to.state)
            .into_iter()
            .filter(|variable| !history(&from.state).contains(variable));
        // Solve for the perturbed equilibria once for all history variables of the event.
        let unknown = || vec![None; variations.len()];
        let moved: Vec<_> =
            here.as_mut().zip(varied.as_ref()).map_or_else(unknown, |(here, varied)| {
                varied.iter().map(|q| moved_to(path.system(), here, q)).collect()
            });
        for variable in new {
            let rates = moved
                .iter()
                .zip(variations)
                .map(|(at, neighbours)| {
                    let [below, above] = at.as_ref()?;
                    let value =
                        |chain: &Chain, state| chain.history_value(state, variable, &to.state);
                    let rise = value(&neighbours.above, above)? - value(&neighbours.below, below)?;
                    Some(rise / (2.0 * neighbours.step)).filter(|rate| rate.is_finite())
                })
                .collect();
            anchors.push(Anchor { variable, rates });
        }
    }
    anchors
}

/// Returns the perturbed rows with the history variables that their own paths have at `state`.
///
/// `None` if a derivative of one of these variables is unknown.
pub(in crate::puncture) fn with<'v>(
    anchors: &[Anchor],
    state: &SkinState,
    variations: &'v [Neighbours<Chain>],
) -> Option<Cow<'v, [Neighbours<Chain>]>> {
    let mut varied = Cow::Borrowed(variations);
    for variable in history(state) {
        // A variable may have the same value after two events: use the later event.
        let anchor = anchors.iter().rev().find(|anchor| anchor.variable == variable)?;
        for (neighbours, rate) in varied.to_mut().iter_mut().zip(&anchor.rates) {
            let change = neighbours.step * (*rate)?;
            neighbours.below.shift_anchor(variable, -change);
            neighbours.above.shift_anchor(variable, change);
        }
    }
    Some(varied)
}

/// Lists the history variables of a state.
pub(in crate::puncture) fn history(state: &SkinState) -> Vec<HistoryVariable> {
    let mode = &state.mode.needle;
    let touches = mode.all().filter(|(_, touch)| touch.has_history());
    let touches = touches.map(|(_, touch)| {
        HistoryVariable::TipContact(if mode.is_round() { touch.without_part() } else { *touch })
    });
    let contacts =
        Contacts::anchors(state).map(|(contact, value)| HistoryVariable::Contact(contact, value));
    touches.chain(contacts).collect()
}

/// Solves for the event at the end of a segment, with the active set and mode before the event.
pub(in crate::puncture) fn event_before(
    path: &mut Continuation<Chain>,
    [from, to]: [&SkinPoint; 2],
) -> Option<AnchoredPoint<SkinMode>> {
    let SkinPoint { state, arriving: direction, .. } = path.between(from, to, 1.0)?;
    let guard = match &to.event {
        Some(solver::Event::Changed(changes)) => vanished(path.system(), &state, changes),
        _ => None,
    };
    // At a smooth reversal the slip distance is stationary along the path. A small error in the
    // position of the point then does not change it, so no guard is needed.
    let anchor = guard.map_or(PathAnchor::Still, PathAnchor::Guard);
    Some(AnchoredPoint { state, direction, anchor })
}

/// Computes the equilibria at an event for the smaller and the larger value of a parameter.
///
/// `None` if a perturbed row violates another constraint at the event.
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
    /// Computes from `state` the value of a history variable that is set in the state `to`.
    ///
    /// It is an anchor or a ratio of forces. `state` is at the event, before the change.
    fn history_value(
        &self,
        state: &SkinState,
        variable: HistoryVariable,
        to: &SkinState,
    ) -> Option<f64> {
        let touch = match variable {
            HistoryVariable::Contact(contact, _) => {
                return self.contacts.anchor_value(state, contact, to);
            }
            HistoryVariable::TipContact(touch) => touch,
        };
        let TipState::Locked { .. } = touch.tip_state else {
            // A round tip may move to another outline part after the event. Evaluate its slip
            // coordinate on the part that it touches in the state `to`.
            let part = to.mode.needle.part(touch.scale).unwrap_or(touch.part);
            return Some(self.tip_kinematics(&state.z, touch.scale, part)?.xi());
        };
        let before = &state.mode.needle.tip_contacts;
        let Some(slot) = before.iter().position(|before| {
            before
                .as_ref()
                .is_some_and(|before| (before.scale, before.part) == (touch.scale, touch.part))
        }) else {
            // The tip did not touch this outline part before. The corner of the scale has reached
            // the tip, which is locked without a tangential force.
            return Some(0.0);
        };
        let normal_force = self.needle.as_ref()?.normal_force(slot);
        Some(state.z[normal_force + 1] / state.z[normal_force])
    }

    /// Shifts a history variable of this perturbed row by an amount.
    fn shift_anchor(&mut self, variable: HistoryVariable, by: f64) {
        match (variable, &mut self.needle) {
            (HistoryVariable::TipContact(touch), Some(needle)) => {
                needle.anchor_shifts.push((touch, by));
            }
            (HistoryVariable::TipContact(..), None) => {}
            (HistoryVariable::Contact(contact, _), _) => self.contacts.shift_anchor(contact, by),
        }
    }
}

impl GuidedNeedle {
    /// Returns the anchor or ratio of a tip contact on this row, possibly a perturbed one.
    ///
    /// `of_mode` is its value on the unperturbed row.
    pub(super) fn shifted_anchor(&self, touch: &TipContact, of_mode: f64) -> f64 {
        let touch = if self.is_round() { touch.without_part() } else { *touch };
        let moved = self.anchor_shifts.iter().find(|(moved, _)| *moved == touch);
        of_mode + moved.map_or(0.0, |(_, by)| *by)
    }
}
