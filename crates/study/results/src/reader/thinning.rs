//! A long table thinned out: every so many rows, and those that are best by one value.

use super::table::Table;
use crate::columns::{Goal, plain_goal};
use crate::folder::MEASURE_TABLES;

/// Rows of a table that are kept, with their places.
#[derive(Debug)]
pub(super) struct Thinning {
    every: usize,
    places: Vec<usize>,
    table: Table,
    best: Vec<BestRow>,
}

/// The best row by one column.
#[derive(Debug)]
struct BestRow {
    column: usize,
    goal: Goal,
    row: Option<(f64, usize, csv::StringRecord)>,
}

impl Thinning {
    /// Of a table like `table`, which is empty, with so many rows, about `most`.
    pub fn new(table: Table, rows: usize, most: usize) -> Self {
        let best = MEASURE_TABLES.iter().filter_map(|(name, _)| {
            let column = table.column(name)?;
            Some(BestRow { column, goal: plain_goal(name)?, row: None })
        });
        // A table that is kept whole has its best rows anyway.
        let best = if rows > most { best.collect() } else { Vec::new() };
        // Of a table without a limit no rows were counted, and every one is kept.
        let every = rows.div_ceil(most.max(1)).max(1);
        Self { every, places: Vec::new(), table, best }
    }

    /// Takes the row at `place` into account.
    pub fn visit(&mut self, place: usize, row: &csv::StringRecord) {
        for best in &mut self.best {
            best.visit(place, row);
        }
        if place.is_multiple_of(self.every) {
            self.places.push(place);
            self.table.push(row);
        }
    }

    /// The rows that are kept, in their order.
    pub fn finish(mut self) -> Table {
        if self.best.is_empty() {
            return self.table;
        }
        for (_, place, row) in self.best.into_iter().filter_map(|best| best.row) {
            self.places.push(place);
            self.table.push(&row);
        }
        // A row may be the best by several values and stand at one of the distances, too.
        let mut order: Vec<usize> = (0..self.places.len()).collect();
        order.sort_by_key(|k| self.places[*k]);
        order.dedup_by_key(|k| self.places[*k]);
        self.table.only(&order)
    }
}

impl BestRow {
    fn visit(&mut self, place: usize, row: &csv::StringRecord) {
        // A design that failed has an empty cell, and is the best by nothing.
        let cell = row.get(self.column).and_then(|cell| cell.parse::<f64>().ok());
        let Some(value) = cell else { return };
        if self.row.as_ref().is_none_or(|(best, ..)| self.goal.prefers(value, *best)) {
            self.row = Some((value, place, row.clone()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn thinned(rows: usize, most: usize) -> Vec<String> {
        let header = ["design", "penetration"].map(str::to_owned);
        let table = Table::new(header.to_vec(), |_| true);
        let mut thinning = Thinning::new(table, rows, most);
        for place in 0..rows {
            let penetration = (place as f64 - 7.0).abs();
            let row = [place.to_string(), penetration.to_string()];
            thinning.visit(place, &csv::StringRecord::from(row.to_vec()));
        }
        let table = thinning.finish();
        (0..table.length()).map(|row| table.name(row).to_owned()).collect()
    }

    #[test]
    fn a_short_table_is_kept_and_a_long_one_keeps_its_best() {
        assert_eq!(thinned(3, 5), ["0", "1", "2"]);
        assert_eq!(thinned(20, 4), ["0", "5", "7", "10", "15"]);
    }
}
