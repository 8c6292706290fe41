//! The front of several objectives: one is made as large as can be while the others keep floors, from one end of the front to the other.

use ranking::dominates;
use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

use crate::best::{BestDesign, best_design};
use crate::candidate::{Candidate, Merit, Target};
use crate::evaluations::Halt;
use crate::improvement::{Plan, improved};
use crate::judgement::Judgement;
use crate::local::Search;
use crate::progress::SearchPart;

/// Rounds in which points are put into the widest gaps, at most.
const REFILLS: usize = 3;

/// A floor is inside a gap if it is this share of it beyond its beginning: a design keeps its own floor by a little more than it must.
const INSIDE: f64 = 1e-3;

/// An objective that is worse by less than this part is as good: a floor is kept to within as much.
const EQUAL: f64 = 1e-9;

/// Designs of which all objectives differ by less than this part are one point: tables show six digits.
const SAME: f64 = 1e-6;

/// The ends of a front are looked for this share of it inside: designs that are the best in one objective to the last digit may be a line
/// without width, along which no search can step.
const BESIDE: f64 = 1e-6;

/// A gap below this share of the front needs no point: its ends look the same.
const NARROW: f64 = 1e-3;

/// The ratio of the ends of a front from which on its points are spaced by equal ratios.
const DECADE: f64 = 10.0;

/// The front of several objectives.
#[derive(Clone, Debug)]
pub struct Front {
    /// The designs that none beats, in the order of the first objective, the best first.
    pub designs: Vec<BestDesign>,
    /// Points at which the best design is that of another point: the front has a step there.
    pub same: usize,
    /// Points whose best design is beaten by that of another.
    pub beaten: usize,
    /// Points at which no design was found.
    pub empty: usize,
}

impl Front {
    /// Points that were asked for, and not searched: no gap was left that was wide and no step, nor a design of a surface far from its points.
    pub fn left_out(&self, points: usize) -> usize {
        points.saturating_sub(self.designs.len() + self.same + self.beaten + self.empty)
    }
}

/// The front: points between its ends, then others where it is the least known.
pub(crate) fn search(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    plan: Plan,
    points: usize,
) -> Result<Front, Halt> {
    // Half of the points tell where the front changes.
    let mut targets = first_targets(search, history, points.div_ceil(2).max(2).min(points));
    improve(search, history, &targets, plan.of_a_point())?;
    let mut front = rescaled_front(search, history, &targets)?;
    if let Some(ends) = ends(search, &front.designs) {
        improve(search, history, &ends, plan.between_points())?;
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
        improve(search, history, &more, plan.between_points())?;
        targets.extend(more);
        front = rescaled_front(search, history, &targets)?;
    }
    Ok(front)
}

/// The targets of the ends themselves, from what was found beside them: each objective is made as large as can be while the other keeps what it
/// has there, but for what looks the same.
fn ends(search: &Search<'_>, designs: &[BestDesign]) -> Option<[Target; 2]> {
    let values = |design: &BestDesign| turned(search, &design.candidate);
    let (first, last) = (values(designs.first()?)?, values(designs.last()?)?);
    let beyond = |k: usize, from: &[f64], to: &[f64]| Spacing::between(from[k], to[k]).at(-NARROW);
    let end = |objective, floor| Target { objective, floors: vec![(1 - objective, floor)] };
    let floors = [beyond(1, &first, &last), beyond(0, &last, &first)];
    (first.len() == 2 && designs.len() > 1).then(|| [end(0, floors[0]), end(1, floors[1])])
}

/// Targets for the points that a front still lacks: in the widest gaps of a curve, or else at those known designs of a surface that are the
/// farthest from all of its points.
fn more_targets(
    search: &Search<'_>,
    history: &[Candidate],
    designs: &[BestDesign],
    targets: &[Target],
    points: usize,
) -> Vec<Target> {
    let more = points.saturating_sub(designs.len());
    let values = |candidate| turned(search, candidate);
    let front: Vec<Vec<f64>> = designs.iter().filter_map(|d| values(&d.candidate)).collect();
    if search.judge.objectives() == 2 {
        return between(&front, targets, more);
    }
    let known: Vec<Vec<f64>> = history.iter().filter_map(values).collect();
    let floors = spread(&known, &front, more).into_iter().map(target);
    // Where a floor has led before it leads again.
    floors.filter(|target| !targets.contains(target)).collect()
}

