//! Band matrices and their LU factorisation.
//!
//! Unknowns are numbered so that every equation couples only unknowns with close numbers. The cost
//! of a factorisation is then proportional to the number of unknowns. A general sparse LU
//! factorisation needs more than twice the time on such matrices.
#![expect(
    clippy::inline_always,
    reason = "only code that is inlined into its caller can use wide registers"
)]

use std::ops::Range;

use pulp::{Simd, WithSimd};

use crate::tangent::Tangent;

/// Error for a matrix that cannot be factorised, because a column has no usable pivot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the matrix is singular: no pivot in column {column} of {size}")]
pub struct SingularMatrix {
    /// Index of the column without a pivot, from 0.
    pub column: usize,
    /// Number of columns of the matrix.
    pub size: usize,
}

/// Square band matrix: entries more than `half` columns from the diagonal are zero.
#[derive(Clone, Debug)]
pub struct BandMatrix {
    /// Number of rows.
    size: usize,
    /// Half-bandwidth.
    half: usize,
    /// Entries row by row; row `i` contains the columns `i − half ..= i + half`.
    rows: Vec<f64>,
    /// For each row, the first written entry and one past the last written entry.
    ///
    /// Both are counted from column `i − half`. Entries outside this range are zero.
    used: Vec<[usize; 2]>,
}

impl BandMatrix {
    /// Creates a zero matrix of `size` rows with half-bandwidth `half`.
    pub fn new(size: usize, half: usize) -> Self {
        Self {
            size,
            half,
            rows: vec![0.0; size * (2 * half + 1)],
            used: vec![[2 * half + 1, 0]; size],
        }
    }

    /// Returns the number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Returns the half-bandwidth.
    pub fn half_bandwidth(&self) -> usize {
        self.half
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        for row in 0..self.size {
            self.clear_row(row);
        }
    }

    /// Sets every entry of a row to zero.
    pub fn clear_row(&mut self, row: usize) {
        let start = row * self.width();
        // Clear only written entries, because rows of open contacts are nearly empty.
        let [first, end] = std::mem::replace(&mut self.used[row], [2 * self.half + 1, 0]);
        if first < end {
            self.rows[start + first..start + end].fill(0.0);
        }
    }

    /// Copies all entries from `other`, a matrix of the same shape.
    pub(crate) fn set(&mut self, other: &Self) {
        let width = self.width();
        let rows = self.rows.chunks_exact_mut(width).zip(other.rows.chunks_exact(width));
        for ((row, entries), (used, other)) in rows.zip(self.used.iter_mut().zip(&other.used)) {
            let [first, end] = [used[0].min(other[0]), used[1].max(other[1])];
            if first < end {
                row[first..end].copy_from_slice(&entries[first..end]);
            }
            *used = *other;
        }
    }

    /// Returns the entry at (`row`, `column`).
    ///
    /// # Panics
    /// If the entry lies outside the band.
    pub fn get(&self, row: usize, column: usize) -> f64 {
        self.rows[row * self.width() + self.offset(row, column)]
    }

    /// Returns the range of columns of a row that lie within the band.
    pub fn columns(&self, row: usize) -> Range<usize> {
        row.saturating_sub(self.half)..(row + self.half + 1).min(self.size)
    }

    /// Returns the stored entries of a row, from column `row − half` on.
    fn row(&self, row: usize) -> &[f64] {
        &self.rows[row * self.width()..][..self.width()]
    }

    /// Returns the number of stored entries of each row.
    fn width(&self) -> usize {
        2 * self.half + 1
    }

    /// Returns the index of a column among the stored entries of a row.
    fn offset(&self, row: usize, column: usize) -> usize {
        assert!(
            row.abs_diff(column) <= self.half && column < self.size,
            "entry ({row}, {column}) lies outside the band of half-width {}",
            self.half
        );
        column + self.half - row
    }
}

impl Tangent for BandMatrix {
    /// Adds `value` to the entry at (`row`, `column`).
    ///
    /// # Panics
    /// If the entry lies outside the band.
    fn add(&mut self, row: usize, column: usize, value: f64) {
        let offset = self.offset(row, column);
        let start = row * self.width();
        self.rows[start + offset] += value;
        let [first, end] = self.used[row];
        self.used[row] = [first.min(offset), end.max(offset + 1)];
    }

    fn add_row(&mut self, row: usize, column: usize, values: impl ExactSizeIterator<Item = f64>) {
        let Some(others) = values.len().checked_sub(1) else { return };
        let (offset, last) = (self.offset(row, column), self.offset(row, column + others));
        let start = row * self.width();
        for (entry, value) in self.rows[start + offset..=start + last].iter_mut().zip(values) {
            *entry += value;
        }
        let [first, end] = self.used[row];
        self.used[row] = [first.min(offset), end.max(last + 1)];
    }
}

