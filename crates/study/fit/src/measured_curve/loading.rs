//! Signs, branches and events of a measured curve.

use std::ops::Range;

/// Reversal of the displacement that ends a branch, as a fraction of the displacement range.
const TURNED_BACK: f64 = 0.05;
/// Fraction of the largest force below which the force stays after a specimen has failed.
const LOST: f64 = 0.2;
/// Fraction of the largest force that the last point before a failure exceeds.
const BEFORE_LOSS: f64 = 0.5;
/// Least drop of the force that is reported, as a fraction of the largest force.
///
/// Both the drop between two points and the drop between the means of their neighbours must exceed
/// this value.
const DROP: f64 = 0.25;
/// Number of points before and after a drop in these means.
const NEIGHBOURS: usize = 3;
/// Largest change of the displacement during a hold, as a fraction of the displacement range.
const HELD: f64 = 1e-3;
/// Least number of points of a hold: absolute, and as a fraction of all points.
const LEAST_HELD: (usize, f64) = (5, 0.05);

/// Fraction of the largest force up to which a curve is searched for the first contact.
const CONTACT: f64 = 0.3;
/// Least length of an approach before contact: fraction of the displacement range, and points.
const LEAST_APPROACH: (f64, usize) = (0.1, 5);
/// Largest rise of the force during an approach, as a fraction of the largest force.
const FLAT: f64 = 0.02;
/// Least F statistic of a line with a bend at first contact, compared with a straight line.
///
/// The statistic is the maximum over many positions of the bend, so this limit exceeds the usual
/// quantiles of the F distribution.
const SIGNIFICANT: f64 = 20.0;
/// Maximum number of positions of first contact that are compared.
const CONTACTS: usize = 100;

/// Kind of an event of a measured curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveEventKind {
    /// The force or moment begins to rise after an approach without contact.
    Touches,
    /// The displacement or curvature turns back, and unloading begins.
    TurnsBack,
    /// After unloading, the displacement or curvature grows again.
    TurnsAgain,
    /// The force or moment drops to a fraction and does not recover.
    Fails,
    /// The force or moment drops in one step, but the specimen still carries load.
    Drops,
    /// The displacement or curvature is held, and the force relaxes.
    Held,
}

/// Event of a measured curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveEvent {
    /// Kind of the event.
    pub kind: CurveEventKind,
    /// Line number of the last point before the event.
    pub line: u64,
    /// Displacement or curvature at the event.
    pub at: f64,
    /// Number of points that the fit leaves out because of the event.
    pub excluded_points: usize,
}

/// Branches of a measured curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Branches {
    /// Indices of the points of the first loading branch.
    pub(crate) loading: Vec<usize>,
    /// Indices of the points of the unloading branch after it.
    pub(crate) unloading: Vec<usize>,
    /// Events, in the order of their lines.
    pub(crate) events: Vec<CurveEvent>,
}

/// Detects reversed signs of the displacement and of the force.
///
/// Some machines count compression as negative. The displacement is reversed in two cases:
///
/// - its value of largest size is negative and below its first value;
/// - it never rises above its first value, and the size of the force grows meanwhile, e.g. the
///   position of a crosshead that moves down.
///
/// The force is reversed if its value of largest size is negative, and its size grows with the
/// displacement.
pub(super) fn reversed_signs(points: &[[f64; 2]]) -> [bool; 2] {
    let [largest_x, largest_y] = [0, 1].map(|axis| {
        let values = points.iter().map(|point| point[axis]);
        values.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
    });
    let count = points.len() as f64;
    let [x, y] = [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / count);
    let products = points.iter().map(|point| (point[0] - x) * (point[1] - y));
    let covariance: f64 = products.sum::<f64>() * largest_y.signum();
    let first = points.first().map_or(0.0, |point| point[0]);
    let lowest = points.iter().map(|point| point[0]).fold(first, f64::min);
    let is_falling = points.iter().all(|p| p[0] <= first + TURNED_BACK * (first - lowest));
    let is_reversed = (largest_x < 0.0 && largest_x < first) || (is_falling && covariance < 0.0);
    let covariance = if is_reversed { -covariance } else { covariance };
    [is_reversed, largest_y < 0.0 && covariance > 0.0]
}

