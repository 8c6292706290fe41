//! Access to the table of a sweep by column and row.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::Arc;

use results::columns::{distinguishes_designs, name, parameter_of};
use results::{Results, Table};
use text::number::{self, DistinctNumbers};

use crate::palette::SlantPalette;

/// Parameters on the axes of the standard figures.
const GEOMETRY: [&str; 3] = ["gap_over_t", "length_over_t", "slant_deg"];

/// Parameters, as pairs of column name and value.
pub(crate) type AxisValues<'a> = Vec<(&'a str, Cow<'a, str>)>;

/// The designs of a sweep, from `designs.csv`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Designs {
    table: Arc<Table>,
}

impl Designs {
    /// Returns the designs of a run.
    pub fn of(results: &Results) -> Self {
        Self { table: Arc::clone(results.table()) }
    }

    /// Returns the column names, from left to right.
    pub fn headers(&self) -> &[String] {
        self.table.header()
    }

    /// Returns the number of designs.
    pub fn count(&self) -> usize {
        self.table.length()
    }

    /// Returns the number of the design in `row`, as it is written in the table.
    pub fn design(&self, row: usize) -> &str {
        self.table.name(row)
    }

    /// Returns the text of a cell; empty if the table has no such column.
    pub fn text(&self, column: &str, row: usize) -> Cow<'_, str> {
        self.table.column(column).map_or_else(Cow::default, |column| self.table.text(row, column))
    }

    /// Returns a cell as a number; `None` if the column is missing or the cell is not a number.
    pub fn number(&self, column: &str, row: usize) -> Option<f64> {
        self.table.number(row, self.table.column(column)?)
    }

    /// Returns a column as numbers, NaN for empty cells; `None` if any cell is text.
    pub(crate) fn only_numbers(&self, column: &str) -> Option<&[f64]> {
        self.table.numbers(self.table.column(column)?)
    }

    /// Returns true if any design has a number in a column.
    pub(crate) fn has(&self, column: &str) -> bool {
        (0..self.count()).any(|row| self.number(column, row).is_some())
    }

    /// Returns all numbers of a column.
    pub(crate) fn numbers(&self, column: &str) -> impl Iterator<Item = f64> {
        (0..self.count()).filter_map(move |row| self.number(column, row))
    }

    /// Returns true for each design with a positive value in a column.
    pub(crate) fn positive(&self, column: &str) -> Vec<bool> {
        (0..self.count()).map(|row| self.number(column, row).is_some_and(|v| v > 0.0)).collect()
    }

    /// Returns the column names of the varied parameters.
    pub(crate) fn varied(&self) -> Vec<&str> {
        let headers = self.headers().iter().map(String::as_str);
        let parameters = headers.filter(|name| distinguishes_designs(name, self.headers()));
        parameters.filter(|name| self.texts(name).len() > 1).collect()
    }

    /// Returns the name of the varied column with a one-to-one relation to `column`.
    ///
    /// A varied `column` returns itself. Any other `column` must be a length in mm, for example a
    /// pitch that determines the gaps.
    pub(crate) fn varied_as(&self, column: &str) -> Option<&str> {
        let varied = self.varied();
        if let Some(own) = varied.iter().find(|varied| **varied == column) {
            return Some(own);
        }
        parameter_of(column).filter(|parameter| parameter.is_in_mm())?;
        let in_mm = self.groups(column);
        varied.into_iter().find(|varied| {
            let pairs: BTreeSet<_> = self.groups(varied).into_iter().zip(in_mm.clone()).collect();
            // If the number of different pairs equals the number of different values of each
            // column, the columns determine each other.
            pairs.len() > 1
                && [self.texts(varied).len(), self.texts(column).len()] == [pairs.len(); 2]
        })
    }

    /// Returns the column that contains the length ratio `axis` as a length in mm.
    ///
    /// `axis` is a length divided by the thickness, such as `gap_over_t`. Returns `axis` itself if
    /// the table has no equivalent column in mm.
    pub(crate) fn in_mm(&self, axis: &str) -> String {
        let in_mm = axis.replace("_over_t", "_mm");
        if self.are_equivalent(axis, &in_mm) { in_mm } else { axis.to_owned() }
    }

    /// Returns true if two columns of numbers determine each other.
    pub(crate) fn are_equivalent(&self, one: &str, other: &str) -> bool {
        let (ones, others) = (self.distinct(one), self.distinct(other));
        let mut pairs = BTreeSet::new();
        for row in 0..self.count() {
            let numbers = self.number(one, row).zip(self.number(other, row));
            let places = numbers.map(|(a, b)| (ones.position(a), others.position(b)));
            pairs.extend(places);
        }
        !pairs.is_empty() && [ones.as_slice().len(), others.as_slice().len()] == [pairs.len(); 2]
    }

    /// Returns the column names of the varied parameters besides gap, aspect ratio and slant.
    pub(crate) fn further_axes(&self) -> Vec<&str> {
        self.varied().into_iter().filter(|name| !GEOMETRY.contains(name)).collect()
    }

    /// Groups the designs by the varied parameters besides gap, aspect ratio and slant.
    ///
    /// Returns for each group the values of these parameters, and its designs.
    pub(crate) fn parts(&self) -> Vec<(AxisValues<'_>, Self)> {
        self.parts_by(&GEOMETRY)
    }

    /// Groups the designs by the varied parameters that are not among `axes`.
    ///
    /// Returns for each group the values of these parameters, and its designs.
    pub(crate) fn parts_by(&self, axes: &[&str]) -> Vec<(AxisValues<'_>, Self)> {
        let others: Vec<&str> =
            self.varied().into_iter().filter(|name| !axes.contains(name)).collect();
        let groups: Vec<_> = others.iter().map(|axis| self.groups(axis)).collect();
        let mut parts: Vec<(Vec<&str>, Vec<usize>)> = Vec::new();
        for row in 0..self.count() {
            let own: Vec<&str> = groups.iter().map(|texts| texts[row].as_ref()).collect();
            match parts.iter_mut().find(|(other, _)| *other == own) {
                Some((_, rows)) => rows.push(row),
                None => parts.push((own, vec![row])),
            }
        }
        let parts = parts.into_iter().map(|(_, rows)| {
            let values = others.iter().map(|axis| (*axis, self.text(axis, rows[0]))).collect();
            (values, self.only(&rows))
        });
        parts.collect()
    }

    /// Returns true if the surface folds during the puncture of the design in `row`.
    pub(crate) fn folded(&self, row: usize) -> bool {
        let fold = self.table.column(name::FOLD_FORCE);
        fold.is_some_and(|fold| !self.table.is_empty(row, fold))
    }

    /// Returns true if the surface folds in the puncture of any design.
    pub(crate) fn any_folded(&self) -> bool {
        (0..self.count()).any(|row| self.folded(row))
    }

    /// Returns a table of only the designs in `rows`.
    pub(crate) fn only(&self, rows: &[usize]) -> Self {
        Self { table: Arc::new(self.table.only(rows)) }
    }

    /// Returns the different texts of a column.
    ///
    /// Numbers that are equal up to round-off share one text.
    pub(crate) fn texts(&self, column: &str) -> BTreeSet<Cow<'_, str>> {
        self.groups(column).into_iter().collect()
    }

    /// Returns one text per design; designs with equal values in `column` have equal texts.
    fn groups(&self, column: &str) -> Vec<Cow<'_, str>> {
        let distinct = self.distinct(column);
        let texts = (0..self.count()).map(|row| {
            let number = self.number(column, row).and_then(|number| distinct.position(number));
            let number = number.map(|index| number::text(distinct.as_slice()[index]).into());
            number.unwrap_or_else(|| self.text(column, row))
        });
        texts.collect()
    }

    /// Returns the colours and marks of the slants.
    pub(crate) fn palette(&self) -> SlantPalette {
        SlantPalette::new(self.numbers("slant_deg"))
    }

    /// Returns the different numbers of a column, ascending.
    pub(crate) fn values(&self, column: &str) -> Vec<f64> {
        self.distinct(column).as_slice().to_vec()
    }

    /// Returns the different numbers of a column.
    pub(crate) fn distinct(&self, column: &str) -> DistinctNumbers {
        self.numbers(column).collect()
    }
}
