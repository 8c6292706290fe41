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
    /// The reason for what comes out, where it is known.
    pub reason: String,
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

/// The statements of each claim.
const STATEMENTS: [(&str, &[Statement]); 30] = [
    ("C01", &coverage::UNSLANTED),
    ("C02", &coverage::BEST),
    ("C03", &puncture::FIRST_CONTACT_UNSLANTED),
    ("C04", &puncture::FIRST_CONTACT_AT_45),
    ("C05", &puncture::STEEP_SCALES_TOUCH_FIRST),
    ("C06", &puncture::INITIAL_STIFFNESS_BY_SLANT),
    ("C07", &puncture::STIFFNESS_BY_SLANT),
    ("C08", &puncture::UNSLANTED_CONTACT),
    ("C09", &puncture::BY_LENGTH),
    ("C10", &puncture::BY_GAP),
    ("C11", &critical_force::BY_GAP),
    ("C12", &critical_force::LARGEST_IN_FIGURES),
    ("C13", &critical_force::LARGEST_VALUE),
    ("C14", &critical_force::FORCE_AND_STIFFNESS),
    ("C15", &critical_force::LARGEST_STIFFNESS_IN_FIGURES),
    ("C16", &critical_force::STRONGEST_PARAMETER),
    ("C17", &domino::UNSLANTED),
    ("C18", &domino::DOMINO),
    ("C19", &flexure::AXIAL_ENERGY),
    ("C20", &flexure::SOFTENING),
    ("C21", &flexure::LOSS_OF_COMPLIANCE),
    ("C22", &flexure::COMPLIANT_AT_SMALL_SLANTS),
    ("C23", &flexure::COMPLIANT_AT_LARGE_SLANTS),
    ("C24", &flexure::BY_LENGTH),
    ("C25", &optimum::LEAST_PENETRATION),
    ("C26", &flexure::MOST_COMPLIANT),
    ("C27", &critical_force::LARGEST_OF_ALL),
    ("C28", &optimum::BALANCED),
    ("C29", &optimum::SHARE_OF_PRINTED),
    ("C30", &puncture::TWO_BLOCKS),
];

/// Returns the numbers of the claims.
pub(crate) fn ids() -> impl Iterator<Item = &'static str> {
    STATEMENTS.iter().map(|(id, _)| *id)
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
    let graded = STATEMENTS.map(|(id, statements)| (id, verdict(statements, &evidence)));
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
    let known = STATEMENTS.iter().find(|(id, _)| *id == claim.id);
    let (_, statements) = known.ok_or_else(|| ValidationError::UncheckedClaim(claim.id.clone()))?;
    let verdicts = [0, 1].map(|base| verdict(statements, &evidence[base]));
    let checked = |statement: &Statement| CheckedStatement {
        says: statement.says,
        measured: statement.measured,
        limits: statement.limits(),
        found: [0, 1].map(|base| statement.find(&evidence[base])),
    };
    let statements = statements.iter().map(checked).collect();
    Ok(CheckedClaim { claim, statements, verdicts })
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
