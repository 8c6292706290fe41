//! The equations of a guided needle, and the conditions under which they hold.

use solver::{Residual, Tangent};

use super::mode::{Place, Rub, Touch};
use super::outline::{COORDINATES, Meeting};
use super::{BACKWARD, CONSTRAINTS, FORWARD, GuidedNeedle, HIGH, LOW, PUSH};
use crate::contacts::{Contacts, HOLDS, SkinPoint, SkinState, product_integral};
use crate::puncture::system::Chain;

/// A foot may lie beyond the end of a face by this much, over `t`: corners that lie on it do so to round-off and their approach.
const BESIDE: f64 = 1e-9;

/// The shortest steps of a path come as near as this, over `t`, to an end that they cannot pass.
const AT_AN_END: f64 = 1e-6;

/// Difference of the unknowns over which slopes of conditions are differences, relative to the largest rate.
pub(super) const STEP: f64 = 1e-6;

impl Chain {
    /// Adds the equations of a guided needle: its balance (L1), the gaps that are closed, and the laws of its tangential forces (L2).
    pub(in crate::puncture) fn add_needle(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        let load = self.layout.load();
        // The row of the depth is the balance of the needle itself.
        residual.add(needle.depth, state.z[load]);
        matrix.add(needle.depth, load, 1.0);
        if needle.of_touch < needle.unknowns {
            // A touch that is not there has no tangential force.
            let touches = &state.mode.needle.touches;
            for slot in (0..needle.slots).filter(|&slot| touches[slot].is_none()) {
                let drag = needle.push(slot) + 1;
                residual.add(drag, state.z[drag]);
                matrix.add(drag, drag, 1.0);
            }
        }
        for (slot, touch, scale, meeting) in self.touches(state) {
            let at = self.layout.scale(scale);
            let rows = [at, at + 1, at + 2, needle.depth];
            let push = needle.push(slot);
            add_balance(&meeting, rows, push, &state.z, residual, matrix);
            residual.add(push, meeting.gap());
            add_row(push, rows, 1.0, meeting.tip.gap_slopes(), matrix);
            // A round tip that does not rub has no tangential force, and no law for it.
            if needle.of_touch == needle.unknowns {
                continue;
            }
            add_law(needle, (touch, push), &meeting, rows, &state.z, residual, matrix);
            for (constraint, sign) in [(FORWARD, 1.0), (BACKWARD, -1.0)] {
                // How far the tip has slid: it only counts, and tells the path where it turns back.
                let (Rub::Slip { from, .. }, true) =
                    (touch.rub, state.active[needle.number(slot, constraint)])
                else {
                    continue;
                };
                let slid = push + 1 + constraint;
                residual.add(slid, state.z[slid]);
                residual.add(slid, sign * (from - meeting.way()));
                matrix.add(slid, slid, 1.0);
                add_row(slid, rows, -sign, meeting.way_slopes(), matrix);
            }
        }
    }

    /// Appends the conditions of the constraints of a guided needle.
    pub(in crate::puncture) fn needle_conditions(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        values: &mut Vec<f64>,
    ) {
        let first = values.len();
        values.resize(first + needle.endings().end, HOLDS);
        let values = &mut values[first..];
        let tilt = needle.tilt_number();
        for (_, touch, number, meeting) in self.touches(state) {
            let [_, _, rotation] = self.displacement(&state.z, number);
            values[tilt] = values[tilt].min(needle.critical_tilt - rotation.abs());
            // The foot is where the left face begins and where the right one ends.
            let to_foot = match touch.place {
                Place::Left => meeting.tip.way,
                Place::Right => meeting.tip.length - meeting.tip.way,
                _ => HOLDS,
            };
            values[tilt + 1] = values[tilt + 1].min(to_foot);
        }
        if needle.is_round() {
            return self.round_conditions(needle, state, values);
        }
        for (number, touch) in state.mode.needle.touches.iter().enumerate() {
            let other = state.mode.needle.touches[1 - number].filter(|_| touch.is_none());
            if let Some(other) = other {
                values[CONSTRAINTS * number + PUSH] = self.gap_of_next(state, &other);
            }
        }
        for (number, touch, _, meeting) in self.touches(state) {
            let of_touch = &mut values[CONSTRAINTS * number..][..CONSTRAINTS];
            self.touch_conditions(needle, state, (number, touch), &meeting, of_touch);
        }
    }

