//! Equations of a guided needle, and the conditions under which its discrete state is valid.

use geometry::Vec2;
use solver::{Residual, Tangent};

use super::outline::{COORDINATES, TipKinematics};
use super::{BACKWARD, CONSTRAINTS_PER_TOUCH, FACE_END, FACE_START, FORWARD, GuidedNeedle, NORMAL};
use crate::contacts::{
    Contacts, Dissipation, OutlinePart, SATISFIED, SkinPoint, SkinState, TipContact, TipFriction,
    TipState, product_integral,
};
use crate::puncture::system::Chain;

/// Distance beyond the end of a face up to which a tip still faces it, in units of `t`.
///
/// It is larger than round-off and than the approach of a corner that lies on the face.
const BESIDE: f64 = 1e-9;

/// Distance from the end of a face within which the path has reached this end, in units of `t`.
///
/// The shortest steps of the solver come closer, but cannot pass the end.
const AT_AN_END: f64 = 1e-6;

/// Largest change of an unknown in difference quotients along a direction.
pub(super) const STEP: f64 = 1e-6;

impl Chain {
    /// Adds the equations of a guided needle: equilibrium (L1), closed gaps, friction (L2).
    pub(in crate::puncture) fn add_needle(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        let load = self.layout.load();
        // The equation of the depth is the equilibrium of the needle: load and contact forces.
        residual.add(needle.depth, state.z[load]);
        matrix.add(needle.depth, load, 1.0);
        if needle.constraints_per_touch < needle.unknowns_per_touch {
            // Slots without a tip contact have no tangential force.
            let touches = &state.mode.needle.tip_contacts;
            for slot in (0..needle.slots).filter(|&slot| touches[slot].is_none()) {
                let tangential_force = needle.normal_force(slot) + 1;
                residual.add(tangential_force, state.z[tangential_force]);
                matrix.add(tangential_force, tangential_force, 1.0);
            }
        }
        for (slot, touch, scale, kinematics) in self.tip_contacts(state) {
            let at = self.layout.scale(scale);
            let rows = [at, at + 1, at + 2, needle.depth];
            let normal_force = needle.normal_force(slot);
            add_balance(&kinematics, rows, normal_force, &state.z, residual, matrix);
            residual.add(normal_force, kinematics.gap());
            add_row(normal_force, rows, 1.0, kinematics.tip.gap_slopes(), matrix);
            // A frictionless round tip has no tangential force and no friction law.
            if needle.constraints_per_touch == needle.unknowns_per_touch {
                continue;
            }
            add_law(needle, (touch, normal_force), &kinematics, rows, &state.z, residual, matrix);
            for (constraint, sign) in [(FORWARD, 1.0), (BACKWARD, -1.0)] {
                // The slip distance enters no other equation. It only lets the solver detect a
                // reversal of sliding.
                let (TipState::Slip { start, .. }, true) =
                    (touch.tip_state, state.active[needle.number(slot, constraint)])
                else {
                    continue;
                };
                let slid = normal_force + 1 + constraint;
                residual.add(slid, state.z[slid]);
                residual.add(slid, sign * (start - kinematics.xi()));
                matrix.add(slid, slid, 1.0);
                add_row(slid, rows, -sign, kinematics.xi_slopes(), matrix);
            }
        }
        if let Some((slot, corner)) = self.corner_friction(state) {
            needle.add_equal_fractions(slot, &corner, &state.z, residual, matrix);
        }
    }

    /// Returns the slot of the tip contact on the face of a notch, and the friction of its corner.
    ///
    /// `None` unless tip and corner stick.
    fn corner_friction(&self, state: &SkinState) -> Option<(usize, TipFriction)> {
        let [face, corner] = self.notch(state)?;
        Some((face, self.contacts.friction_with_tip(state, corner)?))
    }

