//! The contacts of a row of scales, assembled.

mod assembly;
mod audit;
mod change;
mod closed;
mod friction;
mod mode;
mod pair_unknowns;
mod stick_slip;
mod stiffness;

pub use change::ContactChange;
pub use closed::Contact;
pub(crate) use friction::product_integral;
use friction::{FrictionState, SLIP_DISTANCE};
pub(crate) use mode::SkinMode;

use contact::{
    ContactLaw, CornerContact, CornerEdge, Corners, Equation, FORCES, Force, Level, Pair, Pose,
};
use solver::Change;

use crate::arrangement::Arrangement;

/// The levels of a pair, each with a contact of its own.
const LEVELS: [Level; 2] = [Level::Upper, Level::Lower];

/// Constraints of the contacts between two scales under this law: their forces, and what they rub with.
pub(crate) fn pair_constraints(law: &ContactLaw) -> usize {
    LEVELS.len() * slots(law)
}

/// Constraints of a contact under this law.
fn slots(law: &ContactLaw) -> usize {
    if law.friction() > 0.0 { FORCES + 2 } else { FORCES }
}

/// Value of the condition of a force that cannot act next, or of one that does not exist: any number above zero, for it is neither violated nor solved
/// for.
pub(crate) const HOLDS: f64 = 1.0;

/// A state of a skin.
pub(crate) type SkinState = solver::State<SkinMode>;

/// An equilibrium of a skin on its path.
pub(crate) type SkinPoint = solver::Point<SkinMode>;

/// The contacts between the scales of a row, and where their unknowns stand.
///
/// Contact `2 k` is the upper, `2 k + 1` the lower one of pair `k`: of the scales `k`, `k + 1`, or, where scales that are not
/// neighbours may meet, of each scale with as many on its right as it reaches, one after the other. Their forces are the
/// constraints of the system: number `3 j` is the contact's own force `λ`, `3 j + 1` its partner's `λ'` and
/// `3 j + 2` that of its flush contact, `λ''`. Where scales rub each contact has two more, its grip and its way.
#[derive(Clone, Debug)]
pub(crate) struct Contacts {
    pub(crate) arrangement: Arrangement,
    /// The pairs of the arrangement, or one for each distance.
    pair_shapes: Vec<Pair>,
    /// Scales on its right that a scale may meet: 1, its neighbour, unless a row was seen to need more.
    pub(crate) reach: usize,
    law: ContactLaw,
    /// First of the three unknowns of each scale; `None` for a scale that is held.
    pub(crate) scales: Vec<Option<usize>>,
    /// Whether each scale is placed in the frame of its left neighbour, its rotation measured from the first scale.
    relative: bool,
    /// Constraints of each contact.
    slots: usize,
    /// Unknown of each constraint: these are the constraints of the system.
    pub(crate) forces: Vec<usize>,
    /// Numbers of the ways that contacts slip, which only grow.
    pub(crate) slip_distances: Vec<usize>,
    /// Contacts whose anchor differs from that of a row of which this is a neighbour, and by how much.
    anchor_shifts: Vec<(usize, f64)>,
}

