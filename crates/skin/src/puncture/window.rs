//! The part of an endless row that is solved for.
//!
//! Contact reaches some scales of an endless row. One beyond the last of them the row is a linear chain, which has a closed form
//! ([`FarField`]): the scales of that part are not solved for. As contact spreads the row grows, at the point of the path where it
//! has to.

use geometry::{Corner, OutOfRange, Vec2};
use solver::{Change, Event};
use substrate::{FarField, RowStiffness, SubstrateLaw, SurfaceStrip};

use super::Rows;
use super::system::{Chain, Layout};
use crate::contacts::{Contacts, PAIR_FORCES, SkinPoint, SkinState};

/// Scales on each side of the punctured one with which the path of an endless row begins.
const FIRST_SCALES: usize = 4;

/// Scales by which a row grows at least, and as a part of its length.
const GROWTH: usize = 4;
const GROWTH_PART: usize = 8;

/// Scales beyond an end whose gaps are looked at. What moves the end hardly moves farther ones.
const LOOKED_AT: usize = 12;

/// Where nothing is known of the scales beyond an end, it must not move by more than this (over `t`; radians).
const STILL: f64 = 1e-6;

/// Force of bars beyond an end, above that of the springs that stand for them there, up to which the bars count as springs: over
/// the stiffness of a scale, so it is a displacement (over `t`).
const AS_SPRINGS: f64 = 1e-9;

/// Part to which displacements decay from the scales that a row of bars begins with, besides those of a row of springs, to its
/// ends.
const DECAYED: f64 = 1e-3;

/// Part of the distance to the next scale which, when closed, lets the row grow.
const EARLY: f64 = 0.5;

/// How near the deformation has come to an end of the row that is solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reach {
    /// No scales can touch at the end or beyond it.
    Short,
    /// Scales beyond the end may touch soon.
    Near,
    /// Scales beyond the end may touch here already.
    Beyond,
}

/// The row beyond the ends of the part that is solved for.
#[derive(Clone, Debug)]
pub(crate) struct Surroundings {
    /// How the scales beyond move; `None` if they are taken to be at rest.
    far: Option<FarField>,
    /// Widths of the gaps beyond the left and the right end, from the nearest on.
    gaps: [Vec<f64>; 2],
    /// Displacements of the left and of the right end, over `t`, that can close a gap beyond them.
    closing: [f64; 2],
    /// Distance of the farthest corner of a scale from its node.
    arm: f64,
}

impl Surroundings {
    /// The surroundings of a part of the `rows`.
    ///
    /// # Errors
    /// If a sample has no scales there.
    pub(super) fn new(
        rows: Rows,
        stiffness: &RowStiffness,
        layout: Layout,
    ) -> Result<Self, OutOfRange> {
        let Some(far) = stiffness.far_field() else {
            let gaps = [Vec::new(), Vec::new()];
            return Ok(Self { far: None, gaps, closing: [STILL; 2], arm: 1.0 });
        };
        let wider = Layout { left: layout.left + LOOKED_AT, right: layout.right + LOOKED_AT };
        let row = rows.row(wider)?;
        // The displacements of two neighbours are `1 + decay` times that of the nearer one at most, and `decay^k` times that of
        // the end.
        let decay = far.decay.iter().fold(0.0_f64, |max, decay| max.max(decay.abs()));
        let closing = |pair: &dyn Fn(usize) -> usize| {
            let pairs = (0..LOOKED_AT).map(|k| row.clearance(pair(k)) / decay.powi(k as i32));
            pairs.fold(f64::INFINITY, f64::min) / (1.0 + decay)
        };
        let last = wider.scales() - 1 - LOOKED_AT;
        let closing = [closing(&|k| LOOKED_AT - 1 - k), closing(&|k| last + k)];
        let scale = row.scale(LOOKED_AT);
        let arm = |corner| Vec2::norm(&scale.corner(corner));
        let arm = arm(Corner::TopLeft).max(arm(Corner::TopRight));
        let gaps = [
            (0..LOOKED_AT).map(|k| row.gap(LOOKED_AT - 1 - k)).collect(),
            (0..LOOKED_AT).map(|k| row.gap(last + k)).collect(),
        ];
        Ok(Self { far: Some(far), gaps, closing, arm })
    }

    /// How the scales beyond move; `None` if they are taken to be at rest.
    pub(super) fn far_field(&self) -> Option<&FarField> {
        self.far.as_ref()
    }

    /// With the forces of the far field times the given factors.
    pub(super) fn scaled(self, factors: [f64; 3]) -> Self {
        let scaled = |far: FarField| {
            let relief = std::array::from_fn(|k| factors[k] * far.relief[k]);
            FarField { relief, ..far }
        };
        Self { far: self.far.map(scaled), ..self }
    }

    /// How near a state of a `chain` has come to the left and to the right end.
    pub(super) fn reach(&self, chain: &Chain, state: &SkinState) -> [Reach; 2] {
        let last = chain.layout.scales() - 1;
        let [left, right] = Contacts::touching_at_ends(state);
        [(0, left, 0), (last, right, 1)].map(|(end, touches, side)| {
            let displacement = chain.displacement(&state.z, end);
            let [x, y, rotation] = displacement.map(f64::abs);
            let close = (x + y + self.arm * rotation) / self.closing[side];
            let excess = |far| chain.excess_beyond(displacement, far, &self.gaps[side]);
            let part = close.max(self.far.as_ref().map_or(0.0, excess) / AS_SPRINGS);
            match part {
                1.0.. => Reach::Beyond,
                EARLY.. => Reach::Near,
                _ if touches => Reach::Near,
                _ => Reach::Short,
            }
        })
    }

