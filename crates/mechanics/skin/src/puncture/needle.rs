//! The needle: a dead load, or a body guided straight down.
//!
//! A guided needle has a sharp or round tip at a fixed position `X` along the row. The tip touches
//! a face of a scale with friction, slides to the end of the face, then over the corner or into the
//! notch formed with the face of a neighbour, and on.
//!
//! The parts that the needle touches, and its friction state there, belong to the discrete state of
//! the skin (`contacts/needle_mode.rs`).
//!
//! | File | Content |
//! |---|---|
//! | `outline.rs` | kinematics of the tip at a face: gap, coordinate along the face, their derivatives |
//! | `round.rs` | a tip with a radius: its own conditions and transitions |
//! | `forces.rs` | equations, tangent, and their validity conditions |
//! | `transition.rs` | next state when a condition is violated |
//! | `passage.rs` | measures: where the needle touches more than its face, how its path ends |
//! | `history.rs` | history variables, and their derivatives with respect to parameters |

mod forces;
mod history;
mod outline;
mod passage;
mod round;
mod transition;

use std::ops::Range;

use contact::{CornerContact, CornerEdge};
use geometry::{Frame, Vec2};
use solver::{Condition, Newton};

use super::PunctureParameters;
use super::row_layout::RowLayout;
use super::system::Chain;
use crate::contacts::{Contacts, OutlinePart, SHARP_SLOTS, SkinState, Touch};

pub(super) use history::{HistoryObserver, HistoryVariable, anchors, event_before, history, with};
use outline::{Face, Meeting, Tip};
pub(super) use passage::PassageObserver;
pub use passage::{CriticalEvent, Passage, TipForces};
use round::unknowns_per_scale;
pub(super) use round::{reach, unknowns};

/// Constraint on the needle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Needle {
    /// A dead load attached to its point of the scale, which it follows sideways.
    ///
    /// This is the load of Shafiei et al. (2021).
    #[default]
    Free,
    /// A tip guided straight down, with this coefficient of friction.
    Guided {
        /// `μ_n`; 0 for a frictionless needle.
        friction: f64,
    },
}

impl Needle {
    /// Returns true if the tip has a fixed position along the row.
    pub fn is_guided(self) -> bool {
        self != Self::Free
    }

    /// Returns true if the needle is guided and has friction.
    pub fn has_friction(self) -> bool {
        matches!(self, Self::Guided { friction } if friction > 0.0)
    }
}

/// Number of scales on each side that a guided needle may reach.
///
/// It moves by less than its own depth along the row.
pub(super) const FARTHEST: usize = 8;

/// Number of unknowns per touch.
///
/// `N`, `T`, the forward and backward slip distances, and two unknowns for conditions that never
/// become active.
const UNKNOWNS_PER_TOUCH: usize = 6;

/// Constraints per touch, in this order.
const CONSTRAINTS_PER_TOUCH: usize = 5;
const NORMAL: usize = 0;
const FORWARD: usize = 1;
const BACKWARD: usize = 2;
const FACE_START: usize = 3;
const FACE_END: usize = 4;

/// Number of conditions that end the path: a critical tilt, and passing through.
///
/// They follow the constraints of all touches.
const ENDINGS: usize = 2;

/// Unknowns of a guided needle with a sharp tip: depth, two touches, endings.
///
/// They follow the load.
pub(super) const NEEDLE_UNKNOWNS: usize = 1 + SHARP_SLOTS * UNKNOWNS_PER_TOUCH + ENDINGS;