/// Targets in the widest gaps of a front of two objectives, at most so many. Of a gap in which a floor led to its far end, the front has a
/// step there, only the part before that floor is left; narrow ones need no point.
fn between(front: &[Vec<f64>], targets: &[Target], count: usize) -> Vec<Target> {
    let (Some(first), Some(last)) = (front.first(), front.last()) else { return Vec::new() };
    let scales = [0, 1].map(|k| Spacing::between(first[k], last[k]));
    let gap = |pair: &[Vec<f64>]| {
        let parts = [0, 1].map(|k| scales[k].share(pair[0][k]) - scales[k].share(pair[1][k]));
        let spacing = Spacing::between(pair[0][1], pair[1][1]);
        let floors = targets.iter().flat_map(|target| &target.floors).filter(|(k, _)| *k == 1);
        let places = floors.map(|(_, floor)| spacing.share(*floor));
        let untried = places.filter(|place| *place > INSIDE).fold(1.0, f64::min);
        (untried * parts[0].hypot(parts[1]), spacing.at(0.5 * untried))
    };
    let mut gaps: Vec<(f64, f64)> = front.windows(2).map(gap).collect();
    gaps.retain(|(width, _)| *width > NARROW);
    gaps.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    gaps.truncate(count);
    gaps.into_iter().map(|(_, floor)| target(vec![floor])).collect()
}

/// How values are spaced between two ends: by equal ratios where they span a power of ten, or else by equal differences.
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

    /// The value at a share of the way.
    fn at(self, share: f64) -> f64 {
        let [from, to] = self.ends;
        if self.logarithmic { from * (to / from).powf(share) } else { from + (to - from) * share }
    }

    /// The share of the way at which a value is.
    fn share(self, value: f64) -> f64 {
        let [from, to] = self.ends;
        match self.logarithmic {
            true => (value / from).ln() / (to / from).ln(),
            false if to == from => 0.0,
            false => (value - from) / (to - from),
        }
    }
}

/// A search for each of the points, from what is known.
fn improve(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    targets: &[Target],
    plan: Plan,
) -> Result<(), Halt> {
    search.progress.begin(SearchPart::Front, targets.len() * plan.tasks());
    // Noted in the order of the targets, whichever ends first: a search looks at the same designs on every machine.
    let walks = targets.par_iter().map(|target| improved(search, history, target, plan));
    let walks: Vec<Vec<Candidate>> = walks.collect::<Result<_, _>>()?;
    history.extend(walks.into_iter().flatten());
    Ok(())
}

