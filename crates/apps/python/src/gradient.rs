//! Derivatives of measures, and of columns that are computed from measures.

use std::collections::BTreeSet;

use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use results::columns::{design_columns, measure_name, measure_of, name};
use results::{Column, DesignRow, SlopeSide};
use sweep::{Measure, Parameter, Role};

use crate::error;
use crate::skin::{RequestedMeasures, Skin, evaluator, unknown};
use crate::solved::reason;

/// Relative step of finite differences along linearly extrapolated rows, which have no noise.
const STEP: f64 = 1e-6;

/// Left and right derivative, and the event at a kink.
type Slopes = (Option<f64>, Option<f64>, Option<String>);

/// The value of a measure and its derivatives with respect to every key.
type Gradient = (f64, Vec<Slopes>);

/// Returns values and derivatives of `measures` with respect to `keys`, and the force at a fold.
///
/// The force at the first fold is `None` if nothing folds, or if no measure depends on the path
/// beyond the fold.
#[pyfunction]
pub fn gradients(
    skin: &Bound<'_, Skin>,
    measures: Vec<String>,
    keys: Vec<String>,
) -> PyResult<(Vec<Gradient>, Option<f64>)> {
    let (py, of) = (skin.py(), skin.get());
    let by = keys.iter().map(|key| parameter(skin, key)).collect::<PyResult<Vec<_>>>()?;
    let columns = design_columns(&of.sweep);
    let column = |name: &String| {
        let found = columns.iter().find(|column| column.name == *name);
        found.ok_or_else(|| PyKeyError::new_err(format!("there is no measure {name}")))
    };
    let requested = measures.iter().map(column).collect::<PyResult<Vec<_>>>()?;
    // Solve only the measures that the columns need.
    let needed = requested.iter().map(|c| measure_of(&c.name).unwrap_or(Measure::Coverage));
    let needed: BTreeSet<_> = needed.chain([Measure::Sensitivity]).collect();
    let needed = RequestedMeasures { measures: Vec::from_iter(needed), columns: measures };
    let (evaluator, number) = (evaluator(needed), of.sweep.grid().number(0));
    let row = py.detach(|| evaluator.row(number, &of.case()));
    let fold = columns.iter().find(|c| {
        c.name == name::FOLD_FORCE
            && requested.iter().any(|column| {
                let source = measure_name(&column.name);
                measure_of(source) == Some(Measure::Puncture)
                    && ![name::FOLD_FORCE, name::SOUND_FORCE].contains(&source)
            })
    });
    let fold = fold.and_then(|column| column.cell(&row).number());
    let gradients = requested.into_iter().map(|column| gradient(py, column, &row, &by));
    Ok((gradients.collect::<PyResult<_>>()?, fold))
}

/// Returns the parameter `key`; raises an exception unless it is continuous.
fn parameter(skin: &Bound<'_, Skin>, key: &str) -> PyResult<&'static Parameter> {
    let (py, case) = (skin.py(), skin.get().case());
    let parameter = Parameter::named(key).ok_or_else(|| unknown(py, key))?;
    // Lengths in mm and moduli do not have the role `Continuous`, but they act continuously.
    let is_smooth = parameter.has(Role::Continuous) || parameter.has(Role::Toleranced);
    if !is_smooth || parameter.size(&case).is_none() {
        let expected = "a parameter that is given as a number and changes continuously";
        return Err(error::invalid_parameter(py, key, None, expected));
    }
    Ok(parameter)
}

/// Returns the value of a column and its derivatives.
fn gradient(
    py: Python<'_>,
    column: &Column<DesignRow>,
    row: &DesignRow,
    by: &[&'static Parameter],
) -> PyResult<Gradient> {
    let Some(value) = column.cell(row).number() else {
        let reason = reason(row, &column.name).unwrap_or("the skin has no such value");
        return Err(error::failed(&column.name, reason));
    };
    let source = measure_name(&column.name);
    let differentiated = row.result.sensitivity.iter().any(|d| d.measure == source);
    if !differentiated && measure_of(source).is_some() {
        let expected = "a measure that has derivatives";
        return Err(error::invalid_parameter(py, &column.name, None, expected));
    }
    Ok((value, by.iter().map(|parameter| slopes(column, row, parameter)).collect()))
}

/// Returns the derivatives of a column with respect to a parameter.
fn slopes(column: &Column<DesignRow>, row: &DesignRow, parameter: &Parameter) -> Slopes {
    let source = measure_name(&column.name);
    let mut known = row.result.sensitivity.iter();
    // Sensitivities are stored for lengths divided by the thickness.
    let of = parameter.over_t().unwrap_or(parameter);
    let known = known.find(|d| d.measure == source && d.parameter == of.key);
    let kink = known.and_then(|derivative| derivative.kink.clone());
    if column.name == source && measure_of(source).is_some() && !parameter.is_in_mm() {
        // A missing entry means that the measure does not depend on the parameter.
        return known.map_or((Some(0.0), Some(0.0), None), |d| (d.left, d.right, kink));
    }
    let on = |side| {
        let step = STEP * parameter.size(&row.case)?;
        let at = |by| column.cell(&row.extrapolated_by(parameter, by, side)?).number();
        Some((at(step)? - at(-step)?) / (2.0 * step))
    };
    // Without a kink, both sides agree up to round-off.
    let left = on(SlopeSide::Left);
    (left, if kink.is_some() { on(SlopeSide::Right) } else { left }, kink)
}
