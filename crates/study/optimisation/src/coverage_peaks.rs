//! Selects start points on the coverage peaks (O8).
//!
//! Closed forms give a lower bound of the shortfall of a point without solving its design. The
//! points with the smallest bounds are selected.

use std::collections::BTreeMap;

use results::DesignResult;
use sweep::{Case, DesignNumber};

use crate::contact_margin::contact_margin;
use crate::coverage_piece::{self, COMPLIANCES, open_share};
use crate::judge::Judge;
use crate::space::{DesignSpace, SpacePoint};
use crate::space_filling;

/// Number of space-filling points. Peaks are located along lines through these points.
const POINTS: usize = 512;

/// Maximum number of points selected on each peak.
const EACH: usize = 6;

/// Sum of known shortfalls, relative to the limits, above which a point is not selected.
const MAX_SHORTFALL: f64 = 0.25;

/// Minimum distance of two points on a peak, as a fraction of the ranges of the variables.
const MIN_DISTANCE: f64 = 0.05;

/// Number of bisections to locate a peak.
///
/// The remaining error is far below the tolerance within which a point counts as on the border of a
/// coverage branch.
const BISECTIONS: usize = 40;

/// Returns points on each coverage peak, in the order of the peaks.
///
/// The points of a peak are sorted by their known shortfall, the smallest first. `seed` selects the
/// space-filling points.
pub(crate) fn points_on_peaks(space: &DesignSpace, judge: &Judge, seed: u64) -> Vec<SpacePoint> {
    let number = space.sweep().grid().number(0);
    // A `BTreeMap` has the same order in every session, a `HashMap` has not.
    let mut on_peaks: BTreeMap<u32, Vec<(f64, SpacePoint)>> = BTreeMap::new();
    for point in space_filling::points(space, POINTS, seed) {
        for interval in 0..point.fractions.len() {
            for (peak, found) in peaks_along(space, &point, interval) {
                let shortfall = known_shortfall(judge, &space.case(&found), number);
                on_peaks.entry(peak).or_default().push((shortfall, found));
            }
        }
    }
    on_peaks.into_values().flat_map(spread).collect()
}

/// Returns points on coverage peaks along a line through `point`, each with the number of its peak.
///
/// Only the continuous variable with index `interval` varies along this line.
fn peaks_along(space: &DesignSpace, point: &SpacePoint, interval: usize) -> Vec<(u32, SpacePoint)> {
    let at = |fraction| {
        coverage_piece::reach_over_pitch(&space.case(&point.with_fraction(interval, fraction)))
    };
    let Some((first, last)) = at(0.0).zip(at(1.0)) else { return Vec::new() };
    let (low, high) = (first.min(last), first.max(last));
    // `S/p` is monotonic along the interval of a length or the slant, so each integer between its
    // values at both ends is one peak. The range is empty for parameters that do not change `S/p`,
    // e.g. a modulus.
    (low.floor() as u32 + 1..=high.floor() as u32)
        .filter_map(|peak| {
            let (mut below, mut above) = if first < last { (0.0, 1.0) } else { (1.0, 0.0) };
            for _ in 0..BISECTIONS {
                let middle = f64::midpoint(below, above);
                let is_below = at(middle)? < f64::from(peak);
                *(if is_below { &mut below } else { &mut above }) = middle;
            }
            Some((peak, point.with_fraction(interval, above)))
        })
        .collect()
}

/// Returns the sum of the shortfalls of a design on a peak that are known without solving it.
///
/// Coverage, parameters and masses are exact. Compliances have the upper bound `d/p`.
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
    // Contact in bending reduces the compliance. So a lower limit of the compliance requires that
    // the strip bends without contact.
    let touching = judge
        .requirements()
        .find(|r| r.column == COMPLIANCES[0] && r.direction() > 0.0)
        .map_or(0.0, |_| contact_margin(case).min(0.0));
    -known.sum::<f64>() - touching
}

/// Selects the points with the smallest shortfall that are at least `MIN_DISTANCE` apart.
fn spread(mut points: Vec<(f64, SpacePoint)>) -> Vec<SpacePoint> {
    points.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let mut chosen: Vec<SpacePoint> = Vec::new();
    for (shortfall, point) in points {
        // The points are sorted, so the first of two close points has the smaller shortfall.
        if shortfall <= MAX_SHORTFALL
            && chosen.len() < EACH
            && chosen.iter().all(|other| other.distance(&point) >= MIN_DISTANCE)
        {
            chosen.push(point);
        }
    }
    chosen
}
