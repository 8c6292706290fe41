//! The contacts of a row of scales, assembled.

mod contacts;

pub use contacts::Contact;

use contact::{
    COUPLED, ContactLaw, FORCES, Joint, JointResponse, Kind, Level, Overlap, Pair, Pose,
};
use geometry::Vec2;
use solver::{BandMatrix, Residual, State};

use crate::arrangement::Arrangement;

/// Levels at which neighbours meet: an upper and a lower one.
pub(crate) const JOINTS: usize = 2;

/// Contact forces between neighbours.
pub(crate) const PAIR_FORCES: usize = JOINTS * FORCES;

/// Overlap (over `t`) by which the audit may differ from the contact law: round-off of the
/// collision query.
const AUDIT_TOLERANCE: f64 = 1e-8;

/// Part of an edge by which a foot may lie beyond its end: round-off of the path.
const OFF_EDGE: f64 = 1e-6;

/// What a contact does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// It closes.
    Closed,
    /// It opens.
    Opened,
    /// The corner reaches the end of its edge and stays at the other corner.
    ReachedCorner,
    /// It leaves the corner on the edge on which it came.
    LeftCorner,
    /// It passes the corner as the partner's kind, the corners having changed their parts; or the contact beside it, on
    /// flush edges, carries alone.
    HandedOver,
}

impl Change {
    /// Short name, as in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Closed => "closed",
            Self::Opened => "opened",
            Self::ReachedCorner => "reached corner",
            Self::LeftCorner => "left corner",
            Self::HandedOver => "handed over",
        }
    }

    /// What a contact has done where one of its forces has changed sides, from the state after.
    pub(crate) fn of(state: &State, change: solver::Change) -> Self {
        let active = state.active[change.constraint];
        match (Role::of(change.constraint), change.activated) {
            (Role::Own | Role::Beside, true) => Self::Closed,
            (Role::Own, false) if active => Self::HandedOver,
            (Role::Own | Role::Beside, false) => Self::Opened,
            (Role::Partner, true) if active => Self::ReachedCorner,
            (Role::Partner, true) => Self::HandedOver,
            (Role::Partner, false) => Self::LeftCorner,
        }
    }
}

/// Which of the forces of its joint a constraint is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// That of the joint's kind.
    Own,
    /// That of its partner's kind.
    Partner,
    /// That of the contact beside it.
    Beside,
}

impl Role {
    fn of(constraint: usize) -> Self {
        match constraint % FORCES {
            0 => Self::Own,
            1 => Self::Partner,
            _ => Self::Beside,
        }
    }
}

/// The contacts between the neighbours of a row, and where their unknowns stand.
///
/// Joint `2 i` is the upper, `2 i + 1` the lower one of the scales `i`, `i + 1`. Their forces are the
/// constraints of the system: number `3 j` is the force of joint `j`, `3 j + 1` its partner's and
/// `3 j + 2` that of the contact beside it.
#[derive(Clone, Debug)]
pub(crate) struct Joints {
    arrangement: Arrangement,
    /// Of the arrangement: each pair, or one for all.
    pair_shapes: Vec<Pair>,
    law: ContactLaw,
    all: Vec<Joint>,
    /// First of the three unknowns of each scale; `None` for a scale that is held.
    scales: Vec<Option<usize>>,
    /// Whether each scale is placed in the frame of its left neighbour.
    relative: bool,
    /// Unknown of each force.
    forces: Vec<usize>,
}

impl Joints {
    pub(crate) fn new(
        arrangement: Arrangement,
        law: ContactLaw,
        scales: Vec<Option<usize>>,
        forces: Vec<usize>,
    ) -> Self {
        let pairs = scales.len().saturating_sub(1);
        debug_assert_eq!(forces.len(), PAIR_FORCES * pairs);
        Self {
            pair_shapes: arrangement.pairs(),
            arrangement,
            law,
            all: [Joint::new(Level::Upper), Joint::new(Level::Lower)].repeat(pairs),
            scales,
            relative: false,
            forces,
        }
    }