/// Divides a curve into its loading and unloading branches, and detects events.
pub(super) fn branches(points: &[[f64; 2]], lines: &[u64]) -> Branches {
    // Kind, index of the point, and number of points left out.
    let mut events: Vec<(CurveEventKind, usize, usize)> = Vec::new();
    let mut kept: Vec<usize> = (0..points.len()).collect();
    for hold in holds(points).into_iter().rev() {
        events.push((CurveEventKind::Held, hold.start, hold.len() - 1));
        kept.drain(hold.start + 1..hold.end);
    }
    let along: Vec<_> = kept.iter().map(|index| points[*index]).collect();
    let turn = turn(&along, 1.0);
    let mut loaded = turn.map_or(along.len(), |last| last + 1);
    let mut unloading = Vec::new();
    if let Some(last) = last_before_drop(&along[..loaded]) {
        loaded = last + 1;
        events.push((CurveEventKind::Fails, kept[last], along.len() - loaded));
    } else if let Some(last) = turn {
        events.push((CurveEventKind::TurnsBack, kept[last], 0));
        let back = &along[last + 1..];
        let end = self::turn(back, -1.0).map_or(back.len(), |lowest| lowest + 1);
        unloading.extend(&kept[loaded..loaded + end]);
        if end < back.len() {
            let lowest = kept[loaded + end - 1];
            events.push((CurveEventKind::TurnsAgain, lowest, back.len() - end));
        }
    }
    let touching = last_before_contact(&along[..loaded]);
    events.extend(touching.map(|last| (CurveEventKind::Touches, kept[last], 0)));
    let drops = drops(&along[..loaded]).into_iter();
    events.extend(drops.map(|last| (CurveEventKind::Drops, kept[last], 0)));
    events.sort_by_key(|(_, index, _)| lines[*index]);
    let events = events.into_iter().map(|(kind, index, excluded_points)| CurveEvent {
        kind,
        line: lines[index],
        at: points[index][0],
        excluded_points,
    });
    let events = events.collect();
    kept.truncate(loaded);
    Branches { loading: kept, unloading, events }
}

/// Returns the index of the point at which the displacement reverses, if it does.
///
/// `direction` is 1 for increasing and −1 for decreasing displacements before this point.
fn turn(points: &[[f64; 2]], direction: f64) -> Option<usize> {
    let range = range(points);
    let mut farthest = 0;
    for (index, point) in points.iter().enumerate() {
        let beyond = direction * (point[0] - points[farthest][0]);
        if beyond > 0.0 {
            farthest = index;
        } else if -beyond > TURNED_BACK * range {
            return Some(farthest);
        }
    }
    None
}

/// Returns the difference of the largest and smallest displacement.
pub(super) fn range(points: &[[f64; 2]]) -> f64 {
    let ends = points
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p[0]), high.max(p[0])]);
    ends[1] - ends[0]
}

/// Lists the runs of points, by index, at which the displacement is held.
fn holds(points: &[[f64; 2]]) -> Vec<Range<usize>> {
    let tolerance = HELD * range(points);
    let least = LEAST_HELD.0.max((LEAST_HELD.1 * points.len() as f64) as usize);
    let mut holds = Vec::new();
    let mut start = 0;
    while start < points.len() {
        // Runs do not overlap, so that long recordings take linear time.
        let end = points[start..]
            .iter()
            .position(|point| (point[0] - points[start][0]).abs() > tolerance)
            .map_or(points.len(), |n| start + n);
        if end - start >= least && tolerance > 0.0 {
            holds.push(start..end);
        }
        start = end;
    }
    holds
}

