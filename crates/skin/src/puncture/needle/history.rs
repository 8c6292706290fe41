//! What a needle keeps of its way, and how that changes with a parameter.
//!
//! Where the tip sticks it does so at an anchor, and in a notch it is held with a ratio of forces. Both were set at an event of the path,
//! and a parameter moves them as it moves that event:
//!
//! ```text
//! da/dq = ∂a/∂q + ∂a/∂z dz/dq   at the event,     dz/dq = −J⁻¹ (∂r/∂q + ∂r/∂a da/dq) + s v   behind it      (L6)
//! ```
//!
//! The second is (D2) of systems for `q ± h` whose own history is that of their paths, to first order.

use solver::{AnchoredPoint, Linearisation, Neighbours, Path, PathAnchor};

use super::mode::{Place, Rub, Touch};
use super::{GuidedNeedle, NeedleMode};
use crate::contacts::{SkinMode, SkinPoint, SkinState};
use crate::puncture::growing::Segment;
use crate::puncture::system::Chain;
use crate::sensitivity::vanished;

/// The segments of a path at whose ends the needle comes to keep something of its way.
#[derive(Debug, Default)]
pub(in crate::puncture) struct HistoryWatch {
    pub(in crate::puncture) segments: Vec<[SkinPoint; 2]>,
}

impl HistoryWatch {
    pub(in crate::puncture) fn follow(&mut self, Segment { from, to, .. }: &Segment) {
        if kept(&to.state).any(|(_, touch)| !is_in(&touch, &from.state)) {
            self.segments.push([(**from).clone(), to.clone()]);
        }
    }
}

/// What a touch keeps of its way, and its rates of change with each parameter; `None` where that is not known.
pub(in crate::puncture) struct Anchor {
    touch: Touch,
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
    for (_, touch) in kept(&rest) {
        // The needle is set down: its first anchor is a matter of the design alone.
        let of = |neighbours: &Neighbours<Chain>| {
            let [below, above] = [&neighbours.below, &neighbours.above]
                .map(|chain| Some(chain.tip(&rest.z, touch.scale, touch.place)?.way));
            Some((above? - below?) / (2.0 * neighbours.step))
        };
        anchors.push(Anchor { touch, rates: variations.iter().map(of).collect() });
    }
    for [from, to] in segments {
        let place = event_before(path, [from, to]);
        let varied = place.as_ref().and_then(|place| with(&anchors, &place.state, variations));
        for (slot, touch) in kept(&to.state).filter(|(_, touch)| !is_in(touch, &from.state)) {
            let unknown = || vec![None; variations.len()];
            let known = place.as_ref().zip(varied.as_ref()).and_then(|(place, varied)| {
                let mut here = Linearisation::new(path.system(), place.clone()).ok()?;
                let rate = |q| rate(path.system(), &mut here, q, slot, &touch);
                Some(varied.iter().map(rate).collect())
            });
            anchors.push(Anchor { touch, rates: known.unwrap_or_else(unknown) });
        }
    }
    anchors
}

/// Variations of a row of which the neighbours have come to a state, each on its own way; `None` if one of these is not known.
pub(in crate::puncture) fn with(
    anchors: &[Anchor],
    state: &SkinState,
    variations: &[Neighbours<Chain>],
) -> Option<Vec<Neighbours<Chain>>> {
    let mut varied = variations.to_vec();
    for (slot, touch) in kept(state) {
        let anchor = anchors.iter().rev().find(|anchor| anchor.touch == touch)?;
        for (neighbours, rate) in varied.iter_mut().zip(&anchor.rates) {
            let change = neighbours.step * (*rate)?;
            neighbours.below.needle.as_mut()?.moved[slot] = Some((touch, -change));
            neighbours.above.needle.as_mut()?.moved[slot] = Some((touch, change));
        }
    }
    Some(varied)
}

/// The touches of a state that keep something of its way.
pub(in crate::puncture) fn history(state: &SkinState) -> NeedleMode {
    let touches = state.mode.needle.touches;
    NeedleMode { touches: touches.map(|touch| touch.filter(Touch::has_history)) }
}

fn kept(state: &SkinState) -> impl Iterator<Item = (usize, Touch)> + use<> {
    let touches = history(state).touches.into_iter().enumerate();
    touches.filter_map(|(slot, touch)| Some((slot, touch?)))
}

fn is_in(touch: &Touch, state: &SkinState) -> bool {
    state.mode.needle.touches.contains(&Some(*touch))
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

/// The rate of what a touch keeps from an event on; `None` where the event becomes another one with the parameter.
fn rate(
    chain: &Chain,
    here: &mut Linearisation<SkinMode>,
    neighbours: &Neighbours<Chain>,
    slot: usize,
    touch: &Touch,
) -> Option<f64> {
    let moved = here.moved(chain, neighbours, false);
    let systems = [&neighbours.below, &neighbours.above];
    let mut both = systems.into_iter().zip(&moved);
    if both.clone().any(|(system, moved)| here.violated(system, moved).is_some()) {
        return None;
    }
    let mut value = || {
        let (system, moved) = both.next()?;
        system.keeps(&moved.state, slot, touch)
    };
    let (below, above) = (value()?, value()?);
    Some((above - below) / (2.0 * neighbours.step)).filter(|rate| rate.is_finite())
}

impl Chain {
    /// What a touch will keep of a state in which it does not yet: its place, or its ratio of forces.
    fn keeps(&self, state: &SkinState, slot: usize, touch: &Touch) -> Option<f64> {
        let Rub::Held { .. } = touch.rub else {
            return Some(self.tip(&state.z, touch.scale, touch.place)?.way);
        };
        let before = state.mode.needle.touches[slot];
        if before.is_none_or(|before| (before.scale, before.place) != (touch.scale, Place::Top)) {
            // The corner has come to the tip: it is held without a tangential force.
            return Some(0.0);
        }
        let push = self.needle.as_ref()?.push(slot);
        Some(state.z[push + 1] / state.z[push])
    }
}

impl GuidedNeedle {
    /// The anchor of a touch, or its ratio of forces, on the way to this row.
    pub(super) fn keeps(&self, slot: usize, touch: &Touch, of_mode: f64) -> f64 {
        match self.moved[slot] {
            Some((moved, by)) if moved == *touch => of_mode + by,
            _ => of_mode,
        }
    }
}
