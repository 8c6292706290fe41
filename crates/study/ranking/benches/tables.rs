//! Benchmarks of ranking and comparing 100,000 designs, which take less than two seconds each.

#[path = "../../results/tests/samples/mod.rs"]
mod samples;

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use ranking::{Ranking, TetrahedralGrid, compare, write_ranking};
use results::Results;
use samples::{Criteria, write_results};

/// Number of slants. With 50 gaps and 50 lengths there are 100,000 designs.
const SLANTS: u32 = 40;

fn tables(c: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    write_results(&path("independent"), SLANTS, Criteria::Independent, 0);
    write_results(&path("other"), SLANTS, Criteria::Independent, 1);
    write_results(&path("conflicting"), SLANTS, Criteria::Conflicting, 0);
    let grid: TetrahedralGrid = "20".parse().expect("a resolution");
    let mut group = c.benchmark_group("100,000 designs");
    group.sample_size(10);
    for run in ["independent", "conflicting"] {
        group.bench_function(format!("rank, {run} criteria"), |b| {
            b.iter(|| {
                let results = Results::read(&path(run)).expect("results");
                let ranking = Ranking::new(&results, grid).expect("a ranking");
                write_ranking(&path("out"), &ranking).expect("writable")
            });
        });
    }
    group.bench_function("compare", |b| {
        b.iter(|| {
            let [first, second] =
                ["independent", "other"].map(|run| Results::read(&path(run)).expect("results"));
            black_box(compare(&first, &second, 0.0).expect("comparable").columns.len())
        });
    });
    group.finish();
}

fn pareto(c: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut group = c.benchmark_group("Pareto front of 100,000 designs");
    group.sample_size(10);
    for criteria in [Criteria::Independent, Criteria::Conflicting] {
        write_results(folder.path(), SLANTS, criteria, 0);
        let results = Results::read(folder.path()).expect("results");
        let points: Vec<_> = (0..results.len())
            .map(|row| {
                let number =
                    |column| results.number(row, column).expect("a number").expect("a value");
                [number(4), number(5), 1.0 / number(6), number(7)]
            })
            .collect();
        group.bench_function(format!("{criteria:?}"), |b| {
            b.iter(|| ranking::pareto_front(black_box(&points)));
        });
    }
    group.finish();
}

criterion_group!(benches, tables, pareto);
criterion_main!(benches);
