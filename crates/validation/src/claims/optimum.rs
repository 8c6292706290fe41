//! Claims about the best designs.

use ranking::{Ranking, TetrahedralGrid, Weights};

use super::finding::{Finding, digits, named};
use crate::study::{MeasuredDesign, Study};

/// The share of the weights from which "a wide range" (C29) holds: a fifth.
const WIDE: f64 = 0.2;

fn covers(design: &MeasuredDesign) -> bool {
    design.coverage > Some(0.0)
}

pub(super) fn least_penetration(study: &Study) -> Option<Finding> {
    let (design, _) = study.largest(covers, |d| d.penetration.map(f64::recip))?;
    Some(Finding::is(design.gap >= 0.7, named(design)))
}

pub(super) fn most_compliant(study: &Study) -> Option<Finding> {
    let (design, _) = study.largest(covers, |d| d.compliance)?;
    let (short, slant) = (design.length == 0.025, design.slant == 60.0);
    Some(Finding::graded(short && slant, short || slant, named(design)))
}

pub(super) fn largest_force(study: &Study) -> Option<Finding> {
    let (design, force) = study.largest(|_| true, |d| d.critical_force)?;
    let agrees = design.gap <= 0.2 && design.length <= 0.1 && design.slant == 75.0;
    Some(Finding::is(agrees, format!("{}, F_c* = {}", named(design), digits(force))))
}

/// Returns the best design with equal weights, and the share of the weights that it wins.
pub(crate) fn balanced_optimum(study: &Study) -> Option<(&MeasuredDesign, f64)> {
    let ranking = Ranking::new(&study.results, TetrahedralGrid::default()).ok()?;
    let winner = ranking.winner(Weights::BALANCED);
    Some((study.designs.get(winner.row())?, winner.share()))
}

pub(super) fn balanced(study: &Study) -> Option<Finding> {
    let (design, _) = balanced_optimum(study)?;
    let agrees = (design.gap, design.length, design.slant) == (0.7, 0.1, 60.0);
    Some(Finding::is(agrees, named(design)))
}

pub(super) fn share_of_the_balanced(study: &Study) -> Option<Finding> {
    let (_, share) = balanced_optimum(study)?;
    Some(Finding::is(share >= WIDE, format!("{:.1} %", 100.0 * share)))
}
