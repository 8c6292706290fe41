//! Maps the coordinates of a pair of scales to the unknowns of the system.

use std::array;

use contact::COORDINATES;
use geometry::{Frame, Vec2};
use solver::{Residual, Tangent};

use super::Contacts;

/// One number per coordinate of a pair.
type OfEach = [f64; COORDINATES];

/// Signed contribution of an unknown to a coordinate.
///
/// A coordinate is the sum of such terms.
#[derive(Clone, Copy)]
pub(super) struct Part {
    unknown: usize,
    coordinate: usize,
    /// 1 or −1.
    sign: f64,
}

/// The unknowns that form the coordinates of a pair.
#[derive(Clone, Copy)]
pub(super) enum PairUnknowns {
    /// Row: each scale has three consecutive unknowns from this index.
    ///
    /// Whole blocks are therefore added.
    Blocks([usize; 2]),
    /// Row on a curved body: the frame of the right scale is rotated from the left one.
    Curved([usize; 2], Frame),
    /// Strip: a rotation is the difference of two unknowns.
    ///
    /// Entries are therefore added one by one.
    Parts([Option<Part>; COORDINATES + 1]),
}

impl Contacts {
    /// Returns the unknowns of the pair of a contact.
    ///
    /// With relative poses the rotation of the right scale has a second term: the rotation of its
    /// frame.
    pub(super) fn pair_unknowns(&self, contact: usize) -> PairUnknowns {
        let ends = self.ends(Self::pair_of(contact));
        let right = self.scales[ends[1]];
        // With relative poses the left scale is the origin, so it has no unknowns here.
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
            // The coordinate is the rotation relative to the left scale, so the rotation of the
            // frame is subtracted.
            _ => {
                let (unknown, coordinate) = (self.frame(ends[1])?, COORDINATES - 1);
                Some(Part { unknown, coordinate, sign: -1.0 })
            }
        }))
    }
}

/// Rotates derivatives with respect to the displacement of the right scale to its frame.
pub(super) fn local(&[lx, ly, turn, x, y, right_turn]: &OfEach, frame: &Frame) -> OfEach {
    let right = frame.inward(Vec2::new(x, y));
    [lx, ly, turn, right.x, right.y, right_turn]
}

/// Rotates second derivatives like [`local`].
pub(super) fn local_square(square: &[OfEach; COORDINATES], frame: &Frame) -> [OfEach; COORDINATES] {
    let by_local = square.map(|row| local(&row, frame));
    let columns: [OfEach; COORDINATES] = array::from_fn(|l| array::from_fn(|k| by_local[k][l]));
    let columns = columns.map(|column| local(&column, frame));
    array::from_fn(|k| array::from_fn(|l| columns[l][k]))
}

impl PairUnknowns {
    /// Computes the dot product of `factors` with the coordinates of the pair in `z`.
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

    /// Adds the balance of each coordinate to the residual rows of its unknowns.
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

    /// Adds the derivatives of the balance with respect to the coordinates.
    pub(super) fn add_square(self, matrix: &mut impl Tangent, slopes: &[OfEach; COORDINATES]) {
        match self {
            Self::Blocks(scales) => {
                for (i, row) in scales.into_iter().enumerate() {
                    for (j, column) in scales.into_iter().enumerate() {
                        let (k, l) = (3 * i, 3 * j);
                        // Written out: closures over arrays are not inlined here in test builds.
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

    /// Adds the derivatives of the balance with respect to the unknown of `column`.
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

    /// Adds the derivatives of the equation of `row` with respect to the coordinates.
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
