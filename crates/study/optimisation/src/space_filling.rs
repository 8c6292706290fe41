//! Space-filling points: the corners of the space, and a low-discrepancy sequence.

use crate::space::{DesignSpace, SpacePoint};

/// Maximum number of continuous variables for which all corners are included.
const CORNERED: usize = 6;

/// Returns `count` space-filling points, or all points of a small discrete space.
///
/// The corners of the space are included if they are at most half of the points. The other points
/// are from a sequence that `seed` shifts.
///
/// The sequence is Roberts's sequence (M. Roberts, *The unreasonable effectiveness of quasirandom
/// sequences*, 2018). Coordinate `j` (from 0) of point `k` is the fractional part of
/// `s_j + k φ^−(j+1)`, with the root `φ` of `φ^(n+1) = φ + 1` for `n` dimensions. For `n = 1` the
/// root is the golden ratio.
pub(crate) fn points(space: &DesignSpace, count: usize, seed: u64) -> Vec<SpacePoint> {
    let combinations = space.combinations();
    if space.intervals().is_empty() && combinations <= count {
        return (0..combinations)
            .map(|index| SpacePoint { fractions: Vec::new(), chosen: space.combination(index) })
            .collect();
    }
    let mut points = corners(space, count / 2);
    // Use a coordinate for each discrete variable too, so that its values get equally many points.
    let sequence = Sequence::new(space.intervals().len() + space.choices().len(), seed);
    let missing = count.saturating_sub(points.len());
    points.extend((1..=missing).map(|index| split(space, &sequence.point(index))));
    points
}

/// Returns the corners of the space, i.e. all combinations of interval ends and choices.
///
/// Empty if there are more than `most` corners.
fn corners(space: &DesignSpace, most: usize) -> Vec<SpacePoint> {
    let (intervals, combinations) = (space.intervals().len(), space.combinations());
    if intervals > CORNERED || combinations.saturating_mul(1 << intervals) > most {
        return Vec::new();
    }
    (0..combinations)
        .flat_map(|combination| {
            (0..1 << intervals).map(move |corner| SpacePoint {
                fractions: (0..intervals)
                    .map(|j| f64::from(u8::from(corner >> j & 1 == 1)))
                    .collect(),
                chosen: space.combination(combination),
            })
        })
        .collect()
}

/// Converts a point of the unit cube to a point of the space.
fn split(space: &DesignSpace, unit: &[f64]) -> SpacePoint {
    let (fractions, rest) = unit.split_at(space.intervals().len());
    let counts = space.choices().iter().map(|choice| choice.values.len());
    // The product may be rounded up to the count if the coordinate is just below 1.
    let chosen = rest
        .iter()
        .zip(counts)
        .map(|(fraction, count)| ((fraction * count as f64) as usize).min(count - 1));
    SpacePoint { fractions: fractions.to_vec(), chosen: chosen.collect() }
}

/// Roberts's low-discrepancy sequence in the unit cube.
pub(crate) struct Sequence {
    /// Point with index 0.
    start: Vec<f64>,
    /// Difference of successive points, before the fractional part is taken.
    step: Vec<f64>,
}

impl Sequence {
    /// Creates the sequence in a cube of this number of `dimensions`.
    pub fn new(dimensions: usize, seed: u64) -> Self {
        let ratio = ratio(dimensions);
        let step: Vec<f64> = (1..=dimensions).map(|j| ratio.powi(-(j as i32))).collect();
        // Each seed shifts the start by an irrational amount, so sequences of different seeds have
        // no points in common.
        let start =
            (0..dimensions).map(|j| (0.5 + seed as f64 * (j as f64 + 2.0).sqrt() * 0.731).fract());
        Self { start: start.collect(), step }
    }

    /// Returns point `index` of the sequence, counted from 1.
    pub fn point(&self, index: usize) -> Vec<f64> {
        let pairs = self.start.iter().zip(&self.step);
        pairs.map(|(start, step)| (start + index as f64 * step).fract()).collect()
    }
}

/// Computes the root `φ > 1` of `φ^(n+1) = φ + 1` for `n` dimensions.
fn ratio(dimensions: usize) -> f64 {
    // Fixed-point iteration. The derivative of the function is below 1/2, so the error after 64
    // rounds is round-off.
    let root = 1.0 / (dimensions as f64 + 1.0);
    (0..64).fold(2.0, |ratio: f64, _| (1.0 + ratio).powf(root))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratio_is_the_golden_ratio_in_one_dimension_and_the_plastic_ratio_in_two() {
        assert!((ratio(1) - 1.618_033_988_749_895).abs() < 1e-15);
        assert!((ratio(2) - 1.324_717_957_244_746).abs() < 1e-15);
    }

    #[test]
    fn sequence_has_points_in_every_part_of_the_cube() {
        for seed in [0, 1, 17] {
            let sequence = Sequence::new(3, seed);
            let mut counts = [0; 64];
            for index in 1..=1024 {
                let point = sequence.point(index);
                counts[point.iter().fold(0, |cell, x| 4 * cell + (x * 4.0) as usize)] += 1;
            }
            // The expected count is 16. Random points would have counts from 6 to 28.
            let [least, most] = [counts.iter().min(), counts.iter().max()].map(Option::unwrap);
            assert!(*least >= 11 && *most <= 21, "{seed}: {least} to {most}");
        }
    }
}