    /// Appends the values of the conditions of all needle constraints.
    pub(in crate::puncture) fn needle_conditions(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        values: &mut Vec<f64>,
    ) {
        let first = values.len();
        values.resize(first + needle.endings().end, SATISFIED);
        let values = &mut values[first..];
        let tilt = needle.tilt_number();
        for (_, touch, number, kinematics) in self.tip_contacts(state) {
            let [_, _, rotation] = self.displacement(&state.z, number);
            values[tilt] = values[tilt].min(needle.critical_tilt - rotation.abs());
            // A scale has its feet at the start of the left face and at the end of the right face.
            let to_foot = match touch.part {
                OutlinePart::Left => kinematics.tip.xi,
                OutlinePart::Right => kinematics.tip.length - kinematics.tip.xi,
                _ => SATISFIED,
            };
            values[tilt + 1] = values[tilt + 1].min(to_foot);
        }
        if needle.is_round() {
            return self.round_conditions(needle, state, values);
        }
        for (number, touch) in state.mode.needle.tip_contacts.iter().enumerate() {
            let other = state.mode.needle.tip_contacts[1 - number].filter(|_| touch.is_none());
            if let Some(other) = other {
                values[CONSTRAINTS_PER_TOUCH * number + NORMAL] = self.gap_of_next(state, &other);
            }
        }
        for (number, touch, _, kinematics) in self.tip_contacts(state) {
            let of_touch = &mut values[CONSTRAINTS_PER_TOUCH * number..][..CONSTRAINTS_PER_TOUCH];
            self.touch_conditions(needle, state, (number, touch), &kinematics, of_touch);
        }
        if let Some((slot, corner)) = self.corner_friction(state) {
            // Tip and corner begin to slide together when the sum of their friction forces reaches
            // the sum of their limits.
            let [normal_force, tangential_force] = needle.forces(&state.z, slot);
            let limit = needle.friction * normal_force + corner.limit;
            let sum = tangential_force + corner.traction;
            let of_touch = &mut values[CONSTRAINTS_PER_TOUCH * slot..][..CONSTRAINTS_PER_TOUCH];
            (of_touch[FORWARD], of_touch[BACKWARD]) = (limit - sum, limit + sum);
        }
    }

    /// Evaluates the conditions of a contact of a sharp tip.
    ///
    /// `number` is the slot of the tip contact, `values` are the values of its constraints.
    fn touch_conditions(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        (number, touch): (usize, &TipContact),
        kinematics: &TipKinematics,
        values: &mut [f64],
    ) {
        let (tip, forces) = (&kinematics.tip, needle.forces(&state.z, number));
        let friction = needle.friction;
        values[NORMAL] = tip.gap;
        needle.stick_slip_conditions(state, number, touch, kinematics, values);
        match touch.tip_state {
            TipState::Slip { .. } => {
                // The lower end of a side face is a foot of the scale. A tip that reaches it is
                // through, which is another condition.
                if touch.part != OutlinePart::Left {
                    values[FACE_START] = tip.xi;
                }
                let is_stopped =
                    touch.part == OutlinePart::Top && self.is_notched(state, touch.scale);
                if touch.part != OutlinePart::Right && !is_stopped {
                    values[FACE_END] = tip.length - tip.xi;
                }
            }
            TipState::Passing { forward } => {
                let force = tip.force(forces);
                let seen = |onward: bool| {
                    let beside = self.tip(&state.z, touch.scale, touch.part.next(onward)?)?;
                    Some(beside.parts(force))
                };
                let [before, after] = [false, true].map(|onward| seen(onward).unwrap_or(forces));
                // The force rotates from the sliding limit on the previous face to the sliding
                // limit on the next face (L5).
                [values[FACE_START], values[FACE_END]] = if forward {
                    [friction * before[0] - before[1], after[1] - friction * after[0]]
                } else {
                    [-friction * before[0] - before[1], after[1] + friction * after[0]]
                };
            }
            TipState::Stick { .. } | TipState::Locked { .. } => {}
        }
    }