    /// The contacts of a row whose scales are each placed in the frame of their left neighbour.
    /// Rotations are measured from the first scale.
    pub(crate) fn relative(
        arrangement: Arrangement,
        law: ContactLaw,
        scales: Vec<Option<usize>>,
        forces: Vec<usize>,
    ) -> Self {
        Self { relative: true, ..Self::new(arrangement, law, scales, forces) }
    }

    /// Unknowns of the forces, which are the constraints of the system.
    pub(crate) fn forces(&self) -> &[usize] {
        &self.forces
    }

    /// The pair whose left scale is `left`.
    fn pair(&self, left: usize) -> &Pair {
        match self.pair_shapes.as_slice() {
            [pair] => pair,
            pairs => &pairs[left],
        }
    }

    /// The left scale of the pair that a constraint belongs to.
    pub(crate) fn left_of(constraint: usize) -> usize {
        constraint / PAIR_FORCES
    }

    /// Which corner meets which edge where a constraint acts; `None` before its joint has closed.
    pub(crate) fn kind(&self, constraint: usize) -> Option<Kind> {
        let joint = self.all[constraint / FORCES];
        match Role::of(constraint) {
            Role::Own | Role::Partner => joint.kind(),
            Role::Beside => joint.beside(),
        }
    }

    /// Pose of a scale, in the frame in which it is placed.
    pub(crate) fn pose(&self, z: &[f64], scale: usize) -> Pose {
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

    /// Number of closed contacts.
    pub(crate) fn closed(state: &State) -> usize {
        let counts = (0..state.active.len()).filter(|&c| Role::of(c) != Role::Partner);
        counts.filter(|&c| state.active[c]).count()
    }

    /// Whether the scales of each pair touch, along the row.
    pub(crate) fn touching(state: &State) -> impl Iterator<Item = bool> + '_ {
        state.active.chunks(PAIR_FORCES).map(|forces| forces.contains(&true))
    }

    /// Forces of a joint on the left scale of its pair: of its corners, and of the contact beside.
    fn forces_on_left(&self, z: &[f64], joint: usize) -> [Vec2; 2] {
        let [left, right] = self.pair_poses(z, joint);
        let pair = self.pair(joint / JOINTS);
        self.all[joint].forces(pair, [&left, &right], self.joint_forces(z, joint))
    }

    /// All the force of a joint, along which the law holds.
    fn force(&self, z: &[f64], joint: usize) -> f64 {
        self.forces_on_left(z, joint).map(|force| force.norm()).iter().sum()
    }

    /// Elastic energy of all contacts.
    pub(crate) fn energy(&self, z: &[f64]) -> f64 {
        let energy = |joint| self.law.energy(self.force(z, joint));
        (0..self.all.len()).map(energy).sum()
    }

    /// Whether a side and a neighbour's end lie flush anywhere.
    pub(crate) fn flush(state: &State) -> bool {
        (0..state.active.len()).any(|c| Role::of(c) == Role::Beside && state.active[c])
    }

    /// Whether any contact carries beyond an end of its edge: at the end where the corners meet it would not be on its
    /// edge any more, and at the other one the model has no contact to go on with.
    pub(crate) fn off_edge(&self, state: &State) -> bool {
        let joints = 0..self.all.len();
        joints.filter(|&joint| !Self::active(&state.active, joint)[1]).any(|joint| {
            let [left, right] = self.pair_poses(&state.z, joint);
            let contacts = [FORCES * joint, FORCES * joint + 2];
            contacts.into_iter().filter(|&c| state.active[c]).any(|c| {
                let pair = self.pair(joint / JOINTS);
                let foot = self.kind(c).map_or(0.0, |kind| pair.gap(kind, &left, &right).foot);
                !(-OFF_EDGE..=1.0 + OFF_EDGE).contains(&foot)
            })
        })
    }

    /// Whether any two scales overlap by more than the approach of their contacts.
    pub(crate) fn interpenetrate(&self, z: &[f64]) -> bool {
        let standing = |i| (self.arrangement.scale(i), self.arrangement.place(i));
        contact::overlaps_of(standing, &self.poses(z)).iter().any(|overlap| {
            let neighbours = overlap.right == overlap.left + 1;
            let allowed = if neighbours { self.approach(z, overlap.left) } else { 0.0 };
            overlap.depth > allowed + AUDIT_TOLERANCE
        })
    }

