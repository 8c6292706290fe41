//! Searches the front of several objectives by the ε-constraint method.
//!
//! One objective is maximised under lower bounds on the others.

use ranking::dominates;
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

use crate::best::{BestDesign, best_design};
use crate::candidate::{Candidate, Merit, SearchStage, Target};
use crate::evaluations::Halt;
use crate::improvement::{Plan, improved_from};
use crate::judgement::Judgement;
use crate::local::Search;
use crate::progress::SearchPart;
use crate::space::SpacePoint;

/// Maximum rounds that add points in the widest gaps.
const REFILLS: usize = 3;

/// Minimum distance of a new lower bound from the start of its gap.
///
/// It is a fraction of the gap. A design exceeds its own lower bound slightly.
const INSIDE: f64 = 1e-3;

/// Relative difference up to which designs are the same point of the front.
///
/// Tables show six digits.
const SAME: f64 = 1e-6;

/// Distance of the first end targets from the ends, as a fraction of the front.
///
/// The exact optimum of one objective may be a set of zero width, in which no search can step.
const BESIDE: f64 = 1e-6;

/// Fraction of the front below which a gap needs no further point.
const NARROW: f64 = 1e-3;

/// Number of parts between the first points of a front.
const QUARTERS: usize = 4;

/// Ratio of the ends of a front above which points are spaced by equal ratios.
const DECADE: f64 = 10.0;

/// Front of several objectives.
#[derive(Clone, Debug)]
pub struct Front {
    /// Non-dominated designs, in the order of the first objective, best first.
    pub designs: Vec<BestDesign>,
    /// Points with the same best design as another point: the front has a step there.
    pub same: usize,
    /// Points with a dominated best design.
    pub beaten: usize,
    /// Points without a feasible design.
    pub empty: usize,
}

impl Front {
    /// Returns the number of requested points that were not searched.
    ///
    /// Either no gap was wide enough, or no known design was far enough from the others.
    pub fn left_out(&self, points: usize) -> usize {
        points.saturating_sub(self.designs.len() + self.same + self.beaten + self.empty)
    }
}

/// Searches points between the ends of a front, then points in the widest gaps.
pub(crate) fn search(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    plan: Plan,
    points: usize,
) -> Result<Front, Halt> {
    // Half of the points show where the front changes.
    let mut targets = first_targets(search, history, points.div_ceil(2).max(2).min(points));
    if search.judge.objectives() == 2 {
        improve_by_halves(search, history, &targets, plan)?;
    } else {
        improve(search, history, &targets, plan.of_a_point(), &[])?;
    }
    let mut front = rescaled_front(search, history, &targets)?;
    if let Some(ends) = ends(search, &front.designs) {
        improve(search, history, &ends, plan.between_points(), &[])?;
        let last = targets.len() - 1;
        let [first_end, last_end] = ends;
        (targets[0], targets[last]) = (first_end, last_end);
        front = rescaled_front(search, history, &targets)?;
    }
    for _ in 0..REFILLS {
        let more = more_targets(search, history, &front.designs, &targets, points);
        if more.is_empty() {
            break;
        }
        let known = front.designs.iter().map(|design| design.candidate.clone()).collect::<Vec<_>>();
        improve(search, history, &more, plan.between_points(), &known)?;
        targets.extend(more);
        front = rescaled_front(search, history, &targets)?;
    }
    Ok(front)
}

/// Returns targets for the exact ends of the front.
///
/// Each objective is maximised while the other keeps its value, within the smallest visible
/// difference.
fn ends(search: &Search<'_>, designs: &[BestDesign]) -> Option<[Target; 2]> {
    let first = turned(search, &designs.first()?.candidate)?;
    let last = turned(search, &designs.last()?.candidate)?;
    if first.len() != 2 || designs.len() < 2 {
        return None;
    }
    // The other objective may fall just below its value at the exact end.
    let floors = [Spacing::between(first[1], last[1]), Spacing::between(last[0], first[0])]
        .map(|spacing| spacing.at(-NARROW));
    Some(
        [0, 1].map(|objective| Target {
            objective,
            floors: vec![(1 - objective, floors[objective])],
        }),
    )
}

