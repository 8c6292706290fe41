//! The matrix of the derivatives, as a system sees it.

/// A matrix that derivatives are added to.
pub trait Tangent {
    /// Adds `value` to the entry at (`row`, `column`).
    fn add(&mut self, row: usize, column: usize, value: f64);

    /// Adds `values` to the entries of a row from `column` on.
    fn add_row(&mut self, row: usize, column: usize, values: impl ExactSizeIterator<Item = f64>) {
        for (k, value) in values.enumerate() {
            self.add(row, column + k, value);
        }
    }

    /// Adds `values` to the entries from the one at (`row`, `column`) down the diagonal, of which no unknown is that of an inactive
    /// constraint.
    fn add_diagonal(&mut self, row: usize, column: usize, values: &[f64]) {
        for (k, value) in values.iter().enumerate() {
            self.add(row + k, column + k, *value);
        }
    }

    /// Adds `values` to the entries from the one at (`row`, `column`) on. No unknown of these rows and columns is that of an inactive
    /// constraint.
    fn add_block<const R: usize, const C: usize>(
        &mut self,
        row: usize,
        column: usize,
        values: &[[f64; C]; R],
    ) {
        for (i, values) in values.iter().enumerate() {
            for (j, value) in values.iter().enumerate() {
                self.add(row + i, column + j, *value);
            }
        }
    }
}

/// A function that is shown every entry, in the order in which they are added.
impl<F: FnMut(usize, usize, f64)> Tangent for F {
    fn add(&mut self, row: usize, column: usize, value: f64) {
        self(row, column, value);
    }
}
