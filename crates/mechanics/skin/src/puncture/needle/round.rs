//! A needle with a round tip: a circle guided straight down.
//!
//! The circle may touch faces and corners of all scales in reach. Scales are convex, so it touches
//! each of them in at most one point, with one normal force. Gap and normal are continuous from
//! face to corner, so the outline part in the mode only selects the second derivatives. With
//! friction the circle sticks or slides at each scale separately, like a sharp tip. The slip
//! coordinate is continuous from face to corner (L9).

use geometry::Vec2;
use solver::{Change, Condition, Newton};

use super::forces::STEP;
use super::outline::Face;
use super::passage::TipForces;
use super::{GuidedNeedle, NORMAL};
use crate::contacts::{OutlinePart, SATISFIED, SkinState, TipContact, TipState};
use crate::puncture::system::Chain;

/// Gap up to which a scale counts as touched at rest, in units of `t`; larger than round-off.
const AT_REST: f64 = 1e-10;

/// Maximum number of trials to find the initial state of a tip that touches two scales at rest.
///
/// The first load may act on only one of these scales, and the tip may stick or slide on it.
const SETTLES: usize = 8;

/// Faces of a scale that a needle can touch, without the corners.
const FACES: [OutlinePart; 3] = [OutlinePart::Left, OutlinePart::Top, OutlinePart::Right];

impl GuidedNeedle {
    /// Iterates over the scales in reach: slot, and number counted from the punctured scale.
    fn scales(&self) -> impl Iterator<Item = (usize, i64)> + use<> {
        let reach = self.reach() as i64;
        (-reach..=reach).enumerate()
    }

    /// Sets the contact of the tip with a scale, or removes it if `touch` is `None`.
    fn set_touch(&self, state: &mut SkinState, scale: i64, touch: Option<TipContact>) {
        let slot = (scale + self.reach() as i64) as usize;
        if touch.is_none() && self.has_friction() {
            self.end_sliding(state, slot);
            state.z[self.normal_force(slot) + 1] = 0.0;
        }
        state.mode.needle.tip_contacts[slot] = touch;
        state.active[self.number(slot, NORMAL)] = touch.is_some();
    }
}

impl Chain {
    /// Computes the centre of the tip at rest, for a circle lowered until it touches.
    ///
    /// A tip that fits between two scales rests on the soft surface between their bases. `x` and
    /// the result are relative to the node of the punctured scale.
    pub(in crate::puncture) fn centre_at_rest(&self, needle: &GuidedNeedle, x: f64) -> Vec2 {
        let mut highest = needle.radius;
        for (_, scale) in needle.scales() {
            let Some(number) = self.scale_numbered(scale) else { continue };
            let frame = self.frame_from_punctured(number);
            for part in FACES {
                let face = Face::new(&self.contacts.arrangement.scale(number), part);
                let face = Face {
                    origin: frame.outward(face.origin),
                    along: frame.outward(face.along),
                    ..face
                };
                let above_node = height_above(&face, x - frame.origin.x, needle.radius);
                highest = highest.max(frame.origin.y + above_node);
            }
        }
        Vec2::new(x, highest)
    }

    /// Finds the outline part of a scale nearest to the centre of the tip, and its distance.
    ///
    /// The distance is negative if the centre lies inside the scale.
    fn nearest(&self, z: &[f64], scale: i64) -> Option<(OutlinePart, f64)> {
        let [left, top, right] = FACES.map(|part| self.tip(z, scale, part));
        let faces = [left?, top?, right?];
        let parts = || FACES.into_iter().zip(&faces);
        let [left, top, _] = &faces;
        // A centre below the base line is not inside the scale. On a convex body this happens for
        // scales far away from the tip.
        let is_above_base = left.to_end(0.0).dot(&top.normal()) <= 0.0;
        if is_above_base && faces.iter().all(|face| face.gap < 0.0) {
            // Inside the scale, the nearest face has the least negative gap.
            let gaps = parts().map(|(part, face)| (part, face.gap));
            return gaps.reduce(|a, b| if b.1 > a.1 { b } else { a });
        }
        // If the perpendicular from the centre meets a face, this face is the nearest part of a
        // convex outline. Comparing distances would not be exact: near a corner the distances of
        // face and corner differ only by the square of a small length.
        let opposite =
            parts().find(|(_, face)| face.gap >= 0.0 && (0.0..=face.length).contains(&face.xi));
        if let Some((part, face)) = opposite {
            return Some((part, face.gap));
        }
        let distances = parts().map(|(part, face)| {
            let beyond = face.xi - face.xi.clamp(0.0, face.length);
            // Only the top corners are parts of the outline. A foot belongs to its side face.
            let at_end = match (part, beyond) {
                (OutlinePart::Top, ..0.0) => OutlinePart::TopLeft,
                (OutlinePart::Left, 0.0..) if beyond > 0.0 => OutlinePart::TopLeft,
                (OutlinePart::Right, ..0.0) => OutlinePart::TopRight,
                (OutlinePart::Top, 0.0..) if beyond > 0.0 => OutlinePart::TopRight,
                _ => part,
            };
            (at_end, face.gap.hypot(beyond))
        });
        distances.reduce(|a, b| if b.1 < a.1 { b } else { a })
    }