/// LU factors of a [`BandMatrix`], with row scaling and partial pivoting.
///
/// Unknowns that are known to be zero, such as the forces of open contacts, are left out with their
/// equations. The remaining matrix is a smaller and narrower band matrix. Storage is reused for
/// further factorisations.
///
/// Row exchanges widen the upper factor to twice the half-bandwidth (Golub & Van Loan, *Matrix
/// Computations*, 4th ed. 2013, §4.3.5, isbn 978-1-4214-0794-4). Most rows stay narrower, so each
/// row is processed only up to its last non-zero entry.
#[derive(Clone, Debug)]
pub struct BandLu {
    /// Number of unknowns, including those left out.
    size: usize,
    /// Half-bandwidth.
    half: usize,
    /// Unknowns that are not left out, in ascending order.
    ///
    /// Rows and columns of the factors are positions in this list.
    kept: Vec<usize>,
    /// Upper factor row by row; row `i` contains the columns `i − half ..= i + 2 half`.
    ///
    /// The columns from the diagonal up to, but not including, `ends[i]` are in use.
    upper: Vec<f64>,
    /// For each row, one past its last column that may be non-zero.
    ends: Vec<usize>,
    /// For each column, the last row that may be non-zero in this column.
    reach: Vec<usize>,
    /// Lower factor; row `k` contains the multipliers that eliminate column `k`.
    ///
    /// The multipliers belong to the rows `k + 1 ..= reach[k]`.
    lower: Vec<f64>,
    /// For each row, the row with which it was exchanged.
    pivots: Vec<usize>,
    /// Inverses of the diagonal entries of the upper factor.
    inverses: Vec<f64>,
    /// Scale factor of each row.
    scales: Vec<f64>,
    /// Storage for right-hand side and solution at the unknowns in `kept`.
    packed: Vec<f64>,
}

/// Factorisation with the widest registers of the processor.
///
/// Products are rounded before they are subtracted (no fused operations), so that the factors have
/// the same bits on every machine.
struct Factorisation<'a> {
    lu: &'a mut BandLu,
    matrix: &'a BandMatrix,
}

impl WithSimd for Factorisation<'_> {
    type Output = Result<(), SingularMatrix>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self { lu, matrix } = self;
        lu.load(matrix)?;
        for k in 0..lu.kept.len() {
            lu.pivot(k)?;
            lu.eliminate(simd, k);
        }
        Ok(())
    }
}

impl BandLu {
    /// Creates storage for the factors of matrices with `size` rows and half-bandwidth `half`.
    pub fn new(size: usize, half: usize) -> Self {
        Self {
            size,
            half,
            kept: Vec::with_capacity(size),
            upper: vec![0.0; size * (3 * half + 1)],
            ends: vec![0; size],
            reach: Vec::with_capacity(size),
            lower: vec![0.0; size * half],
            pivots: vec![0; size],
            inverses: vec![1.0; size],
            scales: vec![1.0; size],
            packed: Vec::with_capacity(size),
        }
    }

    /// Factorises `matrix` without some rows and columns, and replaces earlier factors.
    ///
    /// `left_out` is true for each row and column that is left out.
    ///
    /// # Errors
    /// If a column has no finite, non-zero pivot.
    pub fn factorise(
        &mut self,
        matrix: &BandMatrix,
        left_out: &[bool],
    ) -> Result<(), SingularMatrix> {
        debug_assert!(matrix.size == self.size && matrix.half == self.half);
        // Most unknowns of a row of scales are forces of open contacts. Without these unknowns the
        // matrix is smaller and its band narrower.
        self.kept.clear();
        self.kept.extend((0..self.size).filter(|&i| !left_out[i]));
        pulp::Arch::new().dispatch(Factorisation { lu: self, matrix })
    }

    /// Returns true if the determinant of the factorised matrix is negative.
    pub(crate) fn is_negative(&self) -> bool {
        let rows = self.pivots.iter().zip(&self.inverses).take(self.kept.len()).enumerate();
        rows.fold(false, |negative, (k, (&row, inverse))| negative ^ (row != k) ^ (*inverse < 0.0))
    }

