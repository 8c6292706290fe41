//! A solved skin; Python takes results on demand.

use std::collections::HashMap;

use pyo3::prelude::*;
use results::columns::{design_columns, measure_of};
use results::{Column, DesignRow, PathTable, SolvedDesign, path_tables};

use crate::skin::Skin;
use crate::value::{NamedCells, PythonCell, table};

/// Name, unit, meaning, value, and the reason for a missing value.
type Value = (String, &'static str, &'static str, PythonCell, Option<&'static str>);

/// A solved skin with its paths.
#[pyclass(frozen, module = "squama._squama")]
pub struct Solved {
    pub skin: Py<Skin>,
    pub design: SolvedDesign,
}

/// Returns the reason why a column has no value.
pub fn reason(row: &DesignRow, column: &str) -> Option<&'static str> {
    let mut failures = row.result.failures.iter();
    let failure = failures.find(|failure| Some(failure.measure) == measure_of(column));
    failure.map(|failure| failure.outcome.text())
}

#[pymethods]
impl Solved {
    /// Returns every value of `designs.csv`.
    fn values(&self) -> Vec<Value> {
        let row = &self.design.row;
        let value = |column: &Column<DesignRow>| {
            let (name, cell) = (column.name.to_string(), column.cell(row).into());
            (name, column.unit, column.meaning, cell, reason(row, &column.name))
        };
        design_columns(&self.skin.get().sweep).iter().skip(1).map(value).collect()
    }

    /// Returns the tables of the solved paths, by name.
    fn tables(&self) -> HashMap<&'static str, Vec<NamedCells>> {
        let named =
            |of: PathTable| (of.file.trim_end_matches(".csv"), table(&of.columns, 0..of.rows));
        path_tables(&self.design).into_iter().map(named).collect()
    }

    /// Returns the failures: measure, reason, and explanation.
    fn failures(&self) -> Vec<(&'static str, &'static str, &'static str)> {
        let failures = self.design.row.result.failures.iter();
        failures.map(|of| (of.measure.key(), of.outcome.text(), of.outcome.meaning())).collect()
    }
}
