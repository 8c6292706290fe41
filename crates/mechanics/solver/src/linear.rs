//! Linear solves: LU factorisation of a band matrix.
//!
//! Unknowns are numbered so that every equation couples unknowns a few places apart. One factorisation then costs time
//! proportional to their number. A general sparse LU needs more than twice as long on such matrices
//! (`benches/linear.rs` compares them).
#![expect(
    clippy::inline_always,
    reason = "only what is compiled into its caller may use wide registers"
)]

use std::ops::Range;

use pulp::{Simd, WithSimd};

use crate::tangent::Tangent;

/// A matrix has no LU factorisation in floating point: a column without a usable pivot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the matrix is singular: no pivot in column {column} of {size}")]
pub struct SingularMatrix {
    /// Column, from 0.
    pub column: usize,
    /// Number of columns.
    pub size: usize,
}

/// A square matrix with non-zeros only within `half` places of the diagonal.
#[derive(Clone, Debug)]
pub struct BandMatrix {
    size: usize,
    half: usize,
    /// Row `i` holds the columns `i − half ..= i + half`.
    rows: Vec<f64>,
    /// First place of each row that has been written to, and one past the last: outside them it is zero.
    used: Vec<[usize; 2]>,
}

impl BandMatrix {
    /// A zero matrix of `size` rows with half-bandwidth `half`.
    pub fn new(size: usize, half: usize) -> Self {
        Self {
            size,
            half,
            rows: vec![0.0; size * (2 * half + 1)],
            used: vec![[2 * half + 1, 0]; size],
        }
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Half-bandwidth.
    pub fn half_bandwidth(&self) -> usize {
        self.half
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        for row in 0..self.size {
            self.clear_row(row);
        }
    }

    /// Replaces a row by zeros.
    pub fn clear_row(&mut self, row: usize) {
        let start = row * self.width();
        // Only what was written to is cleared: rows of open contacts are nearly empty.
        let [first, end] = std::mem::replace(&mut self.used[row], [2 * self.half + 1, 0]);
        if first < end {
            self.rows[start + first..start + end].fill(0.0);
        }
    }

    /// Replaces all entries by those of a matrix of the same shape.
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

    /// The entry at (`row`, `column`), which must lie within the band.
    ///
    /// # Panics
    /// If the entry lies outside the band.
    pub fn get(&self, row: usize, column: usize) -> f64 {
        self.rows[row * self.width() + self.place(row, column)]
    }

    /// The columns that a row may use.
    pub fn columns(&self, row: usize) -> Range<usize> {
        row.saturating_sub(self.half)..(row + self.half + 1).min(self.size)
    }

    /// The entries of a row, from `half` places before the diagonal on.
    fn row(&self, row: usize) -> &[f64] {
        &self.rows[row * self.width()..][..self.width()]
    }

    fn width(&self) -> usize {
        2 * self.half + 1
    }

    /// Place of a column in the stored part of a row.
    fn place(&self, row: usize, column: usize) -> usize {
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
        let place = self.place(row, column);
        let start = row * self.width();
        self.rows[start + place] += value;
        let [first, end] = self.used[row];
        self.used[row] = [first.min(place), end.max(place + 1)];
    }

    fn add_row(&mut self, row: usize, column: usize, values: impl ExactSizeIterator<Item = f64>) {
        let Some(others) = values.len().checked_sub(1) else { return };
        let (place, last) = (self.place(row, column), self.place(row, column + others));
        let start = row * self.width();
        for (entry, value) in self.rows[start + place..=start + last].iter_mut().zip(values) {
            *entry += value;
        }
        let [first, end] = self.used[row];
        self.used[row] = [first.min(place), end.max(last + 1)];
    }
}

/// LU factors of a [`BandMatrix`], with rows scaled to equal size and exchanged for the largest
/// pivot. The storage is reused from one factorisation to the next.
///
/// Unknowns that are known to vanish, such as the forces of open contacts, are left out: what remains
/// is a band matrix again, a smaller and a narrower one.
///
/// Row exchanges widen the upper factor to twice the half-bandwidth (Golub & Van Loan, *Matrix
/// Computations*, 4th ed. 2013, §4.3.5, isbn 978-1-4214-0794-4). Most rows need less, and each is worked on
/// up to its last non-zero only.
#[derive(Clone, Debug)]
pub struct BandLu {
    size: usize,
    half: usize,
    /// The unknowns that are solved for, in order. Rows and columns below are numbered among them.
    kept: Vec<usize>,
    /// Row `i` of the upper factor: columns `i − half ..= i + 2 half`, of which those from the
    /// diagonal to `ends[i]` are in use.
    upper: Vec<f64>,
    /// One past the last column of each row that may be non-zero.
    ends: Vec<usize>,
    /// The last row that reaches each column.
    reach: Vec<usize>,
    /// Row `k`: the multipliers that column `k` was eliminated with, rows `k + 1 ..= reach[k]`.
    lower: Vec<f64>,
    pivots: Vec<usize>,
    /// One over the diagonal of the upper factor.
    inverses: Vec<f64>,
    /// Factor by which each row was scaled.
    scales: Vec<f64>,
    /// Storage for the right-hand side and the solution among the unknowns that are kept.
    packed: Vec<f64>,
}

/// The factorisation of a matrix with the widest registers of the processor. Each entry is multiplied and subtracted as with narrow
/// ones, never fused, so the factors have the same bits on every machine.
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
    /// Storage for the factors of matrices of `size` rows and half-bandwidth `half`.
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

