//! Time to compute the springs of one footprint, and of all 120 footprints of the paper's sweep.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use substrate::{Footprint, calibrate};

fn one(c: &mut Criterion) {
    let footprint = Footprint::new(0.2, 2.0, 0.5).unwrap();
    c.bench_function("one footprint", |b| b.iter(|| calibrate(black_box(&footprint))));
}

fn paper_sweep(c: &mut Criterion) {
    let mut footprints = Vec::new();
    for length in [0.025, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0] {
        for gap in 1..=10 {
            let a = 0.5 * length;
            footprints.push(Footprint::new(0.1 * f64::from(gap) / a, 1.0 / a, 0.5).unwrap());
        }
    }
    let mut group = c.benchmark_group("paper sweep");
    group.sample_size(10);
    group.bench_function("120 footprints", |b| {
        b.iter(|| {
            for footprint in &footprints {
                let _ = black_box(calibrate(footprint));
            }
        });
    });
    group.finish();
}

criterion_group!(benches, one, paper_sweep);
criterion_main!(benches);