    /// The conditions of the constraints of a touch but for that of its normal force.
    fn touch_conditions(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        (number, touch): (usize, &Touch),
        meeting: &Meeting,
        values: &mut [f64],
    ) {
        let (tip, forces) = (&meeting.tip, needle.forces(&state.z, number));
        let friction = needle.friction;
        values[PUSH] = tip.gap;
        needle.rub_conditions(state, number, touch, meeting, values);
        match touch.rub {
            Rub::Slip { .. } => {
                // The outer end of a side face is its foot, and to come there is to come through.
                if touch.place != Place::Left {
                    values[LOW] = tip.way;
                }
                let is_stopped = touch.place == Place::Top && self.is_notched(state, touch.scale);
                if touch.place != Place::Right && !is_stopped {
                    values[HIGH] = tip.length - tip.way;
                }
            }
            Rub::Passing { forward } => {
                let force = tip.force(forces);
                let seen = |onward: bool| {
                    let beside = self.tip(&state.z, touch.scale, touch.place.next(onward)?)?;
                    Some(beside.parts(force))
                };
                let [before, after] = [false, true].map(|onward| seen(onward).unwrap_or(forces));
                // The force turns from that of a tip which slides onto the corner to that of one which slides away from it.
                [values[LOW], values[HIGH]] = if forward {
                    [friction * before[0] - before[1], after[1] - friction * after[0]]
                } else {
                    [-friction * before[0] - before[1], after[1] + friction * after[0]]
                };
            }
            Rub::Stick { .. } | Rub::Held { .. } => {}
        }
    }

    /// The gap to the face that the needle would come to next, while its foot lies within it.
    ///
    /// A tip that sticks on a corner meets that face together with the corner, and without pressing on it: corner and face bear their
    /// force alone, until the tip slides.
    fn gap_of_next(&self, state: &SkinState, touch: &Touch) -> f64 {
        let here = self.tip(&state.z, touch.scale, touch.place);
        if let (Rub::Stick { .. }, Place::Top, Some(here)) = (touch.rub, touch.place, here)
            && here.way > here.length - BESIDE
        {
            // Whether the contact of the corner is closed already does not matter: which of the two comes first would be round-off.
            return HOLDS;
        }
        let next = Self::next_touch(touch);
        let tip = next.and_then(|(scale, place)| self.tip(&state.z, scale, place));
        let faced = tip.filter(|tip| (-BESIDE..=tip.length + BESIDE).contains(&tip.way));
        faced.map_or(HOLDS, |tip| tip.gap)
    }

    /// Whether the tip is already below the face that it would come to next, whose end is about to come over it: there a corner meets the
    /// shaft, of which the model knows nothing.
    pub(in crate::puncture) fn is_met_from_the_side(&self, state: &SkinState) -> bool {
        if state.mode.needle.is_round() {
            return false;
        }
        // A tip that has gone on to the next scale is the second of the two touches.
        let mut touches = state.mode.needle.touches.iter().flatten();
        let (Some(touch), None) = (touches.next(), touches.next()) else { return false };
        let next = Self::next_touch(touch);
        let tip = next.and_then(|(scale, place)| self.tip(&state.z, scale, place));
        tip.is_some_and(|tip| {
            let way = tip.way.min(tip.length - tip.way);
            tip.gap < -BESIDE && way.abs() < AT_AN_END
        })
    }

    /// Appends the derivatives of the conditions of a guided needle along a direction.
    pub(in crate::puncture) fn needle_slopes(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        direction: &[f64],
        slopes: &mut Vec<f64>,
    ) {
        let largest = direction.iter().fold(f64::MIN_POSITIVE, |max, x| max.max(x.abs()));
        let step = STEP / largest;
        let at = |step: f64| {
            let mut values = Vec::new();
            self.needle_conditions(needle, &state.moved(step, direction), &mut values);
            values
        };
        let (before, after) = (at(-step), at(step));
        slopes.extend(before.iter().zip(after).map(|(a, b)| (b - a) / (2.0 * step)));
    }

