//! The best of the designs that were looked at, and starts that are apart from each other.

use results::DesignRow;

use crate::candidate::{Candidate, Merit, Target};
use crate::evaluations::Halt;
use crate::local::Search;
use crate::price::{Binding, bindings};
use crate::sampled::confirmation::Confirmation;

/// A distance between two starts, a share of the intervals, at least.
const APART: f64 = 0.12;

/// A best design.
#[derive(Clone, Debug)]
pub struct BestDesign {
    /// The design.
    pub candidate: Candidate,
    /// The design as a row of tables.
    pub row: DesignRow,
    /// The target of the search that found it.
    pub target: Target,
    /// The limits that keep the design from being better, and what each costs.
    pub bindings: Vec<Binding>,
    /// What other samples of it say, if the goal is about them.
    pub confirmation: Option<Confirmation>,
}

/// The best of all designs that were looked at, with what keeps it from being better.
pub(crate) fn best_design(
    search: &Search<'_>,
    history: &[Candidate],
    target: Target,
) -> Result<BestDesign, Halt> {
    // Whoever asks knows that there is a design that can be judged.
    let best = search.best(history.iter(), &target).unwrap_or(&history[0]).clone();
    let row = search.evaluations.row(0, &best.point, &best.result);
    let bindings = bindings(search, &best, &target)?;
    Ok(BestDesign { candidate: best, row, target, bindings, confirmation: None })
}

/// The best designs for a target that are apart from each other, as starts of local searches.
pub(crate) fn apart(
    search: &Search<'_>,
    history: &[Candidate],
    target: &Target,
    count: usize,
) -> Vec<Candidate> {
    let mut order: Vec<(Merit, &Candidate)> =
        history.iter().map(|candidate| (search.merit(candidate, target), candidate)).collect();
    order.sort_by(|(a, _), (b, _)| b.compare(*a));
    let mut starts: Vec<Candidate> = Vec::new();
    for (merit, candidate) in order {
        if merit == Merit::None || starts.len() == count {
            break;
        }
        if starts.iter().all(|start| distance(start, candidate) >= APART) {
            starts.push(candidate.clone());
        }
    }
    starts
}

/// The largest difference between two designs in any interval; infinite if their choices differ.
fn distance(one: &Candidate, other: &Candidate) -> f64 {
    if one.point.chosen != other.point.chosen {
        return f64::INFINITY;
    }
    let pairs = one.point.shares.iter().zip(&other.point.shares);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
