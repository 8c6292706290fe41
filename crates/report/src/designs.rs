//! The table of a sweep, column by column.

use std::collections::{BTreeMap, BTreeSet};

use results::Results;
use results::columns::{name, tells_apart};

use crate::palette::SlantPalette;

/// Parameters that figures of a sweep are drawn over.
const GEOMETRY: [&str; 3] = ["gap_over_t", "length_over_t", "slant_deg"];

/// Parameters, as their columns, and their values.
pub(crate) type AxisValues<'a> = Vec<(&'a str, &'a str)>;

/// The designs of a sweep as `designs.csv` has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Designs {
    headers: Vec<String>,
    /// Cells by column.
    cells: BTreeMap<String, Vec<String>>,
    count: usize,
}

impl Designs {
    /// Creates the designs with these columns, each a header and its cells from the top.
    pub fn new(columns: impl IntoIterator<Item = (String, Vec<String>)>) -> Self {
        let columns: Vec<_> = columns.into_iter().collect();
        let count = columns.first().map_or(0, |(_, cells)| cells.len());
        let headers = columns.iter().map(|(header, _)| header.clone()).collect();
        Self { headers, cells: columns.into_iter().collect(), count }
    }

    /// Returns the designs of a run.
    pub fn of(results: &Results) -> Self {
        let column = |(k, header): (usize, &String)| {
            let cells = (0..results.len()).map(|row| results.text(row, k).to_owned()).collect();
            (header.clone(), cells)
        };
        Self::new(results.header().iter().enumerate().map(column))
    }

    /// Returns the headers, from the left.
    pub fn headers(&self) -> &[String] {
        &self.headers
    }

    /// Returns the number of designs.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns a cell; empty if there is none.
    pub fn text(&self, column: &str, row: usize) -> &str {
        self.cells.get(column).and_then(|cells| cells.get(row)).map_or("", String::as_str)
    }

    /// Returns a cell as a number.
    pub fn number(&self, column: &str, row: usize) -> Option<f64> {
        self.text(column, row).parse().ok()
    }

    /// Returns whether any design has a number in a column.
    pub(crate) fn has(&self, column: &str) -> bool {
        (0..self.count).any(|row| self.number(column, row).is_some())
    }

    /// Returns the numbers of a column, where there are any.
    pub(crate) fn numbers(&self, column: &str) -> impl Iterator<Item = f64> {
        (0..self.count).filter_map(move |row| self.number(column, row))
    }

    /// Returns the varied parameters, as their columns.
    pub(crate) fn varied(&self) -> Vec<&str> {
        let headers = self.headers.iter().map(String::as_str);
        let parameters = headers.filter(|name| tells_apart(name, &self.headers));
        parameters.filter(|name| self.texts(name).len() > 1).collect()
    }

    /// Returns the varied parameters besides gap, aspect ratio and slant, as their columns.
    pub(crate) fn further_axes(&self) -> Vec<&str> {
        self.varied().into_iter().filter(|name| !GEOMETRY.contains(name)).collect()
    }

    /// Returns the designs apart by their further axes, each part with those axes and their values; one part without
    /// any if there are none.
    pub(crate) fn parts(&self) -> Vec<(AxisValues<'_>, Self)> {
        self.parts_by(&GEOMETRY)
    }

    /// Returns the designs apart by the varied parameters that are not among `axes`, each part with those parameters and their
    /// values; one part without any if there are none.
    pub(crate) fn parts_by(&self, axes: &[&str]) -> Vec<(AxisValues<'_>, Self)> {
        let others: Vec<&str> =
            self.varied().into_iter().filter(|name| !axes.contains(name)).collect();
        let values = |row| others.iter().map(|axis| (*axis, self.text(axis, row))).collect();
        let mut parts: Vec<(AxisValues<'_>, Vec<usize>)> = Vec::new();
        for row in 0..self.count {
            let own: AxisValues<'_> = values(row);
            match parts.iter_mut().find(|(other, _)| *other == own) {
                Some((_, rows)) => rows.push(row),
                None => parts.push((own, vec![row])),
            }
        }
        parts.into_iter().map(|(values, rows)| (values, self.only(&rows))).collect()
    }

    /// Returns whether the surface of the substrate folds over before the puncture of a design ends.
    pub(crate) fn folded(&self, row: usize) -> bool {
        !self.text(name::FOLD_FORCE, row).is_empty()
    }

    /// Returns whether the surface folds over under any of the designs.
    pub(crate) fn any_folded(&self) -> bool {
        (0..self.count).any(|row| self.folded(row))
    }

    /// Returns the designs in some rows.
    pub(crate) fn only(&self, rows: &[usize]) -> Self {
        let column = |header: &String| {
            let cells = rows.iter().map(|&row| self.text(header, row).to_owned());
            (header.clone(), cells.collect())
        };
        Self::new(self.headers.iter().map(column))
    }

    /// Returns the different texts of a column.
    pub(crate) fn texts(&self, column: &str) -> BTreeSet<&str> {
        (0..self.count).map(|row| self.text(column, row)).collect()
    }

    /// Returns the colours and marks of the slants.
    pub(crate) fn palette(&self) -> SlantPalette {
        SlantPalette::new(self.numbers("slant_deg"))
    }

    /// Returns the different numbers of a column, sorted.
    pub(crate) fn values(&self, column: &str) -> Vec<f64> {
        let mut values: Vec<f64> = self.numbers(column).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    }
}
