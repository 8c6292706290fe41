//! Claims about flexure.

use super::digits;
use super::evidence::{BentStrip, BestDesigns, Evidence};
use super::statement::{Measured, Statement};
use super::statistics::{DesignValue, GAP, LENGTH, SLANT, TrendSteps};
use super::verdict::{DesignRange, Limits, Optimum};
use super::words::{LARGE_SLANT, covered, in_figures};
use crate::study::MeasuredDesign;

const COMPLIANCE: DesignValue = |design| design.compliance;

/// A slope that falls to less than this part of its largest value softens.
const SOFTENS: f64 = 0.9;

pub(super) const AXIAL_ENERGY: [Statement; 2] = [
    Statement::number(
        "negligible before contact",
        "largest axial over bending energy before contact, 0°",
        |evidence| {
            let before = strip(evidence, 0.0)?.axial_before;
            // Without contact it is round-off, which has no digits.
            let shown = if before < 1e-12 { "below 1e-12".to_owned() } else { digits(before) };
            Some(Measured { value: before, shown })
        },
        Limits::at_most(0.01, 0.1),
    ),
    Statement::number(
        "increases dramatically",
        "axial over bending energy at the end, 0°",
        |evidence| Some(strip(evidence, 0.0)?.axial_at_end.into()),
        Limits::at_least(1.0, 0.1),
    ),
];

pub(super) const SOFTENING: [Statement; 3] = [
    Statement::number(
        "slanted scales soften",
        "slants of which dM*/dκ* at the end is less than 0.9 times its largest after contact, %",
        slanted_scales_soften,
        Limits::TREND,
    ),
    Statement::number(
        "unslanted scales do not",
        "dM*/dκ* at the end over its largest after contact",
        |evidence| Some(strip(evidence, 0.0)?.softening?.into()),
        Limits::at_least(SOFTENS, 0.7),
    ),
    Statement::number(
        "unslanted scales do not, during the entire simulation",
        "the same on a strip of 10 t, which bends further",
        |evidence| Some(evidence.short_strip?.softening?.into()),
        Limits::at_least(SOFTENS, 0.7),
    ),
];

pub(super) const LOSS_OF_COMPLIANCE: [Statement; 1] = [Statement::number(
    "",
    "largest loss (initial over final compliance) of the designs that touch, L/t from 0.1",
    |evidence| {
        let loss = |d: &MeasuredDesign| Some(d.initial_compliance? / d.compliance?);
        let best = evidence.best(|d| in_figures(d) && d.bends_to_contact, loss)?;
        Some(Measured { value: best.value, shown: best.to_string() })
    },
    // Within half an order of magnitude, and within one.
    Limits::between([316.0, 3162.0], [100.0, 10_000.0]),
)];

pub(super) const COMPLIANT_AT_SMALL_SLANTS: [Statement; 2] = [
    Statement::best("0°", TOUCHING, |evidence| touching(evidence, 0.0), printed(0.1, 0.1, 0.0)),
    Statement::best("30°", TOUCHING, |evidence| touching(evidence, 30.0), printed(0.1, 0.1, 30.0)),
];

pub(super) const COMPLIANT_AT_LARGE_SLANTS: [Statement; 2] = [
    Statement::best("60°", TOUCHING, |evidence| touching(evidence, 60.0), printed(0.5, 0.1, 60.0)),
    Statement::best("75°", TOUCHING, |evidence| touching(evidence, 75.0), printed(1.0, 0.1, 75.0)),
];

const TOUCHING: &str = "designs with the largest C_f* of those that touch, L/t from 0.1";

pub(super) const BY_LENGTH: [Statement; 1] = [Statement::number(
    "",
    "steps from length to length at which C_f* falls, %, L/t from 0.1",
    |evidence| {
        let lines = evidence.lines(in_figures, LENGTH, [GAP, SLANT], COMPLIANCE);
        Measured::steps(TrendSteps::falling(&lines))
    },
    Limits::TREND,
)];

pub(super) const MOST_COMPLIANT: [Statement; 1] = [Statement::best(
    "",
    "designs with the largest C_f*, of those with λ > 0",
    |evidence| evidence.best(covered, COMPLIANCE),
    Optimum {
        printed: DesignRange { length: [0.025; 2], slant: [60.0; 2], ..DesignRange::ANY },
        words: DesignRange { length: [0.025; 2], slant: LARGE_SLANT, ..DesignRange::ANY },
    },
)];

const fn printed(gap: f64, length: f64, slant: f64) -> Optimum {
    Optimum::at(DesignRange::design(gap, length, slant))
}

fn strip(evidence: &Evidence, slant: f64) -> Option<&BentStrip> {
    evidence.strips.iter().find(|strip| strip.slant == slant)
}

fn slanted_scales_soften(evidence: &Evidence) -> Option<Measured> {
    let slanted: Vec<_> = evidence.strips.iter().filter(|strip| strip.slant > 0.0).collect();
    let softens = slanted.iter().filter(|s| s.softening.is_some_and(|ratio| ratio < SOFTENS));
    let value = 100.0 * softens.count() as f64 / slanted.len() as f64;
    let ratio = |strip: &&BentStrip| {
        let ratio = strip.softening.map_or_else(|| "no value".to_owned(), digits);
        format!("× {ratio} with {}°", strip.slant)
    };
    let shown = slanted.iter().map(ratio).collect::<Vec<_>>().join(", ");
    (!slanted.is_empty()).then_some(Measured { value, shown })
}

fn touching(evidence: &Evidence, slant: f64) -> Option<BestDesigns> {
    evidence.best(|d| in_figures(d) && d.bends_to_contact && d.slant == slant, COMPLIANCE)
}
