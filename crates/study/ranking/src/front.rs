//! Pareto fronts: designs that no other design dominates.

use std::cmp::Ordering;

use text::number::same;

/// Point with four coordinates; larger coordinates are better.
type Quadruple = [f64; 4];

/// Marks the points on the Pareto front.
///
/// Each point consists of `count` consecutive numbers in `criteria`.
pub(crate) fn front_of(criteria: &[f64], count: usize) -> Vec<bool> {
    let points = criteria.chunks_exact(count);
    // `pareto_front` is limited to four coordinates.
    if count > 4 {
        return sifted(&points.collect::<Vec<_>>());
    }
    // Set missing coordinates to 0 in all points, which does not change dominance.
    let points = points.map(|point| std::array::from_fn(|c| point.get(c).copied().unwrap_or(0.0)));
    pareto_front(&points.collect::<Vec<_>>())
}

/// Marks the points on the Pareto front, for points with any number of coordinates.
///
/// The points are sorted so that a point can only be dominated by earlier points. So each point is
/// compared only with the earlier points of the front.
fn sifted(points: &[&[f64]]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| compare(points[b], points[a]));
    let mut front: Vec<usize> = Vec::new();
    for point in order {
        if !front.iter().any(|&other| dominates(points[other], points[point])) {
            front.push(point);
        }
    }
    let mut on_front = vec![false; points.len()];
    for point in front {
        on_front[point] = true;
    }
    on_front
}

/// Returns true if `p` dominates `q`: no coordinate is worse, and at least one is better (R6).
///
/// Coordinates that are equal up to round-off count as equal.
pub fn dominates(p: &[f64], q: &[f64]) -> bool {
    let mut pairs = p.iter().zip(q);
    pairs.clone().all(|(p, q)| p >= q || same(*p, *q)) && pairs.any(|(p, q)| p > q && !same(*p, *q))
}

/// Marks the points on the Pareto front by divide and conquer, in `O(N log² N)`.
///
/// Coordinates are finite; larger is better. See Kung, Luccio & Preparata 1975, doi
/// 10.1145/321906.321910.
pub fn pareto_front(points: &[Quadruple]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| compare(&points[b], &points[a]));
    let groups: Vec<&[usize]> = order.chunk_by(|&a, &b| points[a] == points[b]).collect();
    let thirds =
        descending_ranks(&groups.iter().map(|group| points[group[0]][2]).collect::<Vec<_>>());
    let candidates = groups.iter().enumerate().map(|(group, members)| {
        let [_, second, _, fourth] = points[members[0]];
        Point { group, second, third: thirds[group], fourth, dominated: false }
    });
    let mut candidates: Vec<_> = candidates.collect();
    let mut best = PrefixMaxima { values: vec![f64::NEG_INFINITY; groups.len() + 1] };
    divide(&mut candidates, &mut best);
    let mut front = vec![false; points.len()];
    for candidate in candidates.iter().filter(|candidate| !candidate.dominated) {
        groups[candidate.group].iter().for_each(|&point| front[point] = true);
    }
    front
}

/// Compares two points lexicographically; zeros of either sign are equal.
fn compare(a: &[f64], b: &[f64]) -> Ordering {
    let by_coordinate = a.iter().zip(b).map(|(a, b)| (a + 0.0).total_cmp(&(b + 0.0)));
    by_coordinate.fold(Ordering::Equal, Ordering::then)
}

/// Returns the rank of each value among the distinct values; the largest value has rank 0.
fn descending_ranks(values: &[f64]) -> Vec<usize> {
    let mut distinct = values.to_vec();
    distinct.sort_by(|a, b| b.total_cmp(a));
    distinct.dedup();
    values.iter().map(|value| distinct.partition_point(|other| other > value)).collect()
}

/// A group of equal points.
#[derive(Clone, Copy)]
struct Point {
    group: usize,
    second: f64,
    /// Rank of the third coordinate; the largest value has rank 0.
    third: usize,
    fourth: f64,
    /// True if another point dominates this point.
    dominated: bool,
}

