//! Comparison of the factors of skyline matrices with the eigenvalues of dense matrices.

use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use solver::SkylineMatrix;

/// Returns a skyline matrix and the dense matrix with the same entries.
fn matrices(size: usize, reach: usize, numbers: &[f64]) -> (SkylineMatrix, DMatrix<f64>) {
    let first =
        (0..size).map(|row| row.saturating_sub((7 * row) % (reach + 1))).collect::<Vec<_>>();
    let mut skyline = SkylineMatrix::new(first.clone());
    let mut dense = DMatrix::zeros(size, size);
    let mut numbers = numbers.iter().cycle();
    for row in 0..size {
        for column in first[row]..=row {
            let value = *numbers.next().unwrap();
            skyline.add(row, column, value);
            skyline.add(column, row, if row == column { 0.0 } else { value });
            dense[(row, column)] = value;
            dense[(column, row)] = value;
        }
    }
    (skyline, dense)
}

proptest! {
    #[test]
    fn the_number_of_negative_pivots_is_the_number_of_negative_eigenvalues(
        size in 1_usize..25, reach in 0_usize..8,
        numbers in prop::collection::vec(-1.0_f64..1.0, 97),
    ) {
        let (skyline, dense) = matrices(size, reach, &numbers);
        let eigenvalues = dense.symmetric_eigenvalues();
        prop_assume!(eigenvalues.iter().all(|value| value.abs() > 1e-6));
        let factors = skyline.factorise().unwrap();
        let negative = eigenvalues.iter().filter(|value| **value < 0.0).count();
        prop_assert_eq!(factors.negative_eigenvalues(), negative);
        let mut x: Vec<f64> = (0..size).map(|row| 1.0 + row as f64).collect();
        factors.solve(&mut x);
        let product = &dense * DVector::from_column_slice(&x);
        let largest = x.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
        for row in 0..size {
            prop_assert!((product[row] - 1.0 - row as f64).abs() < 1e-6 * (1.0 + largest));
        }
    }
}

#[test]
fn a_matrix_with_a_zero_pivot_is_refused() {
    let mut matrix = SkylineMatrix::new(vec![0, 0]);
    for (row, column) in [(0, 0), (1, 0), (1, 1)] {
        matrix.add(row, column, 1.0);
    }
    assert_eq!(matrix.factorise().unwrap_err().column, 1);
}
