//! The comparison of two runs: where they differ, and by how much.

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

/// Two runs, design by design.
#[derive(Clone, Debug)]
pub struct Comparison<'r> {
    first: &'r Results,
    second: &'r Results,
    tolerance: f64,
    matching: Matching,
    places: Vec<ComparedColumn>,
    /// The differences in each column that both runs have.
    pub columns: Vec<ColumnDifference>,
}

/// A column of both runs.
#[derive(Clone, Copy, Debug)]
struct ComparedColumn {
    /// Its places in the one and in the other.
    places: [usize; 2],
    /// The largest difference that rounding may make of a zero.
    noise: f64,
}

/// The share of the largest value of its column that rounding may make of a zero.
const ROUND_OFF: f64 = 1e-14;

/// Runs that cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InvalidComparison {
    /// One of them cannot be read.
    #[error(transparent)]
    Results(#[from] InvalidResults),
    /// Designs that only differ in something that the other run says nothing about.
    #[error(
        "{file}: designs {first} and {second} differ only in something that one of the runs does not record; \
         each table needs its run.toml"
    )]
    Ambiguous {
        /// The table.
        file: String,
        /// A design.
        first: String,
        /// Another one.
        second: String,
    },
}

/// The differences between the values of one column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnDifference {
    /// The column.
    pub name: String,
    /// Designs that have a value in both runs.
    pub compared: usize,
    /// Designs whose values differ by more than the tolerance.
    pub differing: usize,
    /// Designs that have a value in the first run alone.
    pub only_first: usize,
    /// Designs that have a value in the second run alone.
    pub only_second: usize,
    /// The largest relative difference.
    pub relative: Option<Extreme>,
    /// The largest absolute difference.
    pub absolute: Option<Extreme>,
    /// Spearman's rank correlation of the numbers of the two runs.
    pub correlation: Option<f64>,
    /// Texts of the first run, those of the second in their place, and how often.
    pub changes: BTreeMap<(String, String), usize>,
}

impl ColumnDifference {
    /// Whether the two runs agree.
    pub fn is_none(&self) -> bool {
        self.differing + self.only_first + self.only_second == 0
    }
}

/// The largest difference of a column.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// The size of the difference.
    pub difference: f64,
    /// Number of the design in the first run.
    pub design: String,
    /// The value in the first run.
    pub first: f64,
    /// The value in the second run.
    pub second: f64,
}

/// One cell that differs.
#[derive(Clone, Copy, Debug)]
pub struct Difference<'a> {
    first: &'a Results,
    second: &'a Results,
    rows: [usize; 2],
    columns: [usize; 2],
}

impl<'a> Difference<'a> {
    /// The number of the design in the first run and in the second.
    pub fn designs(&self) -> [&'a str; 2] {
        [self.first.design(self.rows[0]), self.second.design(self.rows[1])]
    }

    /// The value of a parameter in the first run.
    pub fn parameter(&self, parameter: &Parameter) -> Cow<'a, str> {
        self.first.parameter(self.rows[0], parameter)
    }

    /// The column.
    pub fn column(&self) -> &'a str {
        self.first.header().get(self.columns[0]).map_or("", String::as_str)
    }

    /// Each cell as the table that it is in, its row and its column.
    fn cells(&self) -> [(&'a Table, usize, usize); 2] {
        let ([row, other_row], [column, other_column]) = (self.rows, self.columns);
        [(self.first.table(), row, column), (self.second.table(), other_row, other_column)]
    }

    /// The cells.
    pub fn texts(&self) -> [Cow<'a, str>; 2] {
        self.cells().map(|(table, row, column)| table.text(row, column))
    }

    /// The cells as numbers, if both are.
    pub fn numbers(&self) -> Option<[f64; 2]> {
        let [first, second] = self.cells().map(|(table, row, column)| table.number(row, column));
        Some([first?, second?])
    }

    fn is_within(&self, tolerance: f64, noise: f64) -> bool {
        let is_small = |pair| relative(pair) <= tolerance || absolute(pair) <= noise;
        // As texts where they are no numbers: words are compared here too.
        self.numbers().is_some_and(is_small) || {
            let [first, second] = self.texts();
            first == second
        }
    }
}

/// `|a − b|`.
pub(crate) fn absolute([first, second]: [f64; 2]) -> f64 {
    (first - second).abs()
}

/// `|a − b| / max(|a|, |b|)`, from 0 to 2.
pub(crate) fn relative([first, second]: [f64; 2]) -> f64 {
    if first.to_bits() == second.to_bits() {
        return 0.0;
    }
    let size = first.abs().max(second.abs());
    if size > 0.0 { absolute([first, second]) / size } else { 0.0 }
}

