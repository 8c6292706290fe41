//! Predictions against solved samples, closed forms, and what an interruption leaves.

mod global;
mod guide;
mod interrupted_analysis;
mod spreads;

use std::path::Path;
use std::sync::atomic::AtomicBool;

use run::Program;
use sweep::Sweep;
use uncertainty::{Analysis, AnalysisError, DesignTolerance, SampleStore};

/// Measures that take little time.
const QUICK: &str = "'coverage', 'puncture'";

const PROGRAM: Program = Program { version: "1.0", revision: "none" };

/// The sweep of one design, solved for these measures, with these deviations.
fn sweep(measures: &str, design: &str, lines: &str) -> Sweep {
    let text = format!("name = 'x'\nmeasures = [{measures}]\n[designs]\n{design}\n{lines}");
    Sweep::parse(&text, "x.toml", &[]).expect("a valid sweep")
}

/// The tolerances of the first design of `sweep`, its samples kept in `folder`.
fn analysed(
    sweep: &Sweep,
    require: &[&str],
    samples: usize,
    folder: &Path,
    stop: bool,
) -> Result<DesignTolerance, AnalysisError> {
    let requirements: Vec<_> = require.iter().map(|r| r.parse().expect("valid")).collect();
    let stop = AtomicBool::new(stop);
    let analysis = Analysis::new(sweep, &requirements, samples, PROGRAM, &stop);
    analysis.design(0, &SampleStore::new(folder))
}

/// The tolerances of the first design of `sweep`, its samples in a folder of their own.
fn tolerance(sweep: &Sweep, require: &[&str], samples: usize) -> DesignTolerance {
    let folder = tempfile::tempdir().expect("a folder");
    analysed(sweep, require, samples, folder.path(), false).expect("tolerances")
}
