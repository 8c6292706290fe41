//! The equations of a guided needle, and the conditions under which they hold.

use solver::{Residual, Tangent};

use super::mode::{Place, Rub, Touch};
use super::outline::{COORDINATES, Tip};
use super::{BACKWARD, CONSTRAINTS, FORWARD, GuidedNeedle, HIGH, LOW, PUSH, THROUGH, TILT};
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
        residual.add(needle.depth, state.z[load]);
        matrix.add(needle.depth, load, 1.0);
        if needle.is_round() {
            return self.add_round(needle, state, residual, matrix);
        }
        for (number, touch) in state.mode.needle.touches.iter().enumerate() {
            let Some(touch) = touch else {
                // A touch that is not there has no tangential force.
                let drag = needle.push(number) + 1;
                residual.add(drag, state.z[drag]);
                matrix.add(drag, drag, 1.0);
                continue;
            };
            let Some(scale) = self.scale_numbered(touch.scale) else { continue };
            let Some(tip) = self.tip(&state.z, touch.scale, touch.place) else { continue };
            let at = self.layout.scale(scale);
            let rows = [at, at + 1, at + 2, needle.depth];
            let push = needle.push(number);
            add_balance(&tip, rows, push, &state.z, residual, matrix);
            residual.add(push, tip.gap);
            add_row(push, rows, 1.0, tip.gap_slopes(), matrix);
            add_law(needle, (number, touch), &tip, rows, &state.z, residual, matrix);
            for (constraint, sign) in [(FORWARD, 1.0), (BACKWARD, -1.0)] {
                // How far the tip has slid: it only counts, and tells the path where it turns back.
                let (Rub::Slip { from, .. }, true) =
                    (touch.rub, state.active[needle.number(number, constraint)])
                else {
                    continue;
                };
                let slid = push + 1 + constraint;
                residual.add(slid, state.z[slid]);
                residual.add(slid, sign * (from - tip.way));
                matrix.add(slid, slid, 1.0);
                add_row(slid, rows, -sign, tip.way_slopes(), matrix);
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
        values.resize(first + needle.constraint_count(), HOLDS);
        let values = &mut values[first..];
        if needle.is_round() {
            return self.round_conditions(needle, state, values);
        }
        for (number, touch) in state.mode.needle.touches.iter().enumerate() {
            let of_touch = &mut values[CONSTRAINTS * number..][..CONSTRAINTS];
            if let Some(touch) = touch {
                self.touch_conditions(needle, state, number, touch, of_touch);
            } else {
                let other = state.mode.needle.touches[1 - number].as_ref();
                of_touch[PUSH] = other.map_or(HOLDS, |touch| self.gap_of_next(state, touch));
            }
            let tip = touch.as_ref().and_then(|t| self.tip(&state.z, t.scale, t.place));
            let left = match (touch.map(|touch| touch.place), tip) {
                (Some(Place::Left), Some(tip)) => tip.way,
                (Some(Place::Right), Some(tip)) => tip.length - tip.way,
                _ => HOLDS,
            };
            values[THROUGH] = values[THROUGH].min(left);
        }
    }

    /// The conditions of the constraints of a touch but for that of its normal force.
    fn touch_conditions(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        number: usize,
        touch: &Touch,
        values: &mut [f64],
    ) {
        let Some(tip) = self.tip(&state.z, touch.scale, touch.place) else { return };
        let push = needle.push(number);
        let forces = [state.z[push], state.z[push + 1]];
        let friction = needle.friction;
        values[PUSH] = tip.gap;
        match touch.rub {
            Rub::Slip { from, .. } => {
                for (constraint, sign) in [(FORWARD, 1.0), (BACKWARD, -1.0)] {
                    if state.active[needle.number(number, constraint)] {
                        values[constraint] =
                            state.z[push + 1 + constraint] + sign * (from - tip.way);
                    }
                }
                if touch.place != Place::Left {
                    values[LOW] = tip.way;
                }
                let is_stopped = touch.place == Place::Top && self.is_notched(state, touch.scale);
                if touch.place != Place::Right && !is_stopped {
                    values[HIGH] = tip.length - tip.way;
                }
            }
            Rub::Stick { .. } => {
                values[FORWARD] = friction * forces[0] - forces[1];
                values[BACKWARD] = friction * forces[0] + forces[1];
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
            Rub::Held { .. } => {}
        }
        if let Some(scale) = self.scale_numbered(touch.scale) {
            let [_, _, rotation] = self.displacement(&state.z, scale);
            values[TILT] = needle.critical_tilt - rotation.abs();
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
        let [Some(touch), None] = state.mode.needle.touches else { return false };
        let next = Self::next_touch(&touch);
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
            let mut moved = state.clone();
            for (z, rate) in moved.z.iter_mut().zip(direction) {
                *z += step * rate;
            }
            let mut values = Vec::new();
            self.needle_conditions(needle, &moved, &mut values);
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
        state.mode.needle.touches.iter().flatten().any(|touch| match touch.rub {
            Rub::Slip { sign, .. } => sign * needle.friction != 0.0,
            Rub::Held { ratio } => ratio != 0.0,
            Rub::Stick { .. } | Rub::Passing { .. } => false,
        })
    }

    /// Whether the needle touches a scale, by its index.
    pub(in crate::puncture) fn touches_scale(&self, state: &SkinState, scale: usize) -> bool {
        let needle = &state.mode.needle;
        needle.touched().any(|touched| self.scale_numbered(touched) == Some(scale))
    }

    /// The unknowns of a guided needle in its stiffness: its depth, and the forces that keep it on faces and in places.
    pub(in crate::puncture) fn needle_in_stiffness(&self, state: &SkinState) -> Vec<usize> {
        let Some(needle) = &self.needle else { return Vec::new() };
        if needle.is_round() {
            return Self::round_in_stiffness(needle, state);
        }
        let mut unknowns = vec![needle.depth];
        for (number, touch) in state.mode.needle.touches.iter().enumerate() {
            let Some(touch) = touch else { continue };
            unknowns.push(needle.push(number));
            if matches!(touch.rub, Rub::Stick { .. } | Rub::Passing { .. }) {
                unknowns.push(needle.push(number) + 1);
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
        if needle.is_round() {
            return self.for_round_stiffness(needle, state, entry);
        }
        for (number, touch) in state.mode.needle.touches.iter().enumerate() {
            let Some(touch) = touch else { continue };
            let Some(scale) = self.scale_numbered(touch.scale) else { continue };
            let Some(tip) = self.tip(&state.z, touch.scale, touch.place) else { continue };
            let at = self.layout.scale(scale);
            let unknowns = [at, at + 1, at + 2, needle.depth];
            let push = needle.push(number);
            let curvature = tip.curvature([state.z[push], state.z[push + 1]]);
            for (row, curvature) in unknowns.into_iter().zip(curvature) {
                for (column, value) in unknowns.into_iter().zip(curvature) {
                    entry(row, column, value);
                }
            }
            let sticks = matches!(touch.rub, Rub::Stick { .. } | Rub::Passing { .. });
            let gap = (push, tip.gap_slopes().map(|slope| -slope));
            let way = sticks.then(|| (push + 1, tip.way_slopes()));
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
        if needle.is_round() {
            return self.round_lateral_force(needle, state);
        }
        let touches = state.mode.needle.touches.iter().enumerate();
        let lateral = |(number, touch): (usize, &Option<Touch>)| {
            let touch = touch.as_ref()?;
            let push = needle.push(number);
            let tip = self.tip(&state.z, touch.scale, touch.place)?;
            Some(tip.force([state.z[push], state.z[push + 1]]).x)
        };
        touches.filter_map(lateral).sum()
    }

    /// What friction takes at the tip between two neighbouring points, `∫ μ_n N |dξ|`.
    pub(in crate::puncture) fn taken_at_tip(
        &self,
        from: &SkinPoint,
        to: &SkinPoint,
        spans: [f64; 2],
    ) -> f64 {
        let Some(needle) = &self.needle else { return 0.0 };
        let of_touch = |slot: usize| -> f64 {
            let Some(Touch { rub: Rub::Slip { sign, from: start }, scale, place }) =
                from.state.mode.needle.touches[slot]
            else {
                return 0.0;
            };
            let Some(end) = self.tip(&to.state.z, scale, place) else { return 0.0 };
            let slid = needle.push(slot) + 1 + if sign > 0.0 { FORWARD } else { BACKWARD };
            let push = needle.push(slot);
            let along = |of: usize| [spans[0] * from.leaving[of], spans[1] * to.arriving[of]];
            let pushes = [from.state.z[push], to.state.z[push]];
            let ways = [from.state.z[slid], sign * (end.way - start)];
            needle.friction * product_integral([pushes, along(push)], [ways, along(slid)])
        };
        of_touch(0) + of_touch(1)
    }

    /// `T` and `ξ` of both touches: friction takes `∫ T dξ`.
    #[cfg(test)]
    pub(in crate::puncture) fn rubbing(&self, state: &SkinState) -> [[f64; 2]; 2] {
        std::array::from_fn(|number| {
            let touch = state.mode.needle.touches[number].as_ref();
            let tip = touch.and_then(|t| self.tip(&state.z, t.scale, t.place));
            let push = self.needle.as_ref().map(|needle| needle.push(number));
            push.zip(tip).map_or([0.0; 2], |(push, tip)| [state.z[push + 1], tip.way])
        })
    }
}

/// The force of a touch in the balances of its scale and, with the other sign, of the needle.
fn add_balance(
    tip: &Tip,
    rows: [usize; COORDINATES],
    push: usize,
    z: &[f64],
    residual: &mut Residual,
    matrix: &mut impl Tangent,
) {
    let forces = [z[push], z[push + 1]];
    let (by_gap, by_way) = (tip.gap_slopes(), tip.way_slopes());
    let curvature = tip.curvature(forces);
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
    (number, touch): (usize, &Touch),
    tip: &Tip,
    rows: [usize; COORDINATES],
    z: &[f64],
    residual: &mut Residual,
    matrix: &mut impl Tangent,
) {
    let push = needle.push(number);
    let row = push + 1;
    match touch.rub {
        Rub::Slip { .. } | Rub::Held { .. } => {
            let ratio = match touch.rub {
                Rub::Slip { sign, .. } => sign * needle.friction,
                Rub::Held { ratio } => needle.keeps(number, touch, ratio),
                Rub::Stick { .. } | Rub::Passing { .. } => 0.0,
            };
            residual.add(row, z[row]);
            residual.add(row, -ratio * z[push]);
            matrix.add(row, row, 1.0);
            matrix.add(row, push, -ratio);
        }
        Rub::Stick { .. } | Rub::Passing { .. } => {
            let at = match touch.rub {
                Rub::Stick { at } => needle.keeps(number, touch, at),
                _ => 0.0,
            };
            // With this sign the determinant keeps its own where a tip that slides comes to rest. With the other one the path would
            // take the equilibria behind that place for another branch, and stop there.
            residual.add(row, at);
            residual.add(row, -tip.way);
            add_row(row, rows, -1.0, tip.way_slopes(), matrix);
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
