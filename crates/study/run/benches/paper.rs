//! Benchmark of the paper's sweep from definition to tables: 720 designs, four measures, all cores.
//!
//! The run takes less than 18 seconds on two cores, including the computation of the springs.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use run::{Options, Program, Start, WorkMeter};
use sweep::{Subset, Sweep};

fn paper(c: &mut Criterion) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../sweeps/paper.toml");
    let sweep = Sweep::read(&file, &[]).expect("the paper sweep");
    let folder = tempfile::tempdir().expect("a folder");
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let program = Program { version: "bench", revision: "bench" };
    let stop = AtomicBool::new(false);
    let tables_every = Duration::from_secs(30);
    let work = &WorkMeter::default();
    let stop = &stop;
    let options = Options { threads, format: None, fail_fast: false, tables_every, stop, work };
    let mut group = c.benchmark_group("paper sweep");
    group.sample_size(10);
    group.bench_function("720 designs, four measures", |b| {
        b.iter(|| {
            let (subset, start, folder) = (Subset::default(), Start::Fresh, folder.path());
            run::run(&sweep, subset, folder, start, &options, &program, |_| ()).expect("a run");
        });
    });
    group.finish();
}

criterion_group!(benches, paper);
criterion_main!(benches);
