//! What a run comes to.

use std::collections::BTreeMap;

use results::row;

use crate::journal::Entry;

/// Counts and best values of the designs of a run.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Designs that were solved.
    pub designs: u64,
    /// Designs that lack a value that was asked for.
    pub failed: u64,
    /// How many designs have which status, for each column of statuses in the order of the table.
    pub statuses: Vec<(String, BTreeMap<String, u64>)>,
    /// The best values, those that exist.
    pub best: Vec<Best>,
    /// Where the columns stand that are looked at.
    columns: Vec<(usize, Watched)>,
}

/// A value and the first design that has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Best {
    /// What it is.
    pub what: &'static str,
    /// The value.
    pub value: f64,
    /// Where it is found.
    pub design: String,
}

/// What is looked at in a column.
#[derive(Clone, Debug)]
enum Watched {
    Status(String),
    Value(&'static str, Better),
}

type Better = fn(&f64, &f64) -> bool;

/// Columns of which the best value is told.
const BEST: [(&str, &str, Better); 4] = [
    ("coverage", "best coverage", f64::gt),
    ("critical_force", "largest critical force", f64::gt),
    ("penetration", "least penetration", f64::lt),
    ("compliance", "largest compliance", f64::gt),
];

/// How the columns of statuses end.
pub(crate) const STATUS: &str = "_status";

impl Summary {
    /// A summary of rows with these columns.
    pub(crate) fn new<'c>(columns: impl IntoIterator<Item = &'c str>) -> Self {
        let watched = |name: &str| match BEST.iter().find(|(column, ..)| *column == name) {
            Some((_, what, better)) => Some(Watched::Value(what, *better)),
            None => name.ends_with(STATUS).then(|| Watched::Status(name.to_owned())),
        };
        let columns = columns.into_iter().enumerate();
        let columns = columns.filter_map(|(place, name)| Some((place, watched(name)?))).collect();
        Self { columns, ..Self::default() }
    }

    /// Counts `entry`. Entries must come in the order of their designs.
    pub(crate) fn add(&mut self, entry: &Entry) {
        self.designs += 1;
        self.failed += u64::from(entry.failed());
        let cells: Vec<_> = row::cells(&entry.row).collect();
        let design = cells.first().copied().unwrap_or_default();
        for (place, watched) in &self.columns {
            let Some(cell) = cells.get(*place).filter(|cell| !cell.is_empty()) else { continue };
            match watched {
                Watched::Status(name) => {
                    *counts(&mut self.statuses, name).entry((*cell).to_owned()).or_default() += 1;
                }
                Watched::Value(what, better) => keep(&mut self.best, what, cell, *better, design),
            }
        }
    }
}

/// The counts of a column, which stands behind those that came before it.
fn counts<'s>(
    statuses: &'s mut Vec<(String, BTreeMap<String, u64>)>,
    name: &str,
) -> &'s mut BTreeMap<String, u64> {
    let known = statuses.iter().position(|(column, _)| column == name);
    let place = known.unwrap_or_else(|| {
        statuses.push((name.to_owned(), BTreeMap::new()));
        statuses.len() - 1
    });
    &mut statuses[place].1
}

fn keep(best: &mut Vec<Best>, what: &'static str, cell: &str, better: Better, design: &str) {
    let Ok(value) = cell.parse::<f64>() else { return };
    let design = || design.to_owned();
    match best.iter_mut().find(|best| best.what == what) {
        None => best.push(Best { what, value, design: design() }),
        Some(known) if better(&value, &known.value) => {
            *known = Best { what, value, design: design() }
        }
        Some(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_and_best_values() {
        let mut summary =
            Summary::new(["design", "penetration", "critical_force", "puncture_status"]);
        for (design, rest) in [(1, "0.5,2,complete"), (2, ",,row limit"), (3, "0.25,2,complete")] {
            let row = format!("{design:04},{rest}");
            let failures = if rest.starts_with(',') { vec![String::new()] } else { Vec::new() };
            summary.add(&Entry { design, at: 0.0, seconds: 0.0, rerun: 0, row, failures });
        }
        assert_eq!((summary.designs, summary.failed), (3, 1));
        let (column, counts) = &summary.statuses[0];
        assert_eq!(column, "puncture_status");
        assert_eq!((counts["complete"], counts["row limit"]), (2, 1));
        let best: Vec<_> = summary.best.iter().map(|b| (b.what, b.design.as_str())).collect();
        assert_eq!(best, [("least penetration", "0003"), ("largest critical force", "0001")]);
    }
}
