//! The columns of `sensitivity.csv`.

use super::column::Column;
use crate::columns;
use crate::design::row::DerivativeRow;

/// The columns of `sensitivity.csv`.
pub static DERIVATIVE_COLUMNS: &[Column<DerivativeRow>] = &columns! { DerivativeRow:
    "design", "-", |r| r.design.to_string(), "position of the design in the grid of its sweep";
    "measure", "-", |r| r.derivative.measure, "column name of the measure";
    "parameter", "-", |r| r.derivative.parameter, "key of the parameter";
    "value", "as the measure", |r| r.derivative.value, "value of the measure";
    "derivative", "as the measure per parameter", |r| r.derivative.derivative(),
        "derivative of the measure with respect to the parameter, empty at a kink";
    "elasticity", "-", |r| r.derivative.elasticity(),
        "relative change of the measure for a relative change of the parameter, empty at a kink";
    "left", "as the measure per parameter", |r| r.derivative.at_kink(r.derivative.left),
        "at a kink, the derivative where the parameter decreases";
    "right", "as the measure per parameter", |r| r.derivative.at_kink(r.derivative.right),
        "at a kink, the derivative where the parameter increases";
    "kink", "-", |r| r.derivative.kink.clone(), "event that causes the kink";
};
