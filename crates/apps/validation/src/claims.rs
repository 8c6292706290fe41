//! The claims of the paper, statement by statement.

mod critical_force;
mod evidence;
mod flexure;
mod gather;
mod measured_number;
mod measurements;
mod puncture;
mod statement;
mod statistics;
#[cfg(test)]
mod tests;
mod verdict;

use serde::Deserialize;

use evidence::Evidence;
pub use statement::Finding;
use statement::Statement;
pub(crate) use statistics::DesignValue;
pub use verdict::Verdict;

use crate::study::{MeasuredDesign, Study};

/// The table of claims, each with its section or figure in the paper.
const CLAIMS: &str = include_str!("../claims.csv");

/// The table of statements with the measured quantities and their limits.
const STATEMENTS: &str = include_str!("../statements.csv");

/// A checkable claim of Shafiei et al. (2021).
#[derive(Clone, Debug, Deserialize)]
pub struct Claim {
    /// The number of the claim, `C01` and so on.
    pub id: String,
    /// Section or figure of the paper.
    #[serde(rename = "where")]
    pub place: String,
    /// The measure to which the claim refers.
    pub about: String,
    /// The statement of the paper.
    pub claim: String,
    /// The reason for the result, if known.
    pub reason: String,
}

/// A claim with its statements, each checked with a base of `L` and of `2L`.
#[derive(Clone, Debug)]
pub struct CheckedClaim {
    /// The claim.
    pub claim: Claim,
    /// Statements of the claim.
    pub statements: Vec<CheckedStatement>,
    /// The verdicts with a base of `L` and of `2L`.
    pub verdicts: [Verdict; 2],
}

/// A statement of a claim, checked with a base of `L` and of `2L`.
#[derive(Clone, Debug)]
pub struct CheckedStatement {
    /// Text of the statement; empty if the statement is the claim itself.
    pub text: String,
    /// The measured quantity.
    pub measured: String,
    /// The limits for reproduction in full and in part.
    pub limits: String,
    /// The findings with a base of `L` and of `2L`.
    pub found: [Finding; 2],
}

/// Returns the claims of the paper.
///
/// # Errors
/// If the table of claims cannot be read.
pub fn claims() -> Result<Vec<Claim>, csv::Error> {
    csv::Reader::from_reader(CLAIMS.as_bytes()).deserialize().collect()
}

/// Returns the claims with their statements.
fn statements() -> anyhow::Result<Vec<(Claim, Vec<Statement>)>> {
    let mut table = csv::Reader::from_reader(STATEMENTS.as_bytes());
    let all: Vec<Statement> = table.deserialize().collect::<Result<_, _>>()?;
    // C18a and C18b belong to C18. All numbers have two digits, so none is a prefix of another.
    Ok(claims()?
        .into_iter()
        .map(|claim| {
            let statements = all.iter().filter(|s| s.id.starts_with(&claim.id)).cloned().collect();
            (claim, statements)
        })
        .collect())
}

/// Returns the numbers of all claims with their verdicts in a study.
///
/// # Errors
/// If the tables of claims cannot be read.
pub(crate) fn score(study: &Study) -> anyhow::Result<Vec<(String, Verdict)>> {
    let evidence = gather::gather(study);
    let verdicts = statements()?
        .into_iter()
        .map(|(claim, statements)| Ok((claim.id, verdict(&statements, &evidence)?)));
    verdicts.collect()
}

fn verdict(statements: &[Statement], evidence: &Evidence) -> anyhow::Result<Verdict> {
    let verdicts = statements.iter().map(|s| Ok(s.find(evidence)?.verdict));
    Ok(Verdict::of_all(&verdicts.collect::<anyhow::Result<Vec<_>>>()?))
}

/// Checks every claim in two studies: with a base of `L` and of `2L`.
pub(crate) fn check(studies: [&Study; 2]) -> anyhow::Result<Vec<CheckedClaim>> {
    judge(&studies.map(gather::gather))
}

fn judge(evidence: &[Evidence; 2]) -> anyhow::Result<Vec<CheckedClaim>> {
    let claims = statements()?.into_iter();
    claims.map(|(claim, statements)| judge_claim(claim, statements, evidence)).collect()
}

fn judge_claim(
    claim: Claim,
    statements: Vec<Statement>,
    [paper, as_written]: &[Evidence; 2],
) -> anyhow::Result<CheckedClaim> {
    let statements = statements
        .into_iter()
        .map(|statement| {
            let found = [statement.find(paper)?, statement.find(as_written)?];
            let Statement { text, measured, limits, .. } = statement;
            Ok(CheckedStatement { text, measured, limits, found })
        })
        .collect::<anyhow::Result<Vec<_>>>()?;
    let verdicts = [0, 1].map(|base| {
        let found = statements.iter().map(|of: &CheckedStatement| of.found[base].verdict);
        Verdict::of_all(&found.collect::<Vec<_>>())
    });
    Ok(CheckedClaim { claim, statements, verdicts })
}

/// Formats a number with four significant digits.
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

/// Formats the parameters of a design as `(d/t, L/t, slant)`.
pub(crate) fn named(design: &MeasuredDesign) -> String {
    format!("({}, {}, {}°)", design.gap, design.length, design.slant)
}
