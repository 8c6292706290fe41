//! Maps the six coordinates of a pair of scales to the unknowns of the system.

use std::array;

use contact::COORDINATES;
use geometry::{Frame, Vec2};
use solver::{Residual, Tangent};

use super::Contacts;

/// One value for each coordinate of a pair: `x`, `y`, rotation of the left and the right scale.
type OfEach = [f64; COORDINATES];

/// Term of a coordinate: an unknown times a sign. A coordinate is the sum of its terms.
#[derive(Clone, Copy)]
pub(super) struct Part {
    unknown: usize,
    coordinate: usize,
    /// 1 or −1.
    sign: f64,
}

/// The unknowns of the coordinates of a pair.
#[derive(Clone, Copy)]
pub(super) enum PairUnknowns {
    /// Row on a flat body: index of the first of three consecutive unknowns of each scale.
    ///
    /// Matrix entries are added in blocks.
    Blocks([usize; 2]),
    /// Row on a curved body: as `Blocks`, with the tangent frame of the right scale.
    ///
    /// The frame is relative to the frame of the left scale.
    Curved([usize; 2], Frame),
    /// Strip, in which the relative rotation of a scale is the difference of two unknowns.
    ///
    /// Matrix entries are added one by one.
    Parts([Option<Part>; COORDINATES + 1]),
}

impl Contacts {
    /// Returns the unknowns of the coordinates of the pair to which a contact belongs.
    ///
    /// With relative poses the rotation of the right scale has a second term: minus the rotation of
    /// the left scale.
    pub(super) fn pair_unknowns(&self, contact: usize) -> PairUnknowns {
        let ends = self.ends(Self::pair_of(contact));
        let right = self.scales[ends[1]];
        // With relative poses the left scale is the reference, so its coordinates are zero.
        let left = self.scales[ends[0]].filter(|_| !self.relative);
        if let (Some(left), Some(right)) = (left, right) {
            return if self.body.is_flat() {
                PairUnknowns::Blocks([left, right])
            } else {
                let (_, frame) = self.pair_and_frame(Self::pair_of(contact));
                PairUnknowns::Curved([left, right], *frame)
            };
        }
        PairUnknowns::Parts(array::from_fn(|k| match k {
            0..3 => Some(Part { unknown: left? + k, coordinate: k, sign: 1.0 }),
            3..COORDINATES => Some(Part { unknown: right? + k - 3, coordinate: k, sign: 1.0 }),
            // Subtract the rotation of the left scale from the rotation of the right scale.
            _ => {
                let (unknown, coordinate) = (self.frame(ends[1])?, COORDINATES - 1);
                Some(Part { unknown, coordinate, sign: -1.0 })
            }
        }))
    }
}

/// Transforms derivatives with respect to the coordinates of a pair on a curved body.
///
/// Rotates the derivatives with respect to the displacement of the right scale from the frame of
/// the left scale to the frame of the right scale.
pub(super) fn local(&[lx, ly, turn, x, y, right_turn]: &OfEach, frame: &Frame) -> OfEach {
    let right = frame.inward(Vec2::new(x, y));
    [lx, ly, turn, right.x, right.y, right_turn]
}

/// Transforms second derivatives like [`local`] transforms first derivatives.
pub(super) fn local_square(square: &[OfEach; COORDINATES], frame: &Frame) -> [OfEach; COORDINATES] {
    let by_local = square.map(|row| local(&row, frame));
    let columns: [OfEach; COORDINATES] = array::from_fn(|l| array::from_fn(|k| by_local[k][l]));
    let columns = columns.map(|column| local(&column, frame));
    array::from_fn(|k| array::from_fn(|l| columns[l][k]))
}

