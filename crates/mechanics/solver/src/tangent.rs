//! Interface of matrices in which a system assembles its derivatives.

/// Matrix to which a system adds derivatives.
pub trait Tangent {
    /// Adds `value` to the entry at (`row`, `column`).
    fn add(&mut self, row: usize, column: usize, value: f64);

    /// Adds `values` to successive entries of a row from `column` on.
    ///
    /// The columns must belong to one block, and none of them to an inactive constraint.
    fn add_row(&mut self, row: usize, column: usize, values: impl ExactSizeIterator<Item = f64>) {
        for (k, value) in values.enumerate() {
            self.add(row, column + k, value);
        }
    }

    /// Adds `values` along the diagonal that starts at (`row`, `column`).
    ///
    /// None of these rows and columns may belong to an inactive constraint.
    fn add_diagonal(&mut self, row: usize, column: usize, values: &[f64]) {
        for (k, value) in values.iter().enumerate() {
            self.add(row + k, column + k, *value);
        }
    }

    /// Adds a block of `values` with its first entry at (`row`, `column`).
    ///
    /// None of these rows and columns may belong to an inactive constraint.
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

/// Implementation for functions, which receive row, column and value of every addition.
impl<F: FnMut(usize, usize, f64)> Tangent for F {
    fn add(&mut self, row: usize, column: usize, value: f64) {
        self(row, column, value);
    }
}
