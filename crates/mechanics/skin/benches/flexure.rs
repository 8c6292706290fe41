//! Measures the run time of bending.
//!
//! - Unit cells: the 720 designs of the reference study, in parallel on all cores.
//! - Chains of 100 to 800 gaps, bent to the end of the path. The run time should grow linearly with
//!   the number of gaps.

#[path = "../tests/samples/mod.rs"]
mod samples;

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rayon::prelude::*;
use skin::flexure::{FlexureParameters, Method, solve};
use skin::{Base, Common};

fn reference_study(c: &mut Criterion) {
    let designs = samples::reference_study(Base::L);
    let parameters = FlexureParameters::default();
    let mut group = c.benchmark_group("720 designs");
    group.sample_size(10);
    group.bench_function("unit cell", |b| {
        b.iter(|| {
            designs.par_iter().for_each(|design| {
                black_box(solve(design, &Common::default(), &parameters)).expect("a valid design");
            });
        });
    });
    group.finish();
}

fn chain_length(c: &mut Criterion) {
    // The scales of this design touch early on the path, and their contacts then slide.
    let design = samples::design(0.1, 0.1, 75.0, Base::L);
    let pitch = design.row().expect("a valid design").pitch();
    let mut group = c.benchmark_group("chain");
    group.sample_size(10);
    for gaps in [100_u32, 200, 400, 800] {
        let parameters = FlexureParameters {
            method: Method::Chain,
            membrane_length: f64::from(gaps) * pitch,
            ..FlexureParameters::default()
        };
        group.throughput(Throughput::Elements(u64::from(gaps)));
        group.bench_function(BenchmarkId::from_parameter(gaps), |b| {
            b.iter(|| {
                black_box(solve(&design, &Common::default(), &parameters)).expect("a valid design")
            });
        });
    }
    group.finish();
}

criterion_group!(benches, reference_study, chain_length);
criterion_main!(benches);
