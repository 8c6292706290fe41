//! Order of the gaps of an uneven strip in which each gap follows a similar gap.

use crate::arrangement::Arrangement;

/// Gaps of a strip in the order in which they are solved.
#[derive(Clone, Debug)]
pub(super) struct GapOrder {
    /// First gap: the gap that is most similar to the mean of all gaps.
    pub(super) first: usize,
    /// All other gaps, each with the most similar gap among the earlier ones.
    pub(super) pairs: Vec<[usize; 2]>,
    /// First gap, and the gaps with the least and the largest value of each feature.
    pub(super) extremes: Vec<usize>,
}

impl GapOrder {
    /// Orders the gaps of a row.
    ///
    /// The pairs are the edges of the minimum spanning tree of all gaps, found by the algorithm of
    /// Prim (1957), doi 10.1002/j.1538-7305.1957.tb01515.x.
    pub(super) fn new(row: &Arrangement, gaps: usize) -> Self {
        let width = (0..gaps).map(|gap| row.gap(gap)).sum::<f64>() / gaps as f64;
        let features: Vec<_> = (0..gaps).map(|gap| features(row, gap, width)).collect();
        let mean =
            [0, 1, 2].map(|k| features.iter().map(|feature| feature[k]).sum::<f64>() / gaps as f64);
        let from_mean: Vec<_> = features.iter().map(|feature| distance(feature, &mean)).collect();
        let first = nearest(&from_mean, 0..gaps).unwrap_or(0);
        let mut left: Vec<_> = (0..gaps).filter(|&gap| gap != first).collect();
        // Distance from the nearest gap in the order so far, and this gap.
        let mut least: Vec<_> =
            features.iter().map(|feature| distance(feature, &features[first])).collect();
        let mut similar = vec![first; gaps];
        let mut pairs = Vec::with_capacity(left.len());
        while let Some(next) = nearest(&least, left.iter().copied()) {
            pairs.push([next, similar[next]]);
            left.retain(|&gap| gap != next);
            for &gap in &left {
                let to_next = distance(&features[gap], &features[next]);
                if to_next < least[gap] {
                    (least[gap], similar[gap]) = (to_next, next);
                }
            }
        }
        Self { first, pairs, extremes: extremes(&features, first) }
    }
}

/// Returns the width of a gap, the distance between its tops, and the mean shift of its scales.
///
/// The width and the distance are in units of `unit`, the mean shift in units of `t`.
fn features(row: &Arrangement, gap: usize, unit: f64) -> [f64; 3] {
    let width = row.gap(gap);
    let [left, right] = [gap, gap + 1].map(|scale| row.scale(scale).shift());
    [width / unit, (width + right - left) / unit, 0.5 * (left + right)]
}

/// Returns the squared distance between the features of two gaps.
fn distance(one: &[f64; 3], other: &[f64; 3]) -> f64 {
    let squares = one.iter().zip(other).map(|(one, other)| (one - other).powi(2));
    // If scales lean to opposite sides, other corners touch.
    let other_corner = if one[2] * other[2] < 0.0 { 1.0 } else { 0.0 };
    squares.sum::<f64>() + other_corner
}

/// Lists `first` and the gaps with the least and the largest value of each feature, once each.
fn extremes(features: &[[f64; 3]], first: usize) -> Vec<usize> {
    let by_feature = (0..3).flat_map(|k| {
        let compare =
            |&one: &usize, &other: &usize| features[one][k].total_cmp(&features[other][k]);
        let gaps = 0..features.len();
        [gaps.clone().min_by(compare), gaps.max_by(compare)]
    });
    let mut extremes: Vec<_> = by_feature.flatten().chain([first]).collect();
    extremes.sort_unstable();
    extremes.dedup();
    extremes
}

/// Returns the gap of least distance among `gaps`.
fn nearest(distances: &[f64], gaps: impl Iterator<Item = usize>) -> Option<usize> {
    gaps.min_by(|&one, &other| distances[one].total_cmp(&distances[other]))
}

#[cfg(test)]
mod tests {
    use super::GapOrder;
    use crate::arrangement::Arrangement;
    use geometry::{Parallelogram, UnevenRow};

    #[test]
    fn each_gap_follows_the_most_similar_gap_that_does_not_lean_to_the_other_side() {
        let slants = [3.0, 3.0, 3.0, -3.0, -3.0];
        let scales =
            slants.iter().map(|slant| Parallelogram::leaning(0.5, *slant).unwrap()).collect();
        let row = UnevenRow::new(scales, vec![0.20, 0.24, 0.21, 0.30]).unwrap();
        let order = GapOrder::new(&Arrangement::Uneven(row), 4);
        // Gap 3 is more similar to gap 1, but the scales of gap 1 lean to the other side.
        assert_eq!(order.first, 1);
        assert_eq!(order.pairs, [[0, 1], [2, 0], [3, 2]]);
        assert_eq!(order.extremes, [0, 1, 2, 3]);
    }
}
