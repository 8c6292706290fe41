//! A needle guided straight down.
//!
//! It has a sharp or round tip at a fixed position `X` along the row. The tip touches a face of a
//! scale with friction, slides to the end of the face, then over the corner or into the notch
//! formed with the face of a neighbour, and on.
//!
//! The parts that the needle touches, and its friction state there, belong to the discrete state of
//! the skin (`contacts/needle_mode.rs`).
//!
//! | File | Content |
//! |---|---|
//! | `outline.rs` | kinematics of the tip at a face: gap, coordinate along the face, their derivatives |
//! | `touches.rs` | touches of the tip with the scales of a row, at rest and where the path ends |
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
mod touches;
mod transition;

use std::ops::Range;

use geometry::Vec2;

use super::parameters::PunctureParameters;
use super::row_layout::RowLayout;
use crate::contacts::{SHARP_SLOTS, Touch};

pub(super) use history::{HistoryObserver, HistoryVariable, anchors, event_before, history, with};
pub(super) use passage::PassageObserver;
pub use passage::{CriticalEvent, Passage, TipForces};

/// Number of scales on each side that a guided needle may reach.
///
/// It moves by less than its own depth along the row.
pub(super) const FARTHEST: usize = 8;

/// Largest reach of a round tip, in scales on each side of the punctured one.
const FARTHEST_TOUCH: usize = 64;

/// Scales in reach beyond those below the tip at rest, because rows move sideways.
const PUSHED_ALONG: usize = 2;

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

/// Returns the reach of a round tip in scales on each side.
///
/// `None` if it is too large.
pub(super) fn reach(radius: f64, pitch: f64) -> Option<usize> {
    let reach = (radius / pitch).ceil() as usize + PUSHED_ALONG;
    (reach <= FARTHEST_TOUCH).then_some(reach)
}

/// Counts the unknowns per scale in reach: normal force, condition on position.
///
/// With friction also the tangential force and the forward and backward slip distances.
fn unknowns_per_scale(has_friction: bool) -> usize {
    if has_friction { 5 } else { 2 }
}

/// Counts the unknowns of a round tip: depth, scales in reach, and endings.
pub(super) fn unknowns(reach: usize, has_friction: bool) -> usize {
    1 + unknowns_per_scale(has_friction) * (2 * reach + 1) + ENDINGS
}

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

    /// Returns the number of scales on each side of the punctured one in reach.
    fn reach(&self) -> usize {
        self.slots / 2
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

    /// Returns the number of the tilt constraint, the first one after the touches.
    fn tilt_number(&self) -> usize {
        self.constraints_per_touch * self.slots
    }

    /// Returns the constraints that end a path: critical tilt and passing through.
    fn endings(&self) -> Range<usize> {
        self.tilt_number()..self.tilt_number() + ENDINGS
    }
}
