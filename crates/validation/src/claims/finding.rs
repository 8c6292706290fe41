//! What comes out of a check.

use std::fmt;

use crate::study::Design;

/// Whether a claim is reproduced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Yes.
    Reproduced,
    /// In part.
    InPart,
    /// No.
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

/// What was found where the paper claims something.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Whether it is what the paper says.
    pub verdict: Verdict,
    /// The number, or the design.
    pub ours: String,
}

impl Finding {
    /// Reproduced or not.
    pub(crate) fn is(reproduced: bool, ours: impl Into<String>) -> Self {
        Self::graded(reproduced, reproduced, ours)
    }

    /// Reproduced, or if not perhaps in part.
    pub(crate) fn graded(reproduced: bool, in_part: bool, ours: impl Into<String>) -> Self {
        let verdict = match (reproduced, in_part) {
            (true, _) => Verdict::Reproduced,
            (_, true) => Verdict::InPart,
            _ => Verdict::NotReproduced,
        };
        Self { verdict, ours: ours.into() }
    }

    /// A number that the paper reports as `reported`: reproduced within a tenth, in part within three.
    pub(crate) fn number(ours: f64, reported: f64) -> Self {
        let off = (ours / reported - 1.0).abs();
        Self::graded(off <= 0.1, off <= 0.3, digits(ours))
    }

    /// Nothing was found: the designs have not been solved.
    pub(crate) fn nothing() -> Self {
        Self { verdict: Verdict::NotReproduced, ours: "no value".to_owned() }
    }
}

/// A number with four significant digits.
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

/// The parameters of a design.
pub(crate) fn named(design: &Design) -> String {
    format!("({}, {}, {}°)", design.gap, design.length, design.slant)
}
