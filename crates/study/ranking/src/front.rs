//! Designs that no other beats: those that remain whatever the weights.

use std::cmp::Ordering;

use results::round_off::same;

/// A point of four coordinates, larger being better.
type Quadruple = [f64; 4];

/// Marks which of some points, each with `count` criteria one after the other, no other dominates.
pub(crate) fn front_of(criteria: &[f64], count: usize) -> Vec<bool> {
    let points = criteria.chunks_exact(count);
    // The sweep below has room for four coordinates.
    if count > 4 {
        return sifted(&points.collect::<Vec<_>>());
    }
    // Criteria beyond the last are 0 for all and tell nothing apart.
    let four = |point: &[f64]| std::array::from_fn(|c| point.get(c).copied().unwrap_or(0.0));
    pareto_front(&points.map(four).collect::<Vec<_>>())
}

/// Marks which of `points` no other dominates, whatever their dimension: each is compared with those before it, in
/// the order in which they may dominate each other, that are on the front themselves.
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

/// Whether a point is at least as good as another in every coordinate, and better in one (R6).
pub fn dominates(p: &[f64], q: &[f64]) -> bool {
    let pairs = || p.iter().zip(q);
    pairs().all(|(p, q)| p >= q || same(*p, *q)) && pairs().any(|(p, q)| p > q && !same(*p, *q))
}

/// Marks which of `points` no other dominates. Coordinates are finite, larger is better.
///
/// ```text
/// p dominates q  ⇔  p_c ≥ q_c for every criterion c, and p_c > q_c for one          (R6)
/// ```
///
/// Points that are equal in everything do not dominate each other: they stand on the front
/// together or not at all.
///
/// In the order of the first coordinate (ties broken by the next ones) a point is dominated only
/// by points before it. Halving that order, the question is which points of the later half have a
/// point of the earlier half above them in the other three coordinates: a sweep along the second,
/// with the best fourth for every third in a tree of prefix maxima. That takes `O(n log² n)`,
/// however many points the front has (Kung, Luccio and Preparata 1975, doi 10.1145/321906.321910).
pub fn pareto_front(points: &[Quadruple]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| compare(&points[b], &points[a]));
    let groups: Vec<&[usize]> = order.chunk_by(|&a, &b| points[a] == points[b]).collect();
    let thirds =
        descending_ranks(&groups.iter().map(|group| points[group[0]][2]).collect::<Vec<_>>());
    let candidate = |(group, members): (usize, &&[usize])| {
        let [_, second, _, fourth] = points[members[0]];
        Point { group, second, third: thirds[group], fourth, beaten: false }
    };
    let mut candidates: Vec<_> = groups.iter().enumerate().map(candidate).collect();
    let mut best = PrefixMaxima { values: vec![f64::NEG_INFINITY; groups.len() + 1] };
    divide(&mut candidates, &mut best);
    let mut front = vec![false; points.len()];
    for candidate in candidates.iter().filter(|candidate| !candidate.beaten) {
        groups[candidate.group].iter().for_each(|&point| front[point] = true);
    }
    front
}

/// By the first coordinate that differs; zeros of either sign are equal.
fn compare(a: &[f64], b: &[f64]) -> Ordering {
    let by_coordinate = a.iter().zip(b).map(|(a, b)| (a + 0.0).total_cmp(&(b + 0.0)));
    by_coordinate.fold(Ordering::Equal, Ordering::then)
}

/// The place of each value among the distinct ones, the largest first.
fn descending_ranks(values: &[f64]) -> Vec<usize> {
    let mut distinct = values.to_vec();
    distinct.sort_by(|a, b| b.total_cmp(a));
    distinct.dedup();
    values.iter().map(|value| distinct.partition_point(|other| other > value)).collect()
}

/// Points that are equal in everything.
#[derive(Clone, Copy)]
struct Point {
    group: usize,
    second: f64,
    /// Rank of the third coordinate, the largest first.
    third: usize,
    fourth: f64,
    beaten: bool,
}

/// Finds which of `candidates`, in the order in which they may dominate each other, are beaten;
/// leaves them in the order of the second coordinate, the largest first.
fn divide(candidates: &mut [Point], best: &mut PrefixMaxima) {
    if candidates.len() < 2 {
        return;
    }
    let (earlier, later) = candidates.split_at_mut(candidates.len() / 2);
    // Beaten points stay, and harm nothing: whom they beat, their victor beats as well.
    divide(earlier, best);
    divide(later, best);
    conquer(earlier, later, best);
    // The sort finds the two runs that are in order already, and merges them.
    candidates.sort_by(|a, b| b.second.total_cmp(&a.second));
}

/// Marks what `earlier` beats of `later`, both in the order of the second coordinate.
fn conquer(earlier: &[Point], later: &mut [Point], best: &mut PrefixMaxima) {
    let mut above = 0;
    for candidate in later {
        // Of equal seconds too: what stands earlier is at least as good in the first, and equal points are one candidate.
        while above < earlier.len() && earlier[above].second >= candidate.second {
            best.raise(earlier[above].third, earlier[above].fourth);
            above += 1;
        }
        candidate.beaten |= best.up_to(candidate.third) >= candidate.fourth;
    }
    // Only what was raised is taken back: to clear the whole tree would cost as much as all points in every part.
    earlier[..above].iter().for_each(|candidate| best.clear(candidate.third));
}

/// Maxima of the values at all places up to a given one: a Fenwick tree.
struct PrefixMaxima {
    values: Vec<f64>,
}

impl PrefixMaxima {
    fn raise(&mut self, place: usize, value: f64) {
        let mut node = place + 1;
        while node < self.values.len() {
            self.values[node] = self.values[node].max(value);
            node += node & node.wrapping_neg();
        }
    }

    fn clear(&mut self, place: usize) {
        let mut node = place + 1;
        while node < self.values.len() {
            self.values[node] = f64::NEG_INFINITY;
            node += node & node.wrapping_neg();
        }
    }

    fn up_to(&self, place: usize) -> f64 {
        let mut node = place + 1;
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
    fn small_fronts() {
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
        fn the_front_is_the_one_of_the_definition(
            // Few values, so that ties in some coordinates and equal points are common.
            points in prop::collection::vec(prop::array::uniform4(-1_i32..6), 0..120),
        ) {
            let points: Vec<Quadruple> = points.iter().map(|p| p.map(f64::from)).collect();
            prop_assert_eq!(pareto_front(&points), by_definition(&points));
        }

        #[test]
        fn of_points_in_general_position_too(
            points in prop::collection::vec(prop::array::uniform4(-1.0_f64..1.0), 0..200),
        ) {
            prop_assert_eq!(pareto_front(&points), by_definition(&points));
        }

        #[test]
        fn of_more_criteria_than_four_too(
            points in prop::collection::vec(prop::array::uniform8(-1_i32..3), 0..60),
            count in 5_usize..9,
        ) {
            let cut = |p: &[i32; 8]| p.map(f64::from)[..count].to_vec();
            let points: Vec<f64> = points.iter().flat_map(cut).collect();
            let points = || points.chunks_exact(count);
            let expected: Vec<bool> = points().map(|q| !points().any(|p| dominates(p, q))).collect();
            prop_assert_eq!(front_of(&points().collect::<Vec<_>>().concat(), count), expected);
        }
    }
}
