//! Points on the peaks of coverage, from which searches begin: those that fall least short of what is known without solving.

use std::collections::BTreeMap;

use ranking::Requirement;
use results::DesignResult;
use sweep::{Case, DesignNumber};

use crate::contact_margin::contact_margin;
use crate::coverage_piece::{self, COMPLIANCES, open_share};
use crate::judge::Judge;
use crate::space::{DesignSpace, SpacePoint};
use crate::space_filling;

/// Points from which peaks are looked for.
const POINTS: usize = 512;

/// Points on each peak that are solved.
const EACH: usize = 6;

/// A point that falls this much short of what is known in closed form is not solved.
const HOPELESS: f64 = 0.25;

/// Points on a peak that are solved are apart by this share of some interval.
const APART: f64 = 0.05;

/// Bisections that find a peak on an interval, well within [`BORDER`].
const BISECTIONS: usize = 40;

/// Points on every peak of coverage that the space has, those first that fall least short of the requirements that are known in closed form.
pub(crate) fn points_on_peaks(space: &DesignSpace, judge: &Judge, seed: u64) -> Vec<SpacePoint> {
    let number = space.sweep().grid().number(0);
    // Ordered, so that the same goal has the same points in the same order in every session.
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

/// The points on peaks that are reached from `point` along an interval.
fn peaks_along(space: &DesignSpace, point: &SpacePoint, interval: usize) -> Vec<(u32, SpacePoint)> {
    let at = |share: f64| {
        let mut moved = point.clone();
        moved.shares[interval] = share;
        moved
    };
    let place = |share| coverage_piece::place(&space.case(&at(share)));
    let Some((first, last)) = place(0.0).zip(place(1.0)) else { return Vec::new() };
    let (low, high) = (first.min(last), first.max(last));
    // The place `S/p` grows or falls all along an interval, whichever length it is.
    let on_peak = |peak: u32| {
        let (mut below, mut above) = if first < last { (0.0, 1.0) } else { (1.0, 0.0) };
        for _ in 0..BISECTIONS {
            let middle = f64::midpoint(below, above);
            let is_below = place(middle)? < f64::from(peak);
            *(if is_below { &mut below } else { &mut above }) = middle;
        }
        Some((peak, at(above)))
    };
    // Empty along an interval that does not move `S/p`, such as a modulus.
    (low.floor() as u32 + 1..=high.floor() as u32).filter_map(on_peak).collect()
}

/// How far a design on a peak falls short of what is known of its requirements without solving it: coverage, parameters, masses, and
/// that no compliance is above `d/p`.
fn known_shortfall(judge: &Judge, case: &Case, number: DesignNumber) -> f64 {
    let Some(open) = open_share(case) else { return f64::INFINITY };
    // On a peak coverage is `1 − d/p` itself (O8), and needs no solution.
    let result = DesignResult { coverage: Some(1.0 - open), ..DesignResult::default() };
    let margin = |(requirement, value): (&Requirement, Option<f64>)| {
        let is_compliance = COMPLIANCES.contains(&requirement.column.as_str());
        let bound = || (is_compliance && requirement.direction() > 0.0).then_some(open);
        value.or_else(bound).map_or(0.0, |value| requirement.margin(value).min(0.0))
    };
    // Where scales touch in bending, no compliance is left.
    let bends = |r: &&Requirement| r.column == COMPLIANCES[0] && r.direction() > 0.0;
    let touching = judge.requirements().find(bends).map_or(0.0, |_| contact_margin(case).min(0.0));
    -judge.known(case, number, result).into_iter().map(margin).sum::<f64>() - touching
}

/// The first of some points by their shortfalls that are apart from each other.
fn spread(mut points: Vec<(f64, SpacePoint)>) -> Vec<SpacePoint> {
    points.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let mut chosen: Vec<SpacePoint> = Vec::new();
    for (shortfall, point) in points {
        // In the order of their shortfalls: of two near each other the one that falls short by more is left out.
        if shortfall <= HOPELESS
            && chosen.len() < EACH
            && chosen.iter().all(|other| other.distance(&point) >= APART)
        {
            chosen.push(point);
        }
    }
    chosen
}
