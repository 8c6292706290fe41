//! A needle with a round tip: a circle that is guided straight down and touches faces and corners of all scales that it reaches.
//!
//! A scale is convex, so a circle touches it at one place at most: there is one normal force for each scale in reach. Faces and corners go
//! over into each other smoothly: the mode only says of which the second derivatives are. With friction the circle sticks or slides at each
//! scale by itself, as a sharp tip does, along a way that goes on from face to corner (L9).

use geometry::Vec2;
use solver::{Change, Condition, Newton};

use super::forces::STEP;
use super::mode::{OutlinePart, TipState, Touch};
use super::outline::Face;
use super::passage::TipForces;
use super::{ENDINGS, GuidedNeedle, NORMAL};
use crate::contacts::{HOLDS, SkinState};
use crate::puncture::system::Chain;

/// Scales on each side of the punctured one that a round tip may come to.
pub(crate) const FARTHEST_TOUCH: usize = 64;

/// Those that it may come to besides the ones below it at rest, since rows are pushed along.
const PUSHED_ALONG: usize = 2;

/// Scales that are touched at rest differ in their gaps by round-off.
const AT_REST: f64 = 1e-10;

/// Set down on two scales a tip is on one of them alone, sticks or slides, after fewer trials than this.
const SETTLES: usize = 8;

const FACES: [OutlinePart; 3] = [OutlinePart::Left, OutlinePart::Top, OutlinePart::Right];

/// Scales on each side of the punctured one that a round tip may come to on a row of this pitch; `None` if they are too many.
pub(in crate::puncture) fn reach(radius: f64, pitch: f64) -> Option<usize> {
    let reach = (radius / pitch).ceil() as usize + PUSHED_ALONG;
    (reach <= FARTHEST_TOUCH).then_some(reach)
}

/// Unknowns of a round tip for each scale in reach: a normal force and a condition on the place; between them, of one that rubs, the
/// tangential force and the ways slid forward and backward.
pub(super) fn of_scale(rubs: bool) -> usize {
    if rubs { 5 } else { 2 }
}

/// Unknowns of a round tip: its depth, those for each scale in reach, and what ends the path.
pub(in crate::puncture) fn unknowns(reach: usize, rubs: bool) -> usize {
    1 + of_scale(rubs) * (2 * reach + 1) + ENDINGS
}

impl GuidedNeedle {
    /// Scales on each side of the punctured one that the tip may come to.
    pub(super) fn reach(&self) -> usize {
        self.slots / 2
    }

    /// Scales that a round tip may come to, by their slot and as they are counted from the punctured one.
    fn scales(&self) -> impl Iterator<Item = (usize, i64)> + use<> {
        let reach = self.reach() as i64;
        (-reach..=reach).enumerate()
    }

    /// Lets the tip touch a scale, or let go of it.
    fn set_touch(&self, state: &mut SkinState, scale: i64, touch: Option<Touch>) {
        let slot = (scale + self.reach() as i64) as usize;
        if touch.is_none() && self.has_friction() {
            self.end_sliding(state, slot);
            state.z[self.normal_force(slot) + 1] = 0.0;
        }
        state.mode.needle.touches[slot] = touch;
        state.active[self.number(slot, NORMAL)] = touch.is_some();
    }
}

impl Chain {
    /// The centre of the tip at rest, from the node of the punctured scale: where the circle comes to rest on the row, coming from above.
    pub(in crate::puncture) fn centre_at_rest(&self, needle: &GuidedNeedle, x: f64) -> Vec2 {
        let mut highest = f64::NEG_INFINITY;
        for (_, scale) in needle.scales() {
            let Some(number) = self.scale_numbered(scale) else { continue };
            let away = self.contacts.arrangement.place(number)
                - self.contacts.arrangement.place(self.layout.left);
            for place in FACES {
                let face = Face::new(&self.contacts.arrangement.scale(number), place);
                highest = highest.max(height_above(&face, x - away, needle.radius));
            }
        }
        Vec2::new(x, highest)
    }

    /// The place of a scale that is nearest to the centre of the tip, and its distance; negative within the scale.
    fn nearest(&self, z: &[f64], scale: i64) -> Option<(OutlinePart, f64)> {
        let [left, top, right] = FACES.map(|place| self.tip(z, scale, place));
        let faces = [left?, top?, right?];
        let places = || FACES.into_iter().zip(&faces);
        if faces.iter().all(|face| face.gap < 0.0) {
            // The nearest face is the one that the centre is the least behind.
            let gaps = places().map(|(place, face)| (place, face.gap));
            return gaps.reduce(|a, b| if b.1 > a.1 { b } else { a });
        }
        let distances = places().map(|(place, face)| {
            let beyond = face.xi - face.xi.clamp(0.0, face.length);
            // Only beyond a top corner the outline goes on: below the bases there is no model.
            let at_end = match (place, beyond) {
                (OutlinePart::Top, ..0.0) => OutlinePart::TopLeft,
                (OutlinePart::Left, 0.0..) if beyond > 0.0 => OutlinePart::TopLeft,
                (OutlinePart::Right, ..0.0) => OutlinePart::TopRight,
                (OutlinePart::Top, 0.0..) if beyond > 0.0 => OutlinePart::TopRight,
                _ => place,
            };
            (at_end, face.gap.hypot(beyond))
        });
        distances.reduce(|a, b| if b.1 < a.1 { b } else { a })
    }

