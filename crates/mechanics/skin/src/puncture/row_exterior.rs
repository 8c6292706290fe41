//! The row beyond the ends of the part that is solved for.

use std::array;

use geometry::{Corner, OutOfRange, Vec2};
use substrate::{FarField, Relief, SurfaceStrip};

use super::Rows;
use super::system::{Chain, RowLayout};
use crate::contacts::SkinState;

/// Scales beyond an end whose gaps are looked at. What moves the end hardly moves farther ones.
const LOOKED_AT: usize = 12;

/// Force of bars beyond an end, above that of the springs that stand for them there, up to which the bars count as springs: over
/// the stiffness of a scale, so it is a displacement (over `t`).
const AS_SPRINGS: f64 = 1e-9;

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

/// What lies beyond an end.
#[derive(Clone, Debug)]
pub(super) struct Beyond {
    /// How the scales move there.
    pub(super) far: FarField,
    /// How many they are; `None` if the row has no end.
    pub(super) scales: Option<usize>,
}

/// The row beyond the ends of the part that is solved for; nothing, for a row that is solved whole.
#[derive(Clone, Debug, Default)]
pub(crate) struct RowExterior {
    /// Beyond the left and the right end.
    sides: [Option<ExteriorSide>; 2],
    /// What the row beyond adds to the stiffness of the substrate, which it takes down: row and column of the tangent, and entries.
    pub(super) relief: Vec<(usize, usize, [[f64; 3]; 3])>,
    /// Distance of the farthest corner of a scale from its node.
    arm: f64,
}

#[derive(Clone, Debug)]
struct ExteriorSide {
    beyond: Beyond,
    /// Widths of the gaps, from the nearest on.
    gaps: Vec<f64>,
    /// The narrowest distances of the scales on both sides of these gaps.
    clearances: Vec<f64>,
}

/// What is to the left of a row is the mirror image of what is to the right of one.
fn mirrored([x, y, rotation]: [f64; 3], side: usize) -> [f64; 3] {
    if side == 0 { [-x, y, -rotation] } else { [x, y, rotation] }
}

impl RowExterior {
    /// The surroundings of a part of the `rows`, with what lies beyond its left and its right end.
    ///
    /// # Errors
    /// If a sample has no scales there.
    pub(super) fn new(
        rows: Rows,
        layout: RowLayout,
        beyond: [Option<Beyond>; 2],
    ) -> Result<Self, OutOfRange> {
        let looked_at = |side: &Option<Beyond>| {
            let scales = side.as_ref().map_or(Some(0), |beyond| beyond.scales);
            scales.map_or(LOOKED_AT, |scales| scales.min(LOOKED_AT))
        };
        let [left, right] = [looked_at(&beyond[0]), looked_at(&beyond[1])];
        // A longer row keeps its middle, so that its outer scales are those that stand beyond.
        let row = rows.row(RowLayout {
            left: layout.left + left,
            right: layout.right + right,
            ..layout
        })?;
        let end = left + layout.scales() - 1;
        let pairs: [Vec<usize>; 2] = [(0..left).rev().collect(), (end..end + right).collect()];
        let side = |(beyond, pairs): (Option<Beyond>, Vec<usize>)| {
            Some(ExteriorSide {
                beyond: beyond?,
                gaps: pairs.iter().map(|&pair| row.gap(pair)).collect(),
                clearances: pairs.iter().map(|&pair| row.clearance(pair)).collect(),
            })
        };
        let [first, last] = pairs;
        let [left_beyond, right_beyond] = beyond;
        let scale = row.scale(left);
        let arm = |corner| Vec2::norm(&scale.corner(corner));
        let sides = [side((left_beyond, first)), side((right_beyond, last))];
        let relief = relief(layout, &sides);
        // Whichever way a scale leans, one of its top corners is the farthest from its node.
        let arm = arm(Corner::TopLeft).max(arm(Corner::TopRight));
        Ok(Self { sides, relief, arm })
    }

    /// How many scales of a row that ends lie beyond its left and its right end.
    pub(super) fn scales_to_ends(&self) -> [usize; 2] {
        let scales = |side: &Option<ExteriorSide>| side.as_ref()?.beyond.scales;
        self.sides.each_ref().map(|side| scales(side).unwrap_or(0))
    }
}