/// Returns the index of the last point of an approach without force.
///
/// Before this point the force is constant, and after it the force rises in a straight line. Such
/// a bent line must fit the beginning of the curve significantly better than one straight line.
fn last_before_contact(points: &[[f64; 2]]) -> Option<usize> {
    let largest = largest_force(points);
    let end = points.iter().position(|point| point[1] > CONTACT * largest)? + 1;
    let toe = &points[..end];
    let step = end.div_ceil(CONTACTS);
    let mut best: Option<(f64, usize)> = None;
    for last in (0..end - 1).step_by(step) {
        let hinge = toe.iter().map(|[x, y]| [(x - toe[last][0]).max(0.0), *y]);
        let (_, squares) = line(hinge);
        if best.is_none_or(|(least, _)| squares < least) {
            best = Some((squares, last));
        }
    }
    let (squares, last) = best?;
    let extent = points[last][0] - points[0][0];
    if last + 1 < LEAST_APPROACH.1 || extent < LEAST_APPROACH.0 * range(points) {
        return None;
    }
    let (_, straight) = line(toe.iter().copied());
    let variance = squares / (end as f64 - 3.0).max(1.0);
    let (slope, around) = line(toe[..=last].iter().copied());
    let mean = toe[..=last].iter().map(|point| point[0]).sum::<f64>() / (last + 1) as f64;
    let spread: f64 = toe[..=last].iter().map(|point| (point[0] - mean).powi(2)).sum();
    let error = (around / (last as f64 - 1.0).max(1.0) / spread).sqrt();
    let is_flat = slope.abs() < 2.0 * error || slope.abs() * extent < FLAT * largest;
    (is_flat && straight - squares > SIGNIFICANT * variance).then_some(last)
}

/// Fits a straight line. Returns its slope and the sum of the squared residuals.
fn line(points: impl Iterator<Item = [f64; 2]> + Clone) -> (f64, f64) {
    let (mut count, mut sums) = (0.0, [0.0; 2]);
    for point in points.clone() {
        count += 1.0;
        sums = [sums[0] + point[0], sums[1] + point[1]];
    }
    let means = sums.map(|sum| sum / count);
    let [mut xx, mut xy, mut yy] = [0.0; 3];
    for point in points {
        let [x, y] = [0, 1].map(|axis| point[axis] - means[axis]);
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    let slope = if xx > 0.0 { xy / xx } else { 0.0 };
    (slope, (yy - slope * xy).max(0.0))
}

/// Returns the index of the last point before the force drops and does not recover.
fn last_before_drop(points: &[[f64; 2]]) -> Option<usize> {
    let largest = largest_force(points);
    let kept = points.iter().rposition(|point| point[1] >= LOST * largest)?;
    (kept + 1 < points.len() && points[kept][1] > BEFORE_LOSS * largest).then_some(kept)
}

fn largest_force(points: &[[f64; 2]]) -> f64 {
    points.iter().map(|point| point[1]).fold(0.0, f64::max)
}

/// Lists the indices of the last points before steep drops of the force.
fn drops(points: &[[f64; 2]]) -> Vec<usize> {
    let least = DROP * largest_force(points);
    let mut drops = Vec::new();
    let mut next = NEIGHBOURS;
    while next + NEIGHBOURS <= points.len() {
        let lost = mean_force(&points[next - NEIGHBOURS..next])
            - mean_force(&points[next..next + NEIGHBOURS]);
        // Require a steep drop between two points near `next`: a gradual loss of force is a
        // property of the skin, not a failure.
        let near = next - NEIGHBOURS..next + NEIGHBOURS - 1;
        let falls = near.map(|last| (points[last][1] - points[last + 1][1], last));
        let (fall, last) = falls.fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a });
        if lost > least && fall > least {
            drops.push(last);
            next += 2 * NEIGHBOURS;
        } else {
            next += 1;
        }
    }
    drops
}

