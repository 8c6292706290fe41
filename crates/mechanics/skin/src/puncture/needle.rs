//! The needle: a dead load, or a body that is guided straight down.
//!
//! A guided needle has a tip, sharp or round, that keeps its place `X` along the row. It touches a face of a scale and rubs on it, slides to the
//! end of the face, over the corner or into the notch that a neighbour's face makes with it, and on.
//!
//! | File | What it holds |
//! |---|---|
//! | `mode.rs` | what the needle touches and how it rubs there: the part of the state that is not a number |
//! | `outline.rs` | the tip seen from a face: gap, way along the face, their derivatives |
//! | `round.rs` | a tip with a radius: its own equations, conditions and transitions |
//! | `forces.rs` | equations, tangent, and the conditions under which they hold |
//! | `transition.rs` | what comes next where a condition ceases to hold |
//! | `passage.rs` | measures of a path: where the needle touches more than its face, how its path ends |
//! | `history.rs` | what it keeps of its way, and how that changes with a parameter |

mod forces;
mod history;
mod mode;
mod outline;
mod passage;
mod round;
mod transition;

use std::ops::Range;

use contact::{CornerContact, CornerEdge};
use geometry::Vec2;
use solver::{Condition, Newton};

use super::PunctureParameters;
use super::system::{Chain, RowLayout};
use crate::contacts::SkinState;

pub(super) use history::{HistoryObserver, HistoryVariable, anchors, event_before, history, with};
pub(crate) use mode::NeedleMode;
pub(super) use mode::OutlinePart;
use mode::{SHARP_SLOTS, Touch};
use outline::{Face, Meeting, Tip};
pub(super) use passage::PassageObserver;
pub use passage::{CriticalEvent, Passage, TipForces};
use round::of_scale;
pub(super) use round::{reach, unknowns};

/// How the needle is held.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Needle {
    /// A dead load that hangs on its point of the scale and follows it sideways, as in Shafiei et al. (2021).
    #[default]
    Free,
    /// A tip that moves straight down, with this coefficient of friction.
    Guided {
        /// `μ_n`; 0 for a needle that does not rub.
        friction: f64,
    },
}

impl Needle {
    /// Whether the tip keeps its place along the row.
    pub fn is_guided(self) -> bool {
        self != Self::Free
    }

    /// Whether it is guided and rubs.
    pub fn has_friction(self) -> bool {
        matches!(self, Self::Guided { friction } if friction > 0.0)
    }
}

/// Scales on each side of the punctured one that a guided needle may come to. It moves by less than its own depth along the row.
pub(super) const FARTHEST: usize = 8;

/// Unknowns of a touch: `N`, `T`, the ways slid forward and backward, and those of two conditions that never act.
const UNKNOWNS_PER_TOUCH: usize = 6;

/// Constraints of a touch, in this order.
const CONSTRAINTS_PER_TOUCH: usize = 5;
const NORMAL: usize = 0;
const FORWARD: usize = 1;
const BACKWARD: usize = 2;
const FACE_START: usize = 3;
const FACE_END: usize = 4;

/// Conditions that end the path, behind those of all touches: a tilt, and coming through.
const ENDINGS: usize = 2;

/// Unknowns of a guided needle with a sharp tip, behind the load: its depth, those of two touches, and those of its endings.
pub(super) const NEEDLE_UNKNOWNS: usize = 1 + SHARP_SLOTS * UNKNOWNS_PER_TOUCH + ENDINGS;

/// A guided needle on a row.
#[derive(Clone, Debug)]
pub(crate) struct GuidedNeedle {
    friction: f64,
    /// Radius of the tip; 0 of a sharp one.
    radius: f64,
    /// The tip at rest, or the centre of a round one, from the node of the punctured scale.
    pub(super) tip: Vec2,
    critical_tilt: f64,
    /// The first of its unknowns: the depth.
    pub(super) depth: usize,
    /// Constraints of the row that are not the needle's: they come first.
    contacts: usize,
    /// Numbers of the constraints that only grow.
    pub(super) slip_distances: Vec<usize>,
    /// Touches that there may be.
    pub(super) slots: usize,
    /// Unknowns of a touch, and how many of them are constraints: of a round tip those of its place are the last.
    unknowns_per_touch: usize,
    constraints_per_touch: usize,
    /// Touches that keep something else of the way to a neighbour of a row than that row does, for a parameter that differs, and by how
    /// much.
    anchor_shifts: Vec<(Touch, f64)>,
}