    /// The state of rest, with the scales that the tip stands on.
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
            // At the end of a face the tip goes on to the corner or back on the face: without forces both have the same rates, which say it.
            let ahead = rest.moved(STEP / largest, &rates);
            let before = rest.clone();
            for (slot, touch) in before.mode.needle.all() {
                let [normal_force, tangential_force] =
                    [0, 1].map(|k| rates[needle.normal_force(slot) + k]);
                // A touch that would have to pull is none.
                if normal_force <= 0.0 {
                    needle.set_touch(&mut rest, touch.scale, None);
                    continue;
                }
                if let Some((place, _)) = self.nearest(&ahead.z, touch.scale) {
                    needle.set_touch(&mut rest, touch.scale, Some(Touch { place, ..*touch }));
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

    /// A round tip that has come to rest on the nearest place of a scale.
    fn round_touch(&self, needle: &GuidedNeedle, z: &[f64], scale: i64) -> Option<Touch> {
        let (place, _) = self.nearest(z, scale)?;
        let at = if needle.has_friction() { self.meeting(z, scale, place)?.xi() } else { 0.0 };
        Some(Touch { scale, place, tip_state: needle.resting(at) })
    }

    /// Writes the conditions of the constraints of a round tip.
    pub(super) fn round_conditions(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        values: &mut [f64],
    ) {
        let through = needle.tilt_number() + 1;
        for (slot, scale) in needle.scales() {
            let of_scale =
                &mut values[needle.constraints_per_touch * slot..][..needle.constraints_per_touch];
            if state.mode.needle.touches[slot].is_none() {
                let nearest = self.nearest(&state.z, scale);
                of_scale[NORMAL] = nearest.map_or(HOLDS, |(_, distance)| distance - needle.radius);
            }
        }
        for (slot, touch, _, meeting) in self.touches(state) {
            let of_scale =
                &mut values[needle.constraints_per_touch * slot..][..needle.constraints_per_touch];
            of_scale[NORMAL] = meeting.gap();
            let [before, after] = self.to_ends(state, touch.scale, touch.place);
            // One condition serves both ends: which one has come is asked at the event.
            of_scale[needle.constraints_per_touch - 1] = before.min(after);
            if needle.has_friction() {
                needle.stick_slip_conditions(state, slot, touch, &meeting, of_scale);
            }
        }
        values[through] = values[through].min(self.above_surface(needle, state));
    }

    /// How far a tip is from the two ends of the place at which it touches a scale; feet are no ends.
    fn to_ends(&self, state: &SkinState, scale: i64, place: OutlinePart) -> [f64; 2] {
        let seen = |place: OutlinePart| self.tip(&state.z, scale, place);
        let is_corner = !FACES.contains(&place);
        [false, true].map(|onward| {
            let face =
                place.next(onward).and_then(|next| seen(if is_corner { next } else { place }));
            let Some(face) = face else { return HOLDS };
            // A corner lies at the end of the face before it, and at the beginning of that behind it.
            let inside = if is_corner == onward { face.xi } else { face.length - face.xi };
            if is_corner { -inside } else { inside }
        })
    }

    /// Distance of the circle from the soft surface between two bases, which is straight from corner to corner.
    fn above_surface(&self, needle: &GuidedNeedle, state: &SkinState) -> f64 {
        let mut least = HOLDS;
        for (_, scale) in needle.scales() {
            let foot = |scale: i64, place: OutlinePart, at_end: bool| {
                let tip = self.tip(&state.z, scale, place)?;
                Some(tip.to_end(if at_end { tip.length } else { 0.0 }))
            };
            let from = foot(scale, OutlinePart::Right, true);
            let to = foot(scale + 1, OutlinePart::Left, false);
            let (Some(from), Some(to)) = (from, to) else { continue };
            let along = to - from;
            let part = (-from.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            least = least.min((from + part * along).norm() - needle.radius);
        }
        least
    }

    /// Takes a round tip to another place or scale.
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
            // It has no force: it never acts.
            state.active[change.constraint] = false;
            let place = state.mode.needle.touches[slot]?.place;
            let [before, after] = self.to_ends(state, scale, place);
            // The end that has come is the nearer one.
            let next = place.next(after < before)?;
            // The way goes on without a step, and the force with it.
            state.mode.needle.touches[slot].as_mut()?.place = next;
        } else {
            let touch = self.round_touch(needle, &state.z, scale);
            needle.set_touch(state, scale, touch.filter(|_| change.activated));
        }
        Some(change.constraint)
    }

    /// The normal forces of a round tip; `None` of another needle, and unless the whole path is noted.
    pub(in crate::puncture) fn tip_forces(&self, state: &SkinState) -> Option<TipForces> {
        let needle = self.needle.as_ref().filter(|needle| self.whole_path && needle.is_round())?;
        let of = |(slot, touch): (usize, &Touch)| {
            (touch.scale, state.z[needle.normal_force(slot)] / self.length)
        };
        Some(state.mode.needle.all().map(of).collect())
    }
}

/// Height of the centre of a circle of this radius that rests on a face, or on one of its ends, at `x` in the frame of the scale.
fn height_above(face: &Face, x: f64, radius: f64) -> f64 {
    let normal = Vec2::new(-face.along.y, face.along.x);
    let on_face = face.origin.y + (radius - (x - face.origin.x) * normal.x) / normal.y;
    let xi = (Vec2::new(x, on_face) - face.origin).dot(&face.along);
    // A face that looks down holds nothing that comes from above.
    if normal.y > 0.0 && (0.0..=face.length).contains(&xi) {
        return on_face;
    }
    let ends = [face.origin, face.origin + face.length * face.along];
    let above = ends.map(|end| {
        let height = (radius.powi(2) - (x - end.x).powi(2)).sqrt();
        // Farther beside an end than its radius, the circle passes it.
        if height.is_nan() { f64::NEG_INFINITY } else { end.y + height }
    });
    above[0].max(above[1])
}