/// A guided needle on a row.
#[derive(Clone, Debug)]
pub(crate) struct GuidedNeedle {
    friction: f64,
    /// Radius of the tip; 0 for a sharp one.
    radius: f64,
    /// Tip at rest, or centre of a round tip, relative to the punctured node.
    pub(super) tip: Vec2,
    critical_tilt: f64,
    /// Index of the first unknown of the needle, the depth.
    pub(super) depth: usize,
    /// Number of contact constraints, which precede the needle constraints.
    contacts: usize,
    /// Constraint numbers of the slip distances, which only grow.
    pub(super) slip_distances: Vec<usize>,
    /// Maximum number of touches.
    pub(super) slots: usize,
    /// Number of unknowns per touch, and of constraints among these unknowns.
    ///
    /// For a round tip the condition on the position is last.
    unknowns_per_touch: usize,
    constraints_per_touch: usize,
    /// Touches with an anchor that differs from the mode's, and the difference.
    ///
    /// Set on perturbed neighbours of a row only.
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
            let per_scale = unknowns_per_scale(friction > 0.0);
            // Every unknown except the tangential force has a constraint.
            let constraints = if friction > 0.0 { per_scale - 1 } else { per_scale };
            // Compute the number of touches from the number of unknowns.
            ((layout.needle - 1 - ENDINGS) / per_scale, per_scale, constraints)
        } else {
            (SHARP_SLOTS, UNKNOWNS_PER_TOUCH, CONSTRAINTS_PER_TOUCH)
        };
        // A frictionless round tip has no slip distances.
        let slides = radius == 0.0 || friction > 0.0;
        let slips = (0..slots)
            .filter(|_| slides)
            .flat_map(|slot| [FORWARD, BACKWARD].map(|xi| constraints_per_touch * slot + xi));
        Self {
            friction,
            radius,
            tip,
            critical_tilt: parameters.critical_tilt_deg.to_radians(),
            depth: layout.load() + 1,
            contacts,
            slip_distances: slips.map(|number| contacts + number).collect(),
            slots,
            unknowns_per_touch,
            constraints_per_touch,
            anchor_shifts: Vec::new(),
        }
    }

    /// Returns true if the tip has a radius.
    pub(super) fn is_round(&self) -> bool {
        self.radius > 0.0
    }

    /// Returns the lowest point of the tip.
    ///
    /// It is relative to the node of the punctured scale at rest.
    pub(super) fn lowest(&self, z: &[f64]) -> Vec2 {
        self.tip - Vec2::new(0.0, self.radius + z[self.depth])
    }

    /// Returns the number of scales on each side that the tip may reach.
    pub(super) fn farthest(&self) -> usize {
        if self.is_round() { self.reach() } else { FARTHEST }
    }

    /// Returns true if the tip has friction.
    pub(super) fn has_friction(&self) -> bool {
        self.friction > 0.0
    }

    /// Lists the unknowns of the needle constraints in order.
    pub(super) fn constraints(&self) -> Vec<usize> {
        let behind = self.normal_force(self.slots);
        // A tangential force that is an unknown in every state is no constraint.
        let tangential_force = |first: usize| {
            (self.constraints_per_touch < self.unknowns_per_touch).then_some(first + 1)
        };
        (0..self.slots)
            .flat_map(|slot| {
                let first = self.normal_force(slot);
                (first..first + self.unknowns_per_touch)
                    .filter(move |unknown| Some(*unknown) != tangential_force(first))
            })
            .chain(behind..behind + ENDINGS)
            .collect()
    }

    /// Returns the unknown of the normal force of a touch.
    ///
    /// The tangential force is the next one.
    fn normal_force(&self, touch: usize) -> usize {
        self.depth + 1 + self.unknowns_per_touch * touch
    }

    /// Returns the system number of a constraint of a touch.
    fn number(&self, touch: usize, constraint: usize) -> usize {
        self.contacts + self.constraints_per_touch * touch + constraint
    }

    /// Returns the constraints that may change together with a constraint.
    ///
    /// With friction these are normal force and slips: opening a sticking touch also ends its stick
    /// constraint.
    pub(super) fn coupled(&self, constraint: usize) -> Range<usize> {
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

    /// Finds the constraint at which a path has ended.
    pub(super) fn ended_at(&self, chain: &Chain, end: &SkinState) -> Option<usize> {
        let mut conditions = Vec::new();
        chain.needle_conditions(self, end, &mut conditions);
        let touches = (0..self.slots).map(|slot| self.constraints_per_touch * slot + NORMAL);
        let touches = touches.filter(|&number| chain.meets_tilted(self, end, number));
        let mut ends = self.endings().chain(touches);
        // It vanishes to within the tolerance of Newton's method.
        let ended = ends.find(|&number| conditions[number].abs() < 1e-8);
        ended.map(|number| self.contacts + number)
    }

    /// Returns true if a path ends where this constraint changes.
    ///
    /// That is at a critical tilt, at the touch of a scale that is already critically tilted, and
    /// when the needle is through.
    pub(super) fn ends(&self, chain: &Chain, state: &SkinState, constraint: usize) -> bool {
        constraint.checked_sub(self.contacts).is_some_and(|number| {
            self.endings().contains(&number) || chain.meets_tilted(self, state, number)
        })
    }

    /// Returns the number of the tilt constraint, the first one after the touches.
    fn tilt_number(&self) -> usize {
        self.constraints_per_touch * self.slots
    }

    /// Returns the constraints that end a path: critical tilt and passing through.
    fn endings(&self) -> Range<usize> {
        self.tilt_number()..self.tilt_number() + ENDINGS
    }
}

