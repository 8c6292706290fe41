//! The columns of `sensitivity.csv`.

use super::column::Column;
use crate::design::row::DerivativeRow;

/// The columns of `sensitivity.csv`.
pub static DERIVATIVE_COLUMNS: &[Column<DerivativeRow>] = &[
    Column::new("design", "-", "position of the design in the grid of its sweep", |r| {
        r.design.to_string().into()
    }),
    Column::new("measure", "-", "the measure, by the name of its column", |r| {
        r.derivative.measure.into()
    }),
    Column::new("parameter", "-", "the parameter, by its key", |r| r.derivative.parameter.into()),
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
