//! A needle with a round tip: a circle that is guided straight down and touches faces and corners of all scales that it reaches.
//!
//! A scale is convex, so a circle touches it at one place at most. Without friction that is one normal force for each scale in reach, and
//! faces and corners go over into each other smoothly: the mode only says of which the second derivatives are.

use geometry::Vec2;
use solver::{Change, Condition, Newton, Residual, Tangent};

use super::GuidedNeedle;
use super::forces::{STEP, add_row};
use super::mode::Place;
use super::outline::{COORDINATES, Face, TURN, Tip};
use super::passage::TipForces;
use crate::contacts::{HOLDS, SkinState};
use crate::puncture::system::Chain;

/// Scales on each side of the punctured one that a round tip may come to.
pub(crate) const FARTHEST_TOUCH: usize = 16;

/// Those that it may come to besides the ones below it at rest, since rows are pushed along.
const PUSHED_ALONG: usize = 2;

/// Scales that are touched at rest differ in their gaps by round-off.
const AT_REST: f64 = 1e-10;

const FACES: [Place; 3] = [Place::Left, Place::Top, Place::Right];

/// Scales on each side of the punctured one that a round tip may come to on a row of this pitch; `None` if they are too many.
pub(in crate::puncture) fn reach(radius: f64, pitch: f64) -> Option<usize> {
    let reach = (radius / pitch).ceil() as usize + PUSHED_ALONG;
    (reach <= FARTHEST_TOUCH).then_some(reach)
}

/// Unknowns of a round tip: its depth, a normal force and a condition on the place for each scale in reach, and what ends the path.
pub(in crate::puncture) fn unknowns(reach: usize) -> usize {
    1 + 2 * (2 * reach + 1) + 2
}

/// The centre of a tip, seen from the place of a scale that is nearest to it.
struct Nearest {
    tip: Tip,
    /// Of a corner.
    is_corner: bool,
}

impl Nearest {
    /// Second derivatives of `−N g` (L8).
    fn curvature(&self, push: f64) -> [[f64; COORDINATES]; COORDINATES] {
        if !self.is_corner {
            return self.tip.curvature([push, 0.0]);
        }
        let mut along = self.tip.way_slopes();
        along[TURN] -= self.tip.gap;
        let mut curvature = along.map(|a| along.map(|b| -push * a * b / self.tip.gap));
        curvature[TURN][TURN] -= push * along[TURN];
        curvature
    }
}

impl GuidedNeedle {
    /// Scales on each side of the punctured one that the tip may come to.
    pub(super) fn reach(&self) -> usize {
        (self.unknowns - unknowns(0)) / (unknowns(1) - unknowns(0))
    }

    /// Scales that a round tip may come to, by their slot and as they are counted from the punctured one.
    fn slots(&self) -> impl Iterator<Item = (usize, i64)> + use<> {
        let reach = self.reach() as i64;
        (-reach..=reach).enumerate()
    }

    /// Unknown of the normal force on the scale of a slot.
    fn normal_force(&self, slot: usize) -> usize {
        self.depth + 1 + 2 * slot
    }

    /// Lets the tip touch the scale of a slot at a place, or let go of it.
    fn touch(&self, state: &mut SkinState, slot: usize, place: Option<Place>) {
        state.mode.needle.set_place(slot as i64 - self.reach() as i64, place);
        state.active[self.contacts + 2 * slot] = place.is_some();
    }

    /// Number of the condition on tilts among those of the needle; that of coming through is the next.
    pub(super) fn tilt_number(&self) -> usize {
        self.unknowns - 3
    }
}

