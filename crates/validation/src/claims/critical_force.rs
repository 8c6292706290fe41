//! Claims about critical force and puncture stiffness.

use super::digits;
use super::evidence::Evidence;
use super::statement::{Measured, Statement};
use super::statistics::{DesignValue, GAP, LENGTH, SLANT, TrendSteps, explained};
use super::verdict::{DesignRange, Limits, Optimum};
use super::words::{LARGE_SLANT, SMALL_GAP, SMALL_LENGTH, any, covered, in_figures};
use crate::study::MeasuredDesign;

const FORCE: DesignValue = |design| design.critical_force;
const LARGEST_STIFFNESS: DesignValue = |design| design.max_stiffness;
const INITIAL_STIFFNESS: DesignValue = |design| design.initial_stiffness;

/// The smallest gap, the smallest length, and the largest slant of the figures.
const CORNER: Optimum =
    Optimum { printed: DesignRange::design(0.1, 0.1, 75.0), words: SMALL_AND_STEEP };
const SMALL_AND_STEEP: DesignRange =
    DesignRange { gap: SMALL_GAP, length: SMALL_LENGTH, slant: LARGE_SLANT };

pub(super) const BY_GAP: [Statement; 1] = [Statement::number(
    "",
    "steps from gap to gap at which F_c* falls, %, L/t from 0.1",
    |evidence| {
        let lines = evidence.lines(in_figures, GAP, [LENGTH, SLANT], FORCE);
        Measured::steps(TrendSteps::falling(&lines))
    },
    Limits::IN_GENERAL,
)];

pub(super) const LARGEST_IN_FIGURES: [Statement; 1] = [Statement::best(
    "",
    "designs with the largest F_c*, L/t from 0.1",
    |evidence| evidence.best(in_figures, FORCE),
    CORNER,
)];

pub(super) const LARGEST_VALUE: [Statement; 1] = [Statement::number(
    "",
    "F_c* at (0.1, 0.1, 75°)",
    |evidence| Some(FORCE(evidence.design(0.1, 0.1, 75.0)?)?.into()),
    Limits::printed(64.0),
)];

/// The paper does not say which stiffness it means: "initial" and "post-contact" are both called puncture stiffness.
pub(super) const FORCE_AND_STIFFNESS: [Statement; 2] = [
    Statement::number(
        "the largest K* of the path",
        "rank correlation with F_c*, L/t from 0.1",
        |evidence| correlation(evidence, LARGEST_STIFFNESS),
        Limits::at_least(0.8, 0.5),
    ),
    Statement::number(
        "K* at rest",
        "rank correlation with F_c*, L/t from 0.1",
        |evidence| correlation(evidence, INITIAL_STIFFNESS),
        Limits::at_least(0.8, 0.5),
    ),
];

pub(super) const LARGEST_STIFFNESS_IN_FIGURES: [Statement; 2] = [
    Statement::best(
        "the largest K* of the path",
        "designs with the largest, L/t from 0.1",
        |evidence| evidence.best(in_figures, LARGEST_STIFFNESS),
        CORNER,
    ),
    Statement::best(
        "K* at rest",
        "designs with the largest, L/t from 0.1",
        |evidence| evidence.best(in_figures, INITIAL_STIFFNESS),
        CORNER,
    ),
];

const EXPLAINED: &str = "share of the variance of its logarithm that the slant explains, over the larger of the other two";

pub(super) const STRONGEST_PARAMETER: [Statement; 4] = [
    Statement::number(
        "F_c*, L/t from 0.1",
        EXPLAINED,
        |evidence| shares(evidence, in_figures, FORCE),
        Limits::at_least(1.0, 1.0),
    ),
    Statement::number(
        "the largest K* of the path, L/t from 0.1",
        EXPLAINED,
        |evidence| shares(evidence, in_figures, LARGEST_STIFFNESS),
        Limits::at_least(1.0, 1.0),
    ),
    Statement::number(
        "K* at rest, L/t from 0.1",
        EXPLAINED,
        |evidence| shares(evidence, in_figures, INITIAL_STIFFNESS),
        Limits::at_least(1.0, 1.0),
    ),
    Statement::number(
        "F_c*, all designs of the study",
        EXPLAINED,
        |evidence| shares(evidence, any, FORCE),
        Limits::at_least(1.0, 1.0),
    ),
];

pub(super) const LARGEST_OF_ALL: [Statement; 1] = [Statement::best(
    "",
    "designs with the largest F_c*, of those with λ > 0",
    |evidence| evidence.best(covered, FORCE),
    Optimum::at(SMALL_AND_STEEP),
)];

fn correlation(evidence: &Evidence, stiffness: DesignValue) -> Option<Measured> {
    let pair = |d: &MeasuredDesign| Some([stiffness(d)?, FORCE(d)?]);
    let pairs: Vec<_> =
        evidence.designs.iter().filter(|d| in_figures(d)).filter_map(pair).collect();
    Some(ranking::rank_correlation(&pairs)?.into())
}

fn shares(
    evidence: &Evidence,
    among: fn(&MeasuredDesign) -> bool,
    value: DesignValue,
) -> Option<Measured> {
    let valued = |d| Some((d, value(d)?.ln()));
    let designs: Vec<_> = evidence.designs.iter().filter(|d| among(d)).filter_map(valued).collect();
    if designs.is_empty() {
        return None;
    }
    let [gap, length, slant] = [GAP, LENGTH, SLANT].map(|p| 100.0 * explained(&designs, p));
    let value = slant / gap.max(length);
    let shown = format!("{}: d/t {gap:.0} %, L/t {length:.0} %, slant {slant:.0} %", digits(value));
    Some(Measured { value, shown })
}
