//! Measures the run time of punctures.
//!
//! - The 720 designs of the reference study, including the computation of their substrate springs,
//!   in parallel on all cores.
//! - One design on rows of 41 to 4001 scales. The run time should grow at most linearly with the
//!   number of scales.

#[path = "../tests/samples/mod.rs"]
mod samples;

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rayon::prelude::*;
use skin::puncture::{PunctureParameters, solve};
use skin::{Base, Common};
use substrate::Calibrations;

fn reference_study(c: &mut Criterion) {
    let designs = samples::reference_study(Base::L);
    let mut group = c.benchmark_group("720 designs");
    group.sample_size(10);
    for (name, parameters) in
        [("41 scales", samples::on_row(41)), ("auto", PunctureParameters::default())]
    {
        group.bench_function(name, |b| {
            b.iter(|| {
                let calibrations = Calibrations::default();
                designs.par_iter().for_each(|design| {
                    black_box(samples::solve_with(&calibrations, design, &parameters));
                });
            });
        });
    }
    group.finish();
}

fn row_length(c: &mut Criterion) {
    let design = samples::settled();
    let springs = samples::springs(&design, &samples::on_row(1), &Calibrations::default());
    let mut group = c.benchmark_group("row");
    group.sample_size(10);
    for scales in [41, 401, 4001] {
        group.throughput(Throughput::Elements(scales as u64));
        group.bench_function(BenchmarkId::from_parameter(scales), |b| {
            b.iter(|| {
                black_box(solve(&design, &springs, &Common::default(), &samples::on_row(scales)))
            });
        });
    }
    group.finish();
}

criterion_group!(benches, reference_study, row_length);
criterion_main!(benches);
