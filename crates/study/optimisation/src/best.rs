//! The best of the designs that were looked at, and starts that are apart from each other.

use results::DesignRow;
use sweep::Measure;

use crate::candidate::{Candidate, Merit, Target};
use crate::coverage_piece::CoveragePiece;
use crate::evaluations::Halt;
use crate::local::Search;
use crate::price::{Binding, bindings};
use crate::sampled::confirmation::Confirmation;

/// A distance between two starts, a share of the intervals, at least.
const APART: f64 = 0.12;

/// The part of its limit by which a start may miss a requirement or a floor and count as one that meets it: a climb ends some 1e-8 beyond limits
/// between which there is next to no room, as between `coverage >= 0.6` and `compliance >= 0.4`.
const NEARLY: f64 = 1e-6;

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

/// A part of the space in which a local search stays: choices, the peak of coverage, whether bending brings scales into contact.
pub(crate) type Region = (Vec<usize>, Option<u32>, Option<bool>);

/// The region of a design, as far as the goal tells regions apart.
pub(crate) fn region(search: &Search<'_>, candidate: &Candidate) -> Region {
    let teeth =
        search.judge.is_about(Measure::Coverage).then(|| search.space.case(&candidate.point));
    let peak = teeth.and_then(|case| CoveragePiece::beside(&case).first().map(|piece| piece.peak));
    let flexure = candidate.result.flexure.filter(|_| search.judge.is_about(Measure::Flexure));
    let contact = flexure.and_then(|flexure| flexure.measures.contact);
    (candidate.point.chosen.clone(), peak, contact)
}

/// Starts of local searches for a target: the best design of each region, then others that are apart from those.
pub(crate) fn starts<'c>(
    search: &Search<'_>,
    history: impl IntoIterator<Item = &'c Candidate>,
    target: &Target,
    count: usize,
) -> Vec<Candidate> {
    let judged = history.into_iter().map(|c| (search.merit_within(c, target, NEARLY), c));
    let mut order: Vec<(Merit, &Candidate)> =
        judged.filter(|(merit, _)| *merit != Merit::None).collect();
    order.sort_by(|(a, _), (b, _)| b.compare(*a));
    let mut regions: Vec<Region> = Vec::new();
    let is_first = |(_, candidate): &(Merit, &Candidate)| {
        let region = region(search, candidate);
        let is_new = !regions.contains(&region);
        if is_new {
            regions.push(region);
        }
        is_new
    };
    // The order of merits is kept in both: the first of a region is its best.
    let (firsts, others): (Vec<_>, Vec<_>) = order.into_iter().partition(is_first);
    let mut starts: Vec<Candidate> =
        firsts.into_iter().take(count).map(|(_, candidate)| candidate.clone()).collect();
    for (_, candidate) in others {
        let is_apart = |start: &Candidate| start.point.distance(&candidate.point) >= APART;
        if starts.len() < count && starts.iter().all(is_apart) {
            starts.push(candidate.clone());
        }
    }
    starts
}