    /// Returns the state at rest with the tip contacts that carry force when the load begins.
    pub(super) fn round_at_rest(&self, needle: &GuidedNeedle, mut rest: SkinState) -> SkinState {
        for (_, scale) in needle.scales() {
            let nearest = self.nearest(&rest.z, scale);
            if nearest.is_some_and(|(_, distance)| distance < needle.radius + AT_REST) {
                let touch = self.round_touch(needle, &rest.z, scale);
                needle.set_touch(&mut rest, scale, touch);
            }
        }
        let control = self.controls[0];
        let condition = Condition::new(vec![(control.index, 1.0 / control.scale)], 0.0);
        for _ in 0..SETTLES {
            let Ok(rates) = Newton::new(self).tangent(self, &rest, &condition) else { return rest };
            let largest = rates.iter().fold(f64::MIN_POSITIVE, |max, x| max.max(x.abs()));
            // A tip at the end of a face moves on to the corner or back on the face. Both outline
            // parts have the same rates at rest, so a small step along these rates decides.
            let ahead = rest.moved(STEP / largest, &rates);
            let before = rest.clone();
            for (slot, touch) in before.mode.needle.all() {
                let [normal_force, tangential_force] =
                    [0, 1].map(|k| rates[needle.normal_force(slot) + k]);
                // Remove contacts with a tensile normal force.
                if normal_force <= 0.0 {
                    needle.set_touch(&mut rest, touch.scale, None);
                    continue;
                }
                if let Some((part, _)) = self.nearest(&ahead.z, touch.scale) {
                    needle.set_touch(&mut rest, touch.scale, Some(TipContact { part, ..*touch }));
                }
                if let TipState::Stick { anchor } = touch.tip_state
                    && tangential_force.abs() > needle.friction * normal_force
                {
                    needle.slide(&mut rest, slot, tangential_force > 0.0, anchor);
                }
            }
            if rest.active == before.active {
                break;
            }
        }
        rest
    }

    /// Creates the contact of a round tip with the nearest part of a scale, without sliding.
    fn round_touch(&self, needle: &GuidedNeedle, z: &[f64], scale: i64) -> Option<TipContact> {
        let (part, _) = self.nearest(z, scale)?;
        let at =
            if needle.has_friction() { self.tip_kinematics(z, scale, part)?.xi() } else { 0.0 };
        Some(TipContact { scale, part, tip_state: needle.resting(at) })
    }

    /// Sets the `values` of the conditions of a round tip.
    pub(super) fn round_conditions(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        values: &mut [f64],
    ) {
        let through = needle.tilt_number() + 1;
        for (slot, scale) in needle.scales() {
            let conditions =
                &mut values[needle.constraints_per_touch * slot..][..needle.constraints_per_touch];
            if state.mode.needle.tip_contacts[slot].is_none() {
                let nearest = self.nearest(&state.z, scale);
                conditions[NORMAL] =
                    nearest.map_or(SATISFIED, |(_, distance)| distance - needle.radius);
            }
        }
        for (slot, touch, _, kinematics) in self.tip_contacts(state) {
            let conditions =
                &mut values[needle.constraints_per_touch * slot..][..needle.constraints_per_touch];
            conditions[NORMAL] = kinematics.gap();
            let [before, after] = self.to_ends(state, touch.scale, touch.part);
            // One condition covers both ends of the outline part. The transition determines which
            // end was reached.
            conditions[needle.constraints_per_touch - 1] = before.min(after);
            if needle.has_friction() {
                needle.stick_slip_conditions(state, slot, touch, &kinematics, conditions);
            }
        }
        values[through] = values[through].min(self.above_surface(needle, state));
    }

