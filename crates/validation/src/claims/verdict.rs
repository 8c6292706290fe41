//! Verdicts, and the limits that they follow from.

use std::fmt;

use super::brief;
use crate::study::MeasuredDesign;

/// The verdict on a claim of the paper, or on one of its statements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The claim holds.
    Reproduced,
    /// The claim holds in part.
    InPart,
    /// The claim does not hold.
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

    /// Returns the verdict on a claim from those on its statements: reproduced if all are, not reproduced if none is, not even
    /// in part.
    pub(crate) fn of_all(statements: &[Self]) -> Self {
        let all = |verdict| statements.iter().all(|found| *found == verdict);
        Self::graded(all(Self::Reproduced), !all(Self::NotReproduced))
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
pub(crate) type Interval = [f64; 2];

fn within(range: Interval, number: f64) -> bool {
    range[0] <= number && number <= range[1]
}

/// The range in which a number must lie for a statement to be reproduced, and the wider one in which it is reproduced
/// in part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    holds: Interval,
    in_part: Interval,
}

impl Limits {
    /// The limits of a trend along lines, in percent of their steps.
    pub(crate) const TREND: Self = Self::at_least(100.0, 75.0);
    /// The limits of a trend that holds "in general".
    pub(crate) const IN_GENERAL: Self = Self::at_least(90.0, 75.0);
    /// The limits of a ratio if there is "no significant effect".
    pub(crate) const NO_EFFECT: Self = Self::at_most(1.1, 1.3);
    /// The limits of a ratio if there is "little effect".
    pub(crate) const LITTLE: Self = Self::at_most(1.5, 2.0);
    /// The limits of a ratio if things differ "much", or "significantly".
    pub(crate) const MUCH: Self = Self::at_least(2.0, 1.5);

    /// Returns the limits of a number that is printed, and positive: reproduced within a tenth of it, in part within three tenths.
    pub(crate) const fn printed(number: f64) -> Self {
        Self::between([0.9 * number, 1.1 * number], [0.7 * number, 1.3 * number])
    }

    pub(crate) const fn exactly(number: f64) -> Self {
        Self::between([number; 2], [number; 2])
    }

    pub(crate) const fn between(holds: Interval, in_part: Interval) -> Self {
        Self { holds, in_part }
    }

    pub(crate) const fn at_least(holds: f64, in_part: f64) -> Self {
        Self::between([holds, f64::INFINITY], [in_part, f64::INFINITY])
    }

    pub(crate) const fn at_most(holds: f64, in_part: f64) -> Self {
        Self::between([f64::NEG_INFINITY, holds], [f64::NEG_INFINITY, in_part])
    }

    pub(crate) fn verdict(&self, number: f64) -> Verdict {
        Verdict::graded(within(self.holds, number), within(self.in_part, number))
    }
}

impl fmt::Display for Limits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", in_words(self.holds, brief))?;
        if self.in_part == self.holds {
            return Ok(());
        }
        write!(f, "; in part {}", in_words(self.in_part, brief))
    }
}

/// Writes a range in words.
fn in_words(range: Interval, number: fn(f64) -> String) -> String {
    match range {
        [low, high] if low == high => number(low),
        [f64::NEG_INFINITY, f64::INFINITY] => "any".to_owned(),
        [f64::NEG_INFINITY, high] => format!("≤ {}", number(high)),
        [low, f64::INFINITY] => format!("≥ {}", number(low)),
        [low, high] => format!("{} to {}", number(low), number(high)),
    }
}

/// Ranges of the parameters of a design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DesignRange {
    pub(crate) gap: Interval,
    pub(crate) length: Interval,
    pub(crate) slant: Interval,
}

impl DesignRange {
    /// Every design.
    pub(crate) const ANY: Self = {
        let any = [f64::NEG_INFINITY, f64::INFINITY];
        Self { gap: any, length: any, slant: any }
    };

    /// A single design.
    pub(crate) const fn design(gap: f64, length: f64, slant: f64) -> Self {
        Self { gap: [gap; 2], length: [length; 2], slant: [slant; 2] }
    }

    pub(crate) fn contains(&self, design: &MeasuredDesign) -> bool {
        within(self.gap, design.gap)
            && within(self.length, design.length)
            && within(self.slant, design.slant)
    }
}

impl fmt::Display for DesignRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plain = |number: f64| number.to_string();
        let degrees = |number: f64| format!("{number}°");
        let [gap, length] = [self.gap, self.length].map(|range| in_words(range, plain));
        write!(f, "({gap}, {length}, {})", in_words(self.slant, degrees))
    }
}

/// The designs that must be best for a statement to be reproduced, and for it to be reproduced in part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Optimum {
    /// The designs with the printed numbers.
    pub(crate) printed: DesignRange,
    /// The designs that fit the printed words.
    pub(crate) words: DesignRange,
}

impl Optimum {
    /// Returns the optimum of a statement that has numbers or words alone.
    pub(crate) const fn at(printed: DesignRange) -> Self {
        Self { printed, words: printed }
    }

    /// Returns the verdict on the best designs, of which there are several if they are equal: one among equals is not the best.
    pub(crate) fn verdict(&self, best: &[MeasuredDesign]) -> Verdict {
        let all =
            |region: &DesignRange| !best.is_empty() && best.iter().all(|d| region.contains(d));
        let among = best.iter().any(|design| self.printed.contains(design));
        Verdict::graded(all(&self.printed), among || all(&self.words))
    }
}

impl fmt::Display for Optimum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.printed)?;
        if self.words == self.printed {
            return f.write_str("; in part among equals");
        }
        write!(f, "; in part {} or among equals", self.words)
    }
}