    /// Computes the gap between a sharp tip and the face that it would touch next.
    ///
    /// The foot of the perpendicular from the tip must lie on this face. A tip that sticks at a
    /// corner never closes the gap: the corner alone presses on the face until the tip slides.
    fn gap_of_next(&self, state: &SkinState, touch: &TipContact) -> f64 {
        if self.sticks_at_corner(state, touch) {
            // The corner and the tip reach the face at the same point of the path, in an order that
            // depends on round-off. So do not require that the contact of the corner is closed.
            return SATISFIED;
        }
        let next = Self::next_touch(touch);
        let tip = next.and_then(|(scale, part)| self.tip(&state.z, scale, part));
        let faced = tip.filter(|tip| (-BESIDE..=tip.length + BESIDE).contains(&tip.xi));
        faced.map_or(SATISFIED, |tip| tip.gap)
    }

    /// Returns true if a tip sticks on the top of a scale, at the right corner of this top.
    fn sticks_at_corner(&self, state: &SkinState, touch: &TipContact) -> bool {
        let sticks = matches!(touch.tip_state, TipState::Stick { .. });
        let here = self.tip(&state.z, touch.scale, touch.part);
        let here = here.filter(|_| sticks && touch.part == OutlinePart::Top);
        here.is_some_and(|here| here.xi > here.length - BESIDE)
    }

    /// Returns true if a tip sticks at a corner and the constraint is its contact with a face.
    ///
    /// The corner lies on this face of the neighbour. The gap between tip and face is then constant
    /// and does not determine the outgoing branch.
    pub(in crate::puncture) fn sticks_beside_face(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        constraint: usize,
    ) -> bool {
        let number = constraint.checked_sub(needle.contacts);
        let Some(number) = number.filter(|number| *number < needle.tilt_number()) else {
            return false;
        };
        let (slot, constraint) = (number / CONSTRAINTS_PER_TOUCH, number % CONSTRAINTS_PER_TOUCH);
        let touches = &state.mode.needle.tip_contacts;
        !needle.is_round()
            && constraint == NORMAL
            && touches[slot].is_none()
            && touches[1 - slot].is_some_and(|touch| self.sticks_at_corner(state, &touch))
    }

    /// Returns true if a corner of the next scale is about to touch the needle from the side.
    ///
    /// The tip is then already below the face that ends at this corner, so the corner would touch
    /// the shaft of the needle, which is not modelled.
    pub(in crate::puncture) fn is_met_from_the_side(&self, state: &SkinState) -> bool {
        if state.mode.needle.is_round() {
            return false;
        }
        // With two tip contacts, the tip already touches the next scale.
        let mut touches = state.mode.needle.tip_contacts.iter().flatten();
        let (Some(touch), None) = (touches.next(), touches.next()) else { return false };
        let next = Self::next_touch(touch);
        let tip = next.and_then(|(scale, part)| self.tip(&state.z, scale, part));
        tip.is_some_and(|tip| {
            let xi = tip.xi.min(tip.length - tip.xi);
            tip.gap < -BESIDE && xi.abs() < AT_AN_END
        })
    }

    /// Appends the derivatives of all needle conditions along `direction`.
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

    /// Returns true if the forces in this state have no potential.
    ///
    /// Friction between scales has no potential, and neither has the tangential force of a tip that
    /// slides with friction or is locked with a nonzero ratio `T/N`.
    pub(in crate::puncture) fn is_nonconservative(&self, state: &SkinState) -> bool {
        if Contacts::friction_acts(state) {
            return true;
        }
        let Some(needle) = &self.needle else { return false };
        state.mode.needle.all().any(|(_, touch)| match touch.tip_state {
            TipState::Slip { sign, .. } => sign * needle.friction != 0.0,
            TipState::Locked { ratio } => ratio != 0.0,
            TipState::Stick { .. } | TipState::Passing { .. } => false,
        })
    }

