//! Tests of predicted and sampled spreads, Sobol' indices, and interrupted analyses.

mod global;
mod guide;
mod interrupted_analysis;
mod spreads;

use std::path::Path;
use std::sync::atomic::AtomicBool;

use run::Program;
use sweep::Sweep;
use uncertainty::{Analysis, AnalysisError, DesignTolerance, SampleStore};

/// Measures that are fast to solve.
const QUICK: &str = "'coverage', 'puncture'";

const PROGRAM: Program = Program { version: "1.0", revision: "none" };

/// Returns a sweep of one design with these measures.
///
/// `design` are the lines of the section `[designs]`, `lines` further sections of the definition.
fn sweep(measures: &str, design: &str, lines: &str) -> Sweep {
    let text = format!("name = 'x'\nmeasures = [{measures}]\n[designs]\n{design}\n{lines}");
    Sweep::parse(&text, "x.toml", &[]).expect("a valid sweep")
}

/// Analyses the first design of `sweep`, and stores its samples in `folder`.
///
/// `require` are the requirements, and `samples` is the number of samples. If `stop` is true, the
/// analysis is interrupted before it solves samples.
fn analysed(
    sweep: &Sweep,
    require: &[&str],
    samples: usize,
    folder: &Path,
    stop: bool,
) -> Result<DesignTolerance, AnalysisError> {
    let requirements: Vec<_> =
        require.iter().map(|r| r.parse().expect("a valid requirement")).collect();
    let stop = AtomicBool::new(stop);
    let analysis = Analysis::new(sweep, &requirements, samples, PROGRAM, &stop);
    analysis.design(0, &SampleStore::new(folder))
}

/// Analyses the first design of `sweep` with samples in a temporary folder.
fn tolerance(sweep: &Sweep, require: &[&str], samples: usize) -> DesignTolerance {
    let folder = tempfile::tempdir().expect("a folder");
    analysed(sweep, require, samples, folder.path(), false).expect("tolerances")
}