/// Returns targets for missing points.
///
/// They are in the widest gaps of a curve, or at known designs far from all points of a surface.
fn more_targets(
    search: &Search<'_>,
    history: &[Candidate],
    designs: &[BestDesign],
    targets: &[Target],
    points: usize,
) -> Vec<Target> {
    let more = points.saturating_sub(designs.len());
    let front: Vec<Vec<f64>> =
        designs.iter().filter_map(|design| turned(search, &design.candidate)).collect();
    if search.judge.objectives() == 2 {
        return between(&front, targets, more);
    }
    let known: Vec<Vec<f64>> =
        history.iter().filter_map(|candidate| turned(search, candidate)).collect();
    let floors = spread(&known, &front, more).into_iter().map(target);
    // A repeated lower bound leads to the same design.
    floors.filter(|target| !targets.contains(target)).collect()
}

/// Returns targets in the widest gaps of a front of two objectives.
///
/// There are at most `count` targets. If a lower bound inside a gap led to the far end of the gap,
/// the front has a step there, and only the part before this bound remains. Narrow gaps are
/// skipped.
fn between(front: &[Vec<f64>], targets: &[Target], count: usize) -> Vec<Target> {
    let (Some(first), Some(last)) = (front.first(), front.last()) else { return Vec::new() };
    let scales = [0, 1].map(|k| Spacing::between(first[k], last[k]));
    let mut gaps: Vec<(f64, f64)> = front
        .windows(2)
        .map(|pair| {
            let parts = [0, 1].map(|k| scales[k].share(pair[0][k]) - scales[k].share(pair[1][k]));
            let spacing = Spacing::between(pair[0][1], pair[1][1]);
            let floors = targets.iter().flat_map(|target| &target.floors).filter(|(k, _)| *k == 1);
            let places = floors.map(|(_, floor)| spacing.share(*floor));
            let untried = places.filter(|place| *place > INSIDE).fold(1.0, f64::min);
            (untried * parts[0].hypot(parts[1]), spacing.at(0.5 * untried))
        })
        .collect();
    gaps.retain(|(width, _)| *width > NARROW);
    gaps.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    gaps.truncate(count);
    gaps.into_iter().map(|(_, floor)| target(vec![floor])).collect()
}

/// Spacing of values between two ends.
///
/// Ratios are equal if the ends differ by a factor of at least ten, otherwise differences are
/// equal.
#[derive(Clone, Copy)]
struct Spacing {
    ends: [f64; 2],
    logarithmic: bool,
}

impl Spacing {
    fn between(from: f64, to: f64) -> Self {
        let ratio = (to / from).max(from / to);
        Self { ends: [from, to], logarithmic: ratio.is_finite() && ratio >= DECADE }
    }

    /// Returns the value at a fraction of the spacing.
    fn at(self, share: f64) -> f64 {
        let [from, to] = self.ends;
        if self.logarithmic { from * (to / from).powf(share) } else { from + (to - from) * share }
    }

    /// Returns the fraction of the spacing at a value.
    fn share(self, value: f64) -> f64 {
        let [from, to] = self.ends;
        match self.logarithmic {
            true => (value / from).ln() / (to / from).ln(),
            false if to == from => 0.0,
            false => (value - from) / (to - from),
        }
    }
}

/// Searches the points of a curve in ever finer intervals.
///
/// The ends and the quarters come first, then halves of each interval.
///
/// The first points search every region of the space. The others continue from the points on both
/// sides, because the designs of a front change gradually along most of it.
fn improve_by_halves(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    targets: &[Target],
    plan: Plan,
) -> Result<(), Halt> {
    let Some(last) = targets.len().checked_sub(1) else { return Ok(()) };
    let mut solved: Vec<usize> = (0..=QUARTERS).map(|k| k * last / QUARTERS).collect();
    solved.dedup();
    improve(search, history, &chosen(targets, &solved), plan.of_a_point(), &[])?;
    loop {
        let middles = solved.windows(2).map(|pair| usize::midpoint(pair[0], pair[1]));
        let next: Vec<usize> = middles.filter(|k| !solved.contains(k)).collect();
        if next.is_empty() {
            return Ok(());
        }
        let known: Vec<Candidate> = chosen(targets, &solved)
            .iter()
            .filter_map(|target| search.best(history.iter(), target).cloned())
            .collect();
        improve(search, history, &chosen(targets, &next), plan.between_points(), &known)?;
        solved.extend(next);
        solved.sort_unstable();
    }
}

fn chosen(targets: &[Target], places: &[usize]) -> Vec<Target> {
    places.iter().map(|&k| targets[k].clone()).collect()
}

