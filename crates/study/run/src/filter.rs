//! Filters that select designs of a run by failure, number or value in `designs.csv`.

use std::str::FromStr;

use journal::JournalError;
use results::columns::design_columns;
use results::{Cell, Column, DesignRow};
use sweep::NoSuchDesign;
use text::{nearest, number};

use crate::run_journal::{Archive, JournalEntry};

/// Filter for the designs of a run; a design passes if it meets all conditions.
#[derive(Clone, Debug, Default)]
pub struct Filter {
    /// True to select only designs that lack a value.
    pub failed: bool,
    /// Selected design numbers, or ranges of numbers such as `1-12`; `None` selects all numbers.
    pub numbers: Option<Vec<String>>,
    /// Conditions on columns of `designs.csv`.
    pub columns: Vec<ColumnFilter>,
}

/// Condition that a column of `designs.csv` has a given value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColumnFilter {
    column: String,
    value: String,
}

/// Error for a text that is not of the form `COLUMN=VALUE`.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is not a condition, expected COLUMN=VALUE, e.g. slant_deg=75")]
pub struct InvalidColumnFilter(String);

/// Reason why a filter cannot be applied to a run.
#[derive(Debug, thiserror::Error)]
pub enum InvalidFilter {
    /// The grid has no design with this number.
    #[error("--design: {0}")]
    Number(NoSuchDesign),
    /// The design has a number but is not solved yet.
    #[error("--design {0}: the design is not solved yet; squama run --resume solves it")]
    NotDone(String),
    /// `designs.csv` has no column with this name.
    #[error("--where {column}: there is no such column in designs.csv, {suggestion}")]
    Column {
        /// Name in the condition.
        column: String,
        /// Advice: a similar name, or all names.
        suggestion: String,
    },
    /// The journal cannot be read.
    #[error(transparent)]
    Journal(#[from] JournalError),
}

impl FromStr for ColumnFilter {
    type Err = InvalidColumnFilter;

    fn from_str(text: &str) -> Result<Self, InvalidColumnFilter> {
        let invalid = || InvalidColumnFilter(text.to_owned());
        let (column, value) = text.split_once('=').ok_or_else(invalid)?;
        let (column, value) = (column.trim().to_owned(), value.trim().to_owned());
        if column.is_empty() { Err(invalid()) } else { Ok(Self { column, value }) }
    }
}

impl ColumnFilter {
    /// Returns the column of this condition among `columns`.
    fn find<'c>(
        &self,
        columns: &'c [Column<DesignRow>],
    ) -> Result<&'c Column<DesignRow>, InvalidFilter> {
        let found = columns.iter().find(|column| column.name == self.column);
        found.ok_or_else(|| {
            let known: Vec<_> = columns.iter().map(|column| column.name.as_ref()).collect();
            // If no name is similar, all names are listed.
            let suggestion = match nearest(&self.column, &known) {
                Some(near) => format!("did you mean {near}?"),
                None => format!("expected one of {}", known.join(", ")),
            };
            InvalidFilter::Column { column: self.column.clone(), suggestion }
        })
    }

    /// Returns true if `cell` has the required value, compared as text or as number.
    fn passes(&self, cell: &Cell) -> bool {
        let cell = cell.to_string();
        let numbers = cell.parse().ok().zip(self.value.parse().ok());
        // Compare texts too, because a value such as `2L` is not a number.
        cell == self.value || numbers.is_some_and(|(cell, value)| number::same(cell, value))
    }
}

impl Filter {
    /// Returns the grid indices of the designs in `archive` that pass, in ascending order.
    ///
    /// # Errors
    ///
    /// If a number or a column does not exist, or the journal cannot be read.
    pub fn designs(&self, archive: &Archive) -> Result<Vec<u64>, InvalidFilter> {
        let columns = design_columns(archive.sweep());
        let found = self.columns.iter().map(|filter| Ok((filter, filter.find(&columns)?)));
        let found = found.collect::<Result<Vec<_>, InvalidFilter>>()?;
        let passes = |row: &DesignRow| {
            (row.result.failed() || !self.failed)
                && found.iter().all(|(filter, column)| filter.passes(&column.cell(row)))
        };
        let mut designs = Vec::new();
        let mut visit = |entry| {
            let row = archive.row(entry);
            designs.extend(passes(&row).then(|| row.number.index()));
        };
        match &self.numbers {
            // Entries of numbered designs are read at their offsets, without reading the other
            // entries.
            Some(numbers) => numbered(archive, numbers)?.into_iter().for_each(visit),
            None => archive.entries()?.in_order().try_for_each(|entry| entry.map(&mut visit))?,
        }
        Ok(designs)
    }
}

/// Returns the journal entries of the given design numbers, sorted and without duplicates.
fn numbered(archive: &Archive, numbers: &[String]) -> Result<Vec<JournalEntry>, InvalidFilter> {
    let grid = archive.sweep().grid();
    let ranges = numbers
        .iter()
        .map(|text| grid.parse_numbers(text.trim()).map_err(InvalidFilter::Number))
        .collect::<Result<Vec<_>, _>>()?;
    let mut indices: Vec<_> = ranges.into_iter().flatten().collect();
    // Reruns solve designs in ascending order, regardless of the order on the command line.
    indices.sort_unstable();
    indices.dedup();
    let mut entries = archive.entries()?;
    indices
        .into_iter()
        .map(&mut |index| {
            let position = archive.designs().position(index);
            let entry = position.map(|position| entries.last(position)).transpose()?.flatten();
            entry.ok_or_else(|| InvalidFilter::NotDone(grid.number(index).to_string()))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_compare_numbers_as_numbers() {
        let filter: ColumnFilter = "slant_deg = 75".parse().expect("a condition");
        assert!(filter.passes(&75.0.into()) && !filter.passes(&7.0.into()));
        assert!("x=75.0".parse::<ColumnFilter>().expect("a condition").passes(&75.0.into()));
        assert!("base=2L".parse::<ColumnFilter>().expect("a condition").passes(&"2L".into()));
        let text = "=3".parse::<ColumnFilter>().expect_err("invalid").to_string();
        assert_eq!(text, "\"=3\" is not a condition, expected COLUMN=VALUE, e.g. slant_deg=75");
    }
}
