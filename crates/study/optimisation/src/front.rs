//! Searches the Pareto front of several objectives by the ε-constraint method.
//!
//! Each point of the front maximises one objective under lower bounds on the other objectives.

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

/// Maximum number of rounds that add points in the widest gaps of the front.
const REFILLS: usize = 3;

/// Fraction of a gap of the front, from its first point, in which earlier lower bounds are ignored.
///
/// A lower bound in this part is the bound with which the first point was found: the design at this
/// point meets the bound exactly.
const INSIDE: f64 = 1e-3;

/// Relative difference of objectives up to which two designs are one point of the front.
///
/// Tables show six digits.
const SAME: f64 = 1e-6;

/// Distance of the targets at the ends of a front from these ends, as a fraction of the front.
///
/// The designs with exactly the best value of one objective may form a set of zero width, in which
/// a search cannot step.
const BESIDE: f64 = 1e-6;

/// Distance of two points, as a fraction of the front, up to which no point is added between them.
const NARROW: f64 = 1e-3;

/// Number of parts into which the points that are searched first divide a front.
const QUARTERS: usize = 4;

/// Smallest ratio of the ends of a front for which the points are spaced by equal ratios.
const DECADE: f64 = 10.0;

/// Pareto front of several objectives.
#[derive(Clone, Debug)]
pub struct Front {
    /// Non-dominated designs, sorted by the first objective, best first.
    pub designs: Vec<BestDesign>,
    /// Number of points that repeat the design of another point, because the front has a step.
    pub same: usize,
    /// Number of points that the design of another point dominates.
    pub beaten: usize,
    /// Number of points without a feasible design.
    pub empty: usize,
}

impl Front {
    /// Returns how many of the `points` requested points were not searched.
    ///
    /// No gap was wide enough for them, or no known design was far enough from the other points.
    pub fn unsearched(&self, points: usize) -> usize {
        points.saturating_sub(self.designs.len() + self.same + self.beaten + self.empty)
    }
}

