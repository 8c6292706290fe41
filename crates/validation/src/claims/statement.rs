//! The statements of a claim, and their checks.

use super::digits;
use super::evidence::{BestDesigns, Evidence};
use super::statistics::TrendSteps;
use super::verdict::{Limits, Optimum, Verdict};

/// A single statement of a claim.
#[derive(Clone, Copy)]
pub(crate) struct Statement {
    /// The statement in words; empty if the claim says just that.
    pub(crate) says: &'static str,
    /// The measured quantity.
    pub(crate) measured: &'static str,
    pub(crate) check: StatementCheck,
}

/// The check of a statement: `None` where there is nothing to measure.
#[derive(Clone, Copy)]
pub(crate) enum StatementCheck {
    /// A number must keep its limits.
    Number(fn(&Evidence) -> Option<Measured>, Limits),
    /// The designs of which something is largest must be those of the paper.
    Best(fn(&Evidence) -> Option<BestDesigns>, Optimum),
}

/// A number that was measured, with its text on the page.
pub(crate) struct Measured {
    pub(crate) value: f64,
    pub(crate) shown: String,
}

impl Measured {
    /// Returns the steps that go the right way, in percent.
    pub(crate) fn steps(steps: TrendSteps) -> Option<Self> {
        let value = steps.percent()?;
        Some(Self { value, shown: format!("{} %: {steps}", digits(value)) })
    }
}

impl From<f64> for Measured {
    fn from(value: f64) -> Self {
        Self { value, shown: digits(value) }
    }
}

/// The verdict on a statement, and the result that it rests on.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The verdict.
    pub verdict: Verdict,
    /// The number or the designs that were found, as text.
    pub ours: String,
}

impl Statement {
    pub(crate) const fn number(
        says: &'static str,
        measured: &'static str,
        measure: fn(&Evidence) -> Option<Measured>,
        limits: Limits,
    ) -> Self {
        Self { says, measured, check: StatementCheck::Number(measure, limits) }
    }

    pub(crate) const fn best(
        says: &'static str,
        measured: &'static str,
        find: fn(&Evidence) -> Option<BestDesigns>,
        optimum: Optimum,
    ) -> Self {
        Self { says, measured, check: StatementCheck::Best(find, optimum) }
    }

    /// Returns the limits, as the page prints them.
    pub(crate) fn limits(&self) -> String {
        match &self.check {
            StatementCheck::Number(_, limits) => limits.to_string(),
            StatementCheck::Best(_, optimum) => optimum.to_string(),
        }
    }

    /// Judges the statement. A statement about a value that does not exist does not hold.
    pub(crate) fn find(&self, evidence: &Evidence) -> Finding {
        let found = match &self.check {
            StatementCheck::Number(measure, limits) => measure(evidence)
                .map(|found| Finding { verdict: limits.verdict(found.value), ours: found.shown }),
            StatementCheck::Best(find, optimum) => find(evidence).map(|best| Finding {
                verdict: optimum.verdict(&best.designs),
                ours: best.to_string(),
            }),
        };
        let nothing = || Finding { verdict: Verdict::NotReproduced, ours: "none".to_owned() };
        found.unwrap_or_else(nothing)
    }
}