/// Runs a search for each target, from the known designs.
///
/// `front` are the best designs of other targets; searches start between them, too.
fn improve(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    targets: &[Target],
    plan: Plan,
    front: &[Candidate],
) -> Result<(), Halt> {
    let units =
        targets.iter().map(|target| plan.evaluations() * search.evaluation_units(target)).sum();
    search.progress.begin(SearchPart::Front, targets.len() * plan.tasks(), units);
    // Collect in the order of the targets, so that the history is the same on every machine.
    let walks = targets.par_iter().map(|target| {
        let point = between_neighbours(search, front, target);
        let start = point.map(|point| search.compared(SearchStage::Gradient, &point, true));
        let start = start.transpose()?.map(|(start, _)| start);
        let start = start.filter(|start| search.merit(start, target) != Merit::None);
        let walk = improved_from(search, history, target, plan, start.as_ref())?.evaluated;
        Ok(start.into_iter().chain(walk).collect())
    });
    let walks: Vec<Vec<Candidate>> = walks.collect::<Result<_, Halt>>()?;
    history.extend(walks.into_iter().flatten());
    Ok(())
}

/// Returns the point between the designs of `front` on both sides of a lower bound.
///
/// It divides their distance like the bound divides the difference of their objectives. `None` if
/// the bound is not between two designs with the same choices.
fn between_neighbours(
    search: &Search<'_>,
    front: &[Candidate],
    target: &Target,
) -> Option<SpacePoint> {
    let [(objective, floor)] = target.floors[..] else { return None };
    let beyond = front
        .iter()
        .filter_map(|candidate| Some((turned(search, candidate)?[objective] - floor, candidate)));
    let above = beyond.clone().filter(|(value, _)| *value >= 0.0);
    let above = above.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
    let below = beyond.filter(|(value, _)| *value < 0.0);
    let below = below.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    let [from, to] = [below, above].map(|(_, candidate)| &candidate.point);
    let share = below.0 / (below.0 - above.0);
    let shares = from.shares.iter().zip(&to.shares).map(|(a, b)| a + share * (b - a));
    (from.chosen == to.chosen)
        .then(|| SpacePoint { shares: shares.collect(), chosen: from.chosen.clone() })
}

/// Returns the front after scaling each design for each target.
///
/// Scaling intervals, such as a thickness in mm, change forces and lengths alone, and cost no
/// solution.
fn rescaled_front(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    targets: &[Target],
) -> Result<Front, Halt> {
    let front = designs(search, history, targets)?;
    let scaling = search.evaluations.scaling_intervals();
    // Samples of a scaled design differ and must be solved.
    if scaling.is_empty() || search.judge.samples().is_some() {
        return Ok(front);
    }
    let pairs = targets.par_iter().flat_map_iter(|target| {
        front.designs.iter().map(move |design| (target, &design.candidate))
    });
    let scaled = pairs.map(|(target, candidate)| search.scaled(target, candidate, &scaling));
    history.extend(scaled.collect::<Result<Vec<_>, _>>()?);
    designs(search, history, targets)
}

/// Returns the non-dominated best designs of the targets, and counts the others.
fn designs(search: &Search<'_>, history: &[Candidate], targets: &[Target]) -> Result<Front, Halt> {
    let found = targets.par_iter().map(|target| {
        let any = history
            .iter()
            .any(|candidate| matches!(search.merit(candidate, target), Merit::Met(_)));
        any.then(|| best_design(search, history, target.clone())).transpose()
    });
    let found: Vec<Option<BestDesign>> = found.collect::<Result<_, _>>()?;
    let found = found.into_iter().flatten();
    let found: Vec<(BestDesign, Vec<f64>)> = found
        .filter_map(|design| turned(search, &design.candidate).map(|values| (design, values)))
        .collect();
    let values: Vec<Vec<f64>> = found.iter().map(|(_, values)| values.clone()).collect();
    let mut front =
        Front { designs: Vec::new(), same: 0, beaten: 0, empty: targets.len() - found.len() };
    let mut kept: Vec<(BestDesign, f64)> = Vec::new();
    for (k, (design, turned)) in found.into_iter().enumerate() {
        // If two limits bind, points may differ only by round-off in one objective. Exact dominance
        // would then keep the worse of two points.
        if values.iter().any(|other| dominates(other, &turned)) {
            front.beaten += 1;
        } else if values[..k].iter().any(|other| is_same(other, &turned)) {
            front.same += 1;
        } else {
            kept.push((design, turned[0]));
        }
    }
    kept.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    front.designs = kept.into_iter().map(|(design, _)| design).collect();
    Ok(front)
}

/// Returns true if all objectives agree within the visible digits.
fn is_same(one: &[f64], other: &[f64]) -> bool {
    one.iter().zip(other).all(|(a, b)| (a - b).abs() <= SAME * b.abs())
}

