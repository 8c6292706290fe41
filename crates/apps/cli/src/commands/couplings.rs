//! What the simplified coupling through the tissue leaves out of the designs that are advised, for people.

use ranking::Requirement;
use results::columns::parameter_of;
use run::{CoupledMeasure, CouplingChange};

use crate::print::change as percent;

/// Changes below this part are not told: the paper's coupling is meant to be about as good.
const SMALL: f64 = 0.02;

/// Those of the `columns` that are measured and no parameter, each once.
pub fn measured<'a>(columns: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut measured: Vec<&str> = Vec::new();
    for column in columns {
        if parameter_of(column).is_none() && !measured.contains(&column) {
            measured.push(column);
        }
    }
    measured
}

/// A sentence for each design; nothing where there is none.
pub fn couplings_report(changes: &[CouplingChange], requirements: &[Requirement]) -> String {
    if changes.is_empty() {
        return String::new();
    }
    let lines: String = changes.iter().map(|change| line(change, requirements)).collect();
    format!(
        "\nScales push on their nearest neighbours alone through the tissue. With all of it coupled (substrate.coupling = \"full\"):\n{lines}"
    )
}

fn line(change: &CouplingChange, requirements: &[Requirement]) -> String {
    let mut told: Vec<String> = change.measures.iter().filter_map(moved).collect();
    if change.folds {
        told.push("the surface of the substrate folds over".to_owned());
    }
    told.extend(requirements.iter().filter_map(|requirement| missed(change, requirement)));
    if told.is_empty() {
        told.push(format!("no measure moves by more than {} %", 100.0 * SMALL));
    }
    format!("  {}: {}\n", change.design, told.join(", "))
}

/// A measure that moves, or that is lost.
fn moved(measure: &CoupledMeasure) -> Option<String> {
    let CoupledMeasure { column, nearest, full } = measure;
    let Some(full) = full else { return Some(format!("{column} has no value")) };
    let part = full / nearest - 1.0;
    (part.abs() > SMALL && part.is_finite())
        .then(|| format!("{column} {}", percent(100.0 * part, 1)))
}

/// A requirement that is met by the nearest neighbours alone.
fn missed(change: &CouplingChange, requirement: &Requirement) -> Option<String> {
    let measure = change.measures.iter().find(|m| m.column == requirement.column)?;
    let is_met = |value: f64| requirement.is_met(value);
    (is_met(measure.nearest) && !measure.full.is_some_and(is_met))
        .then(|| format!("{requirement} is missed"))
}