    /// Replaces the right-hand side `x` by the solution.
    ///
    /// At unknowns that are left out, the right-hand side is ignored and the solution is zero.
    pub fn solve(&mut self, x: &mut [f64]) {
        let mut packed = std::mem::take(&mut self.packed);
        packed.clear();
        packed.extend(self.kept.iter().zip(&self.scales).map(|(&index, scale)| x[index] * scale));
        self.substitute(&mut packed);
        x.fill(0.0);
        for (&index, &solution) in self.kept.iter().zip(&packed) {
            x[index] = solution;
        }
        self.packed = packed;
    }

    /// Substitutes forward and back; `x` contains only the unknowns in `kept`.
    fn substitute(&self, x: &mut [f64]) {
        for k in 0..x.len() {
            x.swap(k, self.pivots[k]);
            let factor = x[k];
            // In most right-hand sides only the entry of the load is non-zero, so skip zeros.
            if factor != 0.0 {
                let multipliers = &self.lower[k * self.half..][..self.reach[k] - k];
                for (x, multiplier) in x[k + 1..].iter_mut().zip(multipliers) {
                    *x -= factor * multiplier;
                }
            }
        }
        for k in (0..x.len()).rev() {
            let row = &self.upper[self.diagonal(k) + 1..][..self.ends[k] - k - 1];
            let sum: f64 = x[k + 1..].iter().zip(row).map(|(x, u)| x * u).sum();
            x[k] = (x[k] - sum) * self.inverses[k];
        }
    }

    /// Copies all rows of `matrix` that are not left out, each divided by its largest entry.
    fn load(&mut self, matrix: &BandMatrix) -> Result<(), SingularMatrix> {
        let count = self.kept.len();
        self.reach.clear();
        self.reach.extend(0..count);
        for i in 0..count {
            let first = self.load_row(i, matrix)?;
            self.reach[first] = self.reach[first].max(i);
        }
        for k in 1..count {
            self.reach[k] = self.reach[k].max(self.reach[k - 1]);
        }
        Ok(())
    }

    /// Copies row `i`, divided by its largest entry, and returns the first column in use.
    ///
    /// This column is not beyond the diagonal.
    fn load_row(&mut self, i: usize, matrix: &BandMatrix) -> Result<usize, SingularMatrix> {
        let Range { start: first, end } = self.columns(i, matrix);
        let row = self.kept[i];
        let start = i * (3 * self.half + 1);
        let row_values = &mut self.upper[start..][..end + self.half - i];
        let (before, entries) = row_values.split_at_mut(first + self.half - i);
        before.fill(0.0);
        let written = matrix.row(row);
        let columns = &self.kept[first..end];
        if columns.last().is_some_and(|last| last - columns[0] == columns.len() - 1) {
            entries.copy_from_slice(&written[columns[0] + self.half - row..][..columns.len()]);
        } else {
            for (entry, &column) in entries.iter_mut().zip(columns) {
                *entry = written[column + self.half - row];
            }
        }
        let larger =
            |largest: f64, entry: &f64| if entry.abs() > largest { entry.abs() } else { largest };
        let largest = entries.iter().fold(0.0, larger);
        // Force balances and gap conditions differ in size by the ratio of the moduli. Without
        // scaling, the choice of units would determine the pivots.
        let scale = 1.0 / largest;
        if !(scale.is_finite() && scale > 0.0) {
            return Err(self.singular(i));
        }
        for entry in entries {
            *entry *= scale;
        }
        self.scales[i] = scale;
        self.ends[i] = end;
        Ok(first)
    }

    /// Returns the range of positions of columns that row `i` uses, including the diagonal.
    fn columns(&self, i: usize, matrix: &BandMatrix) -> Range<usize> {
        let row = self.kept[i];
        let [leftmost, rightmost] = matrix.used[row].map(|offset| row + offset);
        let first = self.kept[..i].partition_point(|&j| j + self.half < leftmost);
        let after = self.kept[i + 1..].partition_point(|&j| j + self.half < rightmost);
        first..i + 1 + after
    }

    /// Creates the error for a column, given by its position.
    fn singular(&self, column: usize) -> SingularMatrix {
        SingularMatrix { column: self.kept[column], size: self.size }
    }

    /// Exchanges row `k` with the row, among `k` and the rows below, of the largest pivot.
    ///
    /// The pivot is the entry in column `k`.
    fn pivot(&mut self, k: usize) -> Result<(), SingularMatrix> {
        let (mut row, mut value, mut largest) = (k, 0.0, 0.0);
        let mut entry = self.diagonal(k);
        for candidate in k..=self.reach[k] {
            let x = self.upper[entry];
            if x.abs() > largest {
                (row, value, largest) = (candidate, x, x.abs());
            }
            // In the next row, the same column is stored one place earlier.
            entry += 3 * self.half;
        }
        // Reject only a pivot of exactly zero. If the matrix is nearly singular, Newton's method
        // detects this by its steps.
        if value == 0.0 || !value.is_finite() {
            return Err(self.singular(k));
        }
        self.pivots[k] = row;
        self.inverses[k] = 1.0 / value;
        if row != k {
            self.exchange(k, row);
        }
        Ok(())
    }

