//! A number measured for a statement.

use super::digits;
use super::statistics::TrendSteps;

/// A number measured for a statement, with its text for the page.
pub(crate) struct Measured {
    pub(crate) value: f64,
    pub(crate) shown: String,
}

impl Measured {
    /// Returns the percentage of steps in the expected direction.
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
