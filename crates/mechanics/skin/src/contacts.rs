//! Contacts of a row or a strip of scales: unknowns, conditions and transitions.

mod assembly;
mod audit;
mod change;
mod closed;
mod dissipation;
mod friction;
mod friction_transitions;
mod mode;
mod needle_mode;
mod pair_unknowns;
mod stiffness;
mod touching;

pub use change::ContactChange;
pub use closed::Contact;
pub(crate) use dissipation::{Dissipation, product_integral};
pub(crate) use friction::TipFriction;
use friction::{FrictionState, SLIP_DISTANCE};
pub(crate) use mode::SkinMode;
pub(crate) use needle_mode::{NeedleMode, OutlinePart, SHARP_SLOTS, TipContact, TipState};
pub(crate) use touching::{PairCoordinate, TouchingEdge};

use contact::{
    ContactLaw, CornerContact, CornerEdge, Corners, Equation, FORCES, Force, Level, Pair, Pose,
};
use geometry::{Body, Frame};
use solver::Change;

use crate::arrangement::Arrangement;

/// The two levels at which a pair of scales can touch; each level has one contact.
const LEVELS: [Level; 2] = [Level::Upper, Level::Lower];

/// Counts the constraints of one pair of scales: normal forces and friction of both contacts.
pub(crate) fn pair_constraints(law: &ContactLaw) -> usize {
    LEVELS.len() * slots(law)
}

/// Counts the constraints of one contact: three normal forces, and two for friction if it acts.
fn slots(law: &ContactLaw) -> usize {
    if law.friction() > 0.0 { FORCES + 2 } else { FORCES }
}

/// Value for a constraint that has no condition in the current state.
///
/// Any positive value is suitable: the constraint then counts as satisfied and causes no event.
pub(crate) const SATISFIED: f64 = 1.0;

/// State of a row or a strip: unknowns, active set and mode.
pub(crate) type SkinState = solver::State<SkinMode>;

/// Equilibrium on the path of a row or a strip.
pub(crate) type SkinPoint = solver::Equilibrium<SkinMode>;

/// The contacts of a row of scales, and the layout of their unknowns.
///
/// Contact `2 k` is the upper and `2 k + 1` the lower contact of pair `k`. With reach 1, pair `k`
/// consists of scales `k` and `k + 1`. With a larger reach, each scale forms one pair with each
/// scale on its right within reach.
///
/// Contact forces are the constraints of the system. Contact `j` has three: constraint `3 j` is its
/// force `λ`, `3 j + 1` its partner force `λ'` and `3 j + 2` its flush force `λ''`. With friction
/// each contact has five constraints: the fourth is its stick multiplier, the fifth its slip
/// distance.
#[derive(Clone, Debug)]
pub(crate) struct Contacts {
    pub(crate) arrangement: Arrangement,
    /// Body under the row. Displacements of a scale are in the tangent frame at its node.
    pub(crate) body: Body,
    /// Undeformed shape of each pair, or for each distance of a pair if all scales are equal.
    ///
    /// Each entry also holds the tangent frame of the right scale, relative to the frame of the
    /// left scale.
    pair_shapes: Vec<(Pair, Frame)>,
    /// Largest distance, in pitches, of two scales that may touch.
    ///
    /// It is 1 unless scales of the row touch beyond their nearest neighbours.
    pub(crate) reach: usize,
    law: ContactLaw,
    /// Index of the first of the three unknowns of each scale; `None` for a fixed scale.
    pub(crate) scales: Vec<Option<usize>>,
    /// True if the displacement of each scale is relative to its left neighbour.
    ///
    /// Rotations are relative to the first scale in either case.
    relative: bool,
    /// Number of constraints of one contact.
    slots: usize,
    /// Index of the unknown of each constraint.
    pub(crate) forces: Vec<usize>,
    /// Constraint numbers of the slip distances, which are unknowns that cannot decrease.
    pub(crate) slip_distances: Vec<usize>,
    /// Contacts with shifted anchors or ratios, each with its shift from the value in the mode.
    ///
    /// Only a row with a perturbed parameter has such shifts, for derivatives.
    anchor_shifts: Vec<(usize, f64)>,
}