/// Searches a front with `points` points.
///
/// The first half of the points divides the known front evenly. The other points fill the widest
/// gaps between these points. Evaluated designs are added to `history`.
pub(crate) fn search(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    plan: Plan,
    points: usize,
) -> Result<Front, Halt> {
    // The first half of the points shows where the front needs more points.
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

/// Returns targets for the exact ends of a front of two objectives.
///
/// At each end one objective is maximised. The other objective has its value at this end as a lower
/// bound, reduced by the fraction `NARROW` of the front. `None` unless the front has two objectives
/// and at least two points.
fn ends(search: &Search<'_>, designs: &[BestDesign]) -> Option<[Target; 2]> {
    let first = signed_objectives(search, &designs.first()?.candidate)?;
    let last = signed_objectives(search, &designs.last()?.candidate)?;
    if first.len() != 2 || designs.len() < 2 {
        return None;
    }
    // Reduce the lower bounds slightly: at the exact end the bounded objective may be smaller.
    let bounds = [Spacing::between(first[1], last[1]), Spacing::between(last[0], first[0])]
        .map(|spacing| spacing.at(-NARROW));
    Some([0, 1].map(|objective| Target {
        objective,
        lower_bounds: vec![(1 - objective, bounds[objective])],
    }))
}

/// Returns targets for points that are still missing.
///
/// For two objectives, the targets are in the widest gaps of the front `designs`. For more
/// objectives, their lower bounds are the objectives of designs in `history` that are far from all
/// points of the front.
fn more_targets(
    search: &Search<'_>,
    history: &[Candidate],
    designs: &[BestDesign],
    targets: &[Target],
    points: usize,
) -> Vec<Target> {
    let more = points.saturating_sub(designs.len());
    let front: Vec<Vec<f64>> =
        designs.iter().filter_map(|design| signed_objectives(search, &design.candidate)).collect();
    if search.judge.objectives() == 2 {
        return between(&front, targets, more);
    }
    let known: Vec<Vec<f64>> =
        history.iter().filter_map(|candidate| signed_objectives(search, candidate)).collect();
    let new_targets = spread(&known, &front, more).into_iter().map(target);
    // A lower bound that was searched before would give the same design.
    new_targets.filter(|target| !targets.contains(target)).collect()
}

/// Returns at most `count` targets in the widest gaps of a front of two objectives.
///
/// If the lower bound of one of the earlier `targets` is inside a gap, the best design of this
/// target is at the far end of the gap, i.e. the front has a step there. The new target is then
/// placed in the part of the gap before this bound. Narrow gaps are skipped.
fn between(front: &[Vec<f64>], targets: &[Target], count: usize) -> Vec<Target> {
    let (Some(first), Some(last)) = (front.first(), front.last()) else { return Vec::new() };
    let scales = [0, 1].map(|k| Spacing::between(first[k], last[k]));
    let mut gaps: Vec<(f64, f64)> = front
        .windows(2)
        .map(|pair| {
            let parts =
                [0, 1].map(|k| scales[k].fraction(pair[0][k]) - scales[k].fraction(pair[1][k]));
            let spacing = Spacing::between(pair[0][1], pair[1][1]);
            let searched =
                targets.iter().flat_map(|target| &target.lower_bounds).filter(|(k, _)| *k == 1);
            let bounds = searched.map(|(_, bound)| spacing.fraction(*bound));
            let untried = bounds.filter(|bound| *bound > INSIDE).fold(1.0, f64::min);
            (untried * parts[0].hypot(parts[1]), spacing.at(0.5 * untried))
        })
        .collect();
    gaps.retain(|(width, _)| *width > NARROW);
    gaps.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    gaps.truncate(count);
    gaps.into_iter().map(|(_, bound)| target(vec![bound])).collect()
}

/// Scale between two ends, on which points are equally spaced.
///
/// The scale is logarithmic if the ends differ by a factor of at least ten, otherwise linear.
#[derive(Clone, Copy)]
struct Spacing {
    ends: [f64; 2],
    logarithmic: bool,
}

impl Spacing {
    /// Creates the scale between two ends.
    fn between(from: f64, to: f64) -> Self {
        let ratio = (to / from).max(from / to);
        Self { ends: [from, to], logarithmic: ratio.is_finite() && ratio >= DECADE }
    }

    /// Returns the value at `fraction` of the scale: 0 is `from`, 1 is `to`.
    fn at(self, fraction: f64) -> f64 {
        let [from, to] = self.ends;
        if self.logarithmic {
            from * (to / from).powf(fraction)
        } else {
            from + (to - from) * fraction
        }
    }

    /// Returns the fraction of the scale at `value`, the inverse of [`Self::at`].
    fn fraction(self, value: f64) -> f64 {
        let [from, to] = self.ends;
        match self.logarithmic {
            true => (value / from).ln() / (to / from).ln(),
            false if to == from => 0.0,
            false => (value - from) / (to - from),
        }
    }
}

/// Searches the points of a front of two objectives by repeated bisection of the front.
///
/// The ends and three points between them are searched first, from the best designs of all regions.
/// Then each interval between neighbouring points is halved. The search for the middle point starts
/// from the designs at both ends of the interval, because the designs change gradually along most
/// of a front.
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

/// Returns the targets with these `indices`.
fn chosen(targets: &[Target], indices: &[usize]) -> Vec<Target> {
    indices.iter().map(|&k| targets[k].clone()).collect()
}

/// Runs a search for each target from the designs in `history`, which it extends.
///
/// `front` are the best designs of other targets. Each search also starts at a point between two of
/// these designs.
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
    // `collect` keeps the order of the targets, so the history does not depend on the threads.
    let searches = targets.par_iter().map(|target| {
        let point = between_neighbours(search, front, target);
        let start = point.map(|point| search.compared(SearchStage::Gradient, &point, true));
        let start = start.transpose()?.map(|(start, _)| start);
        let start = start.filter(|start| search.merit(start, target) != Merit::None);
        let evaluated = improved_from(search, history, target, plan, start.as_ref())?.evaluated;
        Ok(start.into_iter().chain(evaluated).collect())
    });
    let searches: Vec<Vec<Candidate>> = searches.collect::<Result<_, Halt>>()?;
    history.extend(searches.into_iter().flatten());
    Ok(())
}

/// Interpolates between the two designs of `front` that are next to the lower bound of `target`.
///
/// At the returned point the bounded objective would have the value of the bound if it varied
/// linearly. `None` unless `target` has exactly one lower bound, which lies between two designs
/// with equal choices.
fn between_neighbours(
    search: &Search<'_>,
    front: &[Candidate],
    target: &Target,
) -> Option<SpacePoint> {
    let [(objective, bound)] = target.lower_bounds[..] else { return None };
    let beyond = front.iter().filter_map(|candidate| {
        Some((signed_objectives(search, candidate)?[objective] - bound, candidate))
    });
    let above = beyond.clone().filter(|(value, _)| *value >= 0.0);
    let above = above.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
    let below = beyond.filter(|(value, _)| *value < 0.0);
    let below = below.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    let [from, to] = [below, above].map(|(_, candidate)| &candidate.point);
    let fraction = below.0 / (below.0 - above.0);
    let fractions = from.fractions.iter().zip(&to.fractions).map(|(a, b)| a + fraction * (b - a));
    (from.chosen == to.chosen)
        .then(|| SpacePoint { fractions: fractions.collect(), chosen: from.chosen.clone() })
}