impl Contacts {
    pub(crate) fn new(
        arrangement: Arrangement,
        law: ContactLaw,
        scales: Vec<Option<usize>>,
        forces: Vec<usize>,
        relative: bool,
    ) -> Self {
        let slots = slots(&law);
        let neighbours = pair_constraints(&law) * scales.len().saturating_sub(1);
        // A single scale has no pairs to divide by, and its reach does not matter.
        let reach = forces.len().checked_div(neighbours).unwrap_or(1);
        debug_assert_eq!(forces.len(), reach * neighbours);
        let pair_shapes = arrangement.pairs(reach);
        let slip_distances = (0..forces.len()).filter(|number| number % slots == SLIP_DISTANCE);
        let slip_distances = slip_distances.collect();
        Self {
            arrangement,
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

    /// The state of rest of all contacts.
    pub(crate) fn open(&self) -> SkinMode {
        let contacts = vec![CornerContact::Open; self.forces.len() / self.slots];
        let friction_states = if self.has_friction() {
            vec![FrictionState::None; contacts.len()]
        } else {
            Vec::new()
        };
        SkinMode { contacts, friction_states, ..SkinMode::default() }
    }

    /// The contact that a constraint belongs to, and its number there.
    pub(crate) fn contact_of(&self, constraint: usize) -> (usize, usize) {
        (constraint / self.slots, constraint % self.slots)
    }

    /// The constraints of the pair that a constraint belongs to, where scales rub: each of them may begin to slip with it.
    pub(crate) fn companions(&self, constraint: usize) -> std::ops::Range<usize> {
        if !self.has_friction() {
            return constraint..constraint + 1;
        }
        let pair = LEVELS.len() * self.slots;
        let first = constraint / pair * pair;
        first..first + pair
    }

    /// The left and the right scale of the pair that a constraint belongs to.
    pub(crate) fn scales_of(&self, constraint: usize) -> [usize; 2] {
        self.ends(Self::pair_of(constraint / self.slots))
    }

    /// Which corner meets which edge where a constraint acts; `None` if the contact is open.
    pub(crate) fn corner_edge(&self, mode: &SkinMode, constraint: usize) -> Option<CornerEdge> {
        let (contact, slot) = self.contact_of(constraint);
        let edge = mode.contacts[contact].edge()?;
        if slot == Force::Flush as usize { edge.flush() } else { Some(edge) }
    }

    /// Pose of a scale, in the frame in which it is placed.
    pub(crate) fn pose(&self, z: &[f64], scale: usize) -> Pose {
        // Positions are counted in the frame of the left neighbour, rotations from the first scale:
        // those of the frame are taken off.
        let frame = self.frame(scale).map_or(0.0, |rotation| z[rotation]);
        match self.scales[scale] {
            Some(at) => Pose::new(z[at], z[at + 1], z[at + 2] - frame),
            None => Pose::new(0.0, 0.0, 0.0),
        }
    }

    /// Poses of all scales, each in the frame in which it is placed.
    pub(crate) fn poses(&self, z: &[f64]) -> Vec<Pose> {
        (0..self.scales.len()).map(|scale| self.pose(z, scale)).collect()
    }

    /// Rotation of the frame in which a scale is placed; `None` if it does not turn.
    fn frame(&self, scale: usize) -> Option<usize> {
        let neighbour = scale.checked_sub(1).filter(|_| self.relative)?;
        Some(self.scales[neighbour]? + 2)
    }

    /// Number of closed contacts, two where a side lies flush.
    pub(crate) fn closed(state: &SkinState) -> usize {
        state.mode.contacts.iter().flat_map(|contact| contact.carrying()).flatten().count()
    }

    /// Number of scales that touch another one.
    pub(crate) fn engaged(&self, state: &SkinState) -> usize {
        let mut touch = vec![false; self.scales.len()];
        for scale in Self::touching(&state.mode).flat_map(|pair| self.ends(pair)) {
            touch[scale] = true;
        }
        touch.into_iter().filter(|&touches| touches).count()
    }

    /// The pairs that touch, from the left.
    fn touching(mode: &SkinMode) -> impl Iterator<Item = usize> {
        let pairs = mode.contacts.chunks_exact(LEVELS.len()).enumerate();
        let closed = |contacts: &[CornerContact]| {
            contacts.iter().any(|contact| *contact != CornerContact::Open)
        };
        pairs.filter(move |(_, contacts)| closed(contacts)).map(|(pair, _)| pair)
    }

    /// Whether the first and whether the last scale touch another one.
    pub(crate) fn touching_at_ends(&self, state: &SkinState) -> [bool; 2] {
        let last = self.scales.len() - 1;
        let ends = || Self::touching(&state.mode).map(|pair| self.ends(pair));
        [ends().any(|[left, _]| left == 0), ends().any(|[_, right]| right == last)]
    }

    /// Whether a side and a neighbour's end lie flush anywhere.
    pub(crate) fn flush(state: &SkinState) -> bool {
        state.mode.contacts.iter().any(|contact| matches!(contact, CornerContact::Flush(_)))
    }

    /// Replaces `values` by the conditions of all forces that do not act.
    pub(crate) fn conditions(&self, state: &SkinState, values: &mut Vec<f64>) {
        values.clear();
        values.resize(self.forces.len(), HOLDS);
        self.for_each(state, |contact, corners| {
            let values = &mut values[self.slots * contact..][..FORCES];
            match state.mode.contacts[contact] {
                CornerContact::Open => {
                    // Most contacts are open, and need the gap alone, without derivatives.
                    values[0] = corners.facing().map_or(HOLDS, |(_, gap)| gap);
                }
                closed => {
                    for (value, condition) in
                        values.iter_mut().zip(closed.resting_conditions(corners))
                    {
                        *value = condition.map_or(HOLDS, |condition| condition.value);
                    }
                }
            }
        });
        self.friction_conditions(state, &state.z, HOLDS, values);
    }

    /// Replaces `values` as [`Self::conditions`] does, and `slopes` by their derivatives along a direction.
    pub(crate) fn condition_slopes(
        &self,
        state: &SkinState,
        direction: &[f64],
        values: &mut Vec<f64>,
        slopes: &mut Vec<f64>,
    ) {
        values.clear();
        values.resize(self.forces.len(), HOLDS);
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
        self.friction_conditions(state, &state.z, HOLDS, values);
        self.friction_conditions(state, direction, 0.0, slopes);
    }

    /// The condition of a force that does not act.
    pub(crate) fn condition(&self, state: &SkinState, constraint: usize) -> f64 {
        let (contact, slot) = self.contact_of(constraint);
        if slot >= FORCES {
            let value = self.slot_condition(state, &state.z, contact, slot);
            return value.unwrap_or(HOLDS);
        }
        // A pair that would reach beyond the end of the row has unknowns and never touches.
        if !self.is_whole(Self::pair_of(contact)) {
            return HOLDS;
        }
        let poses = self.pair_poses(&state.z, contact);
        let conditions =
            state.mode.contacts[contact].resting_conditions(&self.corners(contact, &poses));
        conditions[slot].map_or(HOLDS, |condition| condition.value)
    }

    /// Derivative of the condition of a force along a direction; zero if there is no such condition.
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

    /// Derivative of a condition along a direction.
    fn along(&self, contact: usize, condition: &Equation, direction: &[f64]) -> f64 {
        let by_parts = self.pair_unknowns(contact).sum(&condition.by_coordinate, direction);
        let unknowns = self.unknowns_of(contact).into_iter().zip(condition.by_force);
        by_parts + unknowns.map(|(unknown, slope)| slope * direction[unknown]).sum::<f64>()
    }

    /// Takes the contact of a force that has changed sides to its next state. Returns the force whose condition has to
    /// hold as the path goes on, or `None` if the contact has no such transition.
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
        // Only friction asks what was before, and without it the copy is saved.
        let before = self.has_friction().then(|| state.clone());
        state.mode.contacts[contact] = next.contact;
        for (unknown, force) in self.unknowns_of(contact).into_iter().zip(next.forces) {
            state.z[unknown] = force;
        }
        state.active[first..first + FORCES].copy_from_slice(&next.contact.acting());
        // Normal forces come first, because the friction of the new state is a part of them.
        if let Some(before) = before {
            self.carry_friction(state, &before, contact, force == Force::Partner);
        }
        Some(first + next.valid as usize)
    }

    /// Shows each contact and its corners, from the left.
    fn for_each(&self, state: &SkinState, mut show: impl FnMut(usize, &Corners)) {
        for (pair, poses) in self.pairs(&state.z) {
            for contact in Self::contacts_of(pair) {
                show(contact, &self.corners(contact, &poses));
            }
        }
    }

    /// The contacts of a pair.
    fn contacts_of(pair: usize) -> std::ops::Range<usize> {
        LEVELS.len() * pair..LEVELS.len() * (pair + 1)
    }

    /// Number of the contacts whose left scale is one of the first so many.
    pub(crate) fn contacts_before(&self, left: usize) -> usize {
        LEVELS.len() * self.reach * left
    }

    /// The pair that a contact belongs to.
    fn pair_of(contact: usize) -> usize {
        contact / LEVELS.len()
    }

    /// The left and the right scale of a pair.
    fn ends(&self, pair: usize) -> [usize; 2] {
        if self.reach == 1 {
            // Asked for all the time, and of nearly every row.
            return [pair, pair + 1];
        }
        let left = pair / self.reach;
        [left, left + 1 + pair % self.reach]
    }

    fn pair(&self, pair: usize) -> &Pair {
        match self.pair_shapes.as_slice() {
            // An uneven row of two scales has as many shapes as an even one: both ways of counting
            // give the same shape there.
            [pair] => pair,
            shapes if shapes.len() == self.reach => &shapes[pair % self.reach],
            shapes => &shapes[pair],
        }
    }

    /// The two corners of a contact.
    fn corners<'a>(&'a self, contact: usize, poses: &'a [Pose; 2]) -> Corners<'a> {
        let level = LEVELS[contact % LEVELS.len()];
        Corners::new(level, self.pair(Self::pair_of(contact)), poses.each_ref())
    }

    /// Unknowns of the forces of a contact.
    fn unknowns_of(&self, contact: usize) -> [usize; FORCES] {
        std::array::from_fn(|k| self.forces[self.slots * contact + k])
    }

    /// Values of the forces of a contact.
    fn forces_of(&self, z: &[f64], contact: usize) -> [f64; FORCES] {
        self.unknowns_of(contact).map(|unknown| z[unknown])
    }

    /// Poses of the pair of a contact, in the frame in which the left scale is placed or, in a row of relative
    /// poses, in the frame of the left scale.
    fn pair_poses(&self, z: &[f64], contact: usize) -> [Pose; 2] {
        let [left, right] = self.ends(Self::pair_of(contact));
        [self.left_pose(z, left), self.pose(z, right)]
    }

    fn left_pose(&self, z: &[f64], scale: usize) -> Pose {
        if self.relative { Pose::new(0.0, 0.0, 0.0) } else { self.pose(z, scale) }
    }

    /// Poses of the scales of every pair, in order.
    fn pairs<'a>(&'a self, z: &'a [f64]) -> impl Iterator<Item = (usize, [Pose; 2])> + 'a {
        let mut turned = None;
        self.whole_pairs().map(move |pair| (pair, self.poses_of(z, pair, &mut turned)))
    }

    /// The pairs of which both scales are there: of the last scales some would reach beyond the end.
    fn whole_pairs(&self) -> impl Iterator<Item = usize> {
        (0..self.reach * (self.scales.len() - 1)).filter(|&pair| self.is_whole(pair))
    }

    fn is_whole(&self, pair: usize) -> bool {
        self.reach == 1 || self.ends(pair)[1] < self.scales.len()
    }

    /// Poses of a pair. The right one is kept in `turned`: a scale that is the left one of the next pair is turned once.
    fn poses_of(&self, z: &[f64], pair: usize, turned: &mut Option<(usize, Pose)>) -> [Pose; 2] {
        let [left, right] = self.ends(pair);
        let of_left = match turned {
            // In relative poses a right scale stands in another frame, and is not reused.
            Some((scale, pose)) if *scale == left && !self.relative => *pose,
            _ => self.left_pose(z, left),
        };
        let of_right = self.pose(z, right);
        *turned = Some((right, of_right));
        [of_left, of_right]
    }
}
