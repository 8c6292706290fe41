//! The claims of the paper, statement by statement.

mod coverage;
mod critical_force;
mod domino;
mod evidence;
mod flexure;
mod gather;
mod optimum;
mod puncture;
mod statement;
mod statistics;
#[cfg(test)]
mod tests;
mod verdict;
mod words;

use serde::Deserialize;

use evidence::Evidence;
pub use statement::Finding;
use statement::Statement;
pub(crate) use statistics::DesignValue;
pub use verdict::Verdict;

use crate::ValidationError;
use crate::study::{MeasuredDesign, Study};

/// The claims and their places in the paper, as a table.
const CLAIMS: &str = include_str!("../claims.csv");

/// A checkable claim of Shafiei et al. (2021).
#[derive(Clone, Debug, Deserialize)]
pub struct Claim {
    /// The number of the claim, `C01` and so on.
    pub id: String,
    /// Section or figure.
    #[serde(rename = "where")]
    pub place: String,
    /// The measure that the claim is about.
    pub about: String,
    /// The statement of the paper.
    pub claim: String,
}

/// A claim with its statements, each checked against the two studies.
#[derive(Clone, Debug)]
pub struct CheckedClaim {
    /// The claim.
    pub claim: Claim,
    /// The statements of the claim.
    pub statements: Vec<CheckedStatement>,
    /// The verdicts on the claim, with a base of `L`, and of `2L`.
    pub verdicts: [Verdict; 2],
    /// The reason for what comes out, where it is known.
    pub reason: &'static str,
}

/// A single statement of a claim, checked against the two studies.
#[derive(Clone, Debug)]
pub struct CheckedStatement {
    /// The statement in words; empty if the claim says just that.
    pub says: &'static str,
    /// The measured quantity.
    pub measured: &'static str,
    /// The limits that it must keep to be reproduced, and to be reproduced in part.
    pub limits: String,
    /// The findings with a base of `L`, and of `2L`.
    pub found: [Finding; 2],
}

/// The statements of each claim, and the reason for what comes out, where it is known.
const STATEMENTS: [(&str, &[Statement], &str); 30] = [
    ("C01", &coverage::UNSLANTED, "by the definition of coverage"),
    ("C02", &coverage::BEST, "decides for the base L: of a base 2L the steepest slant covers best"),
    ("C03", &puncture::FIRST_CONTACT_UNSLANTED, "decides for the base L"),
    ("C04", &puncture::FIRST_CONTACT_AT_45, "between the two bases, nearer to L"),
    ("C05", &puncture::STEEP_SCALES_TOUCH_FIRST, "the lever arm of the load grows with the slant"),
    (
        "C06",
        &puncture::INITIAL_STIFFNESS_BY_SLANT,
        "the lever arm of the load grows with the slant",
    ),
    ("C07", &puncture::STIFFNESS_BY_SLANT, "more scales share the load"),
    ("C08", &puncture::UNSLANTED_CONTACT, "the corner slides down the neighbour's side"),
    (
        "C09",
        &puncture::BY_LENGTH,
        "to bring its corner as deep as a long one does, a short scale turns further, and the edge of its base goes deeper",
    ),
    (
        "C10",
        &puncture::BY_GAP,
        "neighbours couple through the substrate, so the gap cannot be without effect; a row that touches late shows only the soft beginning of contact",
    ),
    ("C11", &critical_force::BY_GAP, ""),
    ("C12", &critical_force::LARGEST_IN_FIGURES, ""),
    (
        "C13",
        &critical_force::LARGEST_VALUE,
        "grows with the width: b = 3.15 t gives 64 with the base L, see docs/open-questions.md",
    ),
    ("C14", &critical_force::FORCE_AND_STIFFNESS, "the paper does not say which stiffness"),
    ("C15", &critical_force::LARGEST_STIFFNESS_IN_FIGURES, "as C14"),
    (
        "C16",
        &critical_force::STRONGEST_PARAMETER,
        "with the two smallest lengths, which the figure leaves out, the length matters most",
    ),
    ("C17", &domino::UNSLANTED, "the paper does not say which design; this is that of Fig. 6a"),
    ("C18", &domino::DOMINO, "as C17"),
    ("C19", &flexure::AXIAL_ENERGY, "the membrane is pulled against the contacts"),
    (
        "C20",
        &flexure::SOFTENING,
        "contacts slide, and their lever arm grows; far beyond contact without slant, too",
    ),
    (
        "C21",
        &flexure::LOSS_OF_COMPLIANCE,
        "contact is nearly rigid, so the thin membrane alone decides; the reduction grows with the slant and as the gap shrinks",
    ),
    (
        "C22",
        &flexure::COMPLIANT_AT_SMALL_SLANTS,
        "which designs touch depends on the gaps of the strip: with 41 to 44 in every design as printed, see docs/open-questions.md",
    ),
    ("C23", &flexure::COMPLIANT_AT_LARGE_SLANTS, "as C22"),
    ("C24", &flexure::BY_LENGTH, "before contact the compliance is d/(2a + d)"),
    ("C25", &optimum::LEAST_PENETRATION, "a scale that touches no neighbour tilts before it sinks"),
    ("C26", &flexure::MOST_COMPLIANT, "without contact the slant is without effect"),
    ("C27", &critical_force::LARGEST_OF_ALL, ""),
    (
        "C28",
        &optimum::BALANCED,
        "no setting that was tried gives the printed optimum, see docs/open-questions.md",
    ),
    ("C29", &optimum::SHARE_OF_PRINTED, "as C28"),
    ("C30", &puncture::TWO_BLOCKS, ""),
];

