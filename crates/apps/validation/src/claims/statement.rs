//! The statements of a claim, and their checks.

use anyhow::Context as _;
use serde::Deserialize;

use super::evidence::Evidence;
use super::measurements::{Measurement, measurement};
use super::verdict::{Limits, Optimum, Verdict};

/// A statement of a claim, as in the table.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Statement {
    /// The number of the claim, with a letter if it has several statements.
    pub(crate) id: String,
    /// Text of the statement; empty if the statement is the claim itself.
    #[serde(rename = "says")]
    pub(crate) text: String,
    /// The measured quantity.
    pub(crate) measured: String,
    /// The limits for reproduction in full and in part.
    pub(crate) limits: String,
}

/// The verdict on a statement, with the result that decides it.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The verdict.
    pub verdict: Verdict,
    /// The result (a number or designs) as text.
    pub ours: String,
}

impl Statement {
    /// Checks the statement. A missing value counts as not reproduced.
    ///
    /// # Errors
    /// If the statement has no measurement, or its limits cannot be parsed.
    pub(crate) fn find(&self, evidence: &Evidence) -> anyhow::Result<Finding> {
        let unchecked = || format!("claim {} has no check", self.id);
        // A statement without a measurement or with invalid limits is an error in the table.
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