    /// Lists the unknowns of the needle that belong to the stiffness of the row (P5).
    ///
    /// They are the depth, the normal forces, and the tangential forces of sticking and passing
    /// tips.
    pub(in crate::puncture) fn needle_in_stiffness(&self, state: &SkinState) -> Vec<usize> {
        let Some(needle) = &self.needle else { return Vec::new() };
        let mut unknowns = vec![needle.depth];
        for (slot, touch, ..) in self.tip_contacts(state) {
            unknowns.push(needle.normal_force(slot));
            if touch.has_fixed_position() {
                unknowns.push(needle.normal_force(slot) + 1);
            }
        }
        unknowns
    }

    /// Calls `entry(row, column, value)` for each stiffness entry of a conservative needle.
    ///
    /// The entries are the second derivatives of `−N g + T ξ`. `N` is an unknown, and so is `T` of
    /// a tip that sticks or passes a corner.
    pub(in crate::puncture) fn for_needle_stiffness(
        &self,
        state: &SkinState,
        mut entry: impl FnMut(usize, usize, f64),
    ) {
        let Some(needle) = &self.needle else { return };
        for (slot, touch, scale, kinematics) in self.tip_contacts(state) {
            let at = self.layout.scale(scale);
            let unknowns = [at, at + 1, at + 2, needle.depth];
            let normal_force = needle.normal_force(slot);
            let curvature = kinematics.curvature(needle.forces(&state.z, slot));
            for (row, curvature) in unknowns.into_iter().zip(curvature) {
                for (column, value) in unknowns.into_iter().zip(curvature) {
                    entry(row, column, value);
                }
            }
            let gap = (normal_force, kinematics.tip.gap_slopes().map(|slope| -slope));
            let xi = touch.has_fixed_position().then(|| (normal_force + 1, kinematics.xi_slopes()));
            for (force, slopes) in std::iter::once(gap).chain(xi) {
                for (unknown, slope) in unknowns.into_iter().zip(slopes) {
                    entry(unknown, force, slope);
                    entry(force, unknown, slope);
                }
            }
        }
    }

    /// Computes the force of the needle on all scales along the row, positive to the right.
    pub(in crate::puncture) fn lateral_force(&self, state: &SkinState) -> f64 {
        let Some(needle) = &self.needle else { return 0.0 };
        let touches = self.tip_contacts(state);
        touches
            .map(|(slot, _, scale, at)| {
                let force = at.tip.force(needle.forces(&state.z, slot));
                self.frame_from_punctured(scale).outward(force).x
            })
            .sum()
    }

    /// Lists the forces of a guided needle on a scale.
    ///
    /// Each entry holds the vector from the node to the point of contact in the deformed state, and
    /// the force.
    pub(in crate::puncture) fn needle_forces_on(
        &self,
        state: &SkinState,
        scale: usize,
    ) -> Vec<[Vec2; 2]> {
        let Some(needle) = &self.needle else { return Vec::new() };
        let touches = self.tip_contacts(state).filter(|(_, _, number, _)| *number == scale);
        let forces = touches.map(|(slot, _, _, at)| {
            [at.contact_arm(), at.tip.force(needle.forces(&state.z, slot))]
        });
        forces.collect()
    }

    /// Returns the normal force of a guided needle on a scale; 0 without contact.
    pub(in crate::puncture) fn needle_push_on(&self, state: &SkinState, scale: usize) -> f64 {
        let Some(needle) = &self.needle else { return 0.0 };
        let touches = self.tip_contacts(state).filter(|(_, _, number, _)| *number == scale);
        touches.map(|(slot, ..)| state.z[needle.normal_force(slot)]).fold(0.0, f64::max)
    }