    /// Stretches of the gaps beyond the ends of a `chain`, and 1, that of a gap far away. Beyond those that are looked at all are
    /// closer to 1.
    pub(super) fn stretches(&self, chain: &Chain, z: &[f64]) -> Vec<f64> {
        let mut stretches = vec![1.0];
        let Some(far) = &self.far else { return stretches };
        for (side, end) in [0, chain.layout.scales() - 1].into_iter().enumerate() {
            let end = chain.displacement(z, end);
            let (mut decayed, mut near) = ([1.0; 3], end);
            for &width in &self.gaps[side] {
                decayed = std::array::from_fn(|k| decayed[k] * far.decay[k]);
                let farther = std::array::from_fn(|k| decayed[k] * end[k]);
                let (left, right) = if side == 0 { (farther, near) } else { (near, farther) };
                let strip = SurfaceStrip { width, half_base: chain.half_base };
                stretches.push(strip.stretch(left, right));
                near = farther;
            }
        }
        stretches
    }
}

impl Layout {
    /// The row with which a path begins.
    pub(super) fn first(stiffness: &RowStiffness, law: SubstrateLaw) -> Self {
        let side = match (stiffness.far_field(), law) {
            (Some(_), SubstrateLaw::Linear) => FIRST_SCALES,
            (Some(far), SubstrateLaw::NeoHookean) => FIRST_SCALES + decayed_beyond(&far),
            (None, _) => still_beyond(stiffness),
        };
        Self { left: side, right: side }
    }

    /// More scales on the sides that are reached, as far as a row of the `longest` length has room.
    pub(super) fn grown(self, reach: [Reach; 2], longest: usize) -> Self {
        let more = GROWTH + self.scales() / GROWTH_PART;
        let room = longest.saturating_sub(self.scales());
        let [left, right] = reach.map(|reach| if reach == Reach::Short { 0 } else { more });
        let right = right.min(room);
        Self { left: self.left + left.min(room - right), right: self.right + right }
    }
}

/// Scales over which displacements along a linear chain decay to a small part.
fn decayed_beyond(far: &FarField) -> usize {
    let x = far.decay[0].abs();
    let decayed = (1_u8..50).find(|&n| x.powi(i32::from(n)) <= DECAYED);
    decayed.map_or(50, usize::from)
}

/// Scales on each side of the punctured one beyond which no scale moves while none touch: a displacement decays along the chain by
/// the root below 1 of `β (r + 1/r) = α`, where `β` stands for all neighbours on a side.
fn still_beyond(stiffness: &RowStiffness) -> usize {
    let RowStiffness { direct, neighbours, .. } = stiffness;
    let side = |k: usize| neighbours.iter().map(|n| n.direct[k] / direct[k]).sum::<f64>();
    let slowest = (0..3).map(|k| 2.0 * side(k).abs()).fold(0.0, f64::max);
    let decay = (1.0 - (1.0 - slowest.min(1.0).powi(2)).sqrt()) / slowest;
    // A coupling so strong that the estimate fails starts from a long row.
    let side = (4_u8..100).find(|&n| decay.powi(i32::from(n)) <= 0.1 * STILL);
    side.map_or(100, usize::from)
}

impl Chain {
    /// A point of the path of a `shorter` row, which lies within this one, as a point of this one.
    pub(super) fn extended(&self, shorter: &Self, point: &SkinPoint) -> SkinPoint {
        let added = self.layout.left - shorter.layout.left;
        let constraint = |constraint: usize| constraint + PAIR_FORCES * added;
        let event = point.event.clone().map(|event| match event {
            Event::Changed(changes) => {
                let moved = changes.into_iter().map(|Change { constraint: number, activated }| {
                    Change { constraint: constraint(number), activated }
                });
                Event::Changed(moved.collect())
            }
            other => other,
        });
        let unknowns = |z: &[f64]| self.extended_unknowns(shorter, z);
        let mut state = SkinState::at_rest(self);
        state.z = unknowns(&point.state.z);
        copy_to(&mut state.active, constraint(0), &point.state.active);
        copy_to(&mut state.mode, Contacts::contacts_of(added).start, &point.state.mode);
        SkinPoint {
            state,
            arriving: unknowns(&point.arriving),
            leaving: unknowns(&point.leaving),
            event,
        }
    }

    /// Unknowns of a `shorter` row, or a direction, in the unknowns of this one.
    fn extended_unknowns(&self, shorter: &Self, z: &[f64]) -> Vec<f64> {
        let mut extended = vec![0.0; self.layout.size()];
        let added = self.layout.left - shorter.layout.left;
        for scale in 0..self.layout.scales() {
            let at = self.layout.scale(scale);
            let scale = scale.cast_signed() - added.cast_signed();
            extended[at..at + 3].copy_from_slice(&shorter.displacement_anywhere(z, scale));
        }
        for force in 0..PAIR_FORCES * (shorter.layout.scales() - 1) {
            let longer = self.layout.force(force + PAIR_FORCES * added);
            extended[longer] = z[shorter.layout.force(force)];
        }
        extended[self.layout.load()] = z[shorter.layout.load()];
        extended
    }
}

fn copy_to<T: Copy>(into: &mut [T], start: usize, values: &[T]) {
    into[start..start + values.len()].copy_from_slice(values);
}
