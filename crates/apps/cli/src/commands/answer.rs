//! Describes one design: its values with requirements, limits and margins, and every warning.

use optimisation::{DesignGoal, FAILED_CHECKS, GOAL, OPTIMUM, OPTIMUM_DEFINITION};
use ranking::{Relation, Requirement};
use results::columns::{Cell, Column, design_columns, mode_column, name};
use results::{Completeness, DesignRow, Results, VerifiedFolder};
use run::{BareNeedle, GapChange, bare_needle, design_warnings};
use serde_json::{Value, json};
use std::path::Path;
use sweep::{Sweep, Variable};

use crate::print::{FOLDED, digits, marked, warning};

/// Absolute value of the relative margin below which a value is reported as "at the limit".
const AT_LIMIT: f64 = 1e-6;

/// A solved design with its requirements.
pub struct DesignAnswer<'a> {
    sweep: &'a Sweep,
    row: &'a DesignRow,
    requirements: &'a [Requirement],
    columns: Vec<Column<DesignRow>>,
}

impl<'a> DesignAnswer<'a> {
    /// Describes the solved design `row` of `sweep`.
    pub fn new(sweep: &'a Sweep, row: &'a DesignRow, requirements: &'a [Requirement]) -> Self {
        Self { sweep, row, requirements, columns: design_columns(sweep) }
    }

    /// Returns the table rows of required values, with limits and margins, and of related values.
    ///
    /// See [`further_rows`](Self::further_rows) for the related values.
    pub fn rows(&self) -> Vec<Vec<String>> {
        let mut rows: Vec<Vec<String>> = Vec::new();
        for requirement in self.requirements {
            // A statistic over samples is no column of a design; statistics have their own table.
            let Some(value) = self.cell(&requirement.column).map(|cell| cell.number()) else {
                continue;
            };
            let cells = [requirement.column.clone(), shown(value), limit_text(requirement, value)];
            rows.push(cells.to_vec());
            let mode = mode_column(&requirement.column);
            let mode = mode.and_then(|mode| Some((mode, self.cell(mode)?.to_string())));
            rows.extend(mode.map(|(mode, cell)| vec![mode.to_owned(), cell]));
        }
        rows.extend(self.further_rows());
        rows
    }

    /// Returns table rows of values that explain the required ones.
    ///
    /// If a requirement limits a force, one row is the depth of the load. If a requirement limits a
    /// pressure on the tissue, one row is the pressure of a needle on bare tissue.
    pub fn further_rows(&self) -> Vec<Vec<String>> {
        let bare = self.bare_needle().map(|bare| {
            let unit = format!(
                "kPa; the skin lowers this pressure by a factor of {}",
                digits(bare.reduction)
            );
            vec!["bare needle".to_owned(), digits(bare.pressure_kpa), unit]
        });
        self.depth().into_iter().chain(bare).collect()
    }

    /// Returns the row of the depth of the load, if a requirement limits a force and none the
    /// depth.
    fn depth(&self) -> Option<Vec<String>> {
        self.requirements.iter().any(|r| r.column.contains("force")).then_some(())?;
        let in_mm = format!("{}_mm", name::CRITICAL_DISPLACEMENT);
        let columns = [in_mm.as_str(), name::CRITICAL_DISPLACEMENT];
        let column = columns.into_iter().find(|column| self.cell(column).is_some())?;
        let is_required = self.requirements.iter().any(|r| r.column == column);
        let depth = self.cell(column)?.number().filter(|_| !is_required)?;
        Some(vec![column.to_owned(), digits(depth), "depth of the load".to_owned()])
    }

    /// Returns the pressure of a needle on bare tissue, if a requirement limits a tissue pressure.
    fn bare_needle(&self) -> Option<BareNeedle> {
        let mut columns = self.requirements.iter().map(|r| &r.column);
        let pressures = [name::TISSUE_PRESSURE_MAX, name::TISSUE_PRESSURE_AT_FORCE];
        columns.find(|column| pressures.iter().any(|pressure| column.starts_with(pressure)))?;
        bare_needle(self.row)
    }

    /// Returns the cell of the column `name`; `None` if there is no such column.
    fn cell(&self, name: &str) -> Option<Cell> {
        let column = self.columns.iter().find(|column| column.name == name)?;
        Some(column.cell(self.row))
    }