    /// Computes the dissipation `∫ μ_n N |dξ|` of the tip between two points of the path.
    pub(in crate::puncture) fn tip_dissipation(
        &self,
        from: &SkinPoint,
        to: &SkinPoint,
        spans: [f64; 2],
    ) -> Dissipation {
        let Some(needle) = &self.needle else { return Dissipation::default() };
        self.tip_contacts(&from.state)
            .map(|(slot, touch, ..)| {
                let TipState::Slip { sign, start } = touch.tip_state else {
                    return Dissipation::default();
                };
                let Some(end) = self.tip_kinematics(&to.state.z, touch.scale, touch.part) else {
                    return Dissipation::default();
                };
                if sign == 0.0 {
                    return Dissipation::default();
                }
                let slid =
                    needle.normal_force(slot) + 1 + if sign > 0.0 { FORWARD } else { BACKWARD };
                let normal_force = needle.normal_force(slot);
                let along = |of: usize| [spans[0] * from.leaving[of], spans[1] * to.arriving[of]];
                // If the second point is at a corner, resolve its force along the normal of the
                // face on which the tip slid.
                let after = self.tip_contacts(&to.state).find(|(other, ..)| *other == slot);
                let push = after.map_or(to.state.z[normal_force], |(.., kinematics)| {
                    let force = kinematics.tip.force(needle.forces(&to.state.z, slot));
                    end.tip.parts(force)[0]
                });
                let pushes = [from.state.z[normal_force], push];
                // The tip may stick at the second point and have no slip distance there, so compute
                // the slip from the poses.
                let slips = [from.state.z[slid], sign * (end.xi() - start)];
                product_integral([pushes, along(normal_force)], [slips, along(slid)])
                    * needle.friction
            })
            .sum()
    }

    /// Returns `T` and `ξ` of the tip contact in each slot; the dissipation is `∫ T dξ`.
    #[cfg(test)]
    pub(in crate::puncture) fn tip_friction(&self, state: &SkinState) -> Vec<[f64; 2]> {
        let Some(needle) = &self.needle else { return Vec::new() };
        let mut all = vec![[0.0; 2]; needle.slots];
        for (slot, _, _, kinematics) in self.tip_contacts(state) {
            all[slot] = [needle.forces(&state.z, slot)[1], kinematics.xi()];
        }
        all
    }
}

impl GuidedNeedle {
    /// Returns the normal force `N` and the tangential force `T` of the tip contact in a slot.
    pub(super) fn forces(&self, z: &[f64], slot: usize) -> [f64; 2] {
        let normal_force = self.normal_force(slot);
        let has_friction = self.constraints_per_touch < self.unknowns_per_touch;
        [z[normal_force], if has_friction { z[normal_force + 1] } else { 0.0 }]
    }

    /// Adds the equation for equal fractions of the friction limits in a notch.
    ///
    /// With the friction forces `T` of the tip and `T_c` of the corner and their limits `μ_n N` and
    /// `μ Λ` it is `T_c = (T_c + T) μ Λ/(μ Λ + μ_n N)`, in the row of the unknown of the corner.
    fn add_equal_fractions(
        &self,
        slot: usize,
        corner: &TipFriction,
        z: &[f64],
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        let row = corner.unknown;
        let normal_force = self.normal_force(slot);
        let of_tip = self.friction * z[normal_force];
        let limit = of_tip + corner.limit;
        let (tangential_force, sum) = (z[normal_force + 1], z[normal_force + 1] + corner.traction);
        let fraction = corner.limit / limit;
        residual.add(row, (1.0 - fraction) * corner.traction);
        residual.add(row, -fraction * tangential_force);
        matrix.add(row, row, 1.0 - fraction);
        matrix.add(row, normal_force + 1, -fraction);
        let by_limit_of_tip = sum * fraction / limit;
        matrix.add(row, normal_force, self.friction * by_limit_of_tip);
        let by_limit_of_corner = -2.0 * (1.0 - fraction) - sum * (1.0 - fraction) / limit;
        for &force in &corner.normal_forces {
            matrix.add(row, force, corner.friction * by_limit_of_corner);
        }
    }

