//! The claims of the paper and their checks.

mod bending;
mod finding;
mod optimum;
mod puncture;
mod statistics;

use serde::Deserialize;

pub use finding::{Finding, Verdict};
pub(crate) use finding::{digits, named};
pub(crate) use statistics::DesignValue;

use crate::ValidationError;
use crate::study::Study;

/// The claims and their places in the paper, as a table.
const CLAIMS: &str = include_str!("../claims.csv");

/// A checkable statement of Shafiei et al. (2021).
#[derive(Clone, Debug, Deserialize)]
pub struct Claim {
    /// The number of the claim: `C01` and so on.
    pub id: String,
    /// The section or figure of the paper.
    #[serde(rename = "where")]
    pub place: String,
    /// The measure that the claim is about.
    pub about: String,
    /// The claim in words.
    pub claim: String,
    /// The quantity by which the claim is checked.
    pub quantity: String,
    /// The value or trend that the paper reports.
    pub reported: String,
}

/// A claim with the finding of each sweep.
#[derive(Clone, Debug)]
pub struct CheckedClaim {
    /// The claim.
    pub claim: Claim,
    /// The findings with a base of `L` and of `2L`.
    pub found: [Finding; 2],
    /// The reason for the verdicts, where it is known.
    pub reason: &'static str,
}

/// A check of a claim against a sweep; `None` where designs that it needs are missing.
type ClaimCheck = fn(&Study) -> Option<Finding>;

/// The check of each claim, and the reason for its verdict, where it is known.
const CHECKS: [(&str, ClaimCheck, &str); 30] = [
    ("C01", puncture::unslanted_coverage, "by the definition of coverage"),
    (
        "C02",
        puncture::best_coverage,
        "decides for the base L: of a base 2L the steepest slant covers best",
    ),
    ("C03", puncture::first_contact_unslanted, "decides for the base L"),
    ("C04", puncture::first_contact_at_45, "between the two bases, nearer to L"),
    ("C05", puncture::steep_scales_touch_first, "the lever arm of the load grows with the slant"),
    ("C06", puncture::initial_stiffness_by_slant, "the lever arm of the load grows with the slant"),
    ("C07", puncture::stiffness_by_slant, "more scales share the load"),
    ("C08", puncture::unslanted_contact, "the corner slides down the neighbour's side"),
    (
        "C09",
        puncture::stiffness_by_length,
        "the slope of F* over u*, for L/t from 0.1; it falls for the longer half only",
    ),
    (
        "C10",
        puncture::stiffness_by_gap,
        "neighbours couple through the substrate, so the gap cannot be without effect",
    ),
    ("C11", puncture::force_by_gap, ""),
    ("C12", puncture::largest_force, ""),
    (
        "C13",
        puncture::largest_force_value,
        "grows with the width: b = 3.15 t gives 64 with the base L, see docs/open-questions.md",
    ),
    ("C14", puncture::force_and_stiffness, ""),
    ("C15", puncture::largest_stiffness, ""),
    ("C16", puncture::strongest_parameter, ""),
    ("C17", puncture::unslanted_load, ""),
    ("C18", puncture::domino, "the paper does not say at which force; this is the critical tilt"),
    ("C19", bending::axial_energy, "the membrane is pulled against the contacts"),
    ("C20", bending::softening, "contacts slide, and their lever arm grows"),
    (
        "C21",
        bending::loss_of_compliance,
        "contact is nearly rigid, so the thin membrane alone decides; the reduction grows with the slant and as the gap shrinks",
    ),
    (
        "C22",
        bending::most_compliant_at_small_slants,
        "before contact the compliance is d/(2a + d), which grows with the gap, and scales of small slant that touch lose it all",
    ),
    ("C23", bending::most_compliant_at_large_slants, "as C22"),
    ("C24", bending::compliance_by_length, "before contact the compliance is d/(2a + d)"),
    ("C25", optimum::least_penetration, "a scale that touches no neighbour tilts before it sinks"),
    ("C26", optimum::most_compliant, ""),
    ("C27", optimum::largest_force, ""),
    (
        "C28",
        optimum::balanced,
        "no setting that was tried gives the printed optimum, see docs/open-questions.md",
    ),
    ("C29", optimum::share_of_the_balanced, "for the optimum that we find"),
    ("C30", puncture::two_blocks, ""),
];

/// Returns the numbers of the claims.
pub(crate) fn ids() -> impl Iterator<Item = &'static str> {
    CHECKS.iter().map(|(id, ..)| *id)
}

/// Returns the claims as the paper has them.
///
/// # Errors
/// If the table of claims cannot be read.
pub fn claims() -> Result<Vec<Claim>, csv::Error> {
    csv::Reader::from_reader(CLAIMS.as_bytes()).deserialize().collect()
}

/// Returns the claims that a study reproduces, and those that it reproduces in part.
pub(crate) fn score(study: &Study) -> [Vec<&'static str>; 2] {
    let graded: Vec<_> =
        CHECKS.iter().filter_map(|(id, check, _)| Some((*id, check(study)?.verdict))).collect();
    [Verdict::Reproduced, Verdict::InPart].map(|wanted| {
        graded.iter().filter(|(_, verdict)| *verdict == wanted).map(|(id, _)| *id).collect()
    })
}

/// Checks every claim against two studies: with the base `L`, and with `2L`.
pub(crate) fn check(studies: [&Study; 2]) -> Result<Vec<CheckedClaim>, ValidationError> {
    let checked = claims()?.into_iter().map(|claim| {
        let known = CHECKS.iter().find(|(id, ..)| *id == claim.id);
        let (_, check, reason) =
            known.ok_or_else(|| ValidationError::UncheckedClaim(claim.id.clone()))?;
        let found = studies.map(|study| check(study).unwrap_or_else(Finding::nothing));
        Ok(CheckedClaim { claim, found, reason })
    });
    checked.collect()
}
