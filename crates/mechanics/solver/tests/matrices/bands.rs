//! Comparison of band LU factorisation with dense LU factorisation.

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use solver::{BandLu, BandMatrix, Tangent};

/// Creates a band matrix from `entries`, row by row.
///
/// Entries above 2 are replaced by zeros.
fn matrix(size: usize, half: usize, entries: &[f64]) -> BandMatrix {
    let mut matrix = BandMatrix::new(size, half);
    let positions = (0..size).flat_map(|i| matrix.columns(i).map(move |j| (i, j)));
    let positions: Vec<_> = positions.collect();
    for ((i, j), &entry) in positions.into_iter().zip(entries) {
        if entry <= 2.0 {
            matrix.add(i, j, entry);
        }
    }
    matrix
}

/// Returns the entry at (`i`, `j`), which is zero outside the band.
fn at(matrix: &BandMatrix, i: usize, j: usize) -> f64 {
    if i.abs_diff(j) <= matrix.half_bandwidth() { matrix.get(i, j) } else { 0.0 }
}

/// Returns the product of a matrix and a vector.
fn times(matrix: &BandMatrix, x: &[f64]) -> Vec<f64> {
    (0..matrix.size()).map(|i| matrix.columns(i).map(|j| matrix.get(i, j) * x[j]).sum()).collect()
}

/// Returns the solution for the rows and columns `kept`, computed by dense LU factorisation.
///
/// The second value is the ratio of the smallest to the largest pivot.
fn reference(matrix: &BandMatrix, kept: &[usize], rhs: &[f64]) -> (Vec<f64>, f64) {
    if kept.is_empty() {
        return (vec![0.0; matrix.size()], 1.0);
    }
    let dense = DMatrix::from_fn(kept.len(), kept.len(), |i, j| at(matrix, kept[i], kept[j]));
    let lu = dense.lu();
    let x = lu.solve(&DVector::from_fn(kept.len(), |i, _| rhs[kept[i]]));
    let x = x.unwrap_or_else(|| DVector::from_element(kept.len(), f64::NAN));
    let u = lu.u();
    let pivots = (0..kept.len()).map(|i| u[(i, i)].abs());
    let (low, high) = pivots.fold((f64::INFINITY, 0.0), |(l, h), p| (p.min(l), p.max(h)));
    let mut full = vec![0.0; matrix.size()];
    for (&k, x) in kept.iter().zip(x.iter()) {
        full[k] = *x;
    }
    (full, low / high)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 800, max_global_rejects: 20_000, ..ProptestConfig::default() })]

    #[test]
    fn solutions_agree_with_a_dense_solver(
        size in 1_usize..30, half in 0_usize..6, left_out in 0_usize..4,
        entries in prop::collection::vec(-2.0_f64..2.8, 30 * 11),
        rhs in prop::collection::vec(-1.0_f64..1.0, 30),
        marks in prop::collection::vec(0_usize..4, 30),
    ) {
        let matrix = matrix(size, half, &entries);
        let left_out: Vec<_> = marks[..size].iter().map(|mark| *mark < left_out).collect();
        let kept: Vec<_> = (0..size).filter(|&i| !left_out[i]).collect();
        let (expected, pivots) = reference(&matrix, &kept, &rhs);
        prop_assume!(pivots > 1e-6);
        let mut lu = BandLu::new(size, half);
        // A previous factorisation must not affect the result.
        let _ = lu.factorise(&matrix, &vec![false; size]);
        lu.factorise(&matrix, &left_out).unwrap();
        let mut x = rhs[..size].to_vec();
        lu.solve(&mut x);
        let largest = expected.iter().fold(1.0_f64, |max, x| max.max(x.abs()));
        for (x, expected) in x.iter().zip(&expected) {
            assert_relative_eq!(*x, *expected, epsilon = 1e-8 * largest);
        }
    }

    #[test]
    fn the_product_of_matrix_and_solution_is_the_right_hand_side(
        size in 1_usize..40, half in 0_usize..8,
        entries in prop::collection::vec(-1.0_f64..1.0, 40 * 15),
        rhs in prop::collection::vec(-1.0_f64..1.0, 40),
    ) {
        let mut matrix = matrix(size, half, &entries);
        for i in 0..size {
            matrix.add(i, i, 3.0 * (half + 1) as f64);
        }
        let mut lu = BandLu::new(size, half);
        lu.factorise(&matrix, &vec![false; size]).unwrap();
        let mut x = rhs[..size].to_vec();
        lu.solve(&mut x);
        for (product, rhs) in times(&matrix, &x).iter().zip(&rhs) {
            assert_relative_eq!(*product, *rhs, epsilon = 1e-13);
        }
    }
}

