//! Signs and loading branch of a measured curve.

/// Fraction of the range of the displacement by which it turns back at the end of loading.
const TURNED_BACK: f64 = 0.05;
/// Fraction of the largest force that remains after a specimen has failed.
const LOST: f64 = 0.2;
/// Fraction of the largest force from which a failure drops in one step.
const BEFORE_LOSS: f64 = 0.5;

/// Reason for which a curve goes on after its first loading branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EndReason {
    /// The displacement or curvature turns back.
    TurnsBack,
    /// The force or moment drops and does not recover.
    Drops,
}

/// End of the first loading branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ending {
    /// Reason.
    pub reason: EndReason,
    /// Line of the last point of the branch.
    pub line: u64,
    /// Number of points after it.
    pub left_out: usize,
}

/// Detects axes with reversed signs, for example of machines that count compression as negative.
///
/// The displacement is reversed if it decreases from the start and is negative. The force is
/// reversed if it decreases while the displacement grows, and is negative where it is largest.
pub(super) fn reversed_signs(points: &[[f64; 2]]) -> [bool; 2] {
    let largest = |axis: usize| {
        let values = points.iter().map(|point| point[axis]);
        values.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
    };
    let count = points.len() as f64;
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / count;
    let [x, y] = [mean(0), mean(1)];
    let covariance: f64 = points.iter().map(|point| (point[0] - x) * (point[1] - y)).sum();
    let first = points.first().map_or(0.0, |point| point[0]);
    let is_reversed = largest(0) < 0.0 && largest(0) < first;
    let covariance = if is_reversed { -covariance } else { covariance };
    [is_reversed, largest(1) < 0.0 && covariance < 0.0]
}

/// Finds the end of the first loading branch; `None` if all points belong to it.
pub(super) fn end(points: &[[f64; 2]], lines: &[u64]) -> Option<Ending> {
    let ending = |last: usize, reason| Ending {
        reason,
        line: lines[last],
        left_out: points.len() - 1 - last,
    };
    let (low, high) = points
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[0]), high.max(p[0])));
    let mut farthest = 0;
    let mut turn = None;
    for (index, point) in points.iter().enumerate() {
        // At a hold, the force relaxes after the first point.
        if point[0] > points[farthest][0] || index == 0 {
            farthest = index;
        } else if points[farthest][0] - point[0] > TURNED_BACK * (high - low) {
            turn = Some(farthest);
            break;
        }
    }
    let loading = &points[..turn.map_or(points.len(), |last| last + 1)];
    let drop = last_before_drop(loading);
    drop.map(|last| ending(last, EndReason::Drops))
        .or_else(|| turn.map(|last| ending(last, EndReason::TurnsBack)))
}

/// Returns the last point before the force drops in one step and does not recover.
fn last_before_drop(points: &[[f64; 2]]) -> Option<usize> {
    let largest = points.iter().map(|point| point[1]).fold(0.0, f64::max);
    let kept = points.iter().rposition(|point| point[1] >= LOST * largest)?;
    (kept + 1 < points.len() && points[kept][1] > BEFORE_LOSS * largest).then_some(kept)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(points: &[[f64; 2]]) -> Option<Ending> {
        end(points, &(1..=points.len() as u64).collect::<Vec<_>>())
    }

    #[test]
    fn negative_compression_is_reversed_but_offsets_are_not() {
        assert_eq!(reversed_signs(&[[0.0, 0.0], [-1.0, -2.0], [-2.0, -5.0]]), [true, true]);
        assert_eq!(reversed_signs(&[[0.0, 0.0], [1.0, -2.0], [2.0, -5.0]]), [false, true]);
        assert_eq!(reversed_signs(&[[3.0, 0.0], [2.0, 2.0], [1.0, 5.0]]), [false, false]);
        assert_eq!(reversed_signs(&[[-9.0, -5.0], [-8.0, -4.0], [-7.0, -2.0]]), [false, false]);
    }

    #[test]
    fn loading_ends_where_the_displacement_turns_back() {
        let there = (0..20).map(|k| [f64::from(k), f64::from(k)]);
        let back = (0..19).rev().map(|k| [f64::from(k), 0.5 * f64::from(k)]);
        let ending = Ending { reason: EndReason::TurnsBack, line: 20, left_out: 19 };
        assert_eq!(found(&there.clone().chain(back).collect::<Vec<_>>()), Some(ending));
        assert_eq!(found(&there.collect::<Vec<_>>()), None);
    }

    #[test]
    fn loading_ends_where_the_specimen_fails() {
        let mut points: Vec<_> = (0..20).map(|k| [f64::from(k), f64::from(k)]).collect();
        points.extend((20..25).map(|k| [f64::from(k), 0.1]));
        let ending = Ending { reason: EndReason::Drops, line: 20, left_out: 5 };
        assert_eq!(found(&points), Some(ending));
        // A gradual loss is a property of the skin.
        let points: Vec<_> = (0..21).map(|k| [f64::from(k), f64::from(k * (20 - k))]).collect();
        assert_eq!(found(&points), None);
    }
}