    /// Whether any two neighbours do. A strip that is bent to a ring may meet its own other end.
    pub(crate) fn neighbours_interpenetrate(&self, z: &[f64]) -> bool {
        self.pairs(z).any(|(left, poses)| {
            let allowed = self.approach(z, left) + AUDIT_TOLERANCE;
            self.overlaps(left, &poses).iter().any(|overlap| overlap.depth > allowed)
        })
    }

    /// Overlap of the pair whose left scale is `left`.
    fn overlaps(&self, left: usize, poses: &[Pose; 2]) -> Vec<Overlap> {
        let pair = self.pair(left);
        let standing = |i: usize| (pair.scales()[i], i as f64 * pair.pitch());
        contact::overlaps_of(standing, poses)
    }

    /// The largest approach of the contacts of a pair.
    fn approach(&self, z: &[f64], left: usize) -> f64 {
        let joints = JOINTS * left..JOINTS * (left + 1);
        joints.map(|joint| self.law.approach(self.force(z, joint)).value).fold(0.0, f64::max)
    }

    pub(crate) fn add_residual(&self, z: &[f64], active: &[bool], residual: &mut Residual) {
        for (left, poses) in self.pairs(z) {
            for joint in JOINTS * left..JOINTS * (left + 1) {
                if !Self::active(active, joint).contains(&true) {
                    let open = self.all[joint].open(self.pair(left), poses.each_ref());
                    for (force, gap) in open.into_iter().enumerate() {
                        residual.add(self.forces[FORCES * joint + force], gap);
                    }
                    continue;
                }
                let rows = self.response(joint, &poses, z, active).residual;
                for Entry { unknown, coordinate, sign } in self.entries(joint).into_iter().flatten()
                {
                    residual.add(unknown, sign * rows[coordinate]);
                }
            }
        }
    }

    pub(crate) fn add_tangent(&self, z: &[f64], active: &[bool], matrix: &mut BandMatrix) {
        for (left, poses) in self.pairs(z) {
            for joint in JOINTS * left..JOINTS * (left + 1) {
                if !Self::active(active, joint).contains(&true) {
                    continue;
                }
                let tangent = self.response(joint, &poses, z, active).tangent;
                let entries = self.entries(joint);
                for row in entries.iter().flatten() {
                    for column in entries.iter().flatten() {
                        let value = tangent[row.coordinate][column.coordinate];
                        matrix.add(row.unknown, column.unknown, row.sign * column.sign * value);
                    }
                }
            }
        }
    }

    /// Derivative of the condition of a force along a direction, its partner at rest.
    pub(crate) fn slope(&self, state: &State, force: usize, direction: &[f64]) -> f64 {
        let joint = force / FORCES;
        let [left, right] = self.pair_poses(&state.z, joint);
        let poses = [&left, &right];
        let pair = self.pair(joint / JOINTS);
        let active = Self::active(&state.active, joint);
        // An open contact is looked at as if it were closed, without a force.
        let (looked_at, acting) = match Role::of(force) {
            Role::Beside => (self.all[joint], active),
            _ if active[0] => (self.all[joint], [true, false, active[2]]),
            _ => (self.all[joint].facing(pair, poses), [true, false, false]),
        };
        let forces = self.joint_forces(&state.z, joint);
        let response = looked_at.response(pair, &self.law, poses, forces, acting);
        let row = response.tangent[6 + force % FORCES];
        let entries = self.entries(joint).into_iter().flatten();
        entries.map(|entry| entry.sign * row[entry.coordinate] * direction[entry.unknown]).sum()
    }