impl Contacts {
    pub(crate) fn new(
        arrangement: Arrangement,
        body: Body,
        law: ContactLaw,
        scales: Vec<Option<usize>>,
        forces: Vec<usize>,
        relative: bool,
    ) -> Self {
        let slots = slots(&law);
        let neighbours = pair_constraints(&law) * scales.len().saturating_sub(1);
        // A single scale has no pairs: avoid a division by zero; its reach is not used.
        let reach = forces.len().checked_div(neighbours).unwrap_or(1);
        debug_assert_eq!(forces.len(), reach * neighbours);
        let pair_shapes = arrangement.pairs(reach, body);
        let slip_distances = (0..forces.len()).filter(|number| number % slots == SLIP_DISTANCE);
        let slip_distances = slip_distances.collect();
        Self {
            arrangement,
            body,
            pair_shapes,
            reach,
            law,
            scales,
            relative,
            slots,
            forces,
            slip_distances,
            anchor_shifts: Vec::new(),
        }
    }

    /// Returns the mode at rest, in which all contacts are open.
    pub(crate) fn open(&self) -> SkinMode {
        let contacts = vec![CornerContact::Open; self.forces.len() / self.slots];
        let friction_states = if self.has_friction() {
            vec![FrictionState::None; contacts.len()]
        } else {
            Vec::new()
        };
        SkinMode { contacts, friction_states, ..SkinMode::default() }
    }

    /// Splits a constraint number into its contact and its slot within the contact.
    pub(crate) fn contact_of(&self, constraint: usize) -> (usize, usize) {
        (constraint / self.slots, constraint % self.slots)
    }

    /// Returns the range of constraints that may change at the same event as `constraint`.
    ///
    /// With friction these are all constraints of its pair, because both contacts of the pair may
    /// begin to slip at this event.
    pub(crate) fn coupled(&self, constraint: usize) -> std::ops::Range<usize> {
        if !self.has_friction() {
            return constraint..constraint + 1;
        }
        let pair = LEVELS.len() * self.slots;
        let first = constraint / pair * pair;
        first..first + pair
    }

    /// Returns the left and the right scale of the pair to which a constraint belongs.
    pub(crate) fn scales_of(&self, constraint: usize) -> [usize; 2] {
        self.ends(Self::pair_of(constraint / self.slots))
    }

    /// Returns the corner and edge on which the force of a constraint acts.
    ///
    /// `None` if its contact is open.
    pub(crate) fn corner_edge(&self, mode: &SkinMode, constraint: usize) -> Option<CornerEdge> {
        let (contact, slot) = self.contact_of(constraint);
        let edge = mode.contacts[contact].edge()?;
        if slot == Force::Flush as usize { edge.flush() } else { Some(edge) }
    }

    /// Returns the pose of a scale, relative to its left neighbour if poses are relative.
    pub(crate) fn pose(&self, z: &[f64], scale: usize) -> Pose {
        // With relative poses the pose is expressed in the frame of the left neighbour. The unknown
        // rotation counts from the first scale, so the rotation of the neighbour is subtracted.
        let frame = self.frame(scale).map_or(0.0, |rotation| z[rotation]);
        match self.scales[scale] {
            Some(at) => Pose::new(z[at], z[at + 1], z[at + 2] - frame),
            None => Pose::new(0.0, 0.0, 0.0),
        }
    }

    /// Returns the poses of all scales, as [`Self::pose`].
    ///
    /// On a curved body all poses are in the tangent frame of the first scale.
    pub(crate) fn poses(&self, z: &[f64]) -> Vec<Pose> {
        let scales = 0..self.scales.len();
        scales
            .map(|scale| self.in_outer_frame(self.pose(z, scale), || self.frame_at(scale)))
            .collect()
    }

    /// Returns the tangent frame of a scale, relative to the frame of the first scale.
    pub(crate) fn frame_at(&self, scale: usize) -> Frame {
        self.body.frame(self.arrangement.position(scale))
    }