    /// Exchanges row `k` with `row`, a row below it, from column `k` on.
    fn exchange(&mut self, k: usize, row: usize) {
        let ends = [self.ends[k], self.ends[row]];
        let end = ends[0].max(ends[1]);
        self.extend(k, end);
        self.extend(row, end);
        let (first, second) = (self.diagonal(k), self.diagonal(row) + k - row);
        let (head, tail) = self.upper.split_at_mut(second);
        head[first..first + end - k].swap_with_slice(&mut tail[..end - k]);
        self.ends[k] = ends[1];
        self.ends[row] = ends[0].max(row + 1);
    }

    /// Subtracts multiples of row `k` from the rows below to eliminate their entries in column `k`.
    #[inline(always)]
    fn eliminate<S: Simd>(&mut self, simd: S, k: usize) {
        let (below, count) = (self.reach[k] - k, self.ends[k] - k);
        if below == 0 {
            return;
        }
        let diagonal = self.diagonal(k);
        let (head, tail) = self.upper.split_at_mut((k + 1) * (3 * self.half + 1));
        let pivot = &head[diagonal + 1..][..count - 1];
        let inverse = self.inverses[k];
        // The rows below from column `k` on. In each row, column `k` is stored one place earlier
        // than in the row above.
        let rows = tail[self.half - 1..].chunks_mut(3 * self.half);
        let multipliers = &mut self.lower[k * self.half..][..below];
        let ends = &mut self.ends[k + 1..][..below];
        for ((row, end), multiplier) in rows.zip(ends).zip(multipliers) {
            *multiplier = row[0] * inverse;
            if *multiplier != 0.0 {
                let used = *end - k;
                if used < count {
                    row[used..count].fill(0.0);
                    *end = k + count;
                }
                subtract(simd, &mut row[1..count], *multiplier, pivot);
            }
        }
    }

    /// Extends the columns in use of a row up to, but not including, `end`, with zeros.
    fn extend(&mut self, row: usize, end: usize) {
        let used = self.ends[row];
        if used < end {
            let diagonal = self.diagonal(row);
            self.upper[diagonal + used - row..diagonal + end - row].fill(0.0);
            self.ends[row] = end;
        }
    }

    /// Returns the index of the diagonal entry of a row in `upper`.
    fn diagonal(&self, row: usize) -> usize {
        row * (3 * self.half + 1) + self.half
    }
}

/// Computes `x ← x − factor y`.
#[inline(always)]
fn subtract<S: Simd>(simd: S, x: &mut [f64], factor: f64, y: &[f64]) {
    let (wide, rest) = S::as_mut_simd_f64s(x);
    let (by, rest_by) = S::as_simd_f64s(y);
    let factors = simd.splat_f64s(factor);
    for (x, y) in wide.iter_mut().zip(by) {
        *x = simd.sub_f64s(*x, simd.mul_f64s(factors, *y));
    }
    for (x, y) in rest.iter_mut().zip(rest_by) {
        *x -= factor * y;
    }
}

#[cfg(test)]
mod tests {
    use super::{BandLu, BandMatrix, Tangent};

    #[test]
    fn the_sign_of_the_determinant_follows_from_exchanges_and_pivots() {
        for ([a, b, c, d], left_out, is_negative) in [
            ([2.0, 1.0, 1.0, 2.0], [false; 2], false),
            ([1.0, 2.0, 2.0, 1.0], [false; 2], true),
            ([0.0, 1.0, -1.0, 0.0], [false; 2], false),
            ([-1.0, 0.0, 0.0, 1.0], [false; 2], true),
            // Rows that are left out do not affect the sign.
            ([-1.0, 0.0, 0.0, 1.0], [true, false], false),
        ] {
            let mut matrix = BandMatrix::new(2, 1);
            for (row, column, value) in [(0, 0, a), (0, 1, b), (1, 0, c), (1, 1, d)] {
                matrix.add(row, column, value);
            }
            let mut lu = BandLu::new(2, 1);
            lu.factorise(&matrix, &left_out).unwrap();
            assert_eq!(lu.is_negative(), is_negative, "{a} {b} {c} {d}");
        }
    }
}