/// Returns the front after optimising the scaling intervals of each design for each target.
///
/// Scaling intervals, such as the thickness in mm, only change forces and lengths in physical
/// units. The designs need no new solution.
fn rescaled_front(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    targets: &[Target],
) -> Result<Front, Halt> {
    let front = designs(search, history, targets)?;
    let scaling = search.evaluations.scaling_intervals();
    // With samples this step would be expensive: the samples of a scaled design must be solved.
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

/// Returns the front: the best design of each target, without dominated and repeated designs.
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
        .filter_map(|design| {
            signed_objectives(search, &design.candidate).map(|values| (design, values))
        })
        .collect();
    let values: Vec<Vec<f64>> = found.iter().map(|(_, values)| values.clone()).collect();
    let mut front =
        Front { designs: Vec::new(), same: 0, beaten: 0, empty: targets.len() - found.len() };
    let mut kept: Vec<(BestDesign, f64)> = Vec::new();
    for (k, (design, signed)) in found.into_iter().enumerate() {
        // `dominates` tolerates round-off. If two limits bind, two points may differ in one
        // objective by round-off only, and exact comparison would keep the worse point.
        if values.iter().any(|other| dominates(other, &signed)) {
            front.beaten += 1;
        } else if values[..k].iter().any(|other| is_same(other, &signed)) {
            front.same += 1;
        } else {
            kept.push((design, signed[0]));
        }
    }
    kept.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    front.designs = kept.into_iter().map(|(design, _)| design).collect();
    Ok(front)
}

/// Returns true if all objectives agree within the digits that tables show.
fn is_same(one: &[f64], other: &[f64]) -> bool {
    one.iter().zip(other).all(|(a, b)| (a - b).abs() <= SAME * b.abs())
}

/// Returns the objectives of a feasible design; objectives to be minimised change sign.
///
/// `None` for an infeasible design.
fn signed_objectives(search: &Search<'_>, candidate: &Candidate) -> Option<Vec<f64>> {
    let Judgement::Judged(worth) = &candidate.verdict else { return None };
    let signed = worth.objectives.iter().enumerate().map(|(k, x)| search.judge.sign(k) * x);
    worth.met.then(|| signed.collect())
}

/// Returns the first targets of a front, derived from the feasible designs in `history`.
fn first_targets(search: &Search<'_>, history: &[Candidate], points: usize) -> Vec<Target> {
    let values: Vec<Vec<f64>> =
        history.iter().filter_map(|c| signed_objectives(search, c)).collect();
    if search.judge.objectives() == 2 {
        return curve(&values, points);
    }
    spread(&values, &[], points).into_iter().map(target).collect()
}

/// Returns the target that maximises the first objective under lower bounds on the others.
///
/// `bounds` are the lower bounds of the second and all following objectives.
fn target(bounds: Vec<f64>) -> Target {
    // One objective is sufficient: with suitable lower bounds on the other objectives, its maximum
    // can be any point of the front.
    Target {
        objective: 0,
        lower_bounds: bounds.into_iter().enumerate().map(|(k, bound)| (k + 1, bound)).collect(),
    }
}

/// Returns targets for a front of two objectives: its ends, and equally spaced points between them.
///
/// `values` are the objectives of the known feasible designs.
fn curve(values: &[Vec<f64>], points: usize) -> Vec<Target> {
    let ends = [0, 1].map(|k| values.iter().max_by(|a, b| a[k].total_cmp(&b[k])));
    let [Some(first), Some(last)] = ends else { return Vec::new() };
    let spacings = [0, 1].map(|k| Spacing::between(first[k], last[k]));
    // At each end of the front, bound one objective at its optimum and maximise the other
    // objective, because many designs may share the optimum of one objective.
    let first_end = Target { objective: 1, lower_bounds: vec![(0, spacings[0].at(BESIDE))] };
    let last_end = target(vec![spacings[1].at(1.0 - BESIDE)]);
    let inner =
        (1..points - 1).map(|k| target(vec![spacings[1].at(k as f64 / (points - 1) as f64)]));
    [first_end].into_iter().chain(inner).chain([last_end]).collect()
}

/// Selects up to `count` non-dominated points of `values` that are far apart.
///
/// Each selected point is as far as possible from the points selected before and from the points
/// `taken`. Returns all objectives of the selected points except the first objective.
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
        // Without `taken` all distances are infinite at first, and the first point is selected.
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

/// Returns the distance between two points, with each objective divided by its span.
fn scaled_distance(a: &[f64], b: &[f64], spans: &[f64]) -> f64 {
    let pairs = a.iter().zip(b).zip(spans);
    pairs.map(|((a, b), span)| ((a - b) / span).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::{dominates, is_same};

    #[test]
    fn dominance_tolerates_round_off_in_one_objective() {
        // Such points occur if requirements on coverage and on compliance bind.
        let (poor, good) = ([0.800_000_000_004_8, 0.06], [0.799_999_999_999_9, 0.6]);
        assert!(dominates(&good, &poor) && !dominates(&poor, &good));
        assert!(!dominates(&good, &good) && is_same(&good, &[0.8, 0.6]));
        assert!(!dominates(&[0.81, 0.06], &good));
    }
}
