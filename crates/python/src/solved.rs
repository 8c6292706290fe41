//! A solved skin, of which Python takes what it asks for.

use std::sync::OnceLock;

use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use results::columns::{
    BentScale, EVENTS, FLEXURE_EVENTS, FLEXURE_PATH, FLEXURE_SCALES, FOLD_FORCE, GUIDED_PATH, PATH,
    PunctureEvent, SCALES, SOUND_FORCE, design_columns, measure_of,
};
use results::{Column, DERIVATIVE_COLUMNS, DesignRow, SolvedDesign};
use sweep::nearest;

use crate::error;
use crate::skin::Skin;
use crate::value::{Array, arrays, cell};

/// A solved skin with its paths.
#[pyclass(frozen, module = "squama._squama")]
pub struct Solved {
    skin: Py<Skin>,
    design: SolvedDesign,
    columns: OnceLock<Vec<Column<DesignRow>>>,
}

/// The exception for a column that a table does not have.
pub fn no_column<R>(columns: &[Column<R>], name: &str) -> PyErr {
    let known: Vec<&str> = columns.iter().map(|column| column.name.as_ref()).collect();
    let hint = nearest(name, &known).map(|near| format!("; did you mean {near}?"));
    PyKeyError::new_err(format!("there is no {name}{}", hint.unwrap_or_default()))
}

impl Solved {
    /// What solving `skin` gave.
    pub fn new(skin: Py<Skin>, design: SolvedDesign) -> Self {
        Self { skin, design, columns: OnceLock::new() }
    }

    fn columns(&self) -> &[Column<DesignRow>] {
        self.columns.get_or_init(|| design_columns(&self.skin.get().sweep))
    }
}

#[pymethods]
impl Solved {
    /// A value of `designs.csv`; NaN if the skin has none, and `Failed` if it could not be measured.
    fn value<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let columns = self.columns();
        let column = columns.iter().find(|column| column.name == name);
        let column = column.ok_or_else(|| no_column(columns, name))?;
        let value = cell(py, column.cell(&self.design.row))?;
        if !value.is_none() {
            return Ok(value);
        }
        let mut failures = self.design.row.result.failures.iter();
        match failures.find(|failure| Some(failure.measure) == measure_of(name)) {
            Some(failure) => Err(error::failed(py, name, failure.outcome.text())),
            None => Ok(f64::NAN.into_pyobject(py)?.into_any()),
        }
    }

    /// Every value: name, unit, meaning and the value, `None` if there is none.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Vec<Array<'py>>> {
        let value = |column: &Column<DesignRow>| {
            let value = cell(py, column.cell(&self.design.row))?;
            Ok((column.name.to_string(), column.unit, column.meaning, value))
        };
        self.columns().iter().skip(1).map(value).collect()
    }

    /// A table of the paths, by its name without `.csv`; one without columns of what was not solved.
    fn table<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Vec<Array<'py>>> {
        let SolvedDesign { row, puncture, flexure } = &self.design;
        if name == "sensitivity" {
            let rows: Vec<_> = row.derivatives().collect();
            return arrays(py, &DERIVATIVE_COLUMNS[1..], &rows);
        }
        if let Some(puncture) = puncture {
            match name {
                "path" => {
                    let points = puncture.path.iter().copied();
                    let points: Vec<_> = points.zip(puncture.instability.iter().copied()).collect();
                    let is_free = puncture.measures.passage.is_none();
                    return arrays(py, if is_free { PATH } else { GUIDED_PATH }, &points);
                }
                "events" => return arrays(py, EVENTS, &PunctureEvent::all(puncture)),
                "scales" => return arrays(py, SCALES, &puncture.scales),
                _ => {}
            }
        }
        if let Some(flexure) = flexure {
            match name {
                "flexure_path" => return arrays(py, FLEXURE_PATH, &flexure.path),
                "flexure_events" => return arrays(py, FLEXURE_EVENTS, &flexure.events),
                "flexure_scales" => {
                    let last = flexure.path.len().saturating_sub(1);
                    let shape = flexure.shape(last).unwrap_or_default();
                    let shape: Vec<BentScale> = shape.into_iter().enumerate().collect();
                    return arrays(py, FLEXURE_SCALES, &shape);
                }
                _ => {}
            }
        }
        Ok(Vec::new())
    }

    /// Complete, or the reason of the first measure that has no value.
    fn status(&self) -> &'static str {
        self.design.row.result.failures.first().map_or("complete", |failure| failure.outcome.text())
    }

    /// What a person should know before using the values.
    fn warnings(&self) -> Vec<String> {
        let DesignRow { result, .. } = &self.design.row;
        let failed = result
            .failures
            .iter()
            .map(|failure| format!("{}: {}", failure.measure.key(), failure.outcome.meaning()));
        let fold = result.puncture.and_then(|puncture| puncture.measures.fold_force);
        let folded = fold.map(|force| {
            format!("the surface folds over at {FOLD_FORCE} {force}: beyond it the model does not hold, {SOUND_FORCE} is up to there")
        });
        failed.chain(folded).collect()
    }
}