    /// Computes the distances of the tip from the start and the end of its outline part.
    ///
    /// A foot of the scale does not count as an end; its entry is [`SATISFIED`].
    fn to_ends(&self, state: &SkinState, scale: i64, part: OutlinePart) -> [f64; 2] {
        let seen = |part: OutlinePart| self.tip(&state.z, scale, part);
        let is_corner = !FACES.contains(&part);
        [false, true].map(|onward| {
            let face = part.next(onward).and_then(|next| seen(if is_corner { next } else { part }));
            let Some(face) = face else { return SATISFIED };
            // The part before a corner ends at the corner; the part after it starts at the corner.
            let inside = if is_corner == onward { face.xi } else { face.length - face.xi };
            if is_corner { -inside } else { inside }
        })
    }

    /// Computes the smallest distance of the circle from the soft surface between two bases.
    ///
    /// The surface is the straight line from the right foot of a scale to the left foot of the next
    /// one.
    fn above_surface(&self, needle: &GuidedNeedle, state: &SkinState) -> f64 {
        let mut least = SATISFIED;
        for (_, scale) in needle.scales() {
            let foot = |scale: i64, part: OutlinePart, at_end: bool| {
                let tip = self.tip(&state.z, scale, part)?;
                let frame = self.frame_from_punctured(self.scale_numbered(scale)?);
                Some(frame.outward(tip.to_end(if at_end { tip.length } else { 0.0 })))
            };
            let from = foot(scale, OutlinePart::Right, true);
            let to = foot(scale + 1, OutlinePart::Left, false);
            let (Some(from), Some(to)) = (from, to) else { continue };
            let along = to - from;
            let fraction = (-from.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            least = least.min((from + fraction * along).norm() - needle.radius);
        }
        least
    }

    /// Moves a round tip to another outline part, or adds or removes its contact with a scale.
    ///
    /// Returns the constraint that must hold on the outgoing branch; `None` without a next state.
    pub(super) fn round_transition(
        &self,
        needle: &GuidedNeedle,
        state: &mut SkinState,
        change: Change,
    ) -> Option<usize> {
        let number = change.constraint - needle.contacts;
        let slot = number / needle.constraints_per_touch;
        let scale = slot as i64 - needle.reach() as i64;
        if number % needle.constraints_per_touch == needle.constraints_per_touch - 1 {
            // This constraint has no force and never becomes active.
            state.active[change.constraint] = false;
            let part = state.mode.needle.tip_contacts[slot]?.part;
            let [before, after] = self.to_ends(state, scale, part);
            // The tip has reached the nearer end.
            let next = part.next(after < before)?;
            // Slip coordinate and forces are continuous, so only the part changes.
            state.mode.needle.tip_contacts[slot].as_mut()?.part = next;
        } else {
            let touch = self.round_touch(needle, &state.z, scale);
            needle.set_touch(state, scale, touch.filter(|_| change.activated));
        }
        Some(change.constraint)
    }

    /// Returns the normal forces of a round tip, in units of `F*`.
    ///
    /// `None` for other needles, and if less than the whole path is recorded.
    pub(in crate::puncture) fn tip_forces(&self, state: &SkinState) -> Option<TipForces> {
        let needle =
            self.needle.as_ref().filter(|needle| self.is_recorded_whole() && needle.is_round())?;
        Some(
            state
                .mode
                .needle
                .all()
                .map(|(slot, touch)| {
                    (touch.scale, state.z[needle.normal_force(slot)] / self.length)
                })
                .collect(),
        )
    }
}

/// Computes the height of the centre of a circle that rests on a face or on an end of the face.
///
/// The centre is at `x`. Its height is −∞ if the circle passes beside the face.
fn height_above(face: &Face, x: f64, radius: f64) -> f64 {
    let normal = Vec2::new(-face.along.y, face.along.x);
    let on_face = face.origin.y + (radius - (x - face.origin.x) * normal.x) / normal.y;
    let xi = (Vec2::new(x, on_face) - face.origin).dot(&face.along);
    // A downward-facing face does not support a circle from above.
    if normal.y > 0.0 && (0.0..=face.length).contains(&xi) {
        return on_face;
    }
    let ends = [face.origin, face.origin + face.length * face.along];
    let above = ends.map(|end| {
        let height = (radius.powi(2) - (x - end.x).powi(2)).sqrt();
        // The circle passes an end that lies beside the centre by more than the radius.
        if height.is_nan() { f64::NEG_INFINITY } else { end.y + height }
    });
    above[0].max(above[1])
}
