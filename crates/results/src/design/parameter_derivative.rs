//! The derivative of a measure with respect to a parameter, as it is kept and written.

use serde::{Deserialize, Serialize};
use skin::Derivative;

use super::design_result::{DesignRow, finite};
use crate::columns::Column;

/// The derivative of a measure of a design with respect to a parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterDerivative {
    /// Name of the measure, as its column.
    pub measure: String,
    /// Key of the parameter.
    pub parameter: String,
    /// Value of the parameter.
    pub at: f64,
    /// Value of the measure.
    pub value: f64,
    /// Derivative where the parameter decreases.
    pub left: Option<f64>,
    /// Derivative where the parameter increases.
    pub right: Option<f64>,
    /// The change at a kink; `None` where both derivatives are the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kink: Option<String>,
}

impl ParameterDerivative {
    /// The derivative with respect to the parameter `key` where it has the value `at`.
    pub fn new(key: &str, at: f64, derivative: Derivative) -> Self {
        let Derivative { measure, value, left, right, kink, .. } = derivative;
        Self {
            measure: measure.to_owned(),
            parameter: key.to_owned(),
            at,
            value,
            left: left.and_then(finite),
            right: right.and_then(finite),
            kink,
        }
    }

    /// The derivative; `None` at a kink.
    pub fn derivative(&self) -> Option<f64> {
        if self.kink.is_none() { self.left } else { None }
    }

    /// The elasticity `d ln m / d ln q`; `None` at a kink, and where the measure is zero.
    pub fn elasticity(&self) -> Option<f64> {
        finite(self.derivative()? * self.at / self.value)
    }

    /// A one-sided derivative, at a kink.
    fn at_kink(&self, side: Option<f64>) -> Option<f64> {
        side.filter(|_| self.kink.is_some())
    }
}

/// A row of `sensitivity.csv`: a design and one of its derivatives.
#[derive(Clone, Debug)]
pub struct DerivativeRow {
    /// Number of the design.
    pub design: String,
    /// The derivative.
    pub derivative: ParameterDerivative,
}

impl DesignRow {
    /// The rows of `sensitivity.csv` that the design has.
    pub fn derivatives(&self) -> impl Iterator<Item = DerivativeRow> {
        let row = |derivative: &ParameterDerivative| DerivativeRow {
            design: self.number.to_string(),
            derivative: derivative.clone(),
        };
        self.result.sensitivity.iter().map(row)
    }
}

/// The columns of `sensitivity.csv`.
pub static DERIVATIVE_COLUMNS: &[Column<DerivativeRow>] = &[
    Column::new("design", "-", "position of the design in the grid of its sweep", |r| {
        r.design.clone().into()
    }),
    Column::new("measure", "-", "the measure, by the name of its column", |r| {
        r.derivative.measure.clone().into()
    }),
    Column::new("parameter", "-", "the parameter, by its key", |r| {
        r.derivative.parameter.clone().into()
    }),
    Column::new("value", "as the measure", "value of the measure", |r| r.derivative.value.into()),
    Column::new(
        "derivative",
        "as the measure per parameter",
        "derivative of the measure with respect to the parameter, empty at a kink",
        |r| r.derivative.derivative().into(),
    ),
    Column::new(
        "elasticity",
        "-",
        "relative change of the measure for a relative change of the parameter, empty at a kink",
        |r| r.derivative.elasticity().into(),
    ),
    Column::new(
        "left",
        "as the measure per parameter",
        "at a kink, the derivative where the parameter decreases",
        |r| r.derivative.at_kink(r.derivative.left).into(),
    ),
    Column::new(
        "right",
        "as the measure per parameter",
        "at a kink, the derivative where the parameter increases",
        |r| r.derivative.at_kink(r.derivative.right).into(),
    ),
    Column::new("kink", "-", "the change at a kink of the measure", |r| {
        r.derivative.kink.clone().into()
    }),
];
