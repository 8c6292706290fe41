//! Motion of the scales beyond the solved part, and proximity of contact to its ends.

use substrate::SurfaceStrip;

use super::row_exterior::{ExteriorSide, mirrored};
use super::system::Chain;
use crate::contacts::SkinState;

/// Largest difference of force between a neo-Hookean bar and its spring beyond the solved part.
///
/// The bars there count as springs. The force is divided by the stiffness of a scale, hence a
/// displacement (over `t`).
const AS_SPRINGS: f64 = 1e-9;

/// Closed fraction of a clearance above which the row is extended early.
const EARLY: f64 = 0.5;

/// Proximity of the deformation to an end of the solved part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reach {
    /// No contact possible at or beyond the end.
    Short,
    /// Scales beyond the end may touch soon.
    Near,
    /// Scales beyond the end may touch already.
    Beyond,
}

impl Chain {
    /// Counts the scales in the row; in a row without ends the solved ones.
    pub(super) fn row_length(&self) -> usize {
        let [left, right] = self.exterior.scales_to_ends();
        left + self.layout.scales() + right
    }

    /// Returns displacements of scales counted from an end, mirrored to a right end.
    fn at_end<'a>(&'a self, z: &'a [f64], side: usize) -> impl Fn(usize) -> [f64; 3] + 'a {
        let last = self.layout.scales() - 1;
        move |k| mirrored(self.displacement(z, if side == 0 { k } else { last - k }), side)
    }

    /// Computes the displacements of the end scale and of the checked scales beyond.
    ///
    /// They are mirrored to a right end.
    fn displacements_beyond(&self, z: &[f64], number: usize, side: &ExteriorSide) -> Vec<[f64; 3]> {
        let end = self.at_end(z, number);
        let mut displacements = vec![end(0)];
        displacements.extend(side.beyond.far.displacements(end, side.gaps.len()));
        displacements
    }

    /// Computes the displacement of a scale that may lie beyond an end.
    pub(crate) fn displacement_anywhere(&self, z: &[f64], scale: isize) -> [f64; 3] {
        let last = self.layout.scales().cast_signed() - 1;
        let nearest = scale.clamp(0, last);
        let number = usize::from(scale > 0);
        match (&self.exterior.sides[number], scale.abs_diff(nearest)) {
            (_, 0) => self.displacement(z, nearest.cast_unsigned()),
            (Some(side), distance) => {
                mirrored(side.beyond.far.displacement(self.at_end(z, number), distance), number)
            }
            // Beyond a row that is solved as a whole, everything is fixed.
            (None, _) => [0.0; 3],
        }
    }

    /// Computes the reaction (force and moment) of the linear substrate on a scale.
    ///
    /// It opposes the displacement: minus the `F_x, F_y, M` of Eq. (1), or of (S9). Bars are not
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

    /// Checks how close a state has come to the left and the right end of a longer row.
    pub(crate) fn reach(&self, state: &SkinState) -> [Reach; 2] {
        let touching = self.contacts.touching_at_ends(state);
        [0, 1].map(|number| {
            let Some(side) = &self.exterior.sides[number] else { return Reach::Short };
            match self.part_closed(&state.z, number, side) {
                1.0.. => Reach::Beyond,
                EARLY.. => Reach::Near,
                // A contact at the very end may load the next scale at once.
                _ if touching[number] => Reach::Near,
                _ => Reach::Short,
            }
        })
    }

    /// Computes the largest fraction of a clearance beyond an end that may be closed.
    ///
    /// For bars also the largest fraction of the force up to which they count as springs.
    fn part_closed(&self, z: &[f64], number: usize, side: &ExteriorSide) -> f64 {
        let displacements = self.displacements_beyond(z, number, side);
        let size =
            |[x, y, rotation]: [f64; 3]| x.abs() + y.abs() + self.exterior.arm * rotation.abs();
        let pairs = displacements.windows(2).zip(&side.clearances);
        // Both scales may move straight towards each other, so the sum of their motions is a bound.
        let parts = pairs.map(|(pair, clearance)| (size(pair[0]) + size(pair[1])) / clearance);
        // With a neo-Hookean substrate the solved part is also extended if a bar outside it leaves
        // its linear range.
        let excess = self.largest_excess(&displacements, &side.gaps) / AS_SPRINGS;
        parts.fold(excess, f64::max)
    }

    /// Computes the stretches of the gaps outside the solved scales.
    ///
    /// Each side contributes the gaps next to the solved scales, then one value that bounds all
    /// farther gaps: the outermost gap of a finite row, or 1 for an infinite row. Stretches of
    /// farther gaps lie between the last two values. Empty if every scale is solved.
    pub(super) fn stretches_beyond(&self, z: &[f64]) -> Vec<f64> {
        let mut stretches = Vec::new();
        for (number, side) in self.exterior.sides.iter().enumerate() {
            let Some(side) = side else { continue };
            let displacements = self.displacements_beyond(z, number, side);
            for (pair, &width) in displacements.windows(2).zip(&side.gaps) {
                let strip = SurfaceStrip { width, half_base: self.half_base };
                stretches.push(strip.stretch(pair[0], pair[1]));
            }
            // Farther gaps lie between the last checked one and this one.
            let last = side.beyond.scales.zip(side.gaps.last());
            stretches.push(last.map_or(1.0, |(scales, &width)| {
                let [near, far] = [scales - 1, scales].map(|distance| match distance {
                    0 => displacements[0],
                    _ => side.beyond.far.displacement(self.at_end(z, number), distance),
                });
                SurfaceStrip { width, half_base: self.half_base }.stretch(near, far)
            }));
        }
        stretches
    }
}
