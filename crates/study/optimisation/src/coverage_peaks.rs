//! Start points on coverage peaks, ordered by predicted shortfall.
//!
//! Closed forms predict the shortfall.

use std::collections::BTreeMap;

use results::DesignResult;
use sweep::{Case, DesignNumber};

use crate::contact_margin::contact_margin;
use crate::coverage_piece::{self, COMPLIANCES, open_share};
use crate::judge::Judge;
use crate::space::{DesignSpace, SpacePoint};
use crate::space_filling;

/// Space-filling points from which peaks are located.
const POINTS: usize = 512;

/// Maximum number of points evaluated on each peak.
const EACH: usize = 6;

/// Predicted shortfall above which a point is not evaluated.
const HOPELESS: f64 = 0.25;

/// Minimum distance of points on a peak, as a fraction of the intervals.
const APART: f64 = 0.05;

/// Number of bisections to locate a peak.
///
/// The error is far below the tolerance of a branch border.
const BISECTIONS: usize = 40;

/// Returns points on every coverage peak, the least predicted shortfall first.
pub(crate) fn points_on_peaks(space: &DesignSpace, judge: &Judge, seed: u64) -> Vec<SpacePoint> {
    let number = space.sweep().grid().number(0);
    // An ordered map gives the same points in the same order in every session.
    let mut on_peaks: BTreeMap<u32, Vec<(f64, SpacePoint)>> = BTreeMap::new();
    for point in space_filling::points(space, POINTS, seed) {
        for interval in 0..point.shares.len() {
            for (peak, found) in peaks_along(space, &point, interval) {
                let shortfall = known_shortfall(judge, &space.case(&found), number);
                on_peaks.entry(peak).or_default().push((shortfall, found));
            }
        }
    }
    on_peaks.into_values().flat_map(spread).collect()
}

/// Returns the points on coverage peaks along one interval through `point`.
fn peaks_along(space: &DesignSpace, point: &SpacePoint, interval: usize) -> Vec<(u32, SpacePoint)> {
    let at =
        |share| coverage_piece::reach_over_pitch(&space.case(&point.with_share(interval, share)));
    let Some((first, last)) = at(0.0).zip(at(1.0)) else { return Vec::new() };
    let (low, high) = (first.min(last), first.max(last));
    // `S/p` is monotonic along an interval of any length parameter.
    // Empty if the interval does not change `S/p`, for example a modulus.
    (low.floor() as u32 + 1..=high.floor() as u32)
        .filter_map(|peak| {
            let (mut below, mut above) = if first < last { (0.0, 1.0) } else { (1.0, 0.0) };
            for _ in 0..BISECTIONS {
                let middle = f64::midpoint(below, above);
                let is_below = at(middle)? < f64::from(peak);
                *(if is_below { &mut below } else { &mut above }) = middle;
            }
            Some((peak, point.with_share(interval, above)))
        })
        .collect()
}

/// Returns the shortfall of a design on a peak, as far as it is known without a solution.
///
/// Coverage, parameters and masses are exact; compliance is bounded by `d/p`.
fn known_shortfall(judge: &Judge, case: &Case, number: DesignNumber) -> f64 {
    let Some(open) = open_share(case) else { return f64::INFINITY };
    // On a peak the coverage is exactly `1 − d/p` (O8).
    let result = DesignResult { coverage: Some(1.0 - open), ..DesignResult::default() };
    let known = judge.known(case, number, result).into_iter().map(|(requirement, value)| {
        let is_compliance = COMPLIANCES.contains(&requirement.column.as_str());
        value
            .or_else(|| (is_compliance && requirement.direction() > 0.0).then_some(open))
            .map_or(0.0, |value| requirement.margin(value).min(0.0))
    });
    // Contact in bending reduces the compliance, so a lower limit on it needs slack before contact.
    let touching = judge
        .requirements()
        .find(|r| r.column == COMPLIANCES[0] && r.direction() > 0.0)
        .map_or(0.0, |_| contact_margin(case).min(0.0));
    -known.sum::<f64>() - touching
}

/// Selects the points with the least shortfall that are apart from each other.
fn spread(mut points: Vec<(f64, SpacePoint)>) -> Vec<SpacePoint> {
    points.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let mut chosen: Vec<SpacePoint> = Vec::new();
    for (shortfall, point) in points {
        // Sorted by shortfall: of two close points, the one with the larger shortfall is dropped.
        if shortfall <= HOPELESS
            && chosen.len() < EACH
            && chosen.iter().all(|other| other.distance(&point) >= APART)
        {
            chosen.push(point);
        }
    }
    chosen
}