    /// Transforms a pose from the tangent frame `frame` to the frame to which `frame` is relative.
    ///
    /// Does nothing on a flat body.
    fn in_outer_frame(&self, pose: Pose, frame: impl FnOnce() -> Frame) -> Pose {
        if self.body.is_flat() {
            return pose;
        }
        let frame = frame();
        let displacement = frame.outward(pose.displacement);
        Pose::new(displacement.x, displacement.y, pose.rotation - frame.angle)
    }

    /// Returns the index of the rotation of the frame in which the pose of a scale is expressed.
    ///
    /// This is the unknown rotation of its left neighbour; `None` if the frame is fixed.
    fn frame(&self, scale: usize) -> Option<usize> {
        let neighbour = scale.checked_sub(1).filter(|_| self.relative)?;
        Some(self.scales[neighbour]? + 2)
    }

    /// Counts the closed contacts; a contact between flush edges counts twice.
    pub(crate) fn closed(state: &SkinState) -> usize {
        state.mode.contacts.iter().flat_map(|contact| contact.carrying()).flatten().count()
    }

    /// Counts the scales that have at least one closed contact.
    pub(crate) fn engaged(&self, state: &SkinState) -> usize {
        let mut touch = vec![false; self.scales.len()];
        for scale in Self::touching(&state.mode).flat_map(|pair| self.ends(pair)) {
            touch[scale] = true;
        }
        touch.into_iter().filter(|&touches| touches).count()
    }

    /// Iterates over the indices of the pairs with a closed contact, from left to right.
    fn touching(mode: &SkinMode) -> impl Iterator<Item = usize> {
        let pairs = mode.contacts.chunks_exact(LEVELS.len()).enumerate();
        pairs
            .filter(|(_, contacts)| contacts.iter().any(|contact| *contact != CornerContact::Open))
            .map(|(pair, _)| pair)
    }

    /// Returns two flags: whether the first and whether the last scale has a closed contact.
    pub(crate) fn touching_at_ends(&self, state: &SkinState) -> [bool; 2] {
        let last = self.scales.len() - 1;
        let pairs = Self::touching(&state.mode).map(|pair| self.ends(pair));
        pairs.fold([false; 2], |[first_touches, last_touches], [left, right]| {
            [first_touches || left == 0, last_touches || right == last]
        })
    }

    /// Returns true if the edges of any contact lie flush (C7).
    pub(crate) fn flush(state: &SkinState) -> bool {
        state.mode.contacts.iter().any(|contact| matches!(contact, CornerContact::Flush(_)))
    }

    /// Replaces `values` by the values of the conditions of all inactive constraints.
    ///
    /// A constraint without a condition gets [`SATISFIED`].
    pub(crate) fn conditions(&self, state: &SkinState, values: &mut Vec<f64>) {
        values.clear();
        values.resize(self.forces.len(), SATISFIED);
        self.for_each(state, |contact, corners| {
            let values = &mut values[self.slots * contact..][..FORCES];
            match state.mode.contacts[contact] {
                CornerContact::Open => {
                    // Fast path without derivatives: most contacts are open and need only the gap.
                    values[0] = corners.facing().map_or(SATISFIED, |(_, gap)| gap);
                }
                closed => {
                    for (value, condition) in
                        values.iter_mut().zip(closed.resting_conditions(corners))
                    {
                        *value = condition.map_or(SATISFIED, |condition| condition.value);
                    }
                }
            }
        });
        self.friction_conditions(state, &state.z, SATISFIED, values);
    }

    /// Replaces `values` like [`Self::conditions`], and `slopes` by derivatives along `direction`.
    pub(crate) fn condition_slopes(
        &self,
        state: &SkinState,
        direction: &[f64],
        values: &mut Vec<f64>,
        slopes: &mut Vec<f64>,
    ) {
        values.clear();
        values.resize(self.forces.len(), SATISFIED);
        slopes.clear();
        slopes.resize(self.forces.len(), 0.0);
        self.for_each(state, |contact, corners| {
            let conditions = state.mode.contacts[contact].resting_conditions(corners);
            for (slot, condition) in (self.slots * contact..).zip(conditions) {
                if let Some(condition) = condition {
                    values[slot] = condition.value;
                    slopes[slot] = self.along(contact, &condition, direction);
                }
            }
        });
        self.friction_conditions(state, &state.z, SATISFIED, values);
        self.friction_conditions(state, direction, 0.0, slopes);
    }

