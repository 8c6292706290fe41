//! The command `squama compare`, which shows the differences between two runs.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{bail, ensure};
use clap::Args;
use ranking::{ColumnDifference, Comparison, Extreme};
use results::Results;
use text::number;

use super::source::{Partial, verified_folder};
use super::{DIFFERENT, DONE};
use crate::print::{aligned, counted, digits, print, shortfall};

/// Arguments of `squama compare`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  squama compare results/paper results/paper-as-written
  squama compare results/reference/paper results/paper --tolerance 1e-9 --exit-code

Designs are matched by their parameters, not by their numbers. --out writes compare.csv (column by
column) and differences.csv (cell by cell).
Exit code: 0 done, 1 the runs differ (with --exit-code), 2 bad input or a disk error.")]
pub struct Arguments {
    /// Results folder of a run, or its definition
    #[arg(value_name = "RESULTS")]
    pub first: PathBuf,

    /// Results folder of another run, or its definition
    #[arg(value_name = "OTHER")]
    pub second: PathBuf,

    /// Largest relative difference of two numbers that count as equal; 0 compares every bit
    #[arg(long, value_name = "T", allow_hyphen_values = true, default_value = "1e-12")]
    pub tolerance: String,

    /// Exit with code 1 if the runs differ
    #[arg(long)]
    pub exit_code: bool,

    /// Write tables of the differences to this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    #[command(flatten)]
    pub partial: Partial,
}

/// Maximum number of unmatched designs that the report lists for each run.
const LISTED: usize = 8;

/// Compares two runs and prints the differences.
pub fn compare(arguments: &Arguments) -> anyhow::Result<u8> {
    let tolerance = tolerance(&arguments.tolerance)?;
    let completeness = arguments.partial.completeness();
    let results =
        |path: &PathBuf| anyhow::Ok(Results::read_from(&verified_folder(path, completeness)?)?);
    let [first, second] = [&arguments.first, &arguments.second].map(results);
    let (first, second) = (first?, second?);
    let comparison = ranking::compare(&first, &second, tolerance)?;
    let mut text = report(&comparison, &first, &second);
    if let Some(folder) = &arguments.out {
        let files = ranking::write_comparison(folder, &comparison)?;
        let _ = writeln!(text, "{}: {}", folder.display(), files.join(" "));
    }
    print(&text)?;
    Ok(if arguments.exit_code && !comparison.has_no_differences() { DIFFERENT } else { DONE })
}

/// Parses the value of `--tolerance`.
fn tolerance(text: &str) -> anyhow::Result<f64> {
    let Ok(tolerance) = text.parse::<f64>() else {
        bail!("--tolerance {text}: not accepted, expected a number of at least 0, e.g. 1e-9");
    };
    ensure!(
        tolerance >= 0.0 && tolerance.is_finite(),
        "--tolerance {text}: out of range, expected a number of at least 0, e.g. 1e-9"
    );
    Ok(tolerance)
}

/// Formats the unmatched designs, the differing parameters and the differing columns.
fn report(comparison: &Comparison<'_>, first: &Results, second: &Results) -> String {
    let [one, other] = [first, second].map(|results| results.folder().display().to_string());
    let both = counted(comparison.matched() as u64, "design");
    let mut text = format!("{one} against {other}: {both} in both\n");
    for results in [first, second] {
        text.push_str(&shortfall(results.verified_folder()));
    }
    for (alone, folder) in comparison.unmatched().iter().zip([one, other]) {
        text.push_str(&unmatched(alone, &folder));
    }
    let parameters: Vec<_> = comparison
        .parameters()
        .iter()
        .map(|c| [c.parameter.path(), c.first.to_string(), format!("against {}", c.second)])
        .collect();
    text.push_str(&aligned(&parameters));
    text.push_str(&columns(comparison));
    text
}

fn unmatched(designs: &[&str], folder: &str) -> String {
    if designs.is_empty() {
        return String::new();
    }
    let mut listed = designs[..designs.len().min(LISTED)].join(" ");
    if designs.len() > LISTED {
        listed.push_str(" …");
    }
    format!("  {} only in {folder}: {listed}\n", counted(designs.len() as u64, "design"))
}

fn columns(comparison: &Comparison<'_>) -> String {
    let (same, differing): (Vec<_>, Vec<_>) =
        comparison.columns.iter().partition(|column| column.has_no_differences());
    let mut text = String::new();
    if !differing.is_empty() {
        let mut rows = vec![HEADER.map(str::to_owned)];
        rows.extend(differing.iter().map(|column| row(column)));
        let _ = write!(text, "\n{}", aligned(&rows));
    }
    let changes: Vec<_> = differing.iter().flat_map(|column| changes(column)).collect();
    if !changes.is_empty() {
        let _ = write!(text, "\n{}", aligned(&changes));
    }
    if !same.is_empty() {
        let names: Vec<_> = same.iter().map(|column| column.name.as_str()).collect();
        // Mention the tolerance only if one of these columns contains numbers, because texts are
        // compared exactly.
        let above = if same.iter().any(|column| column.relative.is_some()) {
            format!(" above {}", number::text(comparison.tolerance()))
        } else {
            String::new()
        };
        let _ = writeln!(text, "\nno difference{above}: {}", names.join(" "));
    }
    text
}

/// Header of the table of differing columns.
const HEADER: [&str; 9] = [
    "column",
    "compared",
    "differ",
    "in one only",
    "largest relative",
    "at design",
    "first",
    "second",
    "rank correlation",
];

/// Returns the row of a column in the table of differing columns.
fn row(column: &ColumnDifference) -> [String; 9] {
    let extreme =
        |cell: fn(&Extreme) -> String| column.relative.as_ref().map_or(String::new(), cell);
    [
        column.name.clone(),
        column.compared.to_string(),
        column.differing.to_string(),
        (column.only_first + column.only_second).to_string(),
        extreme(|e| digits(e.difference)),
        extreme(|e| e.design.clone()),
        extreme(|e| digits(e.first)),
        extreme(|e| digits(e.second)),
        column.correlation.map_or(String::new(), |correlation| format!("{correlation:.4}")),
    ]
}

/// Returns a row for each change of text in a column, with the number of designs that change so.
fn changes(column: &ColumnDifference) -> impl Iterator<Item = [String; 3]> {
    column.changes.iter().map(|((from, to), count)| {
        [column.name.clone(), counted(*count as u64, "design"), format!("{from} → {to}")]
    })
}