impl PairUnknowns {
    /// Computes the dot product of `factors` and the coordinates of the pair for the unknowns `z`.
    pub(super) fn sum(self, factors: &OfEach, z: &[f64]) -> f64 {
        match self {
            Self::Blocks([left, right]) => {
                let z = z[left..left + 3].iter().chain(&z[right..right + 3]);
                factors.iter().zip(z).map(|(factor, z)| factor * z).sum()
            }
            Self::Curved(scales, frame) => Self::Blocks(scales).sum(&local(factors, &frame), z),
            Self::Parts(parts) => {
                let parts = parts.into_iter().flatten();
                parts.map(|part| part.sign * factors[part.coordinate] * z[part.unknown]).sum()
            }
        }
    }

    /// Adds the force balance of each coordinate to the residual rows of its unknowns.
    pub(super) fn add_balance(self, residual: &mut Residual, balance: &OfEach) {
        match self {
            Self::Blocks(scales) => {
                for (i, row) in scales.into_iter().enumerate() {
                    (0..3).for_each(|k| residual.add(row + k, balance[3 * i + k]));
                }
            }
            Self::Curved(scales, frame) => {
                Self::Blocks(scales).add_balance(residual, &local(balance, &frame));
            }
            Self::Parts(parts) => {
                for part in parts.into_iter().flatten() {
                    residual.add(part.unknown, part.sign * balance[part.coordinate]);
                }
            }
        }
    }

    /// Adds the derivatives of the force balance with respect to the coordinates.
    pub(super) fn add_square(self, matrix: &mut impl Tangent, slopes: &[OfEach; COORDINATES]) {
        match self {
            Self::Blocks(scales) => {
                for (i, row) in scales.into_iter().enumerate() {
                    for (j, column) in scales.into_iter().enumerate() {
                        let (k, l) = (3 * i, 3 * j);
                        // Entries are written out, because closures over arrays are not inlined in
                        // test builds.
                        let block = [
                            [slopes[k][l], slopes[k][l + 1], slopes[k][l + 2]],
                            [slopes[k + 1][l], slopes[k + 1][l + 1], slopes[k + 1][l + 2]],
                            [slopes[k + 2][l], slopes[k + 2][l + 1], slopes[k + 2][l + 2]],
                        ];
                        matrix.add_block(row, column, &block);
                    }
                }
            }
            Self::Curved(scales, frame) => {
                Self::Blocks(scales).add_square(matrix, &local_square(slopes, &frame));
            }
            Self::Parts(parts) => {
                for row in parts.into_iter().flatten() {
                    for column in parts.into_iter().flatten() {
                        let value = slopes[row.coordinate][column.coordinate];
                        matrix.add(row.unknown, column.unknown, row.sign * column.sign * value);
                    }
                }
            }
        }
    }

    /// Adds the derivatives of the force balance with respect to the unknown `column`.
    pub(super) fn add_column(self, matrix: &mut impl Tangent, column: usize, slopes: &OfEach) {
        match self {
            Self::Blocks(scales) => {
                for (row, &[x, y, turn]) in scales.into_iter().zip(slopes.as_chunks::<3>().0) {
                    matrix.add_block(row, column, &[[x], [y], [turn]]);
                }
            }
            Self::Curved(scales, frame) => {
                Self::Blocks(scales).add_column(matrix, column, &local(slopes, &frame));
            }
            Self::Parts(parts) => {
                for part in parts.into_iter().flatten() {
                    matrix.add(part.unknown, column, part.sign * slopes[part.coordinate]);
                }
            }
        }
    }

    /// Adds the derivatives of the equation `row` with respect to the coordinates.
    pub(super) fn add_row(self, matrix: &mut impl Tangent, row: usize, slopes: &OfEach) {
        match self {
            Self::Blocks(scales) => {
                for (column, three) in scales.into_iter().zip(slopes.as_chunks::<3>().0) {
                    matrix.add_block(row, column, &[*three]);
                }
            }
            Self::Curved(scales, frame) => {
                Self::Blocks(scales).add_row(matrix, row, &local(slopes, &frame));
            }
            Self::Parts(parts) => {
                for part in parts.into_iter().flatten() {
                    matrix.add(row, part.unknown, part.sign * slopes[part.coordinate]);
                }
            }
        }
    }
}
