//! Describes how full substrate coupling changes the measures of designs.

use ranking::Requirement;
use run::{CoupledMeasure, CouplingChange};

/// Smallest relative change of a measure that is reported.
///
/// The coupling of nearest neighbours, as in the paper, has errors of this order.
const SMALL: f64 = 0.02;

/// Formats a line for each design; the text is empty if there are no designs.
pub fn couplings_report(changes: &[CouplingChange], requirements: &[Requirement]) -> String {
    if changes.is_empty() {
        return String::new();
    }
    let lines: String = changes.iter().map(|change| line(change, requirements)).collect();
    format!("\nChecked with full substrate coupling (substrate.coupling = \"full\"):\n{lines}")
}

/// Formats the changed measures, a fold, and the missed requirements of a design.
fn line(change: &CouplingChange, requirements: &[Requirement]) -> String {
    let mut parts: Vec<String> = change.measures.iter().filter_map(changed).collect();
    if change.folds {
        parts.push("the surface of the substrate folds".to_owned());
    }
    parts.extend(requirements.iter().filter_map(|requirement| missed(change, requirement)));
    if parts.is_empty() {
        parts.push(format!("no measure changes by more than {} %", 100.0 * SMALL));
    }
    format!("  {}: {}\n", change.design, parts.join(", "))
}

/// Describes the change of a measure by full coupling; `None` if the change is small.
fn changed(measure: &CoupledMeasure) -> Option<String> {
    let CoupledMeasure { column, nearest, full } = measure;
    let Some(full) = full else { return Some(format!("{column} has no value")) };
    let change = full / nearest - 1.0;
    (change.abs() > SMALL && change.is_finite()).then(|| {
        format!(
            "{column} is {:.1} % {}",
            100.0 * change.abs(),
            if change < 0.0 { "lower" } else { "higher" }
        )
    })
}

/// Describes a requirement that is met with nearest-neighbour coupling but not with full coupling.
fn missed(change: &CouplingChange, requirement: &Requirement) -> Option<String> {
    let measure = change.measures.iter().find(|m| m.column == requirement.column)?;
    let [nearest, full] = [Some(measure.nearest), measure.full]
        .map(|value| value.is_some_and(|value| requirement.is_met(value)));
    (nearest && !full).then(|| format!("{requirement} is missed"))
}