/// Compares two runs. Designs are the same if their parameters are, whatever their numbers; values
/// are the same if they differ by at most `tolerance`, relative to the larger. Unless `tolerance` is 0,
/// what is below 10⁻¹⁴ of the largest value of its column counts as zero.
///
/// # Errors
/// If the designs of a run cannot be told apart by what the other one knows.
pub fn compare<'r>(
    first: &'r Results,
    second: &'r Results,
    tolerance: f64,
) -> Result<Comparison<'r>, InvalidComparison> {
    let matching = Matching::new(first, second)?;
    let place = |(column, name): (usize, &String)| {
        let other = second.column(name).ok()?;
        // The first column is the number, which another grid gives to another design; parameters say which designs are the same.
        (column > 0 && parameter_of(name).is_none()).then_some([column, other])
    };
    let places: Vec<_> = first.header().iter().enumerate().filter_map(place).collect();
    let mut comparison =
        Comparison { first, second, tolerance, matching, places: Vec::new(), columns: Vec::new() };
    // The matching comes first: the size of a column is that of the designs in both runs.
    comparison.places = places.iter().map(|&places| comparison.compared(places)).collect();
    let places = comparison.places.par_iter();
    comparison.columns = places.map(|&column| comparison.column(column)).collect();
    Ok(comparison)
}

impl Comparison<'_> {
    /// The largest relative difference of values that count as the same.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Designs that both runs have.
    pub fn matched(&self) -> usize {
        self.matching.pairs.len()
    }

    /// Numbers of the designs that only the first run has, and of those that only the second has.
    pub fn unmatched(&self) -> [Vec<&str>; 2] {
        let [first, second] = &self.matching.alone;
        [
            first.iter().map(|&row| self.first.design(row)).collect(),
            second.iter().map(|&row| self.second.design(row)).collect(),
        ]
    }

    /// Parameters that each run sets for all of its designs, but not to the same value.
    pub fn parameters(&self) -> &[ParameterChange] {
        &self.matching.changes
    }

    /// Whether the two runs have the same designs with the same values.
    pub fn is_none(&self) -> bool {
        self.matching.alone.iter().all(Vec::is_empty)
            && self.columns.iter().all(ColumnDifference::is_none)
    }

    fn cell(&self, rows: [usize; 2], columns: [usize; 2]) -> Difference<'_> {
        Difference { first: self.first, second: self.second, rows, columns }
    }

    fn compared(&self, places: [usize; 2]) -> ComparedColumn {
        let cells = self.matching.pairs.iter().map(|&rows| self.cell(rows, places));
        let sizes = cells.filter_map(|cell| cell.numbers()).flatten().map(f64::abs);
        // Whoever asks for a tolerance of 0 wants every bit, zeros too.
        let largest = if self.tolerance > 0.0 { sizes.fold(0.0, f64::max) } else { 0.0 };
        ComparedColumn { places, noise: ROUND_OFF * largest }
    }

    fn column(&self, compared: ComparedColumn) -> ColumnDifference {
        let columns = compared.places;
        let name = self.first.header()[columns[0]].clone();
        let mut column = ColumnDifference { name, ..ColumnDifference::default() };
        let mut numbers = Vec::new();
        for &rows in &self.matching.pairs {
            let cell = self.cell(rows, columns);
            match cell.cells().map(|(table, row, column)| table.is_empty(row, column)) {
                // No value in both, as of a design that fails in both, is no difference.
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

    /// Every cell that differs.
    fn differences(&self) -> impl Iterator<Item = Difference<'_>> {
        // One after the other as they are written: two long runs may differ in every cell.
        let cells = move |rows: [usize; 2]| {
            let cell = move |column: &ComparedColumn| {
                let cell = self.cell(rows, column.places);
                (!cell.is_within(self.tolerance, column.noise)).then_some(cell)
            };
            self.places.iter().filter_map(cell)
        };
        self.matching.pairs.iter().flat_map(move |&rows| cells(rows))
    }

    /// Writes what differs to `folder`: column by column, and cell by cell. Returns the names of the
    /// tables.
    ///
    /// # Errors
    /// If the folder or the disk does not take them.
    fn write(&self, folder: &Path) -> Result<[&'static str; 2], OutputError> {
        let folder = ResultsFolder::new(folder);
        let claim = Claim::take(&folder, Maker::Comparison)?;
        let [by_column, by_cell] = ResultsFolder::COMPARISON;
        let format = self.first.format();
        write_rows(&folder, by_column, format, COMPARISON_COLUMNS, &self.columns)?;
        let parameters: Vec<_> = self.first.parameters().collect();
        let columns = difference_columns(&parameters);
        write_rows(&folder, by_cell, format, &columns, self.differences())?;
        claim.state(&ResultsFolder::COMPARISON)?;
        Ok(ResultsFolder::COMPARISON)
    }
}

impl ColumnDifference {
    /// Takes a cell that both runs have into account.
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

/// Writes a comparison to `folder`; returns the names of the tables.
///
/// # Errors
/// If the folder or the disk does not take them.
pub fn write_comparison(
    folder: &Path,
    comparison: &Comparison<'_>,
) -> Result<[&'static str; 2], OutputError> {
    comparison.write(folder)
}
