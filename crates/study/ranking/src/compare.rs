//! Comparison of two runs: differences by column and by cell.

mod columns;
mod correlation;
mod matching;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use rayon::prelude::*;
use results::columns::parameter_of;
use results::{
    Claim, InvalidResults, Maker, OutputError, Results, ResultsFolder, Table, write_rows,
};
use sweep::Parameter;

use matching::Matching;

pub use columns::{COMPARISON_COLUMNS, difference_columns};
pub use correlation::rank_correlation;
pub use matching::ParameterChange;

/// Comparison of two runs, design by design.
#[derive(Clone, Debug)]
pub struct Comparison<'r> {
    first: &'r Results,
    second: &'r Results,
    tolerance: f64,
    matching: Matching,
    indices: Vec<ComparedColumn>,
    /// Differences in each column that both runs have.
    pub columns: Vec<ColumnDifference>,
}

/// A column that both runs have.
#[derive(Clone, Copy, Debug)]
struct ComparedColumn {
    /// Indices of the column in the first and second run.
    indices: [usize; 2],
    /// Maximum absolute difference that counts as round-off.
    noise: f64,
}

/// Absolute difference that counts as round-off, as a fraction of the largest value of a column.
const ROUND_OFF: f64 = 1e-14;

/// Error: two runs cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InvalidComparison {
    /// The results of a run cannot be read.
    #[error(transparent)]
    Results(#[from] InvalidResults),
    /// Two designs of one run differ only in a parameter that the other run does not record.
    #[error(
        "{file}: designs {first} and {second} differ only in a parameter that one of the runs does not record; \
         each table needs its run.toml"
    )]
    Ambiguous {
        /// File name of the table.
        file: String,
        /// Number of the first of the two designs.
        first: String,
        /// Number of the second of the two designs.
        second: String,
    },
}

/// Differences between the values of one column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnDifference {
    /// Column name.
    pub name: String,
    /// Number of designs with a value in both runs.
    pub compared: usize,
    /// Number of designs with values that differ by more than the tolerance.
    pub differing: usize,
    /// Number of designs with a value in the first run only.
    pub only_first: usize,
    /// Number of designs with a value in the second run only.
    pub only_second: usize,
    /// Largest relative difference.
    pub relative: Option<Extreme>,
    /// Largest absolute difference.
    pub absolute: Option<Extreme>,
    /// Spearman's rank correlation of the numbers in both runs.
    pub correlation: Option<f64>,
    /// Pairs of different texts in the first and second run, with the number of designs of each.
    pub changes: BTreeMap<(String, String), usize>,
}

impl ColumnDifference {
    /// Returns true if the values of both runs agree in this column.
    pub fn has_no_differences(&self) -> bool {
        self.differing + self.only_first + self.only_second == 0
    }
}

/// Largest difference in a column, with its design and its two values.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// Size of the difference.
    pub difference: f64,
    /// Number of the design in the first run.
    pub design: String,
    /// Value in the first run.
    pub first: f64,
    /// Value in the second run.
    pub second: f64,
}

/// A cell of both runs: the values of one matched design in one column.
#[derive(Clone, Copy, Debug)]
pub struct Difference<'a> {
    first: &'a Results,
    second: &'a Results,
    rows: [usize; 2],
    columns: [usize; 2],
}

impl<'a> Difference<'a> {
    /// Returns the numbers of the design in the first and second run.
    pub fn designs(&self) -> [&'a str; 2] {
        [self.first.design(self.rows[0]), self.second.design(self.rows[1])]
    }