#[test]
fn a_matrix_with_a_row_of_zeros_is_singular() {
    let mut matrix = BandMatrix::new(3, 1);
    matrix.add(0, 0, 1.0);
    matrix.add(2, 2, 1.0);
    let error = BandLu::new(3, 1).factorise(&matrix, &[false; 3]).unwrap_err();
    assert_eq!((error.column, error.size), (1, 3));
    assert_eq!(error.to_string(), "the matrix is singular: no pivot in column 1 of 3");
}

#[test]
fn a_matrix_with_dependent_rows_is_singular() {
    let mut matrix = BandMatrix::new(4, 1);
    matrix.add(0, 0, 5.0);
    for (row, column) in [(1, 1), (1, 2), (2, 1), (2, 2)] {
        matrix.add(row, column, 2.0);
    }
    matrix.add(3, 3, 1.0);
    assert_eq!(BandLu::new(4, 1).factorise(&matrix, &[false; 4]).unwrap_err().column, 2);
}

#[test]
fn a_matrix_that_is_not_finite_is_singular() {
    for value in [f64::NAN, f64::INFINITY] {
        let mut matrix = BandMatrix::new(2, 1);
        matrix.add(0, 0, 1.0);
        matrix.add(1, 1, value);
        assert_eq!(
            BandLu::new(2, 1).factorise(&matrix, &[false; 2]).unwrap_err().column,
            1,
            "{value}"
        );
    }
}

#[test]
fn rows_are_exchanged_if_a_diagonal_entry_is_zero() {
    let mut matrix = BandMatrix::new(2, 1);
    matrix.add(0, 1, 4.0);
    matrix.add(1, 0, 2.0);
    let mut lu = BandLu::new(2, 1);
    lu.factorise(&matrix, &[false; 2]).unwrap();
    let mut x = [8.0, 6.0];
    lu.solve(&mut x);
    assert_eq!(x, [3.0, 2.0]);
}

#[test]
fn a_cleared_matrix_is_zero() {
    let mut matrix = BandMatrix::new(5, 2);
    for i in 0..5 {
        for j in matrix.columns(i) {
            matrix.add(i, j, 1.0);
        }
    }
    matrix.clear_row(2);
    assert_eq!(times(&matrix, &[1.0; 5]), [3.0, 4.0, 0.0, 4.0, 3.0]);
    matrix.clear();
    assert_eq!(times(&matrix, &[1.0; 5]), [0.0; 5]);
}

#[test]
#[should_panic(expected = "entry (0, 3) lies outside the band of half-width 2")]
fn entries_outside_the_band_are_refused() {
    BandMatrix::new(5, 2).add(0, 3, 1.0);
}

/// The entries of the first row are much larger, as if its equation were in other units.
///
/// Without row scaling, the first row would be the pivot row, and elimination would lose the digits
/// of the second row.
#[test]
fn pivots_do_not_depend_on_row_scaling() {
    let mut matrix = BandMatrix::new(2, 1);
    for (row, column, value) in [(0, 0, 10.0), (0, 1, 1e17), (1, 0, 1.0), (1, 1, 1.0)] {
        matrix.add(row, column, value);
    }
    let mut lu = BandLu::new(2, 1);
    lu.factorise(&matrix, &[false; 2]).unwrap();
    let mut x = [1e17, 3.0];
    lu.solve(&mut x);
    assert_relative_eq!(x[0], 2.0, max_relative = 1e-14);
    assert_relative_eq!(x[1], 1.0, max_relative = 1e-14);
}
