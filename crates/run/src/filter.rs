//! Which designs of a run are meant: failed ones, some by number, those with certain values.

use std::str::FromStr;

use results::row;
use sweep::{NoSuchDesign, nearest};

use crate::journal::{Archive, Entry, JournalError};

/// Which designs of a run are meant: those for which everything holds that is set.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Those that lack a value.
    pub failed: bool,
    /// Those with these numbers.
    pub numbers: Option<Vec<String>>,
    /// Those whose rows in `designs.csv` have these values.
    pub conditions: Vec<Condition>,
}

/// A column of `designs.csv` and the value that a row must have there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Condition {
    column: String,
    value: String,
}

/// A text that is no condition.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is no condition, expected COLUMN=VALUE, e.g. slant_deg=75")]
pub struct NoCondition(String);

/// A choice that makes no sense for a run.
#[derive(Debug, thiserror::Error)]
pub enum WrongChoice {
    /// A number that is no design of the sweep.
    #[error("--design {0}")]
    Number(NoSuchDesign),
    /// A design that is not done.
    #[error(
        "--design {0}: the design is not done yet, expected one that is; squama run --resume solves it"
    )]
    NotDone(String),
    /// A column that there is not.
    #[error("--where {column}: there is no such column in designs.csv, {hint}")]
    Column {
        /// The column.
        column: String,
        /// What may be meant.
        hint: String,
    },
    /// The journal cannot be read.
    #[error(transparent)]
    Journal(#[from] JournalError),
}

impl FromStr for Condition {
    type Err = NoCondition;

    fn from_str(text: &str) -> Result<Self, NoCondition> {
        let (column, value) = text.split_once('=').ok_or_else(|| NoCondition(text.to_owned()))?;
        let (column, value) = (column.trim().to_owned(), value.trim().to_owned());
        if column.is_empty() {
            Err(NoCondition(text.to_owned()))
        } else {
            Ok(Self { column, value })
        }
    }
}

impl Condition {
    /// The place of the column among `columns`.
    fn place(&self, columns: &[String]) -> Result<usize, WrongChoice> {
        let place = columns.iter().position(|column| *column == self.column);
        place.ok_or_else(|| {
            let known: Vec<_> = columns.iter().map(String::as_str).collect();
            let hint = match nearest(&self.column, &known) {
                Some(near) => format!("did you mean {near}?"),
                None => format!("expected one of {}", known.join(", ")),
            };
            WrongChoice::Column { column: self.column.clone(), hint }
        })
    }

    /// Whether `cell` has the value: as text, or as a number.
    fn holds(&self, cell: &str) -> bool {
        let number = |text: &str| text.parse::<f64>().ok();
        cell == self.value || number(cell).is_some_and(|cell| Some(cell) == number(&self.value))
    }
}

impl Choice {
    /// The designs of `archive` that are meant, as indices of its grid, in order.
    ///
    /// # Errors
    /// If a number or a column does not exist, or the journal cannot be read.
    pub fn designs(&self, archive: &Archive) -> Result<Vec<u64>, WrongChoice> {
        let columns = &archive.header().columns;
        let place = |condition: &Condition| condition.place(columns);
        let places = self.conditions.iter().map(place).collect::<Result<Vec<_>, _>>()?;
        let meant = |entry: &Entry| {
            let holds = |(condition, place): (&Condition, &usize)| {
                row::cell(&entry.row, *place).is_some_and(|cell| condition.holds(cell))
            };
            (entry.failed() || !self.failed) && self.conditions.iter().zip(&places).all(holds)
        };
        let mut designs = Vec::new();
        let mut visit = |entry: &Entry| designs.extend(entry.index().filter(|_| meant(entry)));
        match &self.numbers {
            Some(numbers) => numbered(archive, numbers)?.iter().for_each(visit),
            None => {
                for entry in archive.entries()?.in_order() {
                    visit(&entry?);
                }
            }
        }
        Ok(designs)
    }
}

/// The entries of the designs with these numbers, in order, each once.
fn numbered(archive: &Archive, numbers: &[String]) -> Result<Vec<Entry>, WrongChoice> {
    let grid = archive.sweep().grid();
    let index = |text: &String| grid.parse_number(text.trim()).map_err(WrongChoice::Number);
    let mut indices = numbers.iter().map(index).collect::<Result<Vec<_>, _>>()?;
    indices.sort_unstable();
    indices.dedup();
    let mut entries = archive.entries()?;
    let mut entry = |index: u64| {
        let position = archive.selection().position(index);
        let entry = position.map(|position| entries.last(position)).transpose()?.flatten();
        entry.ok_or_else(|| WrongChoice::NotDone(grid.number(index).to_string()))
    };
    indices.into_iter().map(&mut entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_compare_numbers_as_numbers() {
        let condition: Condition = "slant_deg = 75".parse().expect("a condition");
        assert!(condition.holds("75") && condition.holds("75.0") && !condition.holds("7"));
        assert!("base=2L".parse::<Condition>().expect("a condition").holds("2L"));
        let text = "=3".parse::<Condition>().expect_err("none").to_string();
        assert_eq!(text, "\"=3\" is no condition, expected COLUMN=VALUE, e.g. slant_deg=75");
    }
}
