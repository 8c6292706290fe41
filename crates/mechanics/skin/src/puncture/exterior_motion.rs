//! Motion of the scales beyond the solved part of a row, and extent of contact towards its ends.

use substrate::SurfaceStrip;

use super::row_exterior::{ExteriorSide, mirrored};
use super::system::Chain;
use crate::contacts::SkinState;

/// Largest accepted difference between the forces of a neo-Hookean bar and of a linear spring.
///
/// Beyond the solved part, linear springs replace the bars. The difference is divided by the
/// stiffness `a α_x` of a scale, so it is a displacement in units of `t`.
const AS_SPRINGS: f64 = 1e-9;

/// Fraction of a clearance beyond an end that may close before the row is extended.
///
/// From 1 on, scales may touch, and the step is repeated on the longer row.
const EARLY: f64 = 0.5;

/// Extent of contact towards one end of the solved part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reach {
    /// The end scale is free of contact, and clearances beyond it are less than half closed.
    Short,
    /// The end scale is in contact, or a clearance beyond it may be half closed.
    Near,
    /// A clearance beyond the end scale may be closed completely.
    Beyond,
}

impl Chain {
    /// Counts the scales of a finite row, or the solved scales of a row without ends.
    pub(super) fn row_length(&self) -> usize {
        let [left, right] = self.exterior.scales_to_ends();
        left + self.layout.scales() + right
    }

    /// Returns a function that gives the displacement of solved scale `k`, counted from an end.
    ///
    /// `side` 0 is the left end, 1 the right end. Displacements at the left end are mirrored, so
    /// that they have the signs of a right end.
    fn displacement_from_end<'a>(
        &'a self,
        z: &'a [f64],
        side: usize,
    ) -> impl Fn(usize) -> [f64; 3] + 'a {
        let last = self.layout.scales() - 1;
        move |k| mirrored(self.displacement(z, if side == 0 { k } else { last - k }), side)
    }

    /// Computes the displacements of the end scale and of the checked scales beyond it.
    ///
    /// Displacements at the left end (`side_index` 0) are mirrored to the signs of a right end.
    fn displacements_beyond(
        &self,
        z: &[f64],
        side_index: usize,
        side: &ExteriorSide,
    ) -> Vec<[f64; 3]> {
        let end = self.displacement_from_end(z, side_index);
        let mut displacements = vec![end(0)];
        displacements.extend(side.beyond.far.displacements(end, side.gaps.len()));
        displacements
    }

    /// Computes the displacement of a scale that may lie beyond the solved part.
    ///
    /// `scale` 0 is the first solved scale.
    pub(crate) fn displacement_anywhere(&self, z: &[f64], scale: isize) -> [f64; 3] {
        let last = self.layout.scales().cast_signed() - 1;
        let nearest = scale.clamp(0, last);
        let side_index = usize::from(scale > 0);
        match (&self.exterior.sides[side_index], scale.abs_diff(nearest)) {
            (_, 0) => self.displacement(z, nearest.cast_unsigned()),
            (Some(side), distance) => mirrored(
                side.beyond.far.displacement(self.displacement_from_end(z, side_index), distance),
                side_index,
            ),
            // A row that is solved as a whole has no scales beyond its ends.
            (None, _) => [0.0; 3],
        }
    }

    /// Computes the reaction (force and moment) of the linear substrate on a scale.
    ///
    /// It has the opposite sign of `F_x, F_y, M` in Eq. (1) and (S9). Neo-Hookean bars are not
    /// included.
    pub(crate) fn reaction(&self, z: &[f64], scale: isize) -> [f64; 3] {
        let own = self.displacement_anywhere(z, scale);
        let mut reaction: [f64; 3] = std::array::from_fn(|k| -self.direct[k] * own[k]);
        reaction[0] -= self.roll * own[2];
        reaction[2] -= self.roll * own[0];
        for (distance, neighbour) in (1..).zip(&self.neighbours) {
            let left = self.displacement_anywhere(z, scale - distance);
            let right = self.displacement_anywhere(z, scale + distance);
            for k in 0..3 {
                reaction[k] -= neighbour.direct[k] * (left[k] + right[k]);
            }
            reaction[1] -= neighbour.cross * (left[2] - right[2]);
            reaction[2] -= neighbour.cross * (right[1] - left[1]);
            reaction[0] -= neighbour.lift * (right[1] - left[1]);
            reaction[1] -= neighbour.lift * (left[0] - right[0]);
            reaction[0] -= neighbour.roll * (left[2] + right[2]);
            reaction[2] -= neighbour.roll * (left[0] + right[0]);
        }
        reaction
    }

    /// Returns the extent of contact towards the left and the right end of the solved part.
    pub(crate) fn reach(&self, state: &SkinState) -> [Reach; 2] {
        let touching = self.contacts.touching_at_ends(state);
        [0, 1].map(|side_index| {
            let Some(side) = &self.exterior.sides[side_index] else { return Reach::Short };
            match self.part_closed(&state.z, side_index, side) {
                1.0.. => Reach::Beyond,
                EARLY.. => Reach::Near,
                // A contact of the end scale may load the next scale, so extend the row.
                _ if touching[side_index] => Reach::Near,
                _ => Reach::Short,
            }
        })
    }

    /// Computes an upper bound on the closed fraction of the clearances beyond an end.
    ///
    /// With neo-Hookean bars, the result is at least their excess force over [`AS_SPRINGS`].
    fn part_closed(&self, z: &[f64], side_index: usize, side: &ExteriorSide) -> f64 {
        let displacements = self.displacements_beyond(z, side_index, side);
        let size =
            |[x, y, rotation]: [f64; 3]| x.abs() + y.abs() + self.exterior.arm * rotation.abs();
        let pairs = displacements.windows(2).zip(&side.clearances);
        // Both scales may move straight towards each other, so the sum of their motions is a bound.
        let parts = pairs.map(|(pair, clearance)| (size(pair[0]) + size(pair[1])) / clearance);
        // On a neo-Hookean substrate a bar outside the solved part that leaves its linear range
        // extends the solved part as well.
        let excess = self.largest_excess(&displacements, &side.gaps) / AS_SPRINGS;
        parts.fold(excess, f64::max)
    }

    /// Computes the stretches of the gaps outside the solved scales.
    ///
    /// Each side contributes the stretches of the gaps next to the solved scales, then one value
    /// for the far end: the stretch of the outermost gap of a finite row, or 1 for an infinite row.
    /// Stretches of the gaps in between lie between the last two values. The result is empty if
    /// every scale is solved.
    pub(super) fn stretches_beyond(&self, z: &[f64]) -> Vec<f64> {
        let mut stretches = Vec::new();
        for (side_index, side) in self.exterior.sides.iter().enumerate() {
            let Some(side) = side else { continue };
            let displacements = self.displacements_beyond(z, side_index, side);
            for (pair, &width) in displacements.windows(2).zip(&side.gaps) {
                let strip = SurfaceStrip { width, half_base: self.half_base };
                stretches.push(strip.stretch(pair[0], pair[1]));
            }
            // Stretches of gaps in between lie between the last checked and the outermost stretch.
            let last = side.beyond.scales.zip(side.gaps.last());
            stretches.push(last.map_or(1.0, |(scales, &width)| {
                let [near, far] = [scales - 1, scales].map(|distance| match distance {
                    0 => displacements[0],
                    _ => side
                        .beyond
                        .far
                        .displacement(self.displacement_from_end(z, side_index), distance),
                });
                SurfaceStrip { width, half_base: self.half_base }.stretch(near, far)
            }));
        }
        stretches
    }
}
