//! A needle guided straight down.
//!
//! The needle has a sharp or round tip at a fixed position `X` along the row. The tip slides with
//! friction along a face of a scale. At the end of the face it passes over the corner, or stops in
//! the notch between the corner and the left face of the next scale.
//!
//! A tip contact is the contact of the tip with one scale (`TipContact`). The touched parts of the
//! outlines and the friction states belong to the discrete state of the skin
//! (`contacts/needle_mode.rs`).
//!
//! | File | Content |
//! |---|---|
//! | `outline.rs` | kinematics of the tip at a face: gap, coordinate along the face, their derivatives |
//! | `tip_contacts.rs` | tip contacts at rest and along the path, constraints that end the path |
//! | `round.rs` | conditions and transitions of a tip with a radius |
//! | `forces.rs` | equations and tangent of a tip, conditions under which its state is valid |
//! | `transition.rs` | next state when a condition is violated |
//! | `passage.rs` | first contact beyond the initial face, event that ends the path |
//! | `history.rs` | history variables, and their derivatives with respect to parameters |

mod forces;
mod history;
mod outline;
mod passage;
mod round;
mod tip_contacts;
mod transition;

use std::ops::Range;

use geometry::Vec2;

use super::parameters::PunctureParameters;
use super::row_layout::RowLayout;
use crate::contacts::{SHARP_SLOTS, TipContact};

pub(super) use history::{HistoryObserver, HistoryVariable, anchors, event_before, history, with};
pub(super) use passage::PassageObserver;
pub use passage::{CriticalEvent, Passage, TipForces};

/// Number of scales on each side of the punctured one that a sharp tip may touch.
///
/// The tip moves relative to the row by less than its depth, so it stays within this distance.
pub(super) const FARTHEST: usize = 8;

/// Largest number of scales on each side of the punctured one that a round tip may touch.
const FARTHEST_TOUCH: usize = 64;

/// Number of scales in reach on each side in addition to the scales below the tip at rest.
///
/// The tip may reach these scales when the row moves sideways below it.
const PUSHED_ALONG: usize = 2;

/// Number of unknowns of a contact of a sharp tip with a scale.
///
/// They are `N`, `T`, the forward and backward slip distances, and one for each end of the face.
/// The last two belong to conditions that never become active.
const UNKNOWNS_PER_TOUCH: usize = 6;

/// Number of constraints of a contact of a sharp tip with a scale.
const CONSTRAINTS_PER_TOUCH: usize = 5;

/// Index of the constraint of the normal force within a tip contact.
const NORMAL: usize = 0;
/// Index of the constraint of the forward slip distance within a tip contact.
const FORWARD: usize = 1;
/// Index of the constraint of the backward slip distance within a tip contact.
const BACKWARD: usize = 2;
/// Index of the constraint of a sharp tip at the start of its outline part.
///
/// It is violated when a sliding tip reaches the start of its face, or when the force at a corner
/// reaches the slip limit on the face before the corner.
const FACE_START: usize = 3;
/// Index of the constraint of a sharp tip at the end of its outline part, like [`FACE_START`].
const FACE_END: usize = 4;

/// Number of conditions that end the path: a critical tilt, and passing through.
///
/// These conditions follow the constraints of all tip contacts.
const ENDINGS: usize = 2;

/// Number of unknowns of a guided needle with a sharp tip: depth, two tip contacts, endings.
///
/// They follow the load.
pub(super) const NEEDLE_UNKNOWNS: usize = 1 + SHARP_SLOTS * UNKNOWNS_PER_TOUCH + ENDINGS;

/// Returns the number of scales on each side of the punctured one that a round tip may touch.
///
/// `None` if this number exceeds [`FARTHEST_TOUCH`].
pub(super) fn reach(radius: f64, pitch: f64) -> Option<usize> {
    let reach = (radius / pitch).ceil() as usize + PUSHED_ALONG;
    (reach <= FARTHEST_TOUCH).then_some(reach)
}

