//! Benchmark of one factorisation and solution with the tangent of a row of scales.
//!
//! Compares block elimination with band LU factorisation.

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, criterion_group, criterion_main};
use solver::{BandLu, BandMatrix, BlockElimination, BlockMatrix, Blocks, Tangent};

type Group<'a> = BenchmarkGroup<'a, WallTime>;

/// Number of unknowns of a scale.
///
/// These are two displacements, a rotation and, at each of two levels, two contact forces.
const BLOCK: usize = 7;
/// Half-bandwidth of the tangent.
///
/// The unknowns of a scale are coupled up to the last displacement of the next scale.
const HALF: usize = BLOCK + 3;

/// Returns tangent entries `(row, column, value)` of a row of scales with all contacts closed.
fn entries(scales: usize) -> Vec<(usize, usize, f64)> {
    let size = BLOCK * scales;
    let mut entries = Vec::new();
    for scale in 0..scales {
        let first = BLOCK * scale;
        let coupled: Vec<_> = (first..(first + HALF).min(size)).collect();
        for &i in &coupled {
            for &j in &coupled {
                // Irregular values with a dominant diagonal.
                let value = ((31 * i + 17 * j) as f64).sin();
                entries.push((i, j, if i == j { 8.0 + value } else { value }));
            }
        }
    }
    entries
}

/// Linear system: tangent of a row of `scales` scales, and a right-hand side.
struct RowTangent {
    scales: usize,
    entries: Vec<(usize, usize, f64)>,
    rhs: Vec<f64>,
}

impl RowTangent {
    fn new(scales: usize) -> Self {
        let rhs = (0..BLOCK * scales).map(|i| (i as f64).cos()).collect();
        Self { scales, entries: entries(scales), rhs }
    }

    /// Adds all entries to `matrix`.
    fn fill(&self, matrix: &mut impl Tangent) {
        for &(i, j, value) in &self.entries {
            matrix.add(i, j, value);
        }
    }

    /// Measures block elimination.
    fn in_blocks(&self, group: &mut Group) {
        let starts: Vec<_> = (0..self.scales).map(|scale| BLOCK * scale).collect();
        let blocks = Blocks { links: starts.clone(), starts, root: self.scales - 1, reach: 1 };
        let mut matrix = BlockMatrix::default();
        matrix.reshape(&blocks, &vec![false; self.rhs.len()]);
        self.fill(&mut matrix);
        let mut elimination = BlockElimination::default();
        group.bench_function(BenchmarkId::new("block elimination", self.scales), |bencher| {
            bencher.iter(|| {
                elimination.matrix.clone_from(black_box(&matrix));
                elimination.factorise().expect("block elimination succeeds");
                let mut x = self.rhs.clone();
                elimination.solve(&mut x);
                x
            });
        });
    }

    /// Measures the band LU factorisation.
    fn in_band(&self, group: &mut Group) {
        let mut matrix = BandMatrix::new(self.rhs.len(), HALF);
        self.fill(&mut matrix);
        let mut lu = BandLu::new(self.rhs.len(), HALF);
        let none = vec![false; self.rhs.len()];
        group.bench_function(BenchmarkId::new("band LU", self.scales), |bencher| {
            bencher.iter(|| {
                lu.factorise(black_box(&matrix), &none).expect("the matrix is regular");
                let mut x = self.rhs.clone();
                lu.solve(&mut x);
                x
            });
        });
    }
}

fn linear(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("tangent of a row");
    for scales in [41, 401] {
        let problem = RowTangent::new(scales);
        problem.in_blocks(&mut group);
        problem.in_band(&mut group);
    }
    group.finish();
}

criterion_group!(benches, linear);
criterion_main!(benches);