impl Chain {
    /// The centre of the tip at rest, from the node of the punctured scale: where the circle comes to rest on the row, coming from above.
    pub(in crate::puncture) fn centre_at_rest(&self, needle: &GuidedNeedle, x: f64) -> Vec2 {
        let mut highest = f64::NEG_INFINITY;
        for (_, scale) in needle.slots() {
            let Some(number) = self.scale_numbered(scale) else { continue };
            let away = self.contacts.place(number) - self.contacts.place(self.layout.left);
            for place in FACES {
                let face = Face::new(&self.contacts.scale(number), place);
                highest = highest.max(height_above(&face, x - away, needle.radius));
            }
        }
        Vec2::new(x, highest)
    }

    /// The tip at a place of a scale, a gap of 0 where its centre is there.
    fn seen_from(&self, z: &[f64], scale: i64, place: Place) -> Option<Nearest> {
        let tip = self.tip(z, scale, place)?;
        let is_corner = tip.length == 0.0;
        Some(Nearest { tip: if is_corner { tip.at_corner() } else { tip }, is_corner })
    }

    /// The place of a scale that is nearest to the centre of the tip, and its distance; negative within the scale.
    fn nearest(&self, z: &[f64], scale: i64) -> Option<(Place, f64)> {
        let [left, top, right] = FACES.map(|place| self.tip(z, scale, place));
        let faces = [left?, top?, right?];
        let places = || FACES.into_iter().zip(&faces);
        if faces.iter().all(|face| face.gap < 0.0) {
            // The nearest face is the one that the centre is the least behind.
            let gaps = places().map(|(place, face)| (place, face.gap));
            return gaps.reduce(|a, b| if b.1 > a.1 { b } else { a });
        }
        let distances = places().map(|(place, face)| {
            let beyond = face.way - face.way.clamp(0.0, face.length);
            let at_end = match (place, beyond) {
                (Place::Top, ..0.0) => Place::TopLeft,
                (Place::Left, 0.0..) if beyond > 0.0 => Place::TopLeft,
                (Place::Right, ..0.0) => Place::TopRight,
                (Place::Top, 0.0..) if beyond > 0.0 => Place::TopRight,
                _ => place,
            };
            (at_end, face.gap.hypot(beyond))
        });
        distances.reduce(|a, b| if b.1 < a.1 { b } else { a })
    }

    /// The state of rest, with the scales that the tip stands on.
    pub(super) fn round_at_rest(&self, needle: &GuidedNeedle, mut rest: SkinState) -> SkinState {
        for (slot, scale) in needle.slots() {
            let Some((place, distance)) = self.nearest(&rest.z, scale) else { continue };
            if distance < needle.radius + AT_REST {
                needle.touch(&mut rest, slot, Some(place));
            }
        }
        let control = self.controls[0];
        let condition = Condition::new(vec![(control.index, 1.0 / control.scale)], 0.0);
        let Ok(rates) = Newton::new(self).tangent(self, &rest, &condition) else { return rest };
        let largest = rates.iter().fold(f64::MIN_POSITIVE, |max, x| max.max(x.abs()));
        // At the end of a face the tip goes on to the corner or back on the face: without forces both have the same rates, which say it.
        let ahead = rest.moved(STEP / largest, &rates);
        for (slot, scale) in needle.slots() {
            if rest.mode.needle.place(scale).is_some() {
                let is_pushed = rates[needle.normal_force(slot)] > 0.0;
                let place = self.nearest(&ahead.z, scale).map(|(place, _)| place);
                needle.touch(&mut rest, slot, place.filter(|_| is_pushed));
            }
        }
        rest
    }

    /// The scales that a round tip touches: slot, index, and the tip seen from there.
    fn touched(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
    ) -> impl Iterator<Item = (usize, usize, Nearest)> {
        needle.slots().filter_map(|(slot, scale)| {
            let place = state.mode.needle.place(scale)?;
            Some((slot, self.scale_numbered(scale)?, self.seen_from(&state.z, scale, place)?))
        })
    }