/// The front once the design of every target has been scaled to every other: what a result does not depend on, as a thickness in mm, only
/// scales forces and lengths, and costs nothing.
fn rescaled_front(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    targets: &[Target],
) -> Result<Front, Halt> {
    let front = designs(search, history, targets)?;
    let scaling = search.evaluations.scaling_intervals();
    // Samples of a scaled design are other samples, and do cost.
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

/// The best design of each target that no other design among them beats, and what became of the others.
fn designs(search: &Search<'_>, history: &[Candidate], targets: &[Target]) -> Result<Front, Halt> {
    let found = targets.par_iter().map(|target| {
        let is_met = |c: &&Candidate| matches!(search.merit(c, target), Merit::Met(_));
        let any = history.iter().any(|candidate| is_met(&candidate));
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
        if values.iter().any(|other| beats(other, &turned)) {
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

/// Whether objectives look the same.
fn is_same(one: &[f64], other: &[f64]) -> bool {
    one.iter().zip(other).all(|(a, b)| (a - b).abs() <= SAME * b.abs())
}

/// Whether a point of a front beats another: it is better in an objective, and in none worse, but for round-off.
fn beats(one: &[f64], other: &[f64]) -> bool {
    // Where two limits bind, a floor keeps points of one objective a last digit apart, and the worst of them would stay.
    let pairs = || one.iter().zip(other).map(|(a, b)| (a - b, EQUAL * b.abs()));
    pairs().all(|(gain, size)| gain >= -size) && pairs().any(|(gain, size)| gain > size)
}

/// The turned objectives of a design that meets every requirement.
fn turned(search: &Search<'_>, candidate: &Candidate) -> Option<Vec<f64>> {
    let Judgement::Judged(worth) = &candidate.verdict else { return None };
    let turned = worth.objectives.iter().enumerate().map(|(k, x)| search.judge.sign(k) * x);
    worth.met.then(|| turned.collect())
}

/// The first targets of a front: its ends, and floors between them.
fn first_targets(search: &Search<'_>, history: &[Candidate], points: usize) -> Vec<Target> {
    let values: Vec<Vec<f64>> = history.iter().filter_map(|c| turned(search, c)).collect();
    if search.judge.objectives() == 2 {
        return curve(&values, points);
    }
    spread(&values, &[], points).into_iter().map(target).collect()
}

/// The target with these floors of all objectives but the first.
fn target(floors: Vec<f64>) -> Target {
    // One objective climbs for all points: floors of the others lead it to any part of a front.
    Target {
        objective: 0,
        floors: floors.into_iter().enumerate().map(|(k, floor)| (k + 1, floor)).collect(),
    }
}

/// The ends of a front of two objectives, and floors of the second from where the first is the best to where the second is.
fn curve(values: &[Vec<f64>], points: usize) -> Vec<Target> {
    let end = |k: usize| values.iter().max_by(|a, b| a[k].total_cmp(&b[k]));
    let Some((first, last)) = end(0).zip(end(1)) else { return Vec::new() };
    let between = |k: usize| Spacing::between(first[k], last[k]);
    // At an end the other objective counts: many designs may be the best in one.
    let first_end = Target { objective: 1, floors: vec![(0, between(0).at(BESIDE))] };
    let last_end = target(vec![between(1).at(1.0 - BESIDE)]);
    let share = |k: usize| k as f64 / (points - 1) as f64;
    let inner = (1..points - 1).map(|k| target(vec![between(1).at(share(k))]));
    [first_end].into_iter().chain(inner).chain([last_end]).collect()
}

/// Floors of all objectives but the first at designs that none beats, as far from each other and from `taken` as can be.
fn spread(values: &[Vec<f64>], taken: &[Vec<f64>], count: usize) -> Vec<Vec<f64>> {
    let is_beaten = |value: &Vec<f64>| values.iter().any(|other| dominates(other, value));
    let front: Vec<&Vec<f64>> = values.iter().filter(|value| !is_beaten(value)).collect();
    let span = |k: usize| {
        let all = front.iter().map(|value| value[k]);
        let (low, high) = all
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        if high > low { high - low } else { 1.0 }
    };
    let spans: Vec<f64> = (0..front.first().map_or(0, |value| value.len())).map(span).collect();
    let apart = |a: &[f64], b: &[f64]| {
        let pairs = a.iter().zip(b).zip(&spans);
        pairs.map(|((a, b), span)| ((a - b) / span).powi(2)).sum::<f64>().sqrt()
    };
    let from_taken = |value: &&Vec<f64>| {
        taken.iter().map(|other| apart(value, other)).fold(f64::INFINITY, f64::min)
    };
    let mut nearest: Vec<f64> = front.iter().map(from_taken).collect();
    let mut chosen: Vec<usize> = Vec::new();
    while chosen.len() < count {
        // Of equals the first: nothing is taken at the beginning, and all are as far from that.
        let farther = |a: usize, b: usize| if nearest[b] > nearest[a] { b } else { a };
        let farthest = (0..front.len()).reduce(farther).filter(|&k| nearest[k] > NARROW);
        let Some(farthest) = farthest else { break };
        chosen.push(farthest);
        for (distance, value) in nearest.iter_mut().zip(&front) {
            *distance = distance.min(apart(value, front[farthest]));
        }
    }
    chosen.sort_by(|&a, &b| front[b][0].total_cmp(&front[a][0]));
    chosen.into_iter().map(|k| front[k][1..].to_vec()).collect()
}

#[cfg(test)]
mod tests {
    use super::{beats, is_same};

    #[test]
    fn of_points_alike_but_for_round_off_in_one_objective_the_better_stays() {
        // Where coverage and compliance both bind, floors of coverage leave such points.
        let (poor, good) = ([0.800_000_000_004_8, 0.06], [0.799_999_999_999_9, 0.6]);
        assert!(beats(&good, &poor) && !beats(&poor, &good));
        assert!(!beats(&good, &good) && is_same(&good, &[0.8, 0.6]));
        assert!(!beats(&[0.81, 0.06], &good));
    }
}