/// Marks the dominated candidates.
///
/// On entry, the candidates are in descending lexicographic order. On return, they are in
/// descending order of the second coordinate.
fn divide(candidates: &mut [Point], best: &mut PrefixMaxima) {
    if candidates.len() < 2 {
        return;
    }
    let (earlier, later) = candidates.split_at_mut(candidates.len() / 2);
    // Dominated points need not be removed: if `p` dominates `q`, every point that `q` dominates is
    // also dominated by `p`.
    divide(earlier, best);
    divide(later, best);
    conquer(earlier, later, best);
    // The stable sort detects two sorted runs and merges them.
    candidates.sort_by(|a, b| b.second.total_cmp(&a.second));
}

/// Marks the points of `later` that a point of `earlier` dominates.
///
/// `earlier` and `later` are in descending order of the second coordinate. No point of `earlier`
/// has a smaller first coordinate than a point of `later`.
fn conquer(earlier: &[Point], later: &mut [Point], best: &mut PrefixMaxima) {
    let mut above = 0;
    for candidate in later {
        // Include ties in the second coordinate: an earlier point with no coordinate smaller
        // dominates `candidate`, because equal points form one candidate and so one of its
        // coordinates is larger.
        while above < earlier.len() && earlier[above].second >= candidate.second {
            best.raise(earlier[above].third, earlier[above].fourth);
            above += 1;
        }
        candidate.dominated |= best.up_to(candidate.third) >= candidate.fourth;
    }
    // Clear only the raised nodes. Clearing the whole tree in every call would cost time in
    // proportion to the number of all points.
    earlier[..above].iter().for_each(|candidate| best.clear(candidate.third));
}

/// Fenwick tree that returns the maximum of all values up to an index.
struct PrefixMaxima {
    values: Vec<f64>,
}

impl PrefixMaxima {
    fn raise(&mut self, index: usize, value: f64) {
        let mut node = index + 1;
        while node < self.values.len() {
            self.values[node] = self.values[node].max(value);
            node += node & node.wrapping_neg();
        }
    }

    fn clear(&mut self, index: usize) {
        let mut node = index + 1;
        while node < self.values.len() {
            self.values[node] = f64::NEG_INFINITY;
            node += node & node.wrapping_neg();
        }
    }

    fn up_to(&self, index: usize) -> f64 {
        let mut node = index + 1;
        let mut maximum = f64::NEG_INFINITY;
        while node > 0 {
            maximum = maximum.max(self.values[node]);
            node &= node - 1;
        }
        maximum
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn by_definition(points: &[Quadruple]) -> Vec<bool> {
        points.iter().map(|q| !points.iter().any(|p| dominates(p, q))).collect()
    }

    #[test]
    fn small_fronts_treat_ties_and_signed_zeros_as_equal() {
        assert_eq!(pareto_front(&[]), [] as [bool; 0]);
        assert_eq!(pareto_front(&[[1.0; 4]]), [true]);
        let equal = [[1.0, 2.0, 3.0, 4.0]; 3];
        assert_eq!(pareto_front(&equal), [true; 3]);
        let trade = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.0]];
        assert_eq!(pareto_front(&trade), [true, true, false]);
        assert_eq!(pareto_front(&[[-0.0, 1.0, 0.0, 0.0], [0.0, 0.5, 0.0, -0.0]]), [true, false]);
    }

    proptest! {
        #[test]
        fn the_front_matches_the_definition_with_many_ties(
            // Few distinct values, so that ties in some coordinates and equal points are common.
            points in prop::collection::vec(prop::array::uniform4(-1_i32..6), 0..120),
        ) {
            let points: Vec<Quadruple> = points.iter().map(|p| p.map(f64::from)).collect();
            prop_assert_eq!(pareto_front(&points), by_definition(&points));
        }

        #[test]
        fn the_front_matches_the_definition_in_general_position(
            points in prop::collection::vec(prop::array::uniform4(-1.0_f64..1.0), 0..200),
        ) {
            prop_assert_eq!(pareto_front(&points), by_definition(&points));
        }

        #[test]
        fn the_front_matches_the_definition_beyond_four_criteria(
            points in prop::collection::vec(prop::array::uniform8(-1_i32..3), 0..60),
            count in 5_usize..9,
        ) {
            let points = points.iter().flat_map(|p| p.map(f64::from)[..count].to_vec());
            let numbers: Vec<f64> = points.collect();
            let points: Vec<&[f64]> = numbers.chunks_exact(count).collect();
            let expected: Vec<bool> =
                points.iter().map(|q| !points.iter().any(|p| dominates(p, q))).collect();
            prop_assert_eq!(front_of(&numbers, count), expected);
        }
    }
}