    /// Evaluates the condition of an inactive constraint; [`SATISFIED`] without a condition.
    pub(crate) fn condition(&self, state: &SkinState, constraint: usize) -> f64 {
        let (contact, slot) = self.contact_of(constraint);
        if slot >= FORCES {
            let value = self.slot_condition(state, &state.z, contact, slot);
            return value.unwrap_or(SATISFIED);
        }
        // A pair with its right scale beyond the end of the row has unknowns but no contact.
        if !self.is_whole(Self::pair_of(contact)) {
            return SATISFIED;
        }
        let poses = self.pair_poses(&state.z, contact);
        let conditions =
            state.mode.contacts[contact].resting_conditions(&self.corners(contact, &poses));
        conditions[slot].map_or(SATISFIED, |condition| condition.value)
    }

    /// Evaluates the derivative of the condition of a constraint along `direction`.
    ///
    /// Zero if the constraint has no condition.
    pub(crate) fn slope(&self, state: &SkinState, constraint: usize, direction: &[f64]) -> f64 {
        let (contact, slot) = self.contact_of(constraint);
        if !self.is_whole(Self::pair_of(contact)) {
            return 0.0;
        }
        if slot >= FORCES {
            return self.slot_slope(state, direction, contact, slot);
        }
        let poses = self.pair_poses(&state.z, contact);
        let forces = self.forces_of(&state.z, contact);
        let corners = self.corners(contact, &poses);
        let response = state.mode.contacts[contact].response(&corners, &self.law, forces);
        let condition = response.conditions[slot];
        condition.map_or(0.0, |condition| self.along(contact, &condition, direction))
    }

    /// Evaluates the derivative of the equation `condition` of a contact along `direction`.
    fn along(&self, contact: usize, condition: &Equation, direction: &[f64]) -> f64 {
        let by_parts = self.pair_unknowns(contact).sum(&condition.by_coordinate, direction);
        let unknowns = self.unknowns_of(contact).into_iter().zip(condition.by_force);
        by_parts + unknowns.map(|(unknown, slope)| slope * direction[unknown]).sum::<f64>()
    }

    /// Moves a contact to its next state after one of its constraints became active or inactive.
    ///
    /// Returns the constraint with the condition that the outgoing branch must satisfy, or `None`
    /// if the contact has no such transition.
    pub(crate) fn transition(&self, state: &mut SkinState, change: Change) -> Option<usize> {
        let (contact, slot) = self.contact_of(change.constraint);
        let first = self.slots * contact;
        let Some(&force) = Force::ALL.get(slot) else {
            return Some(first + self.change_friction(state, contact, slot, change.activated)?);
        };
        let poses = self.pair_poses(&state.z, contact);
        let next = state.mode.contacts[contact].transition(
            force,
            change.activated,
            &self.corners(contact, &poses),
            self.forces_of(&state.z, contact),
        )?;
        // Only the update of friction needs a copy of the previous state.
        let before = self.has_friction().then(|| state.clone());
        state.mode.contacts[contact] = next.contact;
        for (unknown, force) in self.unknowns_of(contact).into_iter().zip(next.forces) {
            state.z[unknown] = force;
        }
        state.active[first..first + FORCES].copy_from_slice(&next.contact.acting());
        // Update friction after the normal forces, because it depends on them.
        if let Some(before) = before {
            self.update_friction(state, &before, contact, force == Force::Partner);
        }
        Some(first + next.valid as usize)
    }

    /// Calls `show` with the index and the corners of each contact, from left to right.
    fn for_each(&self, state: &SkinState, mut show: impl FnMut(usize, &Corners)) {
        for (pair, poses) in self.pairs(&state.z) {
            for contact in Self::contacts_of(pair) {
                show(contact, &self.corners(contact, &poses));
            }
        }
    }

    /// Returns the range of the two contacts of a pair.
    fn contacts_of(pair: usize) -> std::ops::Range<usize> {
        LEVELS.len() * pair..LEVELS.len() * (pair + 1)
    }

    /// Counts the contacts of all pairs with one of the first `left` scales as left scale.
    pub(crate) fn contacts_before(&self, left: usize) -> usize {
        LEVELS.len() * self.reach * left
    }