    /// Whether the needle slides with friction, or is held in a notch with a force that does not turn with the row, or scales rub: their
    /// forces have no energy then.
    pub(in crate::puncture) fn rubs(&self, state: &SkinState) -> bool {
        if Contacts::rubs(state) {
            return true;
        }
        let Some(needle) = &self.needle else { return false };
        state.mode.needle.all().any(|(_, touch)| match touch.rub {
            Rub::Slip { sign, .. } => sign * needle.friction != 0.0,
            Rub::Held { ratio } => ratio != 0.0,
            Rub::Stick { .. } | Rub::Passing { .. } => false,
        })
    }

    /// The unknowns of a guided needle in its stiffness: its depth, and the forces that keep it on faces and in places.
    pub(in crate::puncture) fn needle_in_stiffness(&self, state: &SkinState) -> Vec<usize> {
        let Some(needle) = &self.needle else { return Vec::new() };
        let mut unknowns = vec![needle.depth];
        for (slot, touch, ..) in self.touches(state) {
            unknowns.push(needle.push(slot));
            if touch.is_at_a_place() {
                unknowns.push(needle.push(slot) + 1);
            }
        }
        unknowns
    }

    /// Shows every entry of the symmetric stiffness of a needle that does not rub: second derivatives of `−N g + T ξ`, with `N` and, where
    /// the tip sticks, `T` as unknowns.
    pub(in crate::puncture) fn for_needle_stiffness(
        &self,
        state: &SkinState,
        mut entry: impl FnMut(usize, usize, f64),
    ) {
        let Some(needle) = &self.needle else { return };
        for (slot, touch, scale, meeting) in self.touches(state) {
            let at = self.layout.scale(scale);
            let unknowns = [at, at + 1, at + 2, needle.depth];
            let push = needle.push(slot);
            let curvature = meeting.curvature(needle.forces(&state.z, slot));
            for (row, curvature) in unknowns.into_iter().zip(curvature) {
                for (column, value) in unknowns.into_iter().zip(curvature) {
                    entry(row, column, value);
                }
            }
            let gap = (push, meeting.tip.gap_slopes().map(|slope| -slope));
            let way = touch.is_at_a_place().then(|| (push + 1, meeting.way_slopes()));
            for (force, slopes) in std::iter::once(gap).chain(way) {
                for (unknown, slope) in unknowns.into_iter().zip(slopes) {
                    entry(unknown, force, slope);
                    entry(force, unknown, slope);
                }
            }
        }
    }

    /// Force of the needle on the scales along the row, to the right.
    pub(in crate::puncture) fn lateral_force(&self, state: &SkinState) -> f64 {
        let Some(needle) = &self.needle else { return 0.0 };
        let touches = self.touches(state);
        touches.map(|(slot, _, _, at)| at.tip.force(needle.forces(&state.z, slot)).x).sum()
    }

    /// What friction takes at the tip between two neighbouring points, `∫ μ_n N |dξ|`.
    pub(in crate::puncture) fn taken_at_tip(
        &self,
        from: &SkinPoint,
        to: &SkinPoint,
        spans: [f64; 2],
    ) -> f64 {
        let Some(needle) = &self.needle else { return 0.0 };
        let of_touch = |(slot, touch, ..): (usize, &Touch, usize, Meeting)| {
            let Rub::Slip { sign, from: start } = touch.rub else { return 0.0 };
            let Some(end) = self.meeting(&to.state.z, touch.scale, touch.place) else { return 0.0 };
            if sign == 0.0 {
                return 0.0;
            }
            let slid = needle.push(slot) + 1 + if sign > 0.0 { FORWARD } else { BACKWARD };
            let push = needle.push(slot);
            let along = |of: usize| [spans[0] * from.leaving[of], spans[1] * to.arriving[of]];
            // The tip may have come to rest at the second point: its way is taken from the poses.
            let pushes = [from.state.z[push], to.state.z[push]];
            let ways = [from.state.z[slid], sign * (end.way() - start)];
            needle.friction * product_integral([pushes, along(push)], [ways, along(slid)])
        };
        self.touches(&from.state).map(of_touch).sum()
    }

    /// `T` and `ξ` of all touches, by their slots: friction takes `∫ T dξ`.
    #[cfg(test)]
    pub(in crate::puncture) fn rubbing(&self, state: &SkinState) -> Vec<[f64; 2]> {
        let Some(needle) = &self.needle else { return Vec::new() };
        let mut all = vec![[0.0; 2]; needle.slots];
        for (slot, _, _, meeting) in self.touches(state) {
            all[slot] = [needle.forces(&state.z, slot)[1], meeting.way()];
        }
        all
    }
}

