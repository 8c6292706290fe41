//! The command `squama tolerance`, which predicts the effect of tolerances and the yield.

mod figures;
mod record;
mod report;

use std::collections::BTreeSet;

use anyhow::ensure;
use clap::Args;
use rayon::prelude::*;
use results::{Maker, ResultsFolder, write_rows};
use sweep::Sweep;
use uncertainty::{
    Analysis, AnalysisError, DesignTolerance, SOURCE_COLUMNS, SampleStore, TOLERANCE_COLUMNS,
    YIELD_COLUMNS,
};

use super::answer::SearchedDesign;
use super::options::whole;
use super::requirement_args::RequirementArgs;
use super::sample_args::{SampleArgs, SampleFolder};
use super::selection::ranges;
use super::source::{Definition, read};
use super::{DONE, INCOMPLETE, PROGRAM};
use crate::interrupt::Interrupt;
use crate::json;

/// Arguments of `squama tolerance`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama tolerance armour.toml --design 0417 --require 'critical_force >= 2'
  squama tolerance results/armour --design 0417 --require 'critical_force_N >= 2' --require 'coverage >= 0.6'
  squama tolerance sweeps/smoke.toml --set 'tolerance.gap_over_t={ batch_sd = 0.02, scale_sd = 0.01 }'
  squama tolerance sweeps/paper.toml --samples 0 --set 'tolerance.slant_deg={ batch_within = 2 }'

Parts differ from the nominal design by the deviations in [tolerance]. batch_sd is the standard deviation of a
normal deviation that all scales of a batch share, batch_within the largest value of a uniform one, and scale_sd
the standard deviation from scale to scale, of gaps and slants. Keys are parameters, such as gap_over_t, or, with
material.thickness_mm, lengths in mm, such as gap_mm.
Predicts the spread of every measure from its derivatives, with the contribution of each source, and solves samples
to check the prediction. The yield is the fraction of samples that meet a requirement, with its 95 % interval; a
sample that fails does not meet it, and is counted separately.
Writes tolerance.csv, tolerance_sources.csv, yield.csv, figures of a single design, and the samples of each design
to samples/, from which the same command continues after an interruption, or adds more samples.
Exit code: 0 done, 1 a nominal design failed, 2 bad input or a disk error.")]
pub struct Arguments {
    #[command(flatten)]
    pub definition: Definition,

    /// Numbers of designs in the grid, e.g. 0417 or 1-12,0417 [default: all]
    #[arg(long = "design", value_name = "NUMBERS", value_delimiter = ',')]
    pub numbers: Vec<String>,

    #[command(flatten)]
    pub required: RequirementArgs,

    /// Number of samples of each design; 0 gives the linear prediction alone
    #[arg(long, value_name = "N", default_value_t = 1000, allow_hyphen_values = true, value_parser = whole::<0, 1_000_000>)]
    pub samples: u64,

    #[command(flatten)]
    pub sampled: SampleArgs,
}

/// Maximum number of designs, because each occupies some kilobytes of memory until all are solved.
const MOST: u64 = 100_000;

/// Predicts the spread of the measures from tolerances, and the yield of the requirements.
pub fn tolerance(arguments: &Arguments, interrupt: &Interrupt) -> anyhow::Result<u8> {
    let sweep = read(&arguments.definition)?;
    SearchedDesign::read(&arguments.definition.path)?;
    check(arguments, &sweep)?;
    let requirements = arguments.required.read()?;
    let designs = designs(arguments, &sweep)?;
    let command = ("tolerance", Maker::Tolerance);
    let sampled = SampleFolder::new((&arguments.definition, &sweep), &arguments.sampled, command)?;
    let samples = arguments.samples as usize;
    let work = designs.len() as u64 * arguments.samples;
    let analysis = Analysis::new(&sweep, &requirements, samples, PROGRAM, interrupt.stop());
    let solved = sampled.solved((work, interrupt), |store| analysed(&analysis, &designs, store))?;
    let Some((all, mut claim)) = solved else {
        return Ok(interrupt.exit_code().unwrap_or(INCOMPLETE));
    };
    let folder = &sampled.folder;
    let mut files = write(folder, &all)?;
    if let [design] = all.as_slice() {
        for (name, svg) in figures::figures(&sweep, &requirements, design) {
            // Claim each figure, because the names of histograms depend on the requirements.
            claim.add(&name)?;
            folder.write_text(&name, &svg)?;
            files.push(name);
        }
    }
    claim.finish(&files)?;
    json::answer(
        arguments.sampled.solving.json,
        || record::record(&sweep, &all, folder.path(), &files),
        || report::report(&sweep, &requirements, &all),
        (folder.path(), &files),
    )?;
    let failed = all.iter().any(|design| design.nominal.result.failed());
    Ok(if failed { INCOMPLETE } else { DONE })
}

