//! Selects the best design, and the designs from which local searches start.

use results::DesignRow;
use sweep::Measure;

use crate::candidate::{Candidate, Merit, Target};
use crate::checks::DesignChecks;
use crate::coverage_piece::CoveragePiece;
use crate::evaluations::{Halt, Positions};
use crate::local::Search;
use crate::price::{Binding, bindings};
use crate::restarts::Agreement;
use crate::sampled::confirmation::Confirmation;

/// Minimum distance of a start from all other starts, as a fraction of the ranges of the variables.
///
/// The best designs of different regions may be closer.
const MIN_DISTANCE: f64 = 0.12;

/// Shortfall, relative to the limits, up to which a start counts as feasible.
///
/// If two limits leave almost no feasible space (e.g. `coverage >= 0.6` and `compliance >= 0.4`), a
/// gradient search ends with a shortfall of about 1e-8.
const NEARLY: f64 = 1e-6;

/// A best design: the optimum, or a point of a front.
#[derive(Clone, Debug)]
pub struct BestDesign {
    /// The design, with its nominal result and its judgement by the goal.
    pub candidate: Candidate,
    /// Row of the design in the table of best designs, with the values of all columns.
    pub row: DesignRow,
    /// Target of the search that found the design.
    pub target: Target,
    /// Binding limits with their multipliers.
    pub bindings: Vec<Binding>,
    /// Sentence that names the limits that prevent a better design.
    ///
    /// `None` for a point of a front, or if the reason is unknown.
    pub reason: Option<String>,
    /// Check with independent samples; `None` if the goal contains no statistics over samples.
    pub confirmation: Option<Confirmation>,
    /// Number of local searches that found this design; `None` for a point of a front.
    pub agreement: Option<Agreement>,
    /// Checks with finer models; empty for a point of a front.
    pub checks: DesignChecks,
}

/// Returns the best design in `history` for `target`, with its binding limits.
///
/// Reason, confirmation, agreement and checks are added later.
pub(crate) fn best_design(
    search: &Search<'_>,
    history: &[Candidate],
    target: Target,
) -> Result<BestDesign, Halt> {
    let best = best_at_all_positions(search, history, &target)?;
    let row = search.evaluations.row(0, &best.point, &best.result);
    let bindings = bindings(search, &best, &target)?;
    Ok(BestDesign {
        candidate: best,
        row,
        target,
        bindings,
        reason: None,
        confirmation: None,
        agreement: None,
        checks: DesignChecks::default(),
    })
}

/// Returns the best design in `history`, solved at all load positions.
///
/// Some designs in `history` may have been solved at the corners of the top only. If the best of
/// these designs has another merit at all load positions, the next best design is examined.
fn best_at_all_positions(
    search: &Search<'_>,
    history: &[Candidate],
    target: &Target,
) -> Result<Candidate, Halt> {
    let mut solved_at_all: Vec<Candidate> = Vec::new();
    loop {
        let others = history.iter().filter(|c| solved_at_all.iter().all(|s| s.point != c.point));
        // The fallback is never used: callers check that some design has a valid judgement.
        let best = search.best(others.chain(&solved_at_all), target).unwrap_or(&history[0]);
        if search.evaluations.compared_positions(&best.point) == Positions::All
            || solved_at_all.iter().any(|solved| solved.point == best.point)
        {
            return Ok(best.clone());
        }
        let at_all = search.evaluate(best.stage, &best.point, true)?.0;
        let best = best.clone();
        if search.merit(&best, target).agrees(search.merit(&at_all, target)) {
            return Ok(at_all);
        }
        solved_at_all.push(at_all);
    }
}

/// Region of the space that a local search seldom leaves.
///
/// The elements are the indices of the choices, the number of the coverage peak, and `true` if
/// scales are in contact at the end of bending.
pub(crate) type Region = (Vec<usize>, Option<u32>, Option<bool>);

/// Returns the region of a design.
///
/// The coverage peak is `None` if the goal does not depend on coverage. The contact is `None` if
/// the goal does not depend on bending.
pub(crate) fn region(search: &Search<'_>, candidate: &Candidate) -> Region {
    let case =
        search.judge.depends_on(Measure::Coverage).then(|| search.space.case(&candidate.point));
    let peak = case.and_then(|case| CoveragePiece::beside(&case).first().map(|piece| piece.peak));
    let flexure = candidate.result.flexure.filter(|_| search.judge.depends_on(Measure::Flexure));
    let contact = flexure.and_then(|flexure| flexure.measures.contact);
    (candidate.point.chosen.clone(), peak, contact)
}

/// Selects at most `count` designs from `history` as starts of local searches.
///
/// The best designs of the regions are selected first, in the order of merit. Other designs follow
/// if their distance from all selected designs is at least `MIN_DISTANCE`.
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
    // `order` is sorted by merit, so the first design found in a region is its best.
    let (firsts, others): (Vec<_>, Vec<_>) = order.into_iter().partition(|(_, candidate)| {
        let region = region(search, candidate);
        let is_new = !regions.contains(&region);
        if is_new {
            regions.push(region);
        }
        is_new
    });
    let mut starts: Vec<Candidate> =
        firsts.into_iter().take(count).map(|(_, candidate)| candidate.clone()).collect();
    for (_, candidate) in others {
        if starts.len() < count
            && starts.iter().all(|start| start.point.distance(&candidate.point) >= MIN_DISTANCE)
        {
            starts.push(candidate.clone());
        }
    }
    starts
}