    /// Factorises what remains of `matrix` without the rows and columns of the unknowns that are `left_out`, which are known to vanish,
    /// and forgets the factors held before.
    ///
    /// # Errors
    /// If a column has no finite, non-zero pivot.
    pub fn factorise(
        &mut self,
        matrix: &BandMatrix,
        left_out: &[bool],
    ) -> Result<(), SingularMatrix> {
        debug_assert!(matrix.size == self.size && matrix.half == self.half);
        // Most unknowns of a row are forces of open contacts; without them the band is narrower, too.
        self.kept.clear();
        self.kept.extend((0..self.size).filter(|&i| !left_out[i]));
        pulp::Arch::new().dispatch(Factorisation { lu: self, matrix })
    }

    /// Whether the determinant of what remains is negative.
    pub(crate) fn is_negative(&self) -> bool {
        let rows = self.pivots.iter().zip(&self.inverses).take(self.kept.len()).enumerate();
        rows.fold(false, |negative, (k, (&row, inverse))| negative ^ (row != k) ^ (*inverse < 0.0))
    }

    /// Solves in place: `x` holds the right-hand side, then the solution. Where an unknown was left out, the
    /// right-hand side does not count and the solution is zero.
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

    /// Forward and back substitution among the unknowns that are kept.
    fn substitute(&self, x: &mut [f64]) {
        for k in 0..x.len() {
            x.swap(k, self.pivots[k]);
            let factor = x[k];
            // The right-hand side is mostly that of the load: zeros before it need no work.
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

    /// Copies the rows of `matrix` that are kept, each divided by its largest entry.
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

    /// Copies row `i`, divided by its largest entry. Returns its first column, or the diagonal where that comes before.
    fn load_row(&mut self, i: usize, matrix: &BandMatrix) -> Result<usize, SingularMatrix> {
        let Range { start: first, end } = self.columns(i, matrix);
        let row = self.kept[i];
        let start = i * (3 * self.half + 1);
        let places = &mut self.upper[start..][..end + self.half - i];
        let (before, entries) = places.split_at_mut(first + self.half - i);
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
        // Equations of forces and of gaps differ by the ratio of the moduli: unscaled, pivots would be chosen by units.
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

    /// The columns of row `i` that are in use, numbered among those that are kept. The diagonal is among them.
    fn columns(&self, i: usize, matrix: &BandMatrix) -> Range<usize> {
        let row = self.kept[i];
        let [leftmost, rightmost] = matrix.used[row].map(|place| row + place);
        let first = self.kept[..i].partition_point(|&j| j + self.half < leftmost);
        let after = self.kept[i + 1..].partition_point(|&j| j + self.half < rightmost);
        first..i + 1 + after
    }

    fn singular(&self, column: usize) -> SingularMatrix {
        SingularMatrix { column: self.kept[column], size: self.size }
    }

    /// Exchanges row `k` for the one below with the largest entry in column `k`.
    fn pivot(&mut self, k: usize) -> Result<(), SingularMatrix> {
        let column = self.upper[self.diagonal(k)..].iter().step_by((3 * self.half).max(1));
        let (mut row, mut value, mut largest) = (k, 0.0, 0.0);
        for (d, &x) in column.take(self.reach[k] - k + 1).enumerate() {
            if x.abs() > largest {
                (row, value, largest) = (k + d, x, x.abs());
            }
        }
        // Only an exact zero is refused: how near to singular a tangent may be is judged by what the step does with it.
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

    /// Exchanges the columns from `k` on of the rows `k` and `row`, below it.
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

    /// Subtracts multiples of row `k` from the rows below that reach its column.
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
        // The columns from `k` on of the rows below: each row begins one place earlier than the row above it.
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

    /// Brings columns of a row into use, up to `end`.
    fn extend(&mut self, row: usize, end: usize) {
        let used = self.ends[row];
        if used < end {
            let diagonal = self.diagonal(row);
            self.upper[diagonal + used - row..diagonal + end - row].fill(0.0);
            self.ends[row] = end;
        }
    }

    /// Index of the diagonal entry of a row in `upper`.
    fn diagonal(&self, row: usize) -> usize {
        row * (3 * self.half + 1) + self.half
    }
}

/// `x ← x − factor y`.
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
    fn the_sign_of_a_determinant_counts_exchanges_and_pivots() {
        for ([a, b, c, d], left_out, is_negative) in [
            ([2.0, 1.0, 1.0, 2.0], [false; 2], false),
            ([1.0, 2.0, 2.0, 1.0], [false; 2], true),
            ([0.0, 1.0, -1.0, 0.0], [false; 2], false),
            ([-1.0, 0.0, 0.0, 1.0], [false; 2], true),
            // What is left out does not count.
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
