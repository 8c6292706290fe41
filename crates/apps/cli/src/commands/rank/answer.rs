//! Describes the best design of a ranking: its values, margins and warnings.

use ranking::{Preferences, RankedDesign, Requirement};
use results::columns::mode_column;
use results::{DesignRow, Results};
use run::{CouplingChange, GapChange, Patience, solved_row};
use serde_json::{Value, json};
use sweep::Sweep;

use super::super::answer::{DesignAnswer, limit_text};
use super::columns::preferred_columns;
use super::gap_changes::{cell, change_text, missed};
use crate::print::{FOLDED, aligned, digits, marked};

/// Headers of the table; a column without any value is omitted.
const HEADERS: [&str; 5] =
    ["", "value", "required", "gap 10 % smaller / larger", "with full coupling"];

/// The best design of a ranking, solved again if its definition is known.
pub struct RankedAnswer<'a> {
    results: &'a Results,
    preferences: &'a Preferences,
    best: RankedDesign<'a>,
    /// The sweep and the solved design; `None` if the results have no definition.
    solved: Option<(&'a Sweep, DesignRow)>,
}

impl<'a> RankedAnswer<'a> {
    /// Solves the design `best` of `results` again.
    pub fn new(results: &'a Results, preferences: &'a Preferences, best: RankedDesign<'a>) -> Self {
        let sweep = results.definition();
        // Solve without a time limit, because only one design is solved. A design on tissue of
        // finite thickness is slow.
        let solved = sweep.and_then(|sweep| {
            Some((sweep, solved_row(sweep, best.design(), Patience::Unlimited)?))
        });
        Self { results, preferences, best, solved }
    }

    /// Returns the solved design with its requirements; `None` if the design was not solved.
    fn design(&self) -> Option<DesignAnswer<'_>> {
        let (sweep, row) = self.solved.as_ref()?;
        Some(DesignAnswer::new(sweep, row, &self.preferences.requirements))
    }

    /// Formats values, limits, margins and warnings of the best design.
    ///
    /// `change` contains the measures of this design with smaller and larger gaps, `coupling` the
    /// measures with full substrate coupling. Unknown measures are `None`.
    pub fn text(&self, change: Option<&GapChange>, coupling: Option<&CouplingChange>) -> String {
        let mut rows = vec![HEADERS.map(str::to_owned).to_vec()];
        rows.extend(self.rows(change, coupling));
        let design = self.design();
        let further = design.as_ref().map_or_else(Vec::new, DesignAnswer::further_rows);
        rows.extend(further.into_iter().map(padded));
        let mut text = aligned(&without_empty_columns(&rows));
        let requirements = &self.preferences.requirements;
        let mut notes = change.map_or_else(Vec::new, |change| missed(change, requirements));
        if let Some(coupling) = coupling {
            let missed = requirements.iter().filter(|r| is_missed(coupling, r));
            notes.extend(missed.map(|r| format!("misses {r} with full substrate coupling")));
            if coupling.folds {
                notes.push("folds the surface with full substrate coupling".to_owned());
            }
        }
        let number = self.best.design();
        let notes = notes.into_iter().map(|note| format!("{number} {note}."));
        let warnings = design.map_or_else(Vec::new, |design| design.warnings(change));
        let lines = marked(FOLDED, &notes.chain(warnings).collect::<Vec<_>>());
        if !lines.is_empty() {
            text.push('\n');
            text.push_str(&lines);
        }
        text
    }

    /// Returns table rows for the columns of criteria and requirements.
    fn rows(
        &self,
        change: Option<&GapChange>,
        coupling: Option<&CouplingChange>,
    ) -> Vec<Vec<String>> {
        let mut columns: Vec<&str> = Vec::new();
        for column in preferred_columns(self.preferences) {
            if !columns.contains(&column) {
                columns.push(column);
            }
        }
        let mut rows = Vec::new();
        for column in columns {
            let value = self.number(column);
            let limiting = self.preferences.requirements.iter().filter(|r| r.column == column);
            let mut limits = limiting.map(|requirement| limit_text(requirement, value));
            let gap = change.and_then(|c| c.measures.iter().find(|m| m.column == column));
            let full = coupling.and_then(|c| c.measures.iter().find(|m| m.column == column));
            rows.push(vec![
                column.to_owned(),
                value.map_or("none".to_owned(), digits),
                limits.next().unwrap_or_default(),
                gap.map_or_else(String::new, cell),
                full.map_or_else(String::new, |full| change_text(full.nearest, full.full)),
            ]);
            // Add a row for each further requirement on the same column.
            rows.extend(limits.map(|limit| padded(vec![String::new(), String::new(), limit])));
            let mode = mode_column(column).map(|mode| (mode, self.text_in(mode)));
            rows.extend(mode.map(|(mode, text)| padded(vec![mode.to_owned(), text])));
        }
        rows
    }

    /// Returns the number of the best design in a column; `None` if the cell is empty or missing.
    fn number(&self, column: &str) -> Option<f64> {
        let column = self.results.column(column).ok()?;
        self.results.table().number(self.best.row(), column)
    }

    /// Returns the text of the best design in a column; empty if there is no such column.
    fn text_in(&self, column: &str) -> String {
        let column = self.results.column(column).ok();
        let text = column.map(|column| self.results.text(self.best.row(), column).into_owned());
        text.unwrap_or_default()
    }

    /// Returns the design with requirements and warnings as JSON.
    pub fn record(&self, change: Option<&GapChange>) -> Value {
        let mut record = self.design().map_or_else(|| json!({}), |design| design.record(change));
        record["design"] = self.best.design().into();
        record
    }
}

/// Returns true if a requirement is met with nearest-neighbour coupling but not with full coupling.
fn is_missed(change: &CouplingChange, requirement: &Requirement) -> bool {
    change.measures.iter().any(|measure| {
        measure.column == requirement.column
            && requirement.is_met(measure.nearest)
            && !measure.full.is_some_and(|full| requirement.is_met(full))
    })
}

/// Appends empty cells to a row, up to the number of headers.
fn padded(mut row: Vec<String>) -> Vec<String> {
    row.resize(HEADERS.len(), String::new());
    row
}

/// Removes the columns in which only the header has text.
fn without_empty_columns(rows: &[Vec<String>]) -> Vec<Vec<String>> {
    let mut is_kept = [true; HEADERS.len()];
    for (column, is_kept) in is_kept.iter_mut().enumerate() {
        *is_kept = rows.iter().skip(1).any(|row| !row[column].is_empty());
    }
    let mut kept = Vec::new();
    for row in rows {
        let cells = row.iter().zip(is_kept).filter(|(_, is_kept)| *is_kept);
        kept.push(cells.map(|(cell, _)| cell.clone()).collect());
    }
    kept
}