fn mean_force(points: &[[f64; 2]]) -> f64 {
    points.iter().map(|point| point[1]).sum::<f64>() / points.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(points: &[[f64; 2]]) -> Branches {
        branches(points, &(1..=points.len() as u64).collect::<Vec<_>>())
    }

    fn events(points: &[[f64; 2]]) -> Vec<(CurveEventKind, u64, usize)> {
        found(points)
            .events
            .iter()
            .map(|event| (event.kind, event.line, event.excluded_points))
            .collect()
    }

    /// Returns points of a line with slope 1 through the origin.
    fn ramp(displacements: impl Iterator<Item = u32>) -> Vec<[f64; 2]> {
        displacements.map(|k| [f64::from(k), f64::from(k)]).collect()
    }

    #[test]
    fn negative_compression_is_reversed_but_offsets_are_not() {
        assert_eq!(reversed_signs(&[[0.0, 0.0], [-1.0, -2.0], [-2.0, -5.0]]), [true, true]);
        assert_eq!(reversed_signs(&[[0.0, 0.0], [1.0, -2.0], [2.0, -5.0]]), [false, true]);
        assert_eq!(reversed_signs(&[[3.0, 0.0], [2.0, 2.0], [1.0, 5.0]]), [true, false]);
        assert_eq!(reversed_signs(&[[3.0, 0.0], [2.0, -2.0], [1.0, -5.0]]), [true, true]);
        // A curve that contains only the unloading branch keeps its signs.
        assert_eq!(reversed_signs(&[[3.0, 5.0], [2.0, 2.0], [1.0, 0.0]]), [false, false]);
        assert_eq!(reversed_signs(&[[-9.0, -5.0], [-8.0, -4.0], [-7.0, -2.0]]), [false, false]);
    }

    /// Returns a curve with slope 1 after an approach of `length` without force, with noise.
    fn approach(length: f64, noise: f64) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        for k in 0..40_u32 {
            let x = 0.05 * f64::from(k);
            // Deterministic noise without a trend.
            let error = noise * (f64::from(k * k) * 0.7).sin();
            points.push([x, (x - length).max(0.0) + error]);
        }
        points
    }

    #[test]
    fn contact_after_an_approach_is_reported() {
        for noise in [0.0, 0.01, 0.03] {
            let found = events(&approach(1.0, noise));
            let [(CurveEventKind::Touches, line, 0)] = found[..] else { panic!("{found:?}") };
            assert!((19..=23).contains(&line), "{noise}: {line}");
            // A straight line has no approach.
            assert_eq!(events(&approach(0.0, noise)), [], "{noise}");
        }
        // A curve that becomes steeper, and a short approach, do not count as an approach.
        let steeper: Vec<_> = approach(0.0, 0.0).iter().map(|[x, y]| [*x, y * y]).collect();
        assert_eq!(events(&steeper), []);
        assert_eq!(events(&approach(0.1, 0.0)), []);
    }

    #[test]
    fn loading_ends_where_the_displacement_turns_back() {
        let points = ramp((0..20).chain((0..19).rev()));
        let branches = found(&points);
        assert_eq!(branches.loading, (0..20).collect::<Vec<_>>());
        assert_eq!(branches.unloading, (20..39).collect::<Vec<_>>());
        assert_eq!(events(&points), [(CurveEventKind::TurnsBack, 20, 0)]);
        assert_eq!(found(&points[..20]).events, []);
    }

    #[test]
    fn unloading_ends_where_the_displacement_grows_again() {
        let points = ramp((0..20).chain((5..19).rev()).chain(6..12));
        assert_eq!(found(&points).unloading, (20..34).collect::<Vec<_>>());
        let again = (CurveEventKind::TurnsAgain, 34, 6);
        assert_eq!(events(&points), [(CurveEventKind::TurnsBack, 20, 0), again]);
    }

    #[test]
    fn holds_are_left_out_after_their_first_point() {
        let mut points = ramp(0..20);
        let relaxed = (1..9).map(|k| [10.0, 10.0 - 0.3 * f64::from(k)]);
        points.splice(11..11, relaxed);
        assert_eq!(events(&points), [(CurveEventKind::Held, 11, 8)]);
        assert_eq!(found(&points).loading.len(), 20);
        // A hold at the largest displacement precedes the reversal.
        let points = ramp((0..20).chain([19; 6]).chain((0..19).rev()));
        let held = (CurveEventKind::Held, 20, 6);
        assert_eq!(events(&points), [held, (CurveEventKind::TurnsBack, 20, 0)]);
        assert_eq!(found(&points).unloading, (26..45).collect::<Vec<_>>());
    }

    #[test]
    fn loading_ends_where_the_specimen_fails() {
        let mut points = ramp(0..20);
        points.extend((20..25).map(|k| [f64::from(k), 0.1]));
        assert_eq!(events(&points), [(CurveEventKind::Fails, 20, 5)]);
        assert_eq!(found(&points).loading.len(), 20);
        // A gradual loss of force is a property of the skin, not a failure.
        let points: Vec<_> = (0..21).map(|k| [f64::from(k), f64::from(k * (20 - k))]).collect();
        assert_eq!(found(&points).events, []);
    }

    #[test]
    fn drops_within_the_curve_are_kept_and_reported() {
        let points: Vec<_> = (0..40_u32)
            .map(|k| [f64::from(k), if k < 20 { f64::from(k) } else { f64::from(k) - 12.0 }])
            .collect();
        assert_eq!(events(&points), [(CurveEventKind::Drops, 20, 0)]);
        assert_eq!(found(&points).loading.len(), 40);
    }
}