/// Returns the objectives of a feasible design, with changed sign if minimised.
fn turned(search: &Search<'_>, candidate: &Candidate) -> Option<Vec<f64>> {
    let Judgement::Judged(worth) = &candidate.verdict else { return None };
    let turned = worth.objectives.iter().enumerate().map(|(k, x)| search.judge.sign(k) * x);
    worth.met.then(|| turned.collect())
}

/// Returns the first targets of a front: its ends, and lower bounds between them.
fn first_targets(search: &Search<'_>, history: &[Candidate], points: usize) -> Vec<Target> {
    let values: Vec<Vec<f64>> = history.iter().filter_map(|c| turned(search, c)).collect();
    if search.judge.objectives() == 2 {
        return curve(&values, points);
    }
    spread(&values, &[], points).into_iter().map(target).collect()
}

/// Returns the target with these lower bounds on all objectives but the first.
fn target(floors: Vec<f64>) -> Target {
    // The same objective is maximised at all points: lower bounds on the others reach every part of
    // a front.
    Target {
        objective: 0,
        floors: floors.into_iter().enumerate().map(|(k, floor)| (k + 1, floor)).collect(),
    }
}

/// Returns targets for a front of two objectives: its ends and points between.
fn curve(values: &[Vec<f64>], points: usize) -> Vec<Target> {
    let ends = [0, 1].map(|k| values.iter().max_by(|a, b| a[k].total_cmp(&b[k])));
    let [Some(first), Some(last)] = ends else { return Vec::new() };
    let spacings = [0, 1].map(|k| Spacing::between(first[k], last[k]));
    // At an end the other objective decides, because many designs may share the optimum of one.
    let first_end = Target { objective: 1, floors: vec![(0, spacings[0].at(BESIDE))] };
    let last_end = target(vec![spacings[1].at(1.0 - BESIDE)]);
    let inner =
        (1..points - 1).map(|k| target(vec![spacings[1].at(k as f64 / (points - 1) as f64)]));
    [first_end].into_iter().chain(inner).chain([last_end]).collect()
}

/// Returns lower bounds at non-dominated designs with the largest distances.
///
/// Distances are measured to each other and to `taken`.
fn spread(values: &[Vec<f64>], taken: &[Vec<f64>], count: usize) -> Vec<Vec<f64>> {
    let front: Vec<&Vec<f64>> =
        values.iter().filter(|value| !values.iter().any(|other| dominates(other, value))).collect();
    let spans = (0..front.first().map_or(0, |value| value.len())).map(|k| {
        let all = front.iter().map(|value| value[k]);
        let (low, high) = all
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        if high > low { high - low } else { 1.0 }
    });
    let spans: Vec<f64> = spans.collect();
    let mut nearest: Vec<f64> = front
        .iter()
        .map(|value| {
            let distances = taken.iter().map(|other| scaled_distance(value, other, &spans));
            distances.fold(f64::INFINITY, f64::min)
        })
        .collect();
    let mut chosen: Vec<usize> = Vec::new();
    while chosen.len() < count {
        // The first of equal distances; without `taken` all distances are infinite.
        let farthest = (0..front.len())
            .reduce(|a, b| if nearest[b] > nearest[a] { b } else { a })
            .filter(|&k| nearest[k] > NARROW);
        let Some(farthest) = farthest else { break };
        chosen.push(farthest);
        for (distance, value) in nearest.iter_mut().zip(&front) {
            *distance = distance.min(scaled_distance(value, front[farthest], &spans));
        }
    }
    chosen.sort_by(|&a, &b| front[b][0].total_cmp(&front[a][0]));
    chosen.into_iter().map(|k| front[k][1..].to_vec()).collect()
}

/// Returns the distance between two values, relative to the spans of the objectives.
fn scaled_distance(a: &[f64], b: &[f64], spans: &[f64]) -> f64 {
    let pairs = a.iter().zip(b).zip(spans);
    pairs.map(|((a, b), span)| ((a - b) / span).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::{dominates, is_same};

    #[test]
    fn dominance_tolerates_round_off_in_one_objective() {
        // Such points occur if coverage and compliance both bind.
        let (poor, good) = ([0.800_000_000_004_8, 0.06], [0.799_999_999_999_9, 0.6]);
        assert!(dominates(&good, &poor) && !dominates(&poor, &good));
        assert!(!dominates(&good, &good) && is_same(&good, &[0.8, 0.6]));
        assert!(!dominates(&[0.81, 0.06], &good));
    }
}