impl GuidedNeedle {
    pub(super) fn new(
        friction: f64,
        parameters: &PunctureParameters,
        tip: Vec2,
        layout: RowLayout,
        contacts: usize,
    ) -> Self {
        let radius = parameters.needle_radius.unwrap_or(0.0);
        let (slots, unknowns_per_touch, constraints_per_touch) = if radius > 0.0 {
            let of_scale = of_scale(friction > 0.0);
            // All but the tangential force.
            let constraints = if friction > 0.0 { of_scale - 1 } else { of_scale };
            // Read backwards, the number of unknowns gives that of the touches that there may be.
            ((layout.needle - 1 - ENDINGS) / of_scale, of_scale, constraints)
        } else {
            (SHARP_SLOTS, UNKNOWNS_PER_TOUCH, CONSTRAINTS_PER_TOUCH)
        };
        // A round tip that does not rub has no ways to count.
        let slides = radius == 0.0 || friction > 0.0;
        let ways = (0..slots)
            .filter(|_| slides)
            .flat_map(|slot| [FORWARD, BACKWARD].map(|xi| constraints_per_touch * slot + xi));
        Self {
            friction,
            radius,
            tip,
            critical_tilt: parameters.critical_tilt_deg.to_radians(),
            depth: layout.load() + 1,
            contacts,
            slip_distances: ways.map(|number| contacts + number).collect(),
            slots,
            unknowns_per_touch,
            constraints_per_touch,
            anchor_shifts: Vec::new(),
        }
    }

    /// Whether its tip has a radius.
    pub(super) fn is_round(&self) -> bool {
        self.radius > 0.0
    }

    /// The lowest point of its tip, from the node of the punctured scale at rest.
    pub(super) fn lowest(&self, z: &[f64]) -> Vec2 {
        self.tip - Vec2::new(0.0, self.radius + z[self.depth])
    }

    /// Scales on each side of the punctured one that it may come to.
    pub(super) fn farthest(&self) -> usize {
        if self.is_round() { self.reach() } else { FARTHEST }
    }

    /// Whether its tip rubs.
    pub(super) fn has_friction(&self) -> bool {
        self.friction > 0.0
    }

    /// The unknowns of its constraints, in their order.
    pub(super) fn constraints(&self) -> Vec<usize> {
        let behind = self.normal_force(self.slots);
        // A tangential force that is an unknown has an equation in every state: no constraint.
        let tangential_force = |first: usize| {
            (self.constraints_per_touch < self.unknowns_per_touch).then_some(first + 1)
        };
        let of_slot = |slot: usize| {
            let first = self.normal_force(slot);
            (first..first + self.unknowns_per_touch)
                .filter(move |unknown| Some(*unknown) != tangential_force(first))
        };
        (0..self.slots).flat_map(of_slot).chain(behind..behind + ENDINGS).collect()
    }

    /// Unknown of the normal force of a touch; that of the tangential one is the next.
    fn normal_force(&self, touch: usize) -> usize {
        self.depth + 1 + self.unknowns_per_touch * touch
    }

    /// Number of a constraint of a touch among those of the row.
    fn number(&self, touch: usize, constraint: usize) -> usize {
        self.contacts + self.constraints_per_touch * touch + constraint
    }

    /// Those of the push and of the slip of a tip that rubs: as it comes off a face it holds to, its friction goes with it.
    pub(super) fn companions(&self, constraint: usize) -> Range<usize> {
        let number = constraint - self.contacts;
        let first = constraint - number % self.constraints_per_touch;
        let is_of_touch =
            number < self.tilt_number() && number % self.constraints_per_touch <= BACKWARD;
        if is_of_touch && self.has_friction() {
            first..first + 3
        } else {
            constraint..constraint + 1
        }
    }

    /// The constraint at which a path has ended.
    pub(super) fn ended_at(&self, chain: &Chain, end: &SkinState) -> Option<usize> {
        let mut conditions = Vec::new();
        chain.needle_conditions(self, end, &mut conditions);
        let touches = (0..self.slots).map(|slot| self.constraints_per_touch * slot + NORMAL);
        let touches = touches.filter(|&number| chain.meets_tilted(self, end, number));
        let mut ends = self.endings().chain(touches);
        // It has vanished to the tolerance of Newton's method.
        let ended = ends.find(|&number| conditions[number].abs() < 1e-8);
        ended.map(|number| self.contacts + number)
    }

    /// Whether a path ends where this constraint would change sides: a scale is critically tilted, or comes to be touched when it is
    /// already, or the needle is through.
    pub(super) fn ends(&self, chain: &Chain, state: &SkinState, constraint: usize) -> bool {
        constraint.checked_sub(self.contacts).is_some_and(|number| {
            self.endings().contains(&number) || chain.meets_tilted(self, state, number)
        })
    }

    /// Number of the first constraint behind those of the touches: that on tilts.
    fn tilt_number(&self) -> usize {
        self.constraints_per_touch * self.slots
    }

    /// The constraints that end a path, among its own: that on tilts, and that of coming through.
    fn endings(&self) -> Range<usize> {
        self.tilt_number()..self.tilt_number() + ENDINGS
    }
}