/// The relief of both ends in the unknowns of a row.
fn relief(
    layout: RowLayout,
    sides: &[Option<ExteriorSide>; 2],
) -> Vec<(usize, usize, [[f64; 3]; 3])> {
    let last = layout.scales() - 1;
    let of_side = |(number, side): (usize, &Option<ExteriorSide>)| {
        let parts = side.as_ref().map_or(&[][..], |side| &side.beyond.far.relief);
        let unknown =
            move |scale: usize| layout.scale(if number == 0 { scale } else { last - scale });
        // On the left entries that couple the vertical direction with another turn their sign.
        let signs = mirrored([1.0; 3], number);
        let part = move |Relief { force, displacement, by }: &Relief| {
            let by = array::from_fn(|k| array::from_fn(|l| -signs[k] * signs[l] * by[k][l]));
            (unknown(*force), unknown(*displacement), by)
        };
        parts.iter().map(part).collect::<Vec<_>>()
    };
    sides.iter().enumerate().flat_map(of_side).collect()
}

impl Chain {
    /// Number of scales in the row: of one without ends those that are solved for.
    pub(super) fn row_length(&self) -> usize {
        let [left, right] = self.exterior.scales_to_ends();
        left + self.layout.scales() + right
    }

    /// Displacements of the scales at an end, counted from it, as those at the right end of a row.
    fn at_end<'a>(&'a self, z: &'a [f64], side: usize) -> impl Fn(usize) -> [f64; 3] + 'a {
        let last = self.layout.scales() - 1;
        let scale = move |k: usize| if side == 0 { k } else { last - k };
        move |k| mirrored(self.displacement(z, scale(k)), side)
    }

    /// Displacements of the end and of scales beyond it whose gaps are looked at, as those at the right end of a row.
    fn displacements_beyond(&self, z: &[f64], number: usize, side: &ExteriorSide) -> Vec<[f64; 3]> {
        let end = self.at_end(z, number);
        let mut displacements = vec![end(0)];
        displacements.extend(side.beyond.far.displacements(end, side.gaps.len()));
        displacements
    }

    /// The three displacements of a scale, which may lie beyond an end of the row.
    pub(crate) fn displacement_anywhere(&self, z: &[f64], scale: isize) -> [f64; 3] {
        let last = self.layout.scales().cast_signed() - 1;
        let nearest = scale.clamp(0, last);
        let number = usize::from(scale > 0);
        match (&self.exterior.sides[number], scale.abs_diff(nearest)) {
            (_, 0) => self.displacement(z, nearest.cast_unsigned()),
            (Some(side), distance) => {
                mirrored(side.beyond.far.displacement(self.at_end(z, number), distance), number)
            }
            // What lies beyond a row that is solved whole counts as held.
            (None, _) => [0.0; 3],
        }
    }

    /// Reaction of the linear substrate on a scale (force and moment), opposed to its displacement: minus
    /// the `F_x, F_y, M` of Eq. (1), or of (S9). Bars change the force along the row and the moment.
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

    /// How near a state has come to the left and to the right end, if there is more beyond them.
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

    /// The largest part of the distance of two scales beyond an end that their displacements can close, or of the force that lets bars
    /// count as springs.
    fn part_closed(&self, z: &[f64], number: usize, side: &ExteriorSide) -> f64 {
        let displacements = self.displacements_beyond(z, number, side);
        let size =
            |[x, y, rotation]: [f64; 3]| x.abs() + y.abs() + self.exterior.arm * rotation.abs();
        let pairs = displacements.windows(2).zip(&side.clearances);
        // Both scales may move straight towards each other: the sum of their motions is a bound.
        let parts = pairs.map(|(pair, clearance)| (size(pair[0]) + size(pair[1])) / clearance);
        // A row of bars grows, too, where those beyond its end no longer act as springs.
        let excess = self.largest_excess(&displacements, &side.gaps) / AS_SPRINGS;
        parts.fold(excess, f64::max)
    }

    /// Stretches of the gaps beyond the ends of a part of a longer row, and 1, that of a gap far away if the row has no end; none of a
    /// row that is solved whole. Beyond those that are looked at all are closer to that of the last.
    pub(super) fn stretches_beyond(&self, z: &[f64]) -> Vec<f64> {
        let mut stretches = Vec::new();
        for (number, side) in self.exterior.sides.iter().enumerate() {
            let Some(side) = side else { continue };
            let displacements = self.displacements_beyond(z, number, side);
            for (pair, &width) in displacements.windows(2).zip(&side.gaps) {
                let strip = SurfaceStrip { width, half_base: self.half_base };
                stretches.push(strip.stretch(pair[0], pair[1]));
            }
            // Farther gaps lie between the last one looked at and this one, which bounds them.
            let last = side.beyond.scales.zip(side.gaps.last());
            stretches.push(last.map_or(1.0, |(scales, &width)| {
                let at = |distance| match distance {
                    0 => displacements[0],
                    _ => side.beyond.far.displacement(self.at_end(z, number), distance),
                };
                let strip = SurfaceStrip { width, half_base: self.half_base };
                strip.stretch(at(scales - 1), at(scales))
            }));
        }
        stretches
    }
}
