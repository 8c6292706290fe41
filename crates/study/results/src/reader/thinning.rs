//! Thins a long table to equidistant rows and the best rows by some columns.

use super::table::Table;
use crate::columns::{Goal, plain_goal};
use crate::folder::MEASURE_TABLES;

/// Collects some rows of a long table: equidistant rows, and the best rows by some columns.
#[derive(Debug)]
pub(super) struct Thinning {
    /// Distance of the equidistant rows.
    every: usize,
    /// Position of each kept row in the long table.
    positions: Vec<usize>,
    /// The kept rows.
    table: Table,
    best: Vec<BestRow>,
}

/// The best row by one column: its value, its position and its cells.
#[derive(Debug)]
struct BestRow {
    column: usize,
    goal: Goal,
    row: Option<(f64, usize, csv::StringRecord)>,
}

impl Thinning {
    /// Prepares to keep about `most` of the `rows` rows of a table.
    ///
    /// `table` is empty and receives the kept rows.
    pub fn new(table: Table, rows: usize, most: usize) -> Self {
        let best = MEASURE_TABLES.iter().filter_map(|(name, _)| {
            let column = table.column(name)?;
            Some(BestRow { column, goal: plain_goal(name)?, row: None })
        });
        // If all rows are kept, the best rows are among them.
        let best = if rows > most { best.collect() } else { Vec::new() };
        // Without a limit `rows` is 0, and every row is kept.
        let every = rows.div_ceil(most.max(1)).max(1);
        Self { every, positions: Vec::new(), table, best }
    }

    /// Keeps `row` if `position` is a multiple of the distance, or if the row is the best so far.
    pub fn visit(&mut self, position: usize, row: &csv::StringRecord) {
        for best in &mut self.best {
            best.visit(position, row);
        }
        if position.is_multiple_of(self.every) {
            self.positions.push(position);
            self.table.push(row);
        }
    }

    /// Returns the kept rows in the order of the table, each once.
    pub fn finish(mut self) -> Table {
        if self.best.is_empty() {
            return self.table;
        }
        for (_, position, row) in self.best.into_iter().filter_map(|best| best.row) {
            self.positions.push(position);
            self.table.push(&row);
        }
        // Remove duplicates: a row may be equidistant, and the best row by several columns.
        let mut order: Vec<usize> = (0..self.positions.len()).collect();
        order.sort_by_key(|k| self.positions[*k]);
        order.dedup_by_key(|k| self.positions[*k]);
        self.table.only(&order)
    }
}

impl BestRow {
    fn visit(&mut self, position: usize, row: &csv::StringRecord) {
        // A failed design has an empty cell and cannot be the best.
        let cell = row.get(self.column).and_then(|cell| cell.parse::<f64>().ok());
        let Some(value) = cell else { return };
        if self.row.as_ref().is_none_or(|(best, ..)| self.goal.prefers(value, *best)) {
            self.row = Some((value, position, row.clone()));
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
        for position in 0..rows {
            let penetration = (position as f64 - 7.0).abs();
            let row = [position.to_string(), penetration.to_string()];
            thinning.visit(position, &csv::StringRecord::from(row.to_vec()));
        }
        let table = thinning.finish();
        (0..table.length()).map(|row| table.name(row).to_owned()).collect()
    }

    #[test]
    fn thinning_keeps_short_tables_and_the_best_rows_of_long_tables() {
        assert_eq!(thinned(3, 5), ["0", "1", "2"]);
        assert_eq!(thinned(20, 4), ["0", "5", "7", "10", "15"]);
    }
}
