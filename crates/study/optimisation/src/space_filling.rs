//! Space-filling points: the corners, and a low-discrepancy sequence.

use crate::space::{DesignSpace, SpacePoint};

/// Maximum number of intervals for which all corners are included.
const CORNERED: usize = 6;

/// Returns `count` space-filling points, or all points of a small discrete space.
///
/// The corners of the box are included if they take at most half of the points; a sequence shifted
/// by `seed` supplies the others.
///
/// The sequence is Roberts's: coordinate `j` of point `k` is the fractional part of
/// `s_j + k φ^−(j+1)`, with the root `φ` of `φ^(n+1) = φ + 1`. For `n = 1` this is the golden ratio
/// (M. Roberts, *The unreasonable effectiveness of quasirandom sequences*, 2018).
pub(crate) fn points(space: &DesignSpace, count: usize, seed: u64) -> Vec<SpacePoint> {
    let combinations = space.combinations();
    if space.intervals().is_empty() && combinations <= count {
        return (0..combinations)
            .map(|index| SpacePoint { shares: Vec::new(), chosen: space.combination(index) })
            .collect();
    }
    let mut points = corners(space, count / 2);
    // Choices are coordinates too; otherwise some of their values would get hardly any points.
    let sequence = Sequence::new(space.intervals().len() + space.choices().len(), seed);
    let missing = count.saturating_sub(points.len());
    points.extend((1..=missing).map(|index| split(space, &sequence.point(index))));
    points
}

/// Returns the corners of the box for every combination of choices.
///
/// Empty if there are more than `most`.
fn corners(space: &DesignSpace, most: usize) -> Vec<SpacePoint> {
    let (intervals, combinations) = (space.intervals().len(), space.combinations());
    if intervals > CORNERED || combinations.saturating_mul(1 << intervals) > most {
        return Vec::new();
    }
    (0..combinations)
        .flat_map(|combination| {
            (0..1 << intervals).map(move |corner| SpacePoint {
                shares: (0..intervals).map(|j| f64::from(u8::from(corner >> j & 1 == 1))).collect(),
                chosen: space.combination(combination),
            })
        })
        .collect()
}

/// Maps coordinates from 0 to 1 to a point of the space.
fn split(space: &DesignSpace, unit: &[f64]) -> SpacePoint {
    let (shares, rest) = unit.split_at(space.intervals().len());
    let counts = space.choices().iter().map(|choice| choice.values.len());
    // A fraction just below 1 may round up to the count.
    let chosen = rest
        .iter()
        .zip(counts)
        .map(|(share, count)| ((share * count as f64) as usize).min(count - 1));
    SpacePoint { shares: shares.to_vec(), chosen: chosen.collect() }
}

/// Low-discrepancy sequence in the unit cube.
pub(crate) struct Sequence {
    start: Vec<f64>,
    step: Vec<f64>,
}

impl Sequence {
    pub fn new(dimensions: usize, seed: u64) -> Self {
        let ratio = ratio(dimensions);
        let step: Vec<f64> = (1..=dimensions).map(|j| ratio.powi(-(j as i32))).collect();
        // Each seed shifts the start by an irrational amount, so that no sequence continues
        // another.
        let start =
            (0..dimensions).map(|j| (0.5 + seed as f64 * (j as f64 + 2.0).sqrt() * 0.731).fract());
        Self { start: start.collect(), step }
    }

    /// Returns point `index`, from 1.
    pub fn point(&self, index: usize) -> Vec<f64> {
        let pairs = self.start.iter().zip(&self.step);
        pairs.map(|(start, step)| (start + index as f64 * step).fract()).collect()
    }
}

/// Computes the root above 1 of `φ^(n+1) = φ + 1`.
fn ratio(dimensions: usize) -> f64 {
    // Fixed-point iteration: the derivative is below 1/2, so 64 rounds reach round-off.
    let root = 1.0 / (dimensions as f64 + 1.0);
    (0..64).fold(2.0, |ratio: f64, _| (1.0 + ratio).powf(root))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ratio_is_golden_in_one_dimension_and_plastic_in_two() {
        assert!((ratio(1) - 1.618_033_988_749_895).abs() < 1e-15);
        assert!((ratio(2) - 1.324_717_957_244_746).abs() < 1e-15);
    }

    #[test]
    fn a_sequence_fills_every_part_of_the_cube() {
        for seed in [0, 1, 17] {
            let sequence = Sequence::new(3, seed);
            let mut counts = [0; 64];
            for index in 1..=1024 {
                let point = sequence.point(index);
                counts[point.iter().fold(0, |cell, x| 4 * cell + (x * 4.0) as usize)] += 1;
            }
            // Random points would leave counts from 6 to 28.
            let [least, most] = [counts.iter().min(), counts.iter().max()].map(Option::unwrap);
            assert!(*least >= 11 && *most <= 21, "{seed}: {least} to {most}");
        }
    }
}