    /// Returns the value of a parameter in the first run.
    pub fn parameter(&self, parameter: &Parameter) -> Cow<'a, str> {
        self.first.parameter(self.rows[0], parameter)
    }

    /// Returns the column name.
    pub fn column(&self) -> &'a str {
        self.first.header().get(self.columns[0]).map_or("", String::as_str)
    }

    /// Returns table, row and column of the cell in the first and second run.
    fn cells(&self) -> [(&'a Table, usize, usize); 2] {
        let ([row, other_row], [column, other_column]) = (self.rows, self.columns);
        [(self.first.table(), row, column), (self.second.table(), other_row, other_column)]
    }

    /// Returns the texts of the cell in the first and second run.
    pub fn texts(&self) -> [Cow<'a, str>; 2] {
        self.cells().map(|(table, row, column)| table.text(row, column))
    }

    /// Returns the numbers of the cell in the first and second run, if both are numbers.
    pub fn numbers(&self) -> Option<[f64; 2]> {
        let [first, second] = self.cells().map(|(table, row, column)| table.number(row, column));
        Some([first?, second?])
    }

    fn is_within(&self, tolerance: f64, noise: f64) -> bool {
        // Cells that are not numbers are compared as text.
        self.numbers().is_some_and(|pair| relative(pair) <= tolerance || absolute(pair) <= noise)
            || {
                let [first, second] = self.texts();
                first == second
            }
    }
}

/// Returns `|a − b|`.
pub(crate) fn absolute([first, second]: [f64; 2]) -> f64 {
    (first - second).abs()
}

/// Returns `|a − b| / max(|a|, |b|)`, from 0 to 2.
pub(crate) fn relative([first, second]: [f64; 2]) -> f64 {
    if first.to_bits() == second.to_bits() {
        return 0.0;
    }
    let size = first.abs().max(second.abs());
    if size > 0.0 { absolute([first, second]) / size } else { 0.0 }
}

/// Compares two runs.
///
/// Designs are matched by their parameters; the numbers of matched designs may differ. Values are
/// equal if they differ by at most `tolerance` times the larger magnitude of both. Unless
/// `tolerance` is 0, values are also equal if they differ by at most 10⁻¹⁴ of the largest value of
/// their column.
///
/// # Errors
///
/// If two designs of one run differ only in parameters that the other run does not record.
pub fn compare<'r>(
    first: &'r Results,
    second: &'r Results,
    tolerance: f64,
) -> Result<Comparison<'r>, InvalidComparison> {
    let matching = Matching::new(first, second)?;
    let indices: Vec<_> = first
        .header()
        .iter()
        .enumerate()
        .filter_map(|(column, name)| {
            let other = second.column(name).ok()?;
            // Skip the first column, the number of the design, and parameters, which identify the
            // design.
            (column > 0 && parameter_of(name).is_none()).then_some([column, other])
        })
        .collect();
    let mut comparison =
        Comparison { first, second, tolerance, matching, indices: Vec::new(), columns: Vec::new() };
    // The round-off of a column is computed from the matched designs, so match designs first.
    comparison.indices = indices.iter().map(|&indices| comparison.compared(indices)).collect();
    let indices = comparison.indices.par_iter();
    comparison.columns = indices.map(|&column| comparison.column(column)).collect();
    Ok(comparison)
}

