//! Numeric columns of the designs of a sweep.

use results::columns::design_columns;
use results::{Cell, Column, DesignRow};
use sweep::{Measure, Sweep};
use text::nearest;

/// Error: the required column does not exist, or contains no numbers.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no numeric column {found}, {hint}")]
pub struct NoSuchColumn {
    /// Column name in the requirement.
    pub found: String,
    /// Suggestion for the user: a similar column name, or the columns that exist.
    pub hint: String,
}

/// Numeric columns of the designs of a sweep.
pub(crate) struct MeasuredColumns(Vec<Column<DesignRow>>);

impl MeasuredColumns {
    /// Returns the columns of `sweep`, except columns that contain text in `row`.
    pub(crate) fn of(sweep: &Sweep, row: &DesignRow) -> Self {
        let mut columns = design_columns(sweep);
        columns.retain(|column| !matches!(column.cell(row), Cell::Text(_)));
        Self(columns)
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Column<DesignRow>> {
        self.0.iter()
    }

    /// Returns the value of each column in `row`; `None` for an empty cell.
    pub(crate) fn values(&self, row: &DesignRow) -> Vec<Option<f64>> {
        self.0.iter().map(|column| column.cell(row).number()).collect()
    }

    /// Returns the index of the column `name`, which a requirement refers to.
    ///
    /// `row` is the nominal design, and `measures` are the requested measures.
    ///
    /// # Errors
    ///
    /// If no numeric column has this name, or if the column is empty because its measure is not
    /// requested.
    pub(crate) fn required(
        &self,
        name: &str,
        row: &DesignRow,
        measures: &[Measure],
    ) -> Result<usize, NoSuchColumn> {
        let index = self.0.iter().position(|column| column.name == name);
        let index = index.ok_or_else(|| self.no_such_column(name))?;
        let is_whole = Measure::USUAL.iter().all(|measure| measures.contains(measure));
        let has_value = self.0[index].cell(row).number().is_some();
        // A column is also empty if the design failed, although its requirement is valid.
        if has_value || is_whole || row.result.failed() {
            return Ok(index);
        }
        let asked: Vec<_> = measures.iter().map(|measure| measure.key()).collect();
        let hint = format!("expected a column of the measures {}", asked.join(", "));
        Err(NoSuchColumn { found: name.to_owned(), hint })
    }

    fn no_such_column(&self, found: &str) -> NoSuchColumn {
        let names: Vec<&str> = self.0.iter().map(|column| column.name.as_ref()).collect();
        let hint = match nearest(found, &names) {
            Some(near) => format!("did you mean {near}?"),
            None => "expected one of designs.csv, e.g. critical_force".to_owned(),
        };
        NoSuchColumn { found: found.to_owned(), hint }
    }
}