impl Chain {
    /// Returns the state at rest with the needle in place.
    ///
    /// The rates decide whether the tip sticks or slides at first, and in which direction.
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
        // Try sticking first: the rates show whether that exceeds the friction limit.
        let normal_force = needle.normal_force(0);
        if let Ok(rates) = Newton::new(self).tangent(self, &rest, &condition) {
            let [normal, tangential] = [rates[normal_force], rates[normal_force + 1]];
            if tangential.abs() > needle.friction * normal {
                needle.slide(&mut rest, 0, tangential > 0.0, anchor);
            }
        }
        rest
    }

    /// Computes the tip relative to a part of a scale.
    ///
    /// `None` for a free needle, and for a scale that is not solved for or out of reach.
    fn tip(&self, z: &[f64], scale: i64, place: OutlinePart) -> Option<Tip> {
        let needle = self.needle.as_ref()?;
        let number = self.scale_numbered(scale)?;
        let frame = self.frame_from_punctured(number);
        let face = Face::new(&self.contacts.arrangement.scale(number), place);
        let at = needle.tip - Vec2::new(0.0, z[needle.depth]) - frame.origin;
        let upward = frame.inward(Vec2::y());
        Some(Tip::new(&face, &self.contacts.pose(z, number), frame.inward(at), upward))
    }

    /// Returns the tangent frame of a scale in the frame of the punctured one.
    pub(super) fn frame_from_punctured(&self, scale: usize) -> Frame {
        let Contacts { arrangement, body, .. } = &self.contacts;
        body.frame(arrangement.position(scale) - arrangement.position(self.layout.left))
    }

    /// Computes the contact of the tip with a part of a scale.
    fn meeting(&self, z: &[f64], scale: i64, place: OutlinePart) -> Option<Meeting> {
        let (needle, tip) = (self.needle.as_ref()?, self.tip(z, scale, place)?);
        let shape = self.contacts.arrangement.scale(self.scale_numbered(scale)?);
        let behind = [OutlinePart::Left, OutlinePart::Top].into_iter().filter(|face| *face < place);
        let before = behind.map(|face| Face::new(&shape, face).length).sum();
        Some(Meeting::new(tip, needle.radius, before))
    }

    /// Iterates over all touches: slot, touch, index of the scale, and kinematics.
    fn touches<'a>(
        &'a self,
        state: &'a SkinState,
    ) -> impl Iterator<Item = (usize, &'a Touch, usize, Meeting)> {
        state.mode.needle.all().filter_map(|(slot, touch)| {
            let meeting = self.meeting(&state.z, touch.scale, touch.place)?;
            Some((slot, touch, self.scale_numbered(touch.scale)?, meeting))
        })
    }

    /// Converts a scale number counted from the punctured one to an index.
    fn scale_numbered(&self, scale: i64) -> Option<usize> {
        let number = usize::try_from(self.layout.left as i64 + scale).ok()?;
        let farthest = self.needle.as_ref().map_or(0, GuidedNeedle::farthest);
        // The bandwidth of the tangent covers only these scales.
        let is_near = scale.unsigned_abs() as usize <= farthest;
        (number < self.layout.scales() && is_near).then_some(number)
    }

    /// Returns the neighbouring face that the needle would meet next.
    fn next_touch(touch: &Touch) -> Option<(i64, OutlinePart)> {
        match touch.place {
            OutlinePart::Left => Some((touch.scale - 1, OutlinePart::Top)),
            OutlinePart::TopLeft => None,
            OutlinePart::Top | OutlinePart::TopRight | OutlinePart::Right => {
                Some((touch.scale + 1, OutlinePart::Left))
            }
        }
    }

    /// Returns true if a constraint is the first touch of a critically tilted scale.
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
            // A sharp tip meets a second scale only beside the one it touches.
            let other = state.mode.needle.touches[1 - slot].as_ref();
            other.and_then(Self::next_touch).map(|(scale, _)| scale)
        };
        scale.and_then(|scale| self.scale_numbered(scale)).is_some_and(|scale| {
            let [_, _, rotation] = self.displacement(&state.z, scale);
            rotation.abs() > needle.critical_tilt
        })
    }

    /// Returns true if the top right corner of a scale lies on the next left face.
    ///
    /// That face then stops the tip at the corner, so the tip does not pass over it.
    fn is_notched(&self, state: &SkinState, scale: i64) -> bool {
        let contact =
            self.corner_of_notch(scale).and_then(|contact| state.mode.contacts.get(contact));
        contact == Some(&CornerContact::Edge(CornerEdge::TopRightOnLeftEdge))
    }

    /// Returns the contact of the top right corner of a scale.
    fn corner_of_notch(&self, scale: i64) -> Option<usize> {
        // The upper contact with the direct neighbour is the first contact of a scale.
        self.scale_numbered(scale).map(|left| self.contacts.contacts_before(left))
    }
}