    /// Adds the equations of a round tip: the balances and the gaps that are closed.
    pub(super) fn add_round(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        residual: &mut Residual,
        matrix: &mut impl Tangent,
    ) {
        for (slot, scale, nearest) in self.touched(needle, state) {
            let at = self.layout.scale(scale);
            let rows = [at, at + 1, at + 2, needle.depth];
            let push = needle.normal_force(slot);
            let slopes = nearest.tip.gap_slopes();
            let curvature = nearest.curvature(state.z[push]);
            for (i, row) in rows.into_iter().enumerate() {
                // The balance of the needle has the other sign.
                let sign = if i + 1 == COORDINATES { -1.0 } else { 1.0 };
                residual.add(row, -sign * state.z[push] * slopes[i]);
                add_row(row, rows, sign, curvature[i], matrix);
                matrix.add(row, push, -sign * slopes[i]);
            }
            residual.add(push, nearest.tip.gap - needle.radius);
            add_row(push, rows, 1.0, slopes, matrix);
        }
    }

    /// Writes the conditions of the constraints of a round tip.
    pub(super) fn round_conditions(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        values: &mut [f64],
    ) {
        let (tilt, through) = (needle.tilt_number(), needle.tilt_number() + 1);
        for (slot, scale) in needle.slots() {
            let Some(place) = state.mode.needle.place(scale) else {
                let distance = self.nearest(&state.z, scale).map(|(_, distance)| distance);
                values[2 * slot] = distance.map_or(HOLDS, |distance| distance - needle.radius);
                continue;
            };
            let Some(number) = self.scale_numbered(scale) else { continue };
            let [before, after] = self.to_ends(state, scale, place);
            let nearest = self.seen_from(&state.z, scale, place);
            values[2 * slot] = nearest.map_or(HOLDS, |nearest| nearest.tip.gap - needle.radius);
            values[2 * slot + 1] = before.min(after);
            let [_, _, rotation] = self.displacement(&state.z, number);
            values[tilt] = values[tilt].min(needle.critical_tilt - rotation.abs());
            let tip = self.tip(&state.z, scale, place);
            let to_foot = match (place, tip) {
                (Place::Left, Some(tip)) => tip.way,
                (Place::Right, Some(tip)) => tip.length - tip.way,
                _ => HOLDS,
            };
            values[through] = values[through].min(to_foot);
        }
        values[through] = values[through].min(self.above_surface(needle, state));
    }

    /// How far a tip is from the two ends of the place at which it touches a scale; feet are no ends.
    fn to_ends(&self, state: &SkinState, scale: i64, place: Place) -> [f64; 2] {
        let seen = |place: Place| self.tip(&state.z, scale, place);
        let is_corner = !FACES.contains(&place);
        [false, true].map(|onward| {
            let face =
                place.next(onward).and_then(|next| seen(if is_corner { next } else { place }));
            let Some(face) = face else { return HOLDS };
            // A corner lies at the end of the face before it, and at the beginning of that behind it.
            let inside = if is_corner == onward { face.way } else { face.length - face.way };
            if is_corner { -inside } else { inside }
        })
    }

