//! Header of a table of numbers: column names and units in the rows above the numbers.

use std::ops::Range;

use super::columns::{CurveColumns, contradiction, curves, missing, quantities, spelled};
use super::number_table::{NumberTable, Rows};

/// Number of rows above a table that are searched for a header.
const LONGEST_PREAMBLE: usize = 100;

/// Column names above a table.
pub(super) struct Header {
    pub names: Vec<String>,
    /// Names of the columns in the file, if `names` come from the definition.
    in_file: Vec<String>,
    /// True if `names` come from the definition, which may name only the first columns.
    pub is_given: bool,
    /// True if the definition gives `names`, or if `names` include two columns of a test.
    is_known: bool,
    /// Rows of the names and their units in the file.
    rows: Range<usize>,
}

impl Header {
    /// Finds the header of the table below the rows `above`.
    ///
    /// Its names are `given`, otherwise the nearest row with the names of two columns of a test.
    /// Units from the row below the names are appended to them.
    pub fn find(rows: &Rows, above: Range<usize>, given: Option<&[String]>) -> Self {
        let start = above.start.max(above.end.saturating_sub(LONGEST_PREAMBLE));
        if let Some(names) = given {
            let Self { names: in_file, rows, .. } = Self::nearest(rows, above);
            return Self { names: names.to_vec(), in_file, is_given: true, is_known: true, rows };
        }
        let known = (start..above.end).rev().find_map(|row| Self::known(rows, row));
        // No row is a known header. For the error message, choose the row that names the most
        // quantities.
        known.unwrap_or_else(|| {
            let mut best = Self::nearest(rows, start..above.end);
            for row in (start..above.end).filter(|row| rows.is_text(*row)) {
                let has_units = row + 1 < above.end && rows.is_text(row + 1);
                let other = Self::at(rows, row, usize::from(has_units));
                if quantities(&other.names) > quantities(&best.names) {
                    best = other;
                }
            }
            best
        })
    }

    /// Returns the header in the last row of text above the numbers.
    ///
    /// If the row above it is text with the same number of cells, the two rows are names and units.
    fn nearest(rows: &Rows, above: Range<usize>) -> Self {
        let last = above.end.checked_sub(1).filter(|row| above.contains(row) && rows.is_text(*row));
        let Some(last) = last else {
            return Self {
                names: Vec::new(),
                in_file: Vec::new(),
                is_given: false,
                is_known: false,
                rows: above.end..above.end,
            };
        };
        let has_units = last > above.start && rows.is_text(last - 1);
        let same_width = has_units && rows.all[last - 1].cells.len() == rows.all[last].cells.len();
        Self::at(rows, if same_width { last - 1 } else { last }, usize::from(same_width))
    }

    /// Returns the header in `row` if this row names two columns of a test.
    pub fn known(rows: &Rows, row: usize) -> Option<Self> {
        if !rows.is_text(row) {
            return None;
        }
        let below = (row + 1..rows.all.len()).take(2).take_while(|row| rows.is_text(*row)).count();
        // Units are in the next row, or in the row after it, below a row of remarks.
        let with_units = (1..=below).map(|units| Self::at(rows, row, units));
        let header = with_units.into_iter().find(|header| curves(&header.names).is_ok());
        let header = header.or_else(|| {
            // Accept names without a row of units. A row of text below `force_N` is then a remark.
            // Below `force`, a row of text holds unknown units, which must not be ignored.
            let header = Self::at(rows, row, 0);
            let curves = curves(&header.names).ok()?;
            (below == 0 || curves[0].units.is_some()).then_some(header)
        });
        header.map(|header| Self { is_known: true, ..header })
    }

    /// Returns the header with names in `row`, and with units `units` rows below.
    ///
    /// `units` is 0 if the header has no row of units.
    fn at(rows: &Rows, row: usize, units: usize) -> Self {
        let mut names = Vec::new();
        for (column, name) in rows.all[row].cells.iter().enumerate() {
            let unit = if units > 0 { rows.all[row + units].cell(column) } else { "" };
            names.push(spelled(&format!("{name} {unit}")));
        }
        let rows = row..row + units + 1;
        Self { names, in_file: Vec::new(), is_given: false, is_known: false, rows }
    }

    /// Returns the columns of each specimen. An error is a description of the problem.
    pub fn curves(&self) -> Result<Vec<CurveColumns>, String> {
        let curves = curves(&self.names)?;
        for column in curves.iter().flat_map(|curve| curve.indices) {
            let given = &self.names[column];
            let in_file = self.in_file.get(column);
            if let Some(stated) = in_file.and_then(|name| contradiction(given, name)) {
                let column = column + 1;
                return Err(format!(
                    "column {column} is {stated} according to its unit in the file, but is named {given}; expected the same unit"
                ));
            }
        }
        if self.is_known { Ok(curves) } else { Err(missing(&self.names)) }
    }

    /// Returns the line number of the names, if they are in the file.
    pub fn line(&self, rows: &Rows) -> Option<u64> {
        (!self.rows.is_empty()).then(|| rows.all[self.rows.start].line)
    }

    /// Returns the row of text above the header, which may name the specimens.
    pub fn named(&self, rows: &Rows) -> Option<usize> {
        let above = self.rows.start.checked_sub(1).filter(|_| !self.rows.is_empty());
        above.filter(|row| rows.is_text(*row))
    }

    /// Returns the name of a specimen from the row above the header, otherwise an empty text.
    ///
    /// `columns` are the columns of this specimen.
    pub fn specimen(&self, rows: &Rows, columns: Range<usize>) -> String {
        let mut cells =
            columns.map(|column| self.named(rows).map(|row| rows.all[row].cell(column)));
        let name = cells.find(|cell| cell.is_some_and(|cell| !cell.is_empty()));
        name.flatten().unwrap_or_default().to_owned()
    }

    /// Lists the lines around a table that belong neither to the table nor to its header.
    ///
    /// `name` is the row that names the specimens; it belongs to the header.
    pub fn skipped_lines(&self, rows: &Rows, table: &NumberTable, name: Option<usize>) -> Vec<u64> {
        let above = table.above.clone();
        let above = above.filter(|row| !self.rows.contains(row) && Some(*row) != name);
        above.map(|row| rows.all[row].line).chain(table.skipped_lines.iter().copied()).collect()
    }
}
