//! Simplification of curves, to shorten a page.

/// Maximum distance of an omitted point from the curve, relative to the size of the curve.
const TOLERANCE: f64 = 5e-4;

/// Simplifies a curve by the algorithm of Ramer, Douglas and Peucker.
///
/// Ramer (1972), doi 10.1016/S0146-664X(72)80017-0; Douglas and Peucker (1973).
pub(super) fn simplified(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let Some(last) = points.len().checked_sub(1) else { return Vec::new() };
    let size = [0, 1].map(|k| {
        let (low, high) = crate::axis::ends(points.iter().map(|point| point[k]));
        // `distance` divides by the size, which is zero for a horizontal or vertical curve.
        (high - low).max(f64::MIN_POSITIVE)
    });
    let mut kept = vec![false; points.len()];
    [kept[0], kept[last]] = [true, true];
    // An explicit stack, because recursion could be as deep as the number of points.
    let mut parts = vec![(0, last)];
    while let Some((first, last)) = parts.pop() {
        let line = [points[first], points[last]];
        let distances = (first + 1..last).map(|k| (k, distance(points[k], line, size)));
        let farthest = distances.max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, _)) = farthest.filter(|(_, away)| *away > TOLERANCE) {
            kept[k] = true;
            parts.extend([(first, k), (k, last)]);
        }
    }
    points.iter().zip(kept).filter(|(_, kept)| *kept).map(|(point, _)| *point).collect()
}

/// Returns the distance of a point from a segment, relative to the size of the curve.
fn distance(point: [f64; 2], [from, to]: [[f64; 2]; 2], size: [f64; 2]) -> f64 {
    let [along, away] = [to, point].map(|end| [0, 1].map(|k| (end[k] - from[k]) / size[k]));
    let squared = along[0] * along[0] + along[1] * along[1];
    let part =
        if squared > 0.0 { (along[0] * away[0] + along[1] * away[1]) / squared } else { 0.0 };
    let part = part.clamp(0.0, 1.0);
    (away[0] - part * along[0]).hypot(away[1] - part * along[1])
}

#[cfg(test)]
mod tests {
    use super::simplified;

    #[test]
    fn simplification_keeps_ends_and_corners() {
        let corner: Vec<_> = (0..=100).map(|k| [f64::from(k), f64::from(k.max(40) - 40)]).collect();
        assert_eq!(simplified(&corner), [[0.0, 0.0], [40.0, 0.0], [100.0, 60.0]]);
        assert_eq!(simplified(&[[1.0, 2.0]]), [[1.0, 2.0]]);
        assert_eq!(simplified(&[]), [[0.0; 2]; 0]);
    }

    #[test]
    fn simplified_curves_stay_within_the_tolerance() {
        let curve: Vec<_> =
            (0..=1000).map(|k| f64::from(k) / 1000.0).map(|x| [x, 7.0 * x * x * x]).collect();
        let kept = simplified(&curve);
        assert!(kept.len() < 60, "{}", kept.len());
        for [x, y] in curve {
            let next = kept.iter().position(|point| point[0] >= x).unwrap().max(1);
            let [a, b] = [kept[next - 1], kept[next]];
            let line = a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]);
            assert!((line - y).abs() < 7.0 * 3e-3, "{x} {line} {y}");
        }
    }
}
