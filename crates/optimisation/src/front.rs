//! The front of several objectives: one is made as large as can be while the others keep floors, from one end of the front to the other.

use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

use crate::candidate::{Candidate, Merit, Target};
use crate::evaluations::Halt;
use crate::judge::Judgement;
use crate::local::{Effort, Search};
use crate::search::{BestDesign, best_design};

/// A local search for each of the points, from the best that is known for it, then from its neighbours' designs, from both ends.
pub(crate) fn search(
    search: &Search<'_>,
    history: &mut Vec<Candidate>,
    points: usize,
) -> Result<Vec<Target>, Halt> {
    let targets = targets(search, history, points);
    let first = |target: &Target| match search.best(history.iter(), target) {
        Some(start) => search.improve(target, start, Effort { rounds: 2, ..Effort::WHOLE }),
        None => Ok(Vec::new()),
    };
    let walks: Vec<Vec<Candidate>> = targets.par_iter().map(first).collect::<Result<_, _>>()?;
    let bests: Vec<Option<Candidate>> = targets
        .iter()
        .zip(&walks)
        .map(|(target, walk)| search.best(history.iter().chain(walk), target).cloned())
        .collect();
    history.extend(walks.into_iter().flatten());
    let forth = (0..targets.len()).collect::<Vec<_>>();
    let back = forth.iter().rev().copied().collect::<Vec<_>>();
    let chains = [forth, back];
    let chains = chains.par_iter().map(|order| chain(search, &targets, &bests, order));
    history.extend(chains.collect::<Result<Vec<_>, _>>()?.into_iter().flatten());
    Ok(targets)
}

/// Improves the points in an `order`, each from the design of the one before.
fn chain(
    search: &Search<'_>,
    targets: &[Target],
    bests: &[Option<Candidate>],
    order: &[usize],
) -> Result<Vec<Candidate>, Halt> {
    let mut log: Vec<Candidate> = Vec::new();
    let mut neighbour: Option<Candidate> = None;
    for &k in order {
        if let Some(start) = &neighbour {
            log.extend(search.improve(&targets[k], start, Effort::SHORT)?);
        }
        // The neighbour's own search is part of the log.
        neighbour = search.best(bests[k].iter().chain(&log), &targets[k]).cloned();
    }
    Ok(log)
}

/// The best design of each target that no other design among them beats, in the order of the first objective, the best first.
pub(crate) fn designs(
    search: &Search<'_>,
    history: &[Candidate],
    targets: &[Target],
) -> Result<Vec<BestDesign>, Halt> {
    let found = targets.par_iter().map(|target| {
        let is_met = |c: &&Candidate| matches!(search.merit(c, target), Merit::Met(_));
        let any = history.iter().any(|candidate| is_met(&candidate));
        any.then(|| best_design(search, history, target.clone())).transpose()
    });
    let found: Vec<Option<BestDesign>> = found.collect::<Result<_, _>>()?;
    let found: Vec<BestDesign> = found.into_iter().flatten().collect();
    let values: Vec<Vec<f64>> =
        found.iter().filter_map(|design| turned(search, &design.candidate)).collect();
    let is_kept = |k: usize| {
        let beaten = (0..values.len())
            .any(|j| dominates(&values[j], &values[k]) || (j < k && values[j] == values[k]));
        !beaten
    };
    let mut kept: Vec<(BestDesign, f64)> = found
        .into_iter()
        .enumerate()
        .filter(|(k, _)| is_kept(*k))
        .map(|(k, design)| (design, values[k][0]))
        .collect();
    kept.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    Ok(kept.into_iter().map(|(design, _)| design).collect())
}

/// The turned objectives of a design that meets every requirement.
fn turned(search: &Search<'_>, candidate: &Candidate) -> Option<Vec<f64>> {
    let Judgement::Judged(worth) = &candidate.verdict else { return None };
    let turned = worth.objectives.iter().enumerate().map(|(k, x)| search.judge.sign(k) * x);
    worth.met.then(|| turned.collect())
}

fn dominates(one: &[f64], other: &[f64]) -> bool {
    let pairs = || one.iter().zip(other);
    pairs().all(|(a, b)| a >= b) && pairs().any(|(a, b)| a > b)
}

/// The targets of a front: its ends, and floors between them.
fn targets(search: &Search<'_>, history: &[Candidate], points: usize) -> Vec<Target> {
    let values: Vec<Vec<f64>> = history.iter().filter_map(|c| turned(search, c)).collect();
    let count = search.judge.objectives();
    let floors = if count == 2 { even(&values, points) } else { spread(&values, points) };
    let target = |floors: Vec<f64>| Target {
        objective: 0,
        floors: floors.into_iter().enumerate().map(|(k, floor)| (k + 1, floor)).collect(),
    };
    floors.into_iter().map(target).collect()
}

/// Floors of the second of two objectives at equal distances, from where the first is the best to where the second is.
fn even(values: &[Vec<f64>], points: usize) -> Vec<Vec<f64>> {
    let end = |k: usize| {
        let better = |a: &&Vec<f64>, b: &&Vec<f64>| {
            a[k].total_cmp(&b[k]).then(a[1 - k].total_cmp(&b[1 - k]))
        };
        values.iter().max_by(better).map_or(f64::NAN, |value| value[1])
    };
    let (low, high) = (end(0), end(1));
    let share = |k: usize| k as f64 / (points - 1) as f64;
    let floor = |k: usize| if k + 1 == points { high } else { low + (high - low) * share(k) };
    (0..points).map(|k| vec![floor(k)]).collect()
}

/// Floors of all objectives but the first at designs of the front that is known, as far from each other as can be.
fn spread(values: &[Vec<f64>], points: usize) -> Vec<Vec<f64>> {
    let is_beaten = |value: &Vec<f64>| values.iter().any(|other| dominates(other, value));
    let front: Vec<&Vec<f64>> = values.iter().filter(|value| !is_beaten(value)).collect();
    let Some(first) = front.first() else { return Vec::new() };
    let span = |k: usize| {
        let all = front.iter().map(|value| value[k]);
        let (low, high) = all
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        if high > low { high - low } else { 1.0 }
    };
    let spans: Vec<f64> = (0..first.len()).map(span).collect();
    let apart = |a: &[f64], b: &[f64]| {
        let pairs = a.iter().zip(b).zip(&spans);
        pairs.map(|((a, b), span)| ((a - b) / span).powi(2)).sum::<f64>()
    };
    let mut chosen = vec![0];
    let mut nearest: Vec<f64> = front.iter().map(|value| apart(value, first)).collect();
    while chosen.len() < points.min(front.len()) {
        let farthest = (0..front.len()).max_by(|&a, &b| nearest[a].total_cmp(&nearest[b]));
        let Some(farthest) = farthest.filter(|&k| nearest[k] > 0.0) else { break };
        chosen.push(farthest);
        for (distance, value) in nearest.iter_mut().zip(&front) {
            *distance = distance.min(apart(value, front[farthest]));
        }
    }
    chosen.sort_by(|&a, &b| front[b][0].total_cmp(&front[a][0]));
    chosen.into_iter().map(|k| front[k][1..].to_vec()).collect()
}