/// Rejects a sweep without deviations, and a single sample.
fn check(arguments: &Arguments, sweep: &Sweep) -> anyhow::Result<()> {
    ensure!(
        !sweep.deviations().is_empty() || sweep.is_imperfect(),
        "{}: has no [tolerance]; add deviations, e.g. gap_over_t = {{ batch_sd = 0.02 }}, or --set 'tolerance.gap_over_t={{ batch_sd = 0.02 }}'",
        arguments.definition.path.display()
    );
    ensure!(
        arguments.samples != 1,
        "--samples 1: one sample has no spread, expected 0 or at least 2"
    );
    Ok(())
}

/// Returns the indices of the requested designs in the grid, without duplicates.
fn designs(arguments: &Arguments, sweep: &Sweep) -> anyhow::Result<Vec<u64>> {
    let grid = sweep.grid();
    let path = &arguments.definition.path;
    let mut ranges = ranges(grid, &arguments.numbers, path)?;
    if arguments.numbers.is_empty() {
        ranges.push(0..=grid.len().saturating_sub(1));
    }
    // Count the designs before listing them: a list of 10⁹ designs would exhaust the memory.
    let count = ranges.iter().fold(0_u64, |count, range| {
        count.saturating_add((range.end() - range.start()).saturating_add(1))
    });
    ensure!(
        count <= MOST,
        "{}: {count} designs exceed the limit of {MOST}: choose some with --design",
        path.display()
    );
    let mut designs: Vec<u64> = ranges.into_iter().flatten().collect();
    // Remove duplicates without changing the order.
    let mut known = BTreeSet::new();
    designs.retain(|design| known.insert(*design));
    Ok(designs)
}

/// Analyses the tolerances of `designs` in parallel.
///
/// If there are several designs, the results contain no samples, to save memory.
fn analysed(
    analysis: &Analysis<'_>,
    designs: &[u64],
    store: &SampleStore,
) -> Result<Vec<DesignTolerance>, AnalysisError> {
    // The samples of a design are solved in parallel, too, so that no thread idles during the last
    // design.
    designs
        .par_iter()
        .map(|&index| {
            let mut design = analysis.design(index, store)?;
            // Only the figures of a single design need the samples.
            if designs.len() > 1 {
                design.samples = Vec::new();
            }
            Ok(design)
        })
        .collect()
}

/// Writes the tables and returns their file names.
fn write(folder: &ResultsFolder, all: &[DesignTolerance]) -> anyhow::Result<Vec<String>> {
    let mut files = Vec::new();
    let format = folder.csv_format();
    let measures = all.iter().flat_map(DesignTolerance::measure_rows);
    write_rows(folder, "tolerance.csv", format, TOLERANCE_COLUMNS, measures)?;
    files.push("tolerance.csv".to_owned());
    let sources = all.iter().flat_map(DesignTolerance::source_rows);
    write_rows(folder, "tolerance_sources.csv", format, SOURCE_COLUMNS, sources)?;
    files.push("tolerance_sources.csv".to_owned());
    if all.iter().any(|design| !design.yields.is_empty()) {
        let yields = all.iter().flat_map(DesignTolerance::yield_rows);
        write_rows(folder, "yield.csv", format, YIELD_COLUMNS, yields)?;
        files.push("yield.csv".to_owned());
    }
    Ok(files)
}