/// Counts the unknowns of a round tip for each scale in reach.
///
/// They are the normal force, with friction the tangential force and the forward and backward slip
/// distances, and one for the condition that the tip stays on its outline part.
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
    /// Coefficient of friction `μ_n`.
    friction: f64,
    /// Radius of the tip, in units of `t`; 0 for a sharp tip.
    radius: f64,
    /// Sharp tip, or centre of a round tip, at rest, relative to the node of the punctured scale.
    pub(super) tip: Vec2,
    /// Tilt of a touched scale at which the path ends, radians.
    critical_tilt: f64,
    /// Index of the first unknown of the needle, the depth.
    pub(super) depth: usize,
    /// Number of contact constraints, which precede the needle constraints.
    contacts: usize,
    /// Constraint numbers of the slip distances, which cannot decrease.
    pub(super) slip_distances: Vec<usize>,
    /// Maximum number of simultaneous tip contacts.
    pub(super) slots: usize,
    /// Number of unknowns of each tip contact.
    unknowns_per_touch: usize,
    /// Number of unknowns of each tip contact that are constraints.
    ///
    /// For a round tip, the last constraint requires that the tip stays on its outline part.
    constraints_per_touch: usize,
    /// Tip contacts with shifted anchors or ratios, each with its shift from the discrete state.
    ///
    /// Only a row with a perturbed parameter has such shifts, for derivatives.
    anchor_shifts: Vec<(TipContact, f64)>,
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
            // Every unknown except the tangential force is a constraint.
            let constraints = if friction > 0.0 { per_scale - 1 } else { per_scale };
            // The layout has one set of unknowns for each scale that the tip may touch.
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

    /// Returns the lowest point of the tip, relative to the punctured node at rest.
    pub(super) fn lowest(&self, z: &[f64]) -> Vec2 {
        self.tip - Vec2::new(0.0, self.radius + z[self.depth])
    }

    /// Returns the number of scales on each side that a round tip may touch.
    fn reach(&self) -> usize {
        self.slots / 2
    }

    /// Returns the number of scales on each side that the sharp or round tip may touch.
    pub(super) fn farthest(&self) -> usize {
        if self.is_round() { self.reach() } else { FARTHEST }
    }

    /// Returns true if the tip has friction.
    pub(super) fn has_friction(&self) -> bool {
        self.friction > 0.0
    }

    /// Lists the indices of the unknowns that are needle constraints, in order.
    pub(super) fn constraints(&self) -> Vec<usize> {
        let first_ending = self.normal_force(self.slots);
        // A tangential force, if present, is an unknown in every state and no constraint.
        let tangential_force = |first: usize| {
            (self.constraints_per_touch < self.unknowns_per_touch).then_some(first + 1)
        };
        (0..self.slots)
            .flat_map(|slot| {
                let first = self.normal_force(slot);
                (first..first + self.unknowns_per_touch)
                    .filter(move |unknown| Some(*unknown) != tangential_force(first))
            })
            .chain(first_ending..first_ending + ENDINGS)
            .collect()
    }

    /// Returns the index of the normal force of the tip contact in slot `touch`.
    ///
    /// The tangential force, if present, has the next index.
    fn normal_force(&self, touch: usize) -> usize {
        self.depth + 1 + self.unknowns_per_touch * touch
    }

    /// Returns the number in the whole system of a `constraint` of the tip contact in a slot.
    fn number(&self, touch: usize, constraint: usize) -> usize {
        self.contacts + self.constraints_per_touch * touch + constraint
    }

    /// Returns the constraints that may change together with a constraint.
    ///
    /// With friction they are the normal force and both slip distances of the same tip contact: if
    /// a sticking contact opens, sticking ends as well.
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

    /// Returns the number of the tilt constraint among the needle constraints.
    ///
    /// It follows the constraints of all tip contacts.
    fn tilt_number(&self) -> usize {
        self.constraints_per_touch * self.slots
    }

    /// Returns the needle constraints that end a path: critical tilt, then passing through.
    fn endings(&self) -> Range<usize> {
        self.tilt_number()..self.tilt_number() + ENDINGS
    }
}
