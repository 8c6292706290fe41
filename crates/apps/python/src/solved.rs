//! A solved skin. Python requests its results on demand.

use std::collections::HashMap;

use pyo3::prelude::*;
use ranking::{Criterion, Relation};
use results::columns::{design_columns, measure_of, measures_among};
use results::{DesignRow, PathTable, SolvedDesign, path_tables};
use run::{GapChange, Patience, design_warnings};
use sweep::Sweep;

use crate::value::{NamedCells, PythonCell, requirements, table};

/// Name, unit, meaning, value, and the reason for a missing value.
type Value = (String, &'static str, &'static str, PythonCell, Option<&'static str>);

/// Requirement, value, limit and margin.
type Required = (String, Option<f64>, f64, Option<f64>);

/// A solved skin with its paths.
#[pyclass(frozen, module = "squama._squama")]
pub struct Solved {
    /// The sweep of the skin.
    pub sweep: Sweep,
    pub design: SolvedDesign,
}

/// Returns the reason why a column has no value; `None` if its measure did not fail.
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
        design_columns(&self.sweep)
            .iter()
            .skip(1)
            .map(|column| {
                let (name, cell) = (column.name.to_string(), column.cell(row).into());
                (name, column.unit, column.meaning, cell, reason(row, &column.name))
            })
            .collect()
    }

    /// Returns every warning about the design, as the commands print it.
    fn warnings(&self) -> Vec<String> {
        design_warnings(&self.sweep, &self.design.row, None, None)
    }

    /// Returns requirements with value, limit and margin, and every warning.
    ///
    /// Solves the design again with gaps 10 % smaller and larger, to warn of sensitive measures.
    fn answer(&self, require: Vec<String>) -> PyResult<(Vec<Required>, Vec<String>)> {
        let requirements = requirements(&require)?;
        let (sweep, row) = (&self.sweep, &self.design.row);
        let columns = design_columns(sweep);
        let mut rows = Vec::new();
        for requirement in &requirements {
            let column = columns.iter().find(|column| column.name == requirement.column);
            let value = column.and_then(|column| column.cell(row).number());
            let margin = value.map(|value| requirement.margin(value));
            rows.push((requirement.to_string(), value, requirement.limit, margin));
        }
        let radius = requirements.iter().find(|r| {
            r.column == "bend_radius_mm" && matches!(r.relation, Relation::AtMost | Relation::Below)
        });
        let criteria = Criterion::usual(Some(sweep));
        let names = criteria.iter().map(|criterion| criterion.column.as_ref());
        let names = measures_among(names.chain(requirements.iter().map(|r| r.column.as_str())));
        let number = sweep.grid().number(0).to_string();
        let change = GapChange::solve(sweep, &number, &names, Patience::Milliseconds);
        let radius = radius.map(|requirement| requirement.limit);
        Ok((rows, design_warnings(sweep, row, radius, change.as_ref())))
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