    /// Returns every warning about the design as a sentence.
    ///
    /// `change` contains the measures of the design with smaller and larger gaps, if known.
    pub fn warnings(&self, change: Option<&GapChange>) -> Vec<String> {
        let radius = self.requirements.iter().find(|r| {
            r.column == "bend_radius_mm" && matches!(r.relation, Relation::AtMost | Relation::Below)
        });
        let radius = radius.map(|r| r.limit);
        design_warnings(self.sweep, self.row, radius, change)
    }

    /// Formats the warnings, one per line, after an empty line.
    ///
    /// The text is empty if there are no warnings.
    pub fn warnings_text(&self, change: Option<&GapChange>) -> String {
        match marked(FOLDED, &self.warnings(change)) {
            lines if lines.is_empty() => lines,
            lines => format!("\n{lines}"),
        }
    }

    /// Returns the requirements, the warnings and the pressure of a bare needle as JSON.
    pub fn record(&self, change: Option<&GapChange>) -> Value {
        let requirements = self.requirements.iter().filter_map(|requirement| {
            let value = self.cell(&requirement.column)?.number();
            Some(json!({
                "requirement": requirement.to_string(),
                "value": value,
                "limit": requirement.limit,
                "margin": value.map(|value| requirement.margin(value)),
            }))
        });
        let mut record = json!({
            "requirements": requirements.collect::<Vec<_>>(),
            "warnings": self.warnings(change),
        });
        if let Some(BareNeedle { pressure_kpa, reduction }) = self.bare_needle() {
            record["bare_needle"] =
                json!({ "pressure_kPa": pressure_kpa, "pressure_reduction": reduction });
        }
        record
    }
}

fn shown(value: Option<f64>) -> String {
    value.map_or("none".to_owned(), digits)
}

/// Describes the limit of a requirement, and the margin of `value` from this limit.
///
/// Without a value, the text states that the limit is not confirmed.
pub fn limit_text(requirement: &Requirement, value: Option<f64>) -> String {
    let Requirement { relation, limit, .. } = requirement;
    let limit = format!("{} {}", relation.sign(), text::number::text(*limit));
    let Some(value) = value else { return format!("{limit} is not confirmed") };
    let margin = requirement.margin(value);
    match margin {
        _ if margin.abs() < AT_LIMIT => format!("{limit}, at the limit"),
        _ if margin > 0.0 => format!("{limit}, margin {:.1} %", 100.0 * margin),
        _ => format!("{limit} is missed by {:.1} %", -100.0 * margin),
    }
}

/// Requirements, variables and failed checks of the search that found a design.
#[derive(Default)]
pub struct SearchedDesign {
    /// Requirements on columns of the design, without requirements on statistics over samples.
    pub requirements: Vec<Requirement>,
    /// Variables of the search.
    pub variables: Vec<Variable>,
    /// A sentence for each requirement that a check of the optimum contradicts.
    pub failed_checks: Vec<String>,
}

impl SearchedDesign {
    /// Reads the results of a search, and prints a warning for each failed check.
    ///
    /// `path` is the results folder of the search, or the file `optimum.toml` in this folder. For
    /// any other path, all fields of the returned value are empty.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let folder = if path.ends_with(OPTIMUM_DEFINITION) { path.parent() } else { Some(path) };
        let folder = folder.unwrap_or(path);
        if !folder.join(OPTIMUM).is_file() {
            return Ok(Self::default());
        }
        let found = VerifiedFolder::open(folder, Completeness::Partial)?;
        let name = folder.join(GOAL).display().to_string();
        let goal = DesignGoal::parse(&found.text(GOAL)?, &name, &[])?;
        let mut requirements = goal.requirements.clone();
        requirements.retain(|r| goal.statistic(&r.column).is_none());
        let optimum = Results::of_file(&found, OPTIMUM)?;
        let mut failed_checks: Vec<String> = Vec::new();
        // Tables of earlier versions of squama have no column of failed checks.
        if let Ok(column) = optimum.column(FAILED_CHECKS)
            && optimum.len() > 0
        {
            let failed = optimum.text(0, column);
            failed_checks
                .extend(failed.split("; ").filter(|s| !s.is_empty()).map(|s| format!("{s}.")));
        }
        for sentence in &failed_checks {
            warning(&format!("this design fails a check: {sentence}"));
        }
        let variables = goal.space.sweep().variables().to_vec();
        Ok(Self { requirements, variables, failed_checks })
    }
}
