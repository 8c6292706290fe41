//! The validation page in Markdown.

use std::fmt::Write as _;

use crate::{
    Benchmark, CheckedClaim, CheckedStatement, ChoiceEffect, Claim, Finding, Headlines,
    Sensitivity, StripLength, Validation, Verdict,
};

/// The template of the page, with a placeholder in braces for every table and number.
const PAGE: &str = include_str!("page.md");

/// The heading of the last section, the only optional one.
const BETWEEN: &str = "\n## Between the grid points";

impl Validation {
    /// Returns the page in Markdown.
    pub fn page(&self) -> String {
        let mut parts = vec![
            ("benchmarks", lines(&self.benchmarks, Benchmark::row)),
            ("counts L", self.counts(0)),
            ("counts 2L", self.counts(1)),
            ("claims", self.claims.iter().map(CheckedClaim::rows).collect()),
            ("gap counts", lines(&self.gap_counts, StripLength::row)),
            ("sensitivity", lines(&self.sensitivity, Sensitivity::row)),
            ("coupling", lines(&self.effects.coupling, ChoiceEffect::row)),
            ("friction", lines(&self.effects.friction, ChoiceEffect::row)),
        ];
        parts.extend(self.soundness.parts());
        parts.extend(
            self.needle.parts(["claims changed by the needle", "claims kept under the needle"]),
        );
        parts.push(("claims with friction", self.friction.friction_table()));
        let mut page = PAGE.to_owned();
        match &self.between {
            Some(between) => parts.extend(between.parts()),
            // Remove the section, which would otherwise show its placeholders.
            None => page.truncate(PAGE.find(BETWEEN).unwrap_or(PAGE.len())),
        }
        for (name, text) in parts {
            page = page.replace(&format!("{{{name}}}"), &text);
        }
        page
    }

    /// Counts the claims by verdict for one of the two bases.
    fn counts(&self, base: usize) -> String {
        let [yes, part, no] = [Verdict::Reproduced, Verdict::InPart, Verdict::NotReproduced]
            .map(|verdict| self.claims.iter().filter(|c| c.verdicts[base] == verdict).count());
        format!("{yes} reproduced, {part} in part, {no} not")
    }
}

/// Returns the lines of all items, each with a line break.
pub(crate) fn lines<T>(items: &[T], line: impl Fn(&T) -> String) -> String {
    items.iter().map(|item| line(item) + "\n").collect()
}

impl ChoiceEffect {
    /// Returns the row of the table in Markdown.
    pub fn row(&self) -> String {
        let [low, median, high] = self.changes.map(|change| match 100.0 * change {
            // Changes that round to 0 may have either sign, and a test compares the page.
            percent if percent.abs() < 0.05 => "0 %".to_owned(),
            percent => format!("{percent:+.1} %"),
        });
        let ranks = self.ranks.map_or_else(String::new, |ranks| format!("{ranks:.5}"));
        let Self { setting, measure, designs, lost, .. } = self;
        format!(
            "| {setting} | {measure} | {designs} | {low} | {median} | {high} | {ranks} | {lost} |"
        )
    }
}

impl Sensitivity {
    /// Returns the row of the table in Markdown.
    pub fn row(&self) -> String {
        let Headlines { force, balanced, corners } = &self.headlines;
        format!(
            "| {} | {} | {force} | {balanced} | {} |",
            self.sweep,
            self.setting,
            corners.join(" | ")
        )
    }
}

impl Benchmark {
    /// Returns the row of the table in Markdown.
    pub fn row(&self) -> String {
        let order = self.order.map_or_else(String::new, |order| format!("{order:.2}"));
        // Differences at the level of round-off vary between machines.
        let difference = match self.difference() {
            off if off.abs() < 1e-9 => "< 1e-9".to_owned(),
            off => format!("{off:+.1e}"),
        };
        format!(
            "| {} | {} | {:.5} | {:.5} | {difference} | {:.0e} | {order} |",
            self.name, self.source, self.reference, self.ours, self.band
        )
    }
}

impl CheckedClaim {
    /// Returns the rows of the table in Markdown: the claim, and its statements if there are
    /// several.
    pub(crate) fn rows(&self) -> String {
        let Claim { id, place, claim, reason, .. } = &self.claim;
        // The only statement of a claim is in the row of the claim, which it would repeat.
        if let [only] = self.statements.as_slice() {
            return format!("| {id} | {place} | {claim} | {} | {reason} |\n", only.cells());
        }
        let [paper, as_written] = self.verdicts.map(marked);
        let mut rows =
            format!("| {id} | {place} | {claim} | | | {paper} | {as_written} | {reason} |\n");
        for (letter, statement) in ('a'..='z').zip(&self.statements) {
            let _ =
                writeln!(rows, "| {id}{letter} | | {} | {} | |", statement.text, statement.cells());
        }
        rows
    }

    /// Returns rows that compare the findings of each statement with the findings in `others`.
    ///
    /// The columns are the findings with the base `L`, and with `2L` if `bases` is 2. A row is
    /// included if `shown` returns true for the findings with any base.
    pub(crate) fn rows_beside(
        &self,
        others: &[&Self],
        bases: usize,
        shown: impl Fn(&[&Finding]) -> bool,
    ) -> Vec<String> {
        let mut rows = Vec::new();
        for (k, ours) in self.statements.iter().enumerate() {
            let text = if ours.text.is_empty() { &self.claim.claim } else { &ours.text };
            let all = std::iter::once(ours).chain(others.iter().map(|of| &of.statements[k]));
            let found: Vec<Vec<_>> =
                (0..bases).map(|base| all.clone().map(|of| &of.found[base]).collect()).collect();
            let cells: Vec<_> =
                found.iter().flatten().map(|of| format!("{}: {}", of.verdict, of.ours)).collect();
            if found.iter().any(|found| shown(found)) {
                rows.push(format!("| {}: {text} | {} |", self.claim.id, cells.join(" | ")));
            }
        }
        rows
    }
}

impl CheckedStatement {
    fn cells(&self) -> String {
        let [paper, as_written] = [0, 1]
            .map(|base| format!("{}: {}", marked(self.found[base].verdict), self.found[base].ours));
        format!("{} | {} | {paper} | {as_written}", self.measured, self.limits)
    }
}

/// Formats a verdict, in bold if the claim is reproduced.
pub(crate) fn marked(verdict: Verdict) -> String {
    match verdict {
        Verdict::Reproduced => format!("**{verdict}**"),
        _ => verdict.to_string(),
    }
}
