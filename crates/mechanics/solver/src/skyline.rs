//! Symmetric skyline matrices and their number of negative eigenvalues.

use crate::linear::SingularMatrix;

/// Symmetric matrix that stores each row from its first non-zero column to the diagonal.
///
/// Factorisation replaces the matrix by the factors of `L D Lᵀ`: the unit lower triangular `L` left
/// of the diagonal, and `D` on the diagonal. Rows are not exchanged, so the first columns of the
/// rows do not change. By Sylvester's law of inertia, the number of negative entries of `D` is the
/// number of negative eigenvalues of the matrix.
#[derive(Clone, Debug)]
pub struct SkylineMatrix {
    /// First stored column of each row.
    first: Vec<usize>,
    /// Index in `values` of the first value of each row.
    starts: Vec<usize>,
    /// Stored values, row by row.
    values: Vec<f64>,
}

impl SkylineMatrix {
    /// Creates a zero matrix; `first` is the first stored column of each row.
    ///
    /// It must not lie beyond the diagonal of the row.
    pub fn new(first: Vec<usize>) -> Self {
        let (mut starts, mut stored) = (Vec::with_capacity(first.len()), 0);
        for (row, first) in first.iter().enumerate() {
            starts.push(stored);
            stored += row + 1 - first;
        }
        Self { first, starts, values: vec![0.0; stored] }
    }

    /// Returns the number of rows.
    pub fn size(&self) -> usize {
        self.first.len()
    }

    /// Adds `value` to the entry at (`row`, `column`).
    ///
    /// Entries above the diagonal are ignored.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        if column <= row {
            debug_assert!(
                column >= self.first[row],
                "entry ({row}, {column}) is left of the skyline"
            );
            self.values[self.starts[row] + column - self.first[row]] += value;
        }
    }

    /// Returns the stored entries of a row in the columns `from..to`.
    fn entries(&self, row: usize, from: usize, to: usize) -> &[f64] {
        let start = self.starts[row] - self.first[row];
        &self.values[start + from..start + to]
    }

    /// Replaces the matrix by its factors `L` and `D`.
    ///
    /// # Errors
    /// If a pivot is zero or not finite.
    pub fn factorise(mut self) -> Result<Self, SingularMatrix> {
        let size = self.size();
        for row in 0..size {
            let first = self.first[row];
            // The entries of the row become the entries of `L D`; `scale_row` then computes `L`.
            for column in first..row {
                let from = first.max(self.first[column]);
                let known = self.entries(row, from, column).iter();
                let terms = known.zip(self.entries(column, from, column)).map(|(a, b)| a * b);
                let taken: f64 = terms.sum();
                self.add(row, column, -taken);
            }
            let pivot = self.scale_row(row);
            // Small pivots are accepted, because only the signs of the pivots are needed.
            if pivot == 0.0 || !pivot.is_finite() {
                return Err(SingularMatrix { column: row, size });
            }
        }
        Ok(self)
    }

    /// Replaces a row of `L D` by the row of `L`, and returns the entry of `D` of this row.
    fn scale_row(&mut self, row: usize) -> f64 {
        let first = self.first[row];
        let mut taken = 0.0;
        for column in first..row {
            let pivot = self.pivot(column);
            let entry = &mut self.values[self.starts[row] + column - first];
            let factor = *entry / pivot;
            taken += factor * *entry;
            *entry = factor;
        }
        self.add(row, row, -taken);
        self.pivot(row)
    }

    /// Returns the diagonal entry of a row, which is its entry of `D` after factorisation.
    fn pivot(&self, row: usize) -> f64 {
        self.entries(row, row, row + 1)[0]
    }

    /// Returns the number of negative eigenvalues; the matrix must be factorised.
    pub fn negative_eigenvalues(&self) -> usize {
        (0..self.size()).filter(|&row| self.pivot(row) < 0.0).count()
    }

    /// Replaces the right-hand side `x` by the solution; the matrix must be factorised.
    pub fn solve(&self, x: &mut [f64]) {
        for row in 0..self.size() {
            let first = self.first[row];
            let factors = self.entries(row, first, row).iter();
            x[row] -= factors.zip(&x[first..row]).map(|(l, x)| l * x).sum::<f64>();
        }
        for (row, x) in x.iter_mut().enumerate() {
            *x /= self.pivot(row);
        }
        for row in (0..self.size()).rev() {
            let first = self.first[row];
            let (head, tail) = x.split_at_mut(row);
            for (x, l) in head[first..].iter_mut().zip(self.entries(row, first, row)) {
                *x -= l * tail[0];
            }
        }
    }
}