    /// Where a force has just changed sides: fixes the kind of a joint that closes or leaves a corner, and passes the
    /// contact on to the partner's kind, or to the one beside it, where its own force has vanished.
    /// Returns the force whose condition has to stay valid.
    pub(crate) fn exchange(&mut self, state: &mut State, force: usize) -> usize {
        let at = force / FORCES;
        let [own, partner, beside] = [0, 1, 2].map(|k| FORCES * at + k);
        let [left, right] = self.pair_poses(&state.z, at);
        let (pair, poses) = (*self.pair(at / JOINTS), [&left, &right]);
        let [z_own, z_partner, z_beside] = [own, partner, beside].map(|force| self.forces[force]);
        let joint = &mut self.all[at];
        let takes_over = match Role::of(force) {
            Role::Own if state.active[own] => {
                *joint = joint.facing(&pair, poses);
                return own;
            }
            Role::Own if state.active[partner] => {
                joint.hand_over(&pair, poses);
                state.z.swap(z_own, z_partner);
                partner
            }
            Role::Own if state.active[beside] => {
                joint.pass_beside();
                state.z.swap(z_own, z_beside);
                beside
            }
            Role::Partner if state.active[partner] => {
                // Together, the corners are where both contacts of flush edges were.
                state.z[z_own] += std::mem::take(&mut state.z[z_beside]);
                state.active[beside] = false;
                if !Joint::is_flush(&pair, poses) {
                    return partner;
                }
                joint.hand_over(&pair, poses);
                partner
            }
            Role::Partner => {
                joint.leave_corner(&pair, poses);
                return partner;
            }
            _ => return force,
        };
        state.active[own] = true;
        state.active[takes_over] = false;
        takes_over
    }

    fn response(
        &self,
        joint: usize,
        [left, right]: &[Pose; 2],
        z: &[f64],
        active: &[bool],
    ) -> JointResponse {
        let forces = self.joint_forces(z, joint);
        let pair = self.pair(joint / JOINTS);
        let active = Self::active(active, joint);
        self.all[joint].response(pair, &self.law, [left, right], forces, active)
    }

    /// Which forces of a joint act.
    fn active(active: &[bool], joint: usize) -> [bool; FORCES] {
        std::array::from_fn(|k| active[FORCES * joint + k])
    }

    /// The forces of a joint.
    fn joint_forces(&self, z: &[f64], joint: usize) -> [f64; FORCES] {
        std::array::from_fn(|k| z[self.forces[FORCES * joint + k]])
    }

    /// Poses of a pair, in the frame in which the left scale is placed or, in a row of relative
    /// poses, in the frame of the left scale.
    fn pair_poses(&self, z: &[f64], joint: usize) -> [Pose; 2] {
        let left = joint / JOINTS;
        [self.left_pose(z, left), self.pose(z, left + 1)]
    }

    fn left_pose(&self, z: &[f64], scale: usize) -> Pose {
        if self.relative { Pose::new(0.0, 0.0, 0.0) } else { self.pose(z, scale) }
    }

    /// Poses of the scales `i`, `i + 1` for every pair, in order.
    fn pairs<'a>(&'a self, z: &'a [f64]) -> impl Iterator<Item = (usize, [Pose; 2])> + 'a {
        let mut left = self.left_pose(z, 0);
        (1..self.scales.len()).map(move |i| {
            let right = self.pose(z, i);
            let next = if self.relative { left } else { right };
            (i - 1, [std::mem::replace(&mut left, next), right])
        })
    }

    /// What the coordinates of a pair, and the forces of a joint, are made of.
    fn entries(&self, joint: usize) -> [Option<Entry>; COUPLED + 1] {
        let pair = joint / JOINTS;
        let left = self.scales[pair].filter(|_| !self.relative);
        let right = self.scales[pair + 1];
        std::array::from_fn(|k| match k {
            0..3 => Some(Entry::new(left? + k, k)),
            3..6 => Some(Entry::new(right? + k - 3, k)),
            6..COUPLED => Some(Entry::new(self.forces[FORCES * joint + k - 6], k)),
            _ => Some(Entry::new(self.frame(pair + 1)?, 5).opposite()),
        })
    }
}

/// An unknown of a system as a part of a coordinate: the coordinate is the sum of such parts.
#[derive(Clone, Copy)]
pub(crate) struct Entry {
    pub(crate) unknown: usize,
    pub(crate) coordinate: usize,
    /// 1 or −1.
    pub(crate) sign: f64,
}

impl Entry {
    pub(crate) fn new(unknown: usize, coordinate: usize) -> Self {
        Self { unknown, coordinate, sign: 1.0 }
    }

    /// The same, taken away instead of added.
    pub(crate) fn opposite(self) -> Self {
        Self { sign: -self.sign, ..self }
    }
}
