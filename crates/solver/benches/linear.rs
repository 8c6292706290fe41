//! One factorisation and solve of a banded tangent, such as that of a row of scales: band LU against faer's sparse LU
//! with its symbolic part reused.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use faer::prelude::*;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};
use solver::{BandLu, BandMatrix, Tangent};

/// Unknowns of a scale: its three displacements and, at each of two levels, the two forces of corners that are
/// together.
const BLOCK: usize = 7;
/// From the first unknown of a scale to the last of the next one.
const HALF: usize = BLOCK + 3;

/// Entries of a tangent with the pattern of a row of `scales`, all corners together.
fn entries(scales: usize) -> Vec<(usize, usize, f64)> {
    let size = BLOCK * scales;
    let mut entries = Vec::new();
    for scale in 0..scales {
        let first = BLOCK * scale;
        let coupled: Vec<_> = (first..(first + HALF).min(size)).collect();
        for &i in &coupled {
            for &j in &coupled {
                // Numbers without a pattern, the diagonal the largest.
                let value = ((31 * i + 17 * j) as f64).sin();
                entries.push((i, j, if i == j { 8.0 + value } else { value }));
            }
        }
    }
    entries
}

fn linear(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("tangent of a row");
    for scales in [41, 401] {
        let size = BLOCK * scales;
        let entries = entries(scales);
        let rhs: Vec<f64> = (0..size).map(|i| (i as f64).cos()).collect();

        let mut matrix = BandMatrix::new(size, HALF);
        for &(i, j, value) in &entries {
            matrix.add(i, j, value);
        }
        let mut lu = BandLu::new(size, HALF);
        group.bench_function(BenchmarkId::new("band LU", scales), |bencher| {
            bencher.iter(|| {
                lu.factorise(black_box(&matrix)).expect("a regular matrix");
                let mut x = rhs.clone();
                lu.solve(&mut x);
                x
            });
        });

        let triplets: Vec<_> =
            entries.iter().map(|&(i, j, value)| Triplet::new(i, j, value)).collect();
        let sparse = SparseColMat::<usize, f64>::try_new_from_triplets(size, size, &triplets)
            .expect("a sparse matrix");
        let symbolic = SymbolicLu::try_new(sparse.symbolic()).expect("a symbolic factorisation");
        let column = Col::from_fn(size, |i| rhs[i]);
        group.bench_function(BenchmarkId::new("faer sparse LU", scales), |bencher| {
            bencher.iter(|| {
                let lu = Lu::try_new_with_symbolic(symbolic.clone(), black_box(sparse.as_ref()));
                lu.expect("a regular matrix").solve(&column)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, linear);
criterion_main!(benches);
