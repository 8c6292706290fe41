//! Verdicts, and the limits that decide them.

use std::fmt;

use crate::study::MeasuredDesign;

/// The verdict on a claim of the paper, or on one of its statements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The result agrees with the claim.
    Reproduced,
    /// The result agrees with a part of the claim, or approximately.
    InPart,
    /// The result contradicts the claim, or has no value.
    NotReproduced,
}

impl Verdict {
    fn graded(reproduced: bool, in_part: bool) -> Self {
        match (reproduced, in_part) {
            (true, _) => Self::Reproduced,
            (_, true) => Self::InPart,
            _ => Self::NotReproduced,
        }
    }

    /// Returns the verdict on a claim from the verdicts on its statements.
    ///
    /// The claim is reproduced if all statements are reproduced, and not reproduced if all are not
    /// reproduced. Otherwise it is reproduced in part.
    pub(crate) fn of_all(statements: &[Self]) -> Self {
        let is_whole = statements.iter().all(|found| *found == Self::Reproduced);
        let is_partial = statements.iter().any(|found| *found != Self::NotReproduced);
        Self::graded(is_whole, is_partial)
    }
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

/// A closed range of numbers.
type Interval = [f64; 2];

fn within(range: Interval, number: f64) -> bool {
    range[0] <= number && number <= range[1]
}

/// Parses a number, with or without the sign of degrees.
fn number(text: &str) -> Option<f64> {
    text.trim_end_matches('°').parse().ok()
}

/// Parses a range: `≥ 1`, `≤ 1`, `1 to 2`, `1` or `any`.
///
/// Degrees may have their sign.
fn interval(text: &str) -> Option<Interval> {
    if text == "any" {
        Some([f64::NEG_INFINITY, f64::INFINITY])
    } else if let Some(low) = text.strip_prefix("≥ ") {
        Some([number(low)?, f64::INFINITY])
    } else if let Some(high) = text.strip_prefix("≤ ") {
        Some([f64::NEG_INFINITY, number(high)?])
    } else {
        let (low, high) = text.split_once(" to ").unwrap_or((text, text));
        Some([number(low)?, number(high)?])
    }
}

/// The ranges of a number for reproduction in full and in part.
///
/// The second range contains the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    in_full: Interval,
    in_part: Interval,
}

impl Limits {
    /// Parses limits such as `≥ 100; in part ≥ 75`.
    ///
    /// With a single range, a number is reproduced or not, but never in part.
    pub(crate) fn read(text: &str) -> Option<Self> {
        let (in_full, in_part) = text.split_once("; in part ").unwrap_or((text, text));
        Some(Self { in_full: interval(in_full)?, in_part: interval(in_part)? })
    }

    pub(crate) fn verdict(&self, number: f64) -> Verdict {
        Verdict::graded(within(self.in_full, number), within(self.in_part, number))
    }
}

/// Ranges of gap, length and slant of a design.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DesignRange([Interval; 3]);

impl DesignRange {
    /// Parses ranges such as `(0.1 to 0.3, any, 45°)`.
    fn read(text: &str) -> Option<Self> {
        let ranges = text.strip_prefix('(')?.strip_suffix(')')?.split(", ").map(interval);
        let ranges: Vec<_> = ranges.collect::<Option<_>>()?;
        Some(Self(ranges.try_into().ok()?))
    }

    fn contains(&self, design: &MeasuredDesign) -> bool {
        let values = [design.gap, design.length, design.slant];
        self.0.iter().zip(values).all(|(range, value)| within(*range, value))
    }
}

/// The ranges in which the best designs must lie for reproduction in full and in part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Optimum {
    /// Ranges of the designs with the printed numbers.
    printed: DesignRange,
    /// Ranges of the designs that agree with the printed words, such as small or large.
    described: DesignRange,
}

impl Optimum {
    /// Parses the printed designs and the designs that count in part.
    ///
    /// The format is `(0.1, 0.1, 75°); in part (0.1 to 0.3, any, 60° to 75°) or among equals`.
    ///
    /// Without ranges after `in part`, the printed designs are used for both.
    pub(crate) fn read(text: &str) -> Option<Self> {
        // Best designs may always be equal, so limits without `among equals` are invalid.
        let (printed, in_part) = text.split_once("; in part ")?;
        let described = in_part.strip_suffix(" or among equals").unwrap_or(printed);
        let [printed, described] = [printed, described].map(DesignRange::read);
        Some(Self { printed: printed?, described: described? })
    }

    /// Returns the verdict on the best designs; several best designs have equal values.
    ///
    /// If only some of the best designs are printed designs, the claim is reproduced in part.
    pub(crate) fn verdict(&self, best: &[MeasuredDesign]) -> Verdict {
        let all =
            |region: &DesignRange| !best.is_empty() && best.iter().all(|d| region.contains(d));
        let among = best.iter().any(|design| self.printed.contains(design));
        Verdict::graded(all(&self.printed), among || all(&self.described))
    }
}
