//! The command `squama sensitivity`, which computes Sobol' indices.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::ensure;
use clap::Args;
use results::{MEASURE_TABLES, Maker, write_rows};
use serde_json::{Value, json};
use sweep::Sweep;
use uncertainty::{GlobalAnalysis, GlobalSensitivity, INDEX_COLUMNS, IndexEstimate};

use super::options::whole;
use super::sample_args::{SampleArgs, SampleFolder};
use super::source::{Definition, read};
use super::{DONE, INCOMPLETE, PROGRAM};
use crate::interrupt::Interrupt;
use crate::json;
use crate::print::{aligned, counted};

/// Arguments of `squama sensitivity`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama sensitivity box.toml
  squama sensitivity box.toml --samples 4000 --json

Varies the parameters in [variables], such as gap_over_t = { from = 0.1, to = 1 } or length_over_t = [0.5, 1],
independently and uniformly; all other parameters keep their values. Shows the fraction of the variance of each
measure that is due to each variable, alone (first-order Sobol' index) and together with others (total index),
with 95 % intervals. For n variables, each sample solves n + 2 designs. A sample in which a design fails is left
out, and counted.
Writes sobol.csv, and samples/, from which the same command continues after an interruption.
For derivatives at one design, use squama design --sensitivity.
Exit code: 0 done, 2 bad input or a disk error.")]
pub struct Arguments {
    #[command(flatten)]
    pub definition: Definition,

    // This option of earlier versions has no effect; it is accepted because scripts may contain it.
    #[arg(long = "global", hide = true)]
    _global: bool,

    /// Number of samples
    // At least two samples, because one sample has no variance.
    #[arg(long, value_name = "N", default_value_t = 1000, allow_hyphen_values = true, value_parser = whole::<2, 1_000_000>)]
    pub samples: u64,

    #[command(flatten)]
    pub sampled: SampleArgs,
}

/// Name of the table of the Sobol' indices.
const TABLE: &str = "sobol.csv";

/// Computes and prints the Sobol' indices of every measure.
pub fn sensitivity(arguments: &Arguments, interrupt: &Interrupt) -> anyhow::Result<u8> {
    let sweep = read(&arguments.definition)?;
    check(&sweep, &arguments.definition.path)?;
    let command = ("sensitivity", Maker::Sensitivity);
    let sampled = SampleFolder::new((&arguments.definition, &sweep), &arguments.sampled, command)?;
    let (samples, stop) = (arguments.samples as usize, interrupt.stop());
    let analysis = GlobalAnalysis { sweep: &sweep, samples, stop, program: PROGRAM };
    let Some((found, claim)) =
        sampled.solved((arguments.samples, interrupt), |store| analysis.solve(store))?
    else {
        return Ok(interrupt.exit_code().unwrap_or(INCOMPLETE));
    };
    let folder = &sampled.folder;
    let rows = found.measures.iter().flat_map(|measure| measure.rows(&found.variables));
    write_rows(folder, TABLE, folder.csv_format(), INDEX_COLUMNS, rows)?;
    claim.finish(&[TABLE])?;
    json::answer(
        arguments.sampled.solving.json,
        || record(&sweep, &found, folder.path()),
        || report(&sweep, &found, samples),
        (folder.path(), &[TABLE]),
    )?;
    Ok(DONE)
}

/// Rejects a definition without variables, or with an axis of several values.
fn check(sweep: &Sweep, path: &Path) -> anyhow::Result<()> {
    let path = path.display();
    ensure!(
        !sweep.variables().is_empty(),
        "{path}: has no [variables]; add some, e.g. gap_over_t = {{ from = 0.1, to = 1 }}"
    );
    let several = sweep.grid().axes().iter().filter(|axis| axis.len() > 1);
    let several: Vec<_> = several.map(|axis| axis.parameter().key).collect();
    ensure!(
        several.is_empty(),
        "{path}: {} designs besides the variables; give one value, or [variables], for {}",
        sweep.grid().len(),
        several.join(" ")
    );
    Ok(())
}

/// Formats the indices of the main measures.
fn report(sweep: &Sweep, found: &GlobalSensitivity, samples: usize) -> String {
    // Each sample has two independent points, and a mixture of both points for each variable.
    let points = samples * (found.variables.len() + 2);
    let samples = counted(samples as u64, "sample");
    let mut text = format!("{}: {samples}, {points} designs\n", sweep.name());
    // Print only the main measures, because sobol.csv has all of them.
    for measure in
        found.measures.iter().filter(|m| MEASURE_TABLES.iter().any(|(table, _)| *table == m.name))
    {
        let failed = match measure.failed {
            0 => String::new(),
            failed => format!(", {} left out", counted(failed as u64, "sample")),
        };
        let _ = writeln!(text, "\n{}{failed}", measure.name);
        let rows: Vec<_> = found
            .variables
            .iter()
            .zip(&measure.indices)
            .map(|(variable, indices)| {
                let (first, total) = (percent(indices.first), percent(indices.total));
                [(*variable).to_owned(), format!("alone {first}"), format!("with others {total}")]
            })
            .collect();
        text.push_str(&aligned(&rows));
    }
    text + &constant(found)
}

/// Names the main measures that do not depend on the variables.
fn constant(found: &GlobalSensitivity) -> String {
    let constant: Vec<&str> = MEASURE_TABLES
        .iter()
        .map(|(table, _)| *table)
        .filter(|table| found.constant.iter().any(|name| name == table))
        .collect();
    let variables = found.variables.join(", ");
    if found.measures.is_empty() {
        return format!("\nNothing varies: no measure depends on {variables}.\n");
    }
    if constant.is_empty() {
        return String::new();
    }
    format!("\nConstant, because they do not depend on {variables}: {}\n", constant.join(", "))
}

/// Formats an index and its 95 % interval in percent.
fn percent(estimate: IndexEstimate) -> String {
    let [low, high] = estimate.interval().map(|end| 100.0 * end);
    format!("{:.0} % ({low:.0} to {high:.0} %)", 100.0 * estimate.value)
}

fn record(sweep: &Sweep, found: &GlobalSensitivity, folder: &Path) -> Value {
    json!({
        "sweep": sweep.name(),
        "measures": found.measures.iter().map(|measure| {
        let indices = found.variables.iter().zip(&measure.indices).map(|(variable, indices)| {
            json!({
                "variable": variable,
                "first": estimate_record(indices.first),
                "total": estimate_record(indices.total),
            })
        });
        json!({
            "measure": measure.name,
            "spread": measure.spread,
            "samples": measure.samples,
            "failed": measure.failed,
            "indices": indices.collect::<Vec<_>>(),
        })
    }).collect::<Vec<_>>(),
        "constant": found.constant,
        "folder": folder.to_string_lossy(),
        "files": [TABLE],
    })
}

fn estimate_record(estimate: IndexEstimate) -> Value {
    json!({ "value": estimate.value, "interval": estimate.interval() })
}