    /// Returns the index of the pair to which a contact belongs.
    fn pair_of(contact: usize) -> usize {
        contact / LEVELS.len()
    }

    /// Returns the left and the right scale of a pair.
    fn ends(&self, pair: usize) -> [usize; 2] {
        if self.reach == 1 {
            // Fast path without division: inner loops call this function, and nearly every row has
            // reach 1.
            return [pair, pair + 1];
        }
        let left = pair / self.reach;
        [left, left + 1 + pair % self.reach]
    }

    fn pair(&self, pair: usize) -> &Pair {
        &self.pair_and_frame(pair).0
    }

    /// Returns an undeformed pair and the tangent frame of its right scale.
    ///
    /// The frame is relative to the frame of the left scale.
    fn pair_and_frame(&self, pair: usize) -> &(Pair, Frame) {
        match self.pair_shapes.as_slice() {
            // One shape belongs to an even row of reach 1 or to an uneven row of two scales.
            [pair] => pair,
            shapes if shapes.len() == self.reach => &shapes[pair % self.reach],
            shapes => &shapes[pair],
        }
    }

    /// Returns the corners of the left and the right scale that can touch at a contact.
    fn corners<'a>(&'a self, contact: usize, poses: &'a [Pose; 2]) -> Corners<'a> {
        let level = LEVELS[contact % LEVELS.len()];
        Corners::new(level, self.pair(Self::pair_of(contact)), poses.each_ref())
    }

    /// Returns the indices of the unknowns of the three forces of a contact.
    fn unknowns_of(&self, contact: usize) -> [usize; FORCES] {
        std::array::from_fn(|k| self.forces[self.slots * contact + k])
    }

    /// Returns the values of the three forces of a contact.
    fn forces_of(&self, z: &[f64], contact: usize) -> [f64; FORCES] {
        self.unknowns_of(contact).map(|unknown| z[unknown])
    }

    /// Returns the poses of the left and the right scale of a contact.
    ///
    /// Both poses are in the frame of the left scale if poses are relative or the body is curved,
    /// otherwise in the frame of the row.
    fn pair_poses(&self, z: &[f64], contact: usize) -> [Pose; 2] {
        self.poses_of(z, Self::pair_of(contact), &mut None)
    }

    fn left_pose(&self, z: &[f64], scale: usize) -> Pose {
        if self.relative { Pose::new(0.0, 0.0, 0.0) } else { self.pose(z, scale) }
    }

    /// Iterates over all pairs from left to right, with the poses of their two scales.
    fn pairs<'a>(&'a self, z: &'a [f64]) -> impl Iterator<Item = (usize, [Pose; 2])> + 'a {
        let mut turned = None;
        self.whole_pairs().map(move |pair| (pair, self.poses_of(z, pair, &mut turned)))
    }

    /// Iterates over the indices of the pairs with both scales inside the row.
    fn whole_pairs(&self) -> impl Iterator<Item = usize> {
        (0..self.count_pairs()).filter(|&pair| self.is_whole(pair))
    }

    /// Counts the pairs, including pairs with their right scale beyond the end of the row.
    fn count_pairs(&self) -> usize {
        self.reach * (self.scales.len() - 1)
    }

    fn is_whole(&self, pair: usize) -> bool {
        self.reach == 1 || self.ends(pair)[1] < self.scales.len()
    }

    /// Returns the poses of the left and the right scale of a pair.
    ///
    /// `turned` caches the scale number and the pose of the right scale. The next pair has this
    /// scale on its left and need not compute the sine and cosine of its rotation again.
    fn poses_of(&self, z: &[f64], pair: usize, turned: &mut Option<(usize, Pose)>) -> [Pose; 2] {
        let [left, right] = self.ends(pair);
        let of_left = match turned {
            // With relative poses the cached pose is in another frame and cannot be used.
            Some((scale, pose)) if *scale == left && !self.relative => *pose,
            _ => self.left_pose(z, left),
        };
        let of_right = self.pose(z, right);
        *turned = Some((right, of_right));
        [of_left, self.in_outer_frame(of_right, || self.pair_and_frame(pair).1)]
    }
}
