//! The verdict on a claim, and the value that it rests on.

use std::fmt;

use crate::study::MeasuredDesign;

/// The verdict on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The claim holds.
    Reproduced,
    /// The claim holds in part.
    InPart,
    /// The claim does not hold.
    NotReproduced,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Reproduced => "reproduced",
            Self::InPart => "in part",
            Self::NotReproduced => "not reproduced",
        })
    }
}

/// The result of the check of a claim.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Whether the paper's claim holds.
    pub verdict: Verdict,
    /// The number or the design that was found.
    pub ours: String,
}

impl Finding {
    /// Creates a finding that is reproduced or not.
    pub(crate) fn is(reproduced: bool, ours: impl Into<String>) -> Self {
        Self::graded(reproduced, reproduced, ours)
    }

    /// Creates a finding that is reproduced, or if not perhaps in part.
    pub(crate) fn graded(reproduced: bool, in_part: bool, ours: impl Into<String>) -> Self {
        let verdict = match (reproduced, in_part) {
            (true, _) => Verdict::Reproduced,
            (_, true) => Verdict::InPart,
            _ => Verdict::NotReproduced,
        };
        Self { verdict, ours: ours.into() }
    }

    /// Creates a finding from a number that the paper reports as `reported`: reproduced within 10 %, in part within 30 %.
    pub(crate) fn number(ours: f64, reported: f64) -> Self {
        let off = (ours / reported - 1.0).abs();
        Self::graded(off <= 0.1, off <= 0.3, digits(ours))
    }

    /// Creates the finding of a check whose designs have not been solved.
    pub(crate) fn nothing() -> Self {
        Self { verdict: Verdict::NotReproduced, ours: "no value".to_owned() }
    }
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

/// Formats the parameters of a design.
pub(crate) fn named(design: &MeasuredDesign) -> String {
    format!("({}, {}, {}°)", design.gap, design.length, design.slant)
}
