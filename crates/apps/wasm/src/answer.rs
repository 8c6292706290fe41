//! The answer to a request.

pub(crate) mod definition;

use ranking::Requirement;
use results::columns::{Goal, design_columns, plain_goal};
use results::{Cell, Column, DesignRow, ParameterDerivative, Quantity};
use serde::Serialize;
use sweep::{Case, Sweep};

use crate::path::{BentStrip, PuncturedRow};

/// The answer to a request: a solved design.
#[derive(Clone, Debug, Serialize)]
pub struct Answer {
    /// The identifier of the request.
    pub id: u64,
    /// True for a complete answer, false for a fast answer while the user drags.
    pub fine: bool,
    /// The columns of `designs.csv` that have a value.
    pub values: Vec<Value>,
    /// The requirements of the request, in the same order, with their margins.
    pub requirements: Vec<Required>,
    /// Warnings about the validity of the results.
    pub warnings: Vec<String>,
    /// Physical units of the drawn quantities, as far as the material is known.
    pub units: Units,
    /// The puncture; `None` in a bare answer, or if the puncture could not be started.
    pub puncture: Option<PuncturedRow>,
    /// The bending; `None` in a bare answer, or if the bending could not be started.
    pub flexure: Option<BentStrip>,
    /// The derivatives of the measures, in a complete answer; empty if they take too long.
    pub slopes: Vec<Slope>,
    /// The nearest design on the grid of the sweep; `None` for a sweep of a single design.
    pub closest: Option<Closest>,
    /// Command-line options with which `squama design` solves this design.
    pub settings: Vec<String>,
    /// A definition of only this design, with its requirements in a comment.
    pub toml: String,
    /// The result of following a parameter, if requested.
    pub follow: Option<Followed>,
}

/// A column of the design.
#[derive(Clone, Debug, Serialize)]
pub struct Value {
    /// Name of the column.
    pub name: String,
    /// Unit, `-` if it has none.
    pub unit: &'static str,
    /// Meaning of the column, as a short phrase.
    pub meaning: &'static str,
    /// Number in the cell, if the cell is numeric.
    pub value: Option<f64>,
    /// Text of the cell, as in the tables.
    pub text: String,
}

/// A requirement and its status.
#[derive(Clone, Debug, Serialize)]
pub struct Required {
    /// The requirement, as in `coverage >= 0.6`.
    pub text: String,
    /// The value of its column, if there is one.
    pub value: Option<f64>,
    /// The margin relative to the limit, negative if the requirement is not met.
    ///
    /// `None` without a value.
    pub margin: Option<f64>,
    /// True if the value meets the requirement; false without a value.
    pub met: bool,
    /// True for the requirement with the smallest margin.
    pub limits: bool,
}

/// Physical values of a unit length, unit force and unit moment.
#[derive(Clone, Debug, Serialize)]
pub struct Units {
    /// Physical value of a dimensionless length of 1, mm.
    pub length: Option<f64>,
    /// Physical value of a dimensionless force of 1, N.
    pub force: Option<f64>,
    /// Physical value of a dimensionless moment of 1, N mm.
    pub moment: Option<f64>,
}

/// The direction in which a parameter improves a measure.
#[derive(Clone, Debug, Serialize)]
pub struct Slope {
    /// The column of the measure.
    pub measure: &'static str,
    /// The key of the parameter.
    pub parameter: &'static str,
    /// 1 if a larger parameter improves the measure, −1 if a smaller one does, 0 for neither.
    pub better: i8,
    /// Improvement of the measure in per cent for a change of the parameter by one per cent.
    pub gain: Option<f64>,
    /// The event at which the derivative jumps, if the design lies at a kink of the measure.
    pub kink: Option<String>,
}

/// The design on the grid of the sweep that is nearest to the solved design.
#[derive(Clone, Debug, Serialize)]
pub struct Closest {
    /// Number of the design.
    pub design: String,
    /// Values of the design on the axes, by key.
    pub values: Vec<(&'static str, f64)>,
}

/// The result of following a parameter: its last value, and the limit beyond this value.
#[derive(Clone, Debug, Serialize)]
pub struct Followed {
    /// The key of the parameter.
    pub key: String,
    /// The last value before the limit.
    pub value: f64,
    /// A short description of the limit, or of the end of the range.
    pub reason: String,
}

impl Value {
    /// Returns the columns of a design that have a value.
    pub(crate) fn all(sweep: &Sweep, row: &DesignRow) -> Vec<Self> {
        design_columns(sweep)
            .iter()
            .filter_map(|column| Self::new(column, &column.cell(row)))
            .collect()
    }

    /// Creates the value of a column; `None` for an empty cell.
    fn new(column: &Column<DesignRow>, cell: &Cell) -> Option<Self> {
        let (name, text) = (column.name.clone().into_owned(), cell.to_string());
        let value =
            Self { name, unit: column.unit, meaning: column.meaning, value: cell.number(), text };
        (*cell != Cell::Empty).then_some(value)
    }

    /// Returns the number in a column; `None` if it has no number.
    pub(crate) fn number(values: &[Self], column: &str) -> Option<f64> {
        values.iter().find(|value| value.name == column)?.value
    }
}

impl Required {
    pub(crate) fn all(requirements: &[Requirement], values: &[Value]) -> Vec<Self> {
        let margins =
            requirements.iter().map(|one| one.counted_margin(Value::number(values, &one.column)));
        let least = margins.clone().fold(f64::INFINITY, f64::min);
        requirements
            .iter()
            .zip(margins)
            .map(|(one, margin)| Self {
                text: one.to_string(),
                value: Value::number(values, &one.column),
                margin: Some(margin).filter(|margin| margin.is_finite()),
                met: margin >= 0.0,
                limits: margin <= least,
            })
            .collect()
    }
}

impl Units {
    pub(crate) fn of(case: &Case) -> Self {
        let [length, force, moment] = [Quantity::Length, Quantity::Force, Quantity::Moment]
            .map(|quantity| quantity.physical(1.0, case));
        Self { length, force, moment }
    }
}

impl Slope {
    pub(crate) fn new(derivative: &ParameterDerivative) -> Self {
        let ParameterDerivative { measure, parameter, at, value, left, right, ref kink } =
            *derivative;
        let good = if plain_goal(measure) == Some(Goal::Minimize) { -1.0 } else { 1.0 };
        let [smaller, larger] = [left.map(|slope| -good * slope), right.map(|slope| good * slope)];
        let gain = |side: Option<f64>| side.filter(|gain| *gain > 0.0).unwrap_or(0.0);
        // At a kink, both directions may improve the measure; report the steeper direction.
        let (better, side) = match (gain(smaller), gain(larger)) {
            (smaller, larger) if larger > smaller => (1, larger),
            (0.0, _) => (0, 0.0),
            (smaller, _) => (-1, smaller),
        };
        let gain = Some((side * at / value).abs()).filter(|gain| gain.is_finite());
        Self { measure, parameter, better, gain, kink: kink.clone() }
    }
}