impl GuidedNeedle {
    /// `N` and `T` of a touch.
    fn forces(&self, z: &[f64], slot: usize) -> [f64; 2] {
        let push = self.push(slot);
        let rubs = self.of_touch < self.unknowns;
        [z[push], if rubs { z[push + 1] } else { 0.0 }]
    }

    /// The conditions of a touch that sticks (L2), and of one that slides.
    pub(super) fn rub_conditions(
        &self,
        state: &SkinState,
        slot: usize,
        touch: &Touch,
        meeting: &Meeting,
        values: &mut [f64],
    ) {
        let [push, drag] = self.forces(&state.z, slot);
        match touch.rub {
            Rub::Slip { from, .. } => {
                for (constraint, sign) in [(FORWARD, 1.0), (BACKWARD, -1.0)] {
                    if state.active[self.number(slot, constraint)] {
                        let slid = state.z[self.push(slot) + 1 + constraint];
                        values[constraint] = slid + sign * (from - meeting.way());
                    }
                }
            }
            Rub::Stick { .. } => {
                values[FORWARD] = self.friction * push - drag;
                values[BACKWARD] = self.friction * push + drag;
            }
            Rub::Passing { .. } | Rub::Held { .. } => {}
        }
    }
}

/// The force of a touch in the balances of its scale and, with the other sign, of the needle.
fn add_balance(
    meeting: &Meeting,
    rows: [usize; COORDINATES],
    push: usize,
    z: &[f64],
    residual: &mut Residual,
    matrix: &mut impl Tangent,
) {
    // Of a round tip that does not rub the next unknown is one that stays 0.
    let forces = [z[push], z[push + 1]];
    let (by_gap, by_way) = (meeting.tip.gap_slopes(), meeting.way_slopes());
    let curvature = meeting.curvature(forces);
    for (i, row) in rows.into_iter().enumerate() {
        let sign = if i + 1 == COORDINATES { -1.0 } else { 1.0 };
        residual.add(row, -sign * forces[0] * by_gap[i]);
        residual.add(row, sign * forces[1] * by_way[i]);
        add_row(row, rows, sign, curvature[i], matrix);
        matrix.add(row, push, -sign * by_gap[i]);
        matrix.add(row, push + 1, sign * by_way[i]);
    }
}

/// The law of the tangential force, in its row.
fn add_law(
    needle: &GuidedNeedle,
    (touch, push): (&Touch, usize),
    meeting: &Meeting,
    rows: [usize; COORDINATES],
    z: &[f64],
    residual: &mut Residual,
    matrix: &mut impl Tangent,
) {
    let row = push + 1;
    match touch.rub {
        Rub::Slip { .. } | Rub::Held { .. } => {
            let ratio = match touch.rub {
                Rub::Slip { sign, .. } => sign * needle.friction,
                Rub::Held { ratio } => needle.keeps(touch, ratio),
                Rub::Stick { .. } | Rub::Passing { .. } => 0.0,
            };
            residual.add(row, z[row]);
            residual.add(row, -ratio * z[push]);
            matrix.add(row, row, 1.0);
            matrix.add(row, push, -ratio);
        }
        Rub::Stick { .. } | Rub::Passing { .. } => {
            let at = match touch.rub {
                Rub::Stick { at } => needle.keeps(touch, at),
                _ => 0.0,
            };
            // With this sign the determinant keeps its own where a tip that slides comes to rest. With the other one the path would
            // take the equilibria behind that place for another branch, and stop there.
            residual.add(row, at);
            residual.add(row, -meeting.way());
            add_row(row, rows, -1.0, meeting.way_slopes(), matrix);
        }
    }
}

/// Adds `factor` times the slopes by the coordinates of a touch to a row.
pub(super) fn add_row(
    row: usize,
    columns: [usize; COORDINATES],
    factor: f64,
    slopes: [f64; COORDINATES],
    matrix: &mut impl Tangent,
) {
    for (column, slope) in columns.into_iter().zip(slopes) {
        matrix.add(row, column, factor * slope);
    }
}