    /// Distance of the circle from the soft surface between two bases, which is straight from corner to corner.
    fn above_surface(&self, needle: &GuidedNeedle, state: &SkinState) -> f64 {
        let mut least = HOLDS;
        for (_, scale) in needle.slots() {
            let foot = |scale: i64, place: Place, at_end: bool| {
                let tip = self.tip(&state.z, scale, place)?;
                Some(tip.to_end(if at_end { tip.length } else { 0.0 }))
            };
            let from = foot(scale, Place::Right, true);
            let to = foot(scale + 1, Place::Left, false);
            let (Some(from), Some(to)) = (from, to) else { continue };
            let along = to - from;
            let part = (-from.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            least = least.min((from + part * along).norm() - needle.radius);
        }
        least
    }

    /// Takes a round tip to its next mode.
    pub(super) fn round_transition(
        &self,
        needle: &GuidedNeedle,
        state: &mut SkinState,
        change: Change,
    ) -> Option<usize> {
        let number = change.constraint - needle.contacts;
        let (slot, of_place) = (number / 2, number % 2 == 1);
        if number >= needle.tilt_number() {
            return None;
        }
        let scale = slot as i64 - needle.reach() as i64;
        if of_place {
            // It has no force: it never acts.
            state.active[change.constraint] = false;
            let place = state.mode.needle.place(scale)?;
            let [before, after] = self.to_ends(state, scale, place);
            needle.touch(state, slot, place.next(after < before));
        } else {
            let place = self.nearest(&state.z, scale).map(|(place, _)| place);
            needle.touch(state, slot, place.filter(|_| change.activated));
        }
        Some(change.constraint)
    }

    /// The unknowns of a round tip in its stiffness.
    pub(super) fn round_in_stiffness(needle: &GuidedNeedle, state: &SkinState) -> Vec<usize> {
        let touched = needle.slots().filter(|(_, scale)| state.mode.needle.place(*scale).is_some());
        let forces = touched.map(|(slot, _)| needle.normal_force(slot));
        std::iter::once(needle.depth).chain(forces).collect()
    }

    /// Shows every entry of the stiffness of a round tip: second derivatives of `−N g`, with `N` as unknowns.
    pub(super) fn for_round_stiffness(
        &self,
        needle: &GuidedNeedle,
        state: &SkinState,
        mut entry: impl FnMut(usize, usize, f64),
    ) {
        for (slot, scale, nearest) in self.touched(needle, state) {
            let at = self.layout.scale(scale);
            let unknowns = [at, at + 1, at + 2, needle.depth];
            let push = needle.normal_force(slot);
            let curvature = nearest.curvature(state.z[push]);
            for (i, (row, slope)) in unknowns.into_iter().zip(nearest.tip.gap_slopes()).enumerate()
            {
                for (column, value) in unknowns.into_iter().zip(curvature[i]) {
                    entry(row, column, value);
                }
                entry(row, push, -slope);
                entry(push, row, -slope);
            }
        }
    }

    /// The normal forces of a round tip; `None` of another needle, and unless the whole path is noted.
    pub(in crate::puncture) fn tip_forces(&self, state: &SkinState) -> Option<TipForces> {
        let needle = self.needle.as_ref().filter(|needle| self.whole_path && needle.is_round())?;
        let touched = needle.slots().filter(|(_, scale)| state.mode.needle.place(*scale).is_some());
        let of = |(slot, scale)| (scale, state.z[needle.normal_force(slot)] / self.length);
        Some(touched.map(of).collect())
    }

    /// Force of a round tip on the scales along the row, to the right.
    pub(super) fn round_lateral_force(&self, needle: &GuidedNeedle, state: &SkinState) -> f64 {
        let touched = self.touched(needle, state);
        let lateral = |(slot, _, nearest): (usize, usize, Nearest)| {
            nearest.tip.force([state.z[needle.normal_force(slot)], 0.0]).x
        };
        touched.map(lateral).sum()
    }
}

/// Height of the centre of a circle of this radius that rests on a face, or on one of its ends, at `x` in the frame of the scale.
fn height_above(face: &Face, x: f64, radius: f64) -> f64 {
    let normal = Vec2::new(-face.along.y, face.along.x);
    let on_face = face.origin.y + (radius - (x - face.origin.x) * normal.x) / normal.y;
    let way = (Vec2::new(x, on_face) - face.origin).dot(&face.along);
    if normal.y > 0.0 && (0.0..=face.length).contains(&way) {
        return on_face;
    }
    let ends = [face.origin, face.origin + face.length * face.along];
    let above = ends.map(|end| {
        let height = (radius.powi(2) - (x - end.x).powi(2)).sqrt();
        if height.is_nan() { f64::NEG_INFINITY } else { end.y + height }
    });
    above[0].max(above[1])
}
