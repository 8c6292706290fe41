//! The statements of a claim, and their checks.

use anyhow::Context as _;
use serde::Deserialize;

use super::digits;
use super::evidence::{BestDesigns, Evidence};
use super::measurements::measurement;
use super::statistics::TrendSteps;
use super::verdict::{Limits, Optimum, Verdict};

/// A single statement of a claim, as the table has it.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Statement {
    /// The number of the claim, with a letter if it has several statements.
    pub(crate) id: String,
    /// The statement in words; empty if the claim says just that.
    pub(crate) says: String,
    /// The measured quantity.
    pub(crate) measured: String,
    /// The limits that it must keep to be reproduced, and to be reproduced in part.
    pub(crate) limits: String,
}

/// How a statement is measured: `None` where there is nothing to measure.
#[derive(Clone, Copy)]
pub(crate) enum Measurement {
    /// A number must keep its limits.
    Number(fn(&Evidence) -> Option<Measured>),
    /// The designs of which something is largest must be those of the paper.
    Best(fn(&Evidence) -> Option<BestDesigns>),
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
    /// Judges the statement. A statement about a value that does not exist does not hold.
    ///
    /// # Errors
    /// If nothing is measured for the statement, or its limits cannot be read.
    pub(crate) fn find(&self, evidence: &Evidence) -> anyhow::Result<Finding> {
        let unchecked = || format!("claim {} has no check", self.id);
        // A statement without a measurement, or with limits that cannot be read, is a mistake in the table.
        let found = match measurement(&self.id).with_context(unchecked)? {
            Measurement::Number(measure) => {
                let limits = Limits::read(&self.limits).with_context(unchecked)?;
                measure(evidence).map(|found| (limits.verdict(found.value), found.shown))
            }
            Measurement::Best(find) => {
                let optimum = Optimum::read(&self.limits).with_context(unchecked)?;
                find(evidence).map(|best| (optimum.verdict(&best.designs), best.to_string()))
            }
        };
        let (verdict, ours) = found.unwrap_or_else(|| (Verdict::NotReproduced, "none".to_owned()));
        Ok(Finding { verdict, ours })
    }
}
