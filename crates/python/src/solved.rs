//! A solved skin, of which Python takes what it asks for.

use pyo3::prelude::*;
use results::columns::{
    BentScale, EVENTS, FLEXURE_EVENTS, FLEXURE_SCALES, PunctureEvent, SCALES, design_columns,
    flexure_path_columns, measure_of, path_columns,
};
use results::{Column, DERIVATIVE_COLUMNS, DesignRow, SolvedDesign};

use crate::skin::Skin;
use crate::value::{NamedCells, PythonCell, table};

/// Name, unit, meaning, the value, and the reason why there is none.
type Value = (String, &'static str, &'static str, PythonCell, Option<&'static str>);

/// A solved skin with its paths.
#[pyclass(frozen, module = "squama._squama")]
pub struct Solved {
    pub skin: Py<Skin>,
    pub design: SolvedDesign,
}

/// The reason why what a column is about could not be found.
pub fn reason(row: &DesignRow, column: &str) -> Option<&'static str> {
    let mut failures = row.result.failures.iter();
    let failure = failures.find(|failure| Some(failure.measure) == measure_of(column));
    failure.map(|failure| failure.outcome.text())
}

#[pymethods]
impl Solved {
    /// Every value of `designs.csv`.
    fn values(&self) -> Vec<Value> {
        let row = &self.design.row;
        let value = |column: &Column<DesignRow>| {
            let (name, cell) = (column.name.to_string(), column.cell(row).into());
            (name, column.unit, column.meaning, cell, reason(row, &column.name))
        };
        design_columns(&self.skin.get().sweep).iter().skip(1).map(value).collect()
    }

    /// A table of the paths, by its name without `.csv`; one without columns of what was not solved.
    fn table(&self, name: &str) -> Vec<NamedCells> {
        let SolvedDesign { row, puncture, flexure } = &self.design;
        if name == "sensitivity" {
            let rows: Vec<_> = row.derivatives().collect();
            return table(&DERIVATIVE_COLUMNS[1..], &rows);
        }
        if let Some(puncture) = puncture {
            match name {
                "path" => {
                    let points = puncture.path.iter().copied();
                    let points: Vec<_> = points.zip(puncture.instability.iter().copied()).collect();
                    let is_guided = !puncture.measures.passage.is_none();
                    return table(&path_columns(is_guided, puncture.rubs()), &points);
                }
                "events" => return table(EVENTS, &PunctureEvent::all(puncture)),
                "scales" => return table(SCALES, &puncture.scales),
                _ => {}
            }
        }
        if let Some(flexure) = flexure {
            match name {
                "flexure_path" => {
                    return table(&flexure_path_columns(flexure.rubs()), &flexure.path);
                }
                "flexure_events" => return table(FLEXURE_EVENTS, &flexure.events),
                "flexure_scales" => {
                    let last = flexure.path.len().saturating_sub(1);
                    let shape = flexure.shape(last).unwrap_or_default();
                    let shape: Vec<BentScale> = shape.into_iter().enumerate().collect();
                    return table(FLEXURE_SCALES, &shape);
                }
                _ => {}
            }
        }
        Vec::new()
    }

    /// What failed: the measure, the reason, and what that means.
    fn failures(&self) -> Vec<(&'static str, &'static str, &'static str)> {
        let failures = self.design.row.result.failures.iter();
        failures.map(|of| (of.measure.key(), of.outcome.text(), of.outcome.meaning())).collect()
    }
}