impl Chain {
    /// The state of rest, the needle set down. Whether its tip sticks or slides at first, and which way, shows in the rates.
    pub(super) fn at_rest(&self) -> SkinState {
        let mut rest = SkinState::at_rest(self);
        let Some(needle) = &self.needle else { return rest };
        if needle.is_round() {
            return self.round_at_rest(needle, rest);
        }
        rest.active[needle.number(0, NORMAL)] = true;
        // Scale 0 is in every row.
        let Some(Tip { xi: anchor, .. }) = self.tip(&rest.z, 0, OutlinePart::Top) else {
            return rest;
        };
        let tip_state = needle.resting(anchor);
        rest.mode.needle.touches[0] = Some(Touch { scale: 0, place: OutlinePart::Top, tip_state });
        if needle.friction == 0.0 {
            return rest;
        }
        let control = self.controls[0];
        let condition = Condition::new(vec![(control.index, 1.0 / control.scale)], 0.0);
        // The tip is tried as sticking: the rates tell whether that takes more than there is.
        let normal_force = needle.normal_force(0);
        if let Ok(rates) = Newton::new(self).tangent(self, &rest, &condition) {
            let [normal, tangential] = [rates[normal_force], rates[normal_force + 1]];
            if tangential.abs() > needle.friction * normal {
                needle.slide(&mut rest, 0, tangential > 0.0, anchor);
            }
        }
        rest
    }

    /// The tip at a place of a scale; `None` of a free needle, and of a scale that is not solved for or too far away.
    fn tip(&self, z: &[f64], scale: i64, place: OutlinePart) -> Option<Tip> {
        let needle = self.needle.as_ref()?;
        let number = self.scale_numbered(scale)?;
        let away = self.contacts.arrangement.place(number)
            - self.contacts.arrangement.place(self.layout.left);
        let face = Face::new(&self.contacts.arrangement.scale(number), place);
        let at = needle.tip - Vec2::new(away, z[needle.depth]);
        Some(Tip::new(&face, &self.contacts.pose(z, number), at))
    }

    /// The tip where it touches a scale, at this place.
    fn meeting(&self, z: &[f64], scale: i64, place: OutlinePart) -> Option<Meeting> {
        let (needle, tip) = (self.needle.as_ref()?, self.tip(z, scale, place)?);
        let shape = self.contacts.arrangement.scale(self.scale_numbered(scale)?);
        let behind = [OutlinePart::Left, OutlinePart::Top].into_iter().filter(|face| *face < place);
        let before = behind.map(|face| Face::new(&shape, face).length).sum();
        Some(Meeting::new(tip, needle.radius, before))
    }

    /// All touches: slot, touch, index of the scale, and the tip there.
    fn touches<'a>(
        &'a self,
        state: &'a SkinState,
    ) -> impl Iterator<Item = (usize, &'a Touch, usize, Meeting)> {
        state.mode.needle.all().filter_map(|(slot, touch)| {
            let meeting = self.meeting(&state.z, touch.scale, touch.place)?;
            Some((slot, touch, self.scale_numbered(touch.scale)?, meeting))
        })
    }

    /// Index of a scale, counted from the punctured one.
    fn scale_numbered(&self, scale: i64) -> Option<usize> {
        let number = usize::try_from(self.layout.left as i64 + scale).ok()?;
        let farthest = self.needle.as_ref().map_or(0, GuidedNeedle::farthest);
        // The band of the tangent is as wide as this, and farther scales would lie outside of it.
        let is_near = scale.unsigned_abs() as usize <= farthest;
        (number < self.layout.scales() && is_near).then_some(number)
    }

    /// The face that the needle would come to next besides the one that it touches: a neighbour's.
    fn next_touch(touch: &Touch) -> Option<(i64, OutlinePart)> {
        match touch.place {
            OutlinePart::Left => Some((touch.scale - 1, OutlinePart::Top)),
            OutlinePart::TopLeft => None,
            OutlinePart::Top | OutlinePart::TopRight | OutlinePart::Right => {
                Some((touch.scale + 1, OutlinePart::Left))
            }
        }
    }

    /// Whether a constraint of the needle is that of coming to touch a scale that its neighbours have tilted critically before.
    fn meets_tilted(&self, needle: &GuidedNeedle, state: &SkinState, number: usize) -> bool {
        let slot = number / needle.constraints_per_touch;
        if number >= needle.tilt_number()
            || number % needle.constraints_per_touch != NORMAL
            || state.mode.needle.touches[slot].is_some()
        {
            return false;
        }
        let scale = if needle.is_round() {
            Some(slot as i64 - needle.reach() as i64)
        } else {
            // A sharp tip comes to a second scale only beside the one that it touches.
            let other = state.mode.needle.touches[1 - slot].as_ref();
            other.and_then(Self::next_touch).map(|(scale, _)| scale)
        };
        scale.and_then(|scale| self.scale_numbered(scale)).is_some_and(|scale| {
            let [_, _, rotation] = self.displacement(&state.z, scale);
            rotation.abs() > needle.critical_tilt
        })
    }

    /// Whether the top right corner of a scale lies on the left face of its right neighbour, so that the tip is stopped there by that
    /// face, and does not pass over the corner.
    fn is_notched(&self, state: &SkinState, scale: i64) -> bool {
        let contact =
            self.corner_of_notch(scale).and_then(|contact| state.mode.contacts.get(contact));
        contact == Some(&CornerContact::Edge(CornerEdge::TopRightOnLeftEdge))
    }

    /// The contact of the top right corner of a scale.
    fn corner_of_notch(&self, scale: i64) -> Option<usize> {
        // The upper contact of a scale with its neighbour is the first of all its contacts.
        self.scale_numbered(scale).map(|left| self.contacts.contacts_before(left))
    }
}