impl Comparison<'_> {
    /// Returns the maximum relative difference of values that count as equal.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Returns the number of designs in both runs.
    pub fn matched(&self) -> usize {
        self.matching.pairs.len()
    }

    /// Returns the numbers of designs in the first run only, and in the second only.
    pub fn unmatched(&self) -> [Vec<&str>; 2] {
        let [first, second] = &self.matching.alone;
        [
            first.iter().map(|&row| self.first.design(row)).collect(),
            second.iter().map(|&row| self.second.design(row)).collect(),
        ]
    }

    /// Returns parameters that are constant in each run, but differ between the runs.
    pub fn parameters(&self) -> &[ParameterChange] {
        &self.matching.changes
    }

    /// Returns true if both runs have the same designs with the same values.
    pub fn has_no_differences(&self) -> bool {
        self.matching.alone.iter().all(Vec::is_empty)
            && self.columns.iter().all(ColumnDifference::has_no_differences)
    }

    fn cell(&self, rows: [usize; 2], columns: [usize; 2]) -> Difference<'_> {
        Difference { first: self.first, second: self.second, rows, columns }
    }

    fn compared(&self, indices: [usize; 2]) -> ComparedColumn {
        let cells = self.matching.pairs.iter().map(|&rows| self.cell(rows, indices));
        let sizes = cells.filter_map(|cell| cell.numbers()).flatten().map(f64::abs);
        // A tolerance of 0 requests exact equality, so that no difference counts as round-off.
        let largest = if self.tolerance > 0.0 { sizes.fold(0.0, f64::max) } else { 0.0 };
        ComparedColumn { indices, noise: ROUND_OFF * largest }
    }

    fn column(&self, compared: ComparedColumn) -> ColumnDifference {
        let columns = compared.indices;
        let name = self.first.header()[columns[0]].clone();
        let mut column = ColumnDifference { name, ..ColumnDifference::default() };
        let mut numbers = Vec::new();
        for &rows in &self.matching.pairs {
            let cell = self.cell(rows, columns);
            match cell.cells().map(|(table, row, column)| table.is_empty(row, column)) {
                // A value that is missing in both runs, as for a failed design, is no difference.
                [true, true] => {}
                [false, true] => column.only_first += 1,
                [true, false] => column.only_second += 1,
                [false, false] => {
                    column.compared += 1;
                    column.differing +=
                        usize::from(!cell.is_within(self.tolerance, compared.noise));
                    column.add(&cell);
                    numbers.extend(cell.numbers());
                }
            }
        }
        column.correlation = rank_correlation(&numbers);
        column
    }

    /// Returns the cells with different values in both runs.
    fn differences(&self) -> impl Iterator<Item = Difference<'_>> {
        // The iterator is lazy, because two long runs may differ in every cell.
        let cells = move |rows: [usize; 2]| {
            self.indices.iter().filter_map(move |column| {
                let cell = self.cell(rows, column.indices);
                (!cell.is_within(self.tolerance, column.noise)).then_some(cell)
            })
        };
        self.matching.pairs.iter().flat_map(move |&rows| cells(rows))
    }

    /// Writes the differences to `folder`, by column and by cell.
    ///
    /// Returns the file names.
    ///
    /// # Errors
    ///
    /// If the tables cannot be written.
    fn write(&self, folder: &Path) -> Result<[&'static str; 2], OutputError> {
        let folder = ResultsFolder::new(folder);
        let claim = Claim::take(&folder, Maker::Comparison)?;
        let [by_column, by_cell] = ResultsFolder::COMPARISON;
        let format = self.first.format();
        write_rows(&folder, by_column, format, COMPARISON_COLUMNS, &self.columns)?;
        let parameters: Vec<_> = self.first.parameters().collect();
        let columns = difference_columns(&parameters);
        write_rows(&folder, by_cell, format, &columns, self.differences())?;
        claim.finish(&ResultsFolder::COMPARISON)?;
        Ok(ResultsFolder::COMPARISON)
    }
}

impl ColumnDifference {
    /// Includes `cell`, which has values in both runs, in the largest differences or `changes`.
    fn add(&mut self, cell: &Difference<'_>) {
        let Some(pair) = cell.numbers() else {
            let [first, second] = cell.texts().map(Cow::into_owned);
            if first != second {
                *self.changes.entry((first, second)).or_default() += 1;
            }
            return;
        };
        let [first, second] = pair;
        for (largest, difference) in
            [(&mut self.relative, relative(pair)), (&mut self.absolute, absolute(pair))]
        {
            if difference > largest.as_ref().map_or(0.0, |largest| largest.difference) {
                let design = cell.designs()[0].to_owned();
                *largest = Some(Extreme { difference, design, first, second });
            }
        }
    }
}

/// Writes a comparison to `folder`, and returns the file names.
///
/// # Errors
///
/// If the tables cannot be written.
pub fn write_comparison(
    folder: &Path,
    comparison: &Comparison<'_>,
) -> Result<[&'static str; 2], OutputError> {
    comparison.write(folder)
}
