//! Contours of values on a grid, computed by the marching squares algorithm.

/// A position on the grid. Nodes have whole numbers as coordinates.
type Place = [f64; 2];

/// Returns the segments of the contours at `level` on a grid of `size` nodes.
///
/// A segment is a straight line within a square of four nodes. A square in which a node has no
/// value has no segments.
pub(super) fn contours(
    size: [usize; 2],
    value: &impl Fn(usize, usize) -> Option<f64>,
    level: f64,
) -> Vec<[Place; 2]> {
    let [columns, rows] = size.map(|count| count.saturating_sub(1));
    let squares = (0..columns).flat_map(|i| (0..rows).map(move |j| [i, j]));
    squares.flat_map(|at| square(at, value, level).unwrap_or_default()).collect()
}

/// Joins segments that share ends into lines.
pub(super) fn joined(segments: Vec<[Place; 2]>) -> Vec<Vec<Place>> {
    let mut lines: Vec<Vec<Place>> = Vec::new();
    let mut remaining = segments;
    while let Some(first) = remaining.pop() {
        let mut line = first.to_vec();
        for _ in 0..2 {
            while let Some(k) =
                remaining.iter().position(|segment| continued(&line, segment).is_some())
            {
                let segment = remaining.swap_remove(k);
                line.extend(continued(&line, &segment));
            }
            // Then extend the line at its other end.
            line.reverse();
        }
        lines.push(line);
    }
    lines
}

/// Returns the far end of a segment if its other end is the end of `line`.
fn continued(line: &[Place], [from, to]: &[Place; 2]) -> Option<Place> {
    let end = line[line.len() - 1];
    is_same(end, *from).then_some(*to).or(is_same(end, *to).then_some(*from))
}

/// Returns true if two positions are equal up to round-off.
///
/// Two neighbouring squares interpolate a shared position in opposite directions.
fn is_same(a: Place, b: Place) -> bool {
    (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-6
}

/// Returns the segments in the square from node `[i, j]`; `None` if a corner has no value.
fn square(
    [i, j]: [usize; 2],
    value: &impl Fn(usize, usize) -> Option<f64>,
    level: f64,
) -> Option<Vec<[Place; 2]>> {
    // The corners are in cyclic order, so that each edge joins a corner and its successor.
    let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
    let mut values = [0.0; 4];
    for (own, [i, j]) in values.iter_mut().zip(corners) {
        *own = value(i, j)?;
    }
    let edges = (0..4).filter_map(|k| {
        let next = (k + 1) % 4;
        let is_crossed = (values[k] < level) != (values[next] < level);
        let part = (level - values[k]) / (values[next] - values[k]);
        is_crossed.then(|| between(corners[k], corners[next], part))
    });
    let edges: Vec<Place> = edges.collect();
    Some(match *edges.as_slice() {
        [a, b] => vec![[a, b]],
        [a, b, c, d] => {
            // At a saddle, the mean value decides which of the four crossings are connected.
            let middle = values.iter().sum::<f64>() / 4.0;
            if (middle < level) == (values[0] < level) {
                vec![[a, b], [c, d]]
            } else {
                vec![[d, a], [b, c]]
            }
        }
        _ => vec![],
    })
}

/// Returns the position at the fraction `part` between two nodes.
fn between(from: [usize; 2], to: [usize; 2], part: f64) -> Place {
    [0, 1].map(|k| (1.0 - part) * from[k] as f64 + part * to[k] as f64)
}

#[cfg(test)]
mod tests {
    use super::{contours, joined};

    #[test]
    fn segments_are_joined_into_lines() {
        let hill =
            |i: usize, j: usize| Some(-((i as f64 - 3.0).powi(2) + (j as f64 - 3.0).powi(2)));
        let ring = joined(contours([7, 7], &hill, -4.5));
        assert_eq!(ring.len(), 1);
        assert_eq!(ring[0].first(), ring[0].last());
        let lines = joined(contours([4, 6], &|i, j| Some(i as f64 + 0.1 * j as f64), 1.7));
        assert_eq!((lines.len(), lines[0].len()), (1, 6), "{lines:?}");
    }

    #[test]
    fn contours_of_a_plane_lie_at_their_level() {
        let pieces = contours([5, 4], &|i, j| Some(i as f64 + 2.0 * j as f64), 3.3);
        assert!(pieces.len() >= 4);
        for [x, y] in pieces.into_iter().flatten() {
            assert!((x + 2.0 * y - 3.3).abs() < 1e-12, "{x} {y}");
        }
    }

    #[test]
    fn contours_of_a_saddle_follow_its_mean_value() {
        // Two opposite corners have high values, so that the mean value decides.
        for (high, cuts_off_the_low) in [(3.0, true), (1.5, false)] {
            let pieces = contours([2, 2], &|i, j| Some(if i == j { high } else { 0.0 }), 1.0);
            assert_eq!(pieces.len(), 2);
            let is_near = pieces[0].iter().all(|place| place[0] == 1.0 || place[1] == 0.0);
            assert_eq!(is_near, cuts_off_the_low, "{pieces:?}");
        }
    }

    #[test]
    fn squares_with_missing_values_have_no_contours() {
        assert!(contours([3, 3], &|i, j| (i != 1 || j != 1).then_some(i as f64), 0.5).is_empty());
        assert!(contours([1, 3], &|_, j| Some(j as f64), 0.5).is_empty());
    }
}
