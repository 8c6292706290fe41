//! Passage of a guided needle: first contact beyond its initial face, and end of its path.

use serde::{Deserialize, Serialize};

use crate::contacts::{OutlinePart, SkinPoint, SkinState, TipState};
use crate::puncture::adaptive_row::Segment;
use crate::puncture::system::Chain;
use crate::record::Skin;

/// Event that ends the path of a guided needle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CriticalEvent {
    /// A touched scale reaches the critical tilt.
    Tilt,
    /// The needle reaches the soft surface between two bases.
    Through,
}

impl CriticalEvent {
    /// Returns the short name used in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tilt => "tilt",
            Self::Through => "through",
        }
    }
}

/// Measures of the passage of a guided needle through the row; empty for a free needle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Passage {
    /// Event that ended the path; `None` if the path ended for another reason.
    pub critical_event: Option<CriticalEvent>,
    /// Force `F*` at which the tip first touches a corner or another scale.
    ///
    /// `None` if the tip touches only the top of the punctured scale.
    pub passing_force: Option<f64>,
    /// Depth `u*` at the passing force.
    pub passing_displacement: Option<f64>,
    /// Tilt of the punctured scale at the passing force, degrees.
    pub passing_tilt_deg: Option<f64>,
    /// Displacement of the tip along the top of the punctured scale, in units of `t`.
    ///
    /// It is positive towards the left corner, and refers to the passing force, or to the end of
    /// the path if there is no passing force.
    pub needle_shift: Option<f64>,
}

impl Passage {
    /// Returns true if no measure has a value, as for a free needle.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// Number of each scale touched by a round tip, with the normal force in units of `F*`.
///
/// Numbers are counted from the punctured scale, positive to the right.
pub type TipForces = Vec<(i64, f64)>;

/// Detects the first contact beyond the initial face, and records the forces of a round tip.
#[derive(Debug, Default)]
pub(in crate::puncture) struct PassageObserver {
    /// Forces at each point of the path except the last one; empty for a sharp tip.
    pub(in crate::puncture) tip_forces: Vec<TipForces>,
    /// Segment that ends where the tip first touches a corner or another scale.
    pub(in crate::puncture) passed: Option<[SkinPoint; 2]>,
}

impl PassageObserver {
    pub(in crate::puncture) fn follow(
        &mut self,
        chain: &Chain,
        Segment { from, to, .. }: &Segment,
    ) {
        self.tip_forces.extend(chain.tip_forces(&from.state));
        if self.passed.is_none() && is_on_its_face(&from.state) && !is_on_its_face(&to.state) {
            self.passed = Some([(**from).clone(), to.clone()]);
        }
    }

    pub(in crate::puncture) fn finish(&self, chain: &Chain, end: &SkinState) -> Passage {
        let Some(needle) = &chain.needle else { return Passage::default() };
        let ended = needle.ended_at(chain, end);
        let passed = self.passed.as_ref().map(|[_, at]| chain.path_point(at));
        let shifted = self.passed.as_ref().map_or(end, |[_, at]| &at.state);
        Passage {
            critical_event: ended.map(|constraint| {
                let is_through = constraint > needle.contacts + needle.tilt_number();
                if is_through { CriticalEvent::Through } else { CriticalEvent::Tilt }
            }),
            passing_force: passed.map(|point| point.force),
            passing_displacement: passed.map(|point| point.displacement),
            passing_tilt_deg: passed.map(|point| point.tilt_deg),
            needle_shift: chain.shift(shifted),
        }
    }
}

/// Returns true if the needle touches only its initial face.
fn is_on_its_face(state: &SkinState) -> bool {
    state.mode.needle.all().all(|(_, touch)| {
        touch.scale == 0
            && touch.part == OutlinePart::Top
            && !matches!(touch.tip_state, TipState::Locked { .. })
    })
}

impl Chain {
    /// Returns the displacement of the tip along the top of the punctured scale.
    ///
    /// It is positive towards the left corner. `None` for a free needle.
    pub(in crate::puncture) fn shift(&self, state: &SkinState) -> Option<f64> {
        let at = |z: &[f64]| Some(self.tip(z, 0, OutlinePart::Top)?.xi);
        Some(at(&vec![0.0; state.z.len()])? - at(&state.z)?)
    }
}
