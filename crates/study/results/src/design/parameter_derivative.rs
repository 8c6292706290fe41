//! The derivative of a measure with respect to a parameter, as stored and written.

use skin::Derivative;

use super::failure::finite;

/// Derivative of a measure of a design with respect to a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterDerivative {
    /// Column name of the measure.
    pub measure: &'static str,
    /// Key of the parameter.
    pub parameter: &'static str,
    /// Value of the parameter.
    pub at: f64,
    /// Value of the measure.
    pub value: f64,
    /// Left-sided derivative: for a decreasing parameter.
    pub left: Option<f64>,
    /// Right-sided derivative: for an increasing parameter.
    pub right: Option<f64>,
    /// Cause of a kink. `None` if both one-sided derivatives are equal.
    pub kink: Option<String>,
}

impl ParameterDerivative {
    /// Creates the derivative with respect to the parameter `key` at its value `at`.
    pub fn new(key: &'static str, at: f64, derivative: Derivative) -> Self {
        let Derivative { measure, value, left, right, kink, .. } = derivative;
        Self {
            measure,
            parameter: key,
            at,
            value,
            left: left.and_then(finite),
            right: right.and_then(finite),
            kink,
        }
    }

    /// Returns the derivative. `None` at a kink.
    pub fn derivative(&self) -> Option<f64> {
        if self.kink.is_none() { self.left } else { None }
    }

    /// Returns the elasticity `d ln m / d ln q` of the measure `m`, for the parameter `q`.
    ///
    /// `None` at a kink, or if the measure is zero.
    pub fn elasticity(&self) -> Option<f64> {
        finite(self.derivative()? * self.at / self.value)
    }

    /// Returns the one-sided derivative `side` at a kink, `None` elsewhere.
    pub(crate) fn at_kink(&self, side: Option<f64>) -> Option<f64> {
        side.filter(|_| self.kink.is_some())
    }
}