/// Returns the numbers of the claims.
pub(crate) fn ids() -> impl Iterator<Item = &'static str> {
    STATEMENTS.iter().map(|(id, ..)| *id)
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
    let evidence = gather::gather(study);
    let graded = STATEMENTS.map(|(id, statements, _)| (id, verdict(statements, &evidence)));
    [Verdict::Reproduced, Verdict::InPart].map(|wanted| {
        graded.iter().filter(|(_, verdict)| *verdict == wanted).map(|(id, _)| *id).collect()
    })
}

fn verdict(statements: &[Statement], evidence: &Evidence) -> Verdict {
    let verdicts: Vec<_> = statements.iter().map(|s| s.find(evidence).verdict).collect();
    Verdict::of_all(&verdicts)
}

/// Checks every claim against two studies: with the base `L`, and with `2L`.
pub(crate) fn check(studies: [&Study; 2]) -> Result<Vec<CheckedClaim>, ValidationError> {
    judge(&studies.map(gather::gather))
}

fn judge(evidence: &[Evidence; 2]) -> Result<Vec<CheckedClaim>, ValidationError> {
    claims()?.into_iter().map(|claim| judge_claim(claim, evidence)).collect()
}

fn judge_claim(claim: Claim, evidence: &[Evidence; 2]) -> Result<CheckedClaim, ValidationError> {
    let known = STATEMENTS.iter().find(|(id, ..)| *id == claim.id);
    let (_, statements, reason) =
        known.ok_or_else(|| ValidationError::UncheckedClaim(claim.id.clone()))?;
    let verdicts = [0, 1].map(|base| verdict(statements, &evidence[base]));
    let checked = |statement: &Statement| CheckedStatement {
        says: statement.says,
        measured: statement.measured,
        limits: statement.limits(),
        found: [0, 1].map(|base| statement.find(&evidence[base])),
    };
    let statements = statements.iter().map(checked).collect();
    Ok(CheckedClaim { claim, statements, verdicts, reason })
}

/// Writes a number with four significant digits.
pub(crate) fn digits(number: f64) -> String {
    let size = number.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e5).contains(&size) {
        format!("{number:.3e}")
    } else {
        let decimals = (3.0 - size.log10().floor()).max(0.0) as usize;
        format!("{number:.decimals$}")
    }
}

/// Writes the same without the zeros at its end.
fn brief(number: f64) -> String {
    let digits = digits(number);
    if digits.contains('.') && !digits.contains('e') {
        digits.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        digits
    }
}

/// Writes the parameters of a design.
pub(crate) fn named(design: &MeasuredDesign) -> String {
    format!("({}, {}, {}°)", design.gap, design.length, design.slant)
}