    /// Evaluates the slip conditions of a tip that sticks or slides (L2).
    ///
    /// A sticking tip must not exceed its friction limit, and a sliding tip must not reverse.
    pub(super) fn stick_slip_conditions(
        &self,
        state: &SkinState,
        slot: usize,
        touch: &TipContact,
        kinematics: &TipKinematics,
        values: &mut [f64],
    ) {
        let [normal_force, tangential_force] = self.forces(&state.z, slot);
        match touch.tip_state {
            TipState::Slip { start, .. } => {
                for (constraint, sign) in [(FORWARD, 1.0), (BACKWARD, -1.0)] {
                    if state.active[self.number(slot, constraint)] {
                        let slid = state.z[self.normal_force(slot) + 1 + constraint];
                        values[constraint] = slid + sign * (start - kinematics.xi());
                    }
                }
            }
            TipState::Stick { .. } => {
                values[FORWARD] = self.friction * normal_force - tangential_force;
                values[BACKWARD] = self.friction * normal_force + tangential_force;
            }
            TipState::Passing { .. } | TipState::Locked { .. } => {}
        }
    }
}

/// Adds the force of a tip contact to the equilibrium equations of its scale and of the needle.
///
/// The force on the needle has the opposite sign of the force on the scale.
fn add_balance(
    kinematics: &TipKinematics,
    rows: [usize; COORDINATES],
    normal_force: usize,
    z: &[f64],
    residual: &mut Residual,
    matrix: &mut impl Tangent,
) {
    // A frictionless round tip has no tangential force. The unknown after the normal force then
    // belongs to the condition on the position and is always 0.
    let forces = [z[normal_force], z[normal_force + 1]];
    let (by_gap, by_xi) = (kinematics.tip.gap_slopes(), kinematics.xi_slopes());
    let curvature = kinematics.curvature(forces);
    for (i, row) in rows.into_iter().enumerate() {
        let sign = if i + 1 == COORDINATES { -1.0 } else { 1.0 };
        residual.add(row, -sign * forces[0] * by_gap[i]);
        residual.add(row, sign * forces[1] * by_xi[i]);
        add_row(row, rows, sign, curvature[i], matrix);
        matrix.add(row, normal_force, -sign * by_gap[i]);
        matrix.add(row, normal_force + 1, sign * by_xi[i]);
    }
}

/// Adds the friction law of a tip contact, in the row of its tangential force.
fn add_law(
    needle: &GuidedNeedle,
    (touch, normal_force): (&TipContact, usize),
    kinematics: &TipKinematics,
    rows: [usize; COORDINATES],
    z: &[f64],
    residual: &mut Residual,
    matrix: &mut impl Tangent,
) {
    let row = normal_force + 1;
    match touch.tip_state {
        TipState::Slip { .. } | TipState::Locked { .. } => {
            let ratio = match touch.tip_state {
                TipState::Slip { sign, .. } => sign * needle.friction,
                TipState::Locked { ratio } => needle.shifted_anchor(touch, ratio),
                TipState::Stick { .. } | TipState::Passing { .. } => 0.0,
            };
            residual.add(row, z[row]);
            residual.add(row, -ratio * z[normal_force]);
            matrix.add(row, row, 1.0);
            matrix.add(row, normal_force, -ratio);
        }
        TipState::Stick { .. } | TipState::Passing { .. } => {
            let at = match touch.tip_state {
                TipState::Stick { anchor } => needle.shifted_anchor(touch, anchor),
                _ => 0.0,
            };
            // With this sign of the equation, the determinant (N7) keeps its sign when a sliding
            // tip stops. With the opposite sign the solver would conclude that it has switched to
            // another branch, and stop.
            residual.add(row, at);
            residual.add(row, -kinematics.xi());
            add_row(row, rows, -1.0, kinematics.xi_slopes(), matrix);
        }
    }
}

/// Adds `factor` times the `slopes` to a row of the tangent, in the given `columns`.
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
