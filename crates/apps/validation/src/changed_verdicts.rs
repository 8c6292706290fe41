//! Statements of claims with verdicts that differ between the paper's model and other models.

use crate::page::lines;
use crate::{CheckedClaim, Finding};

/// The statements of claims that have different verdicts in the paper's model and in other models.
#[derive(Clone, Debug)]
pub struct ChangedVerdicts {
    /// The statements with different verdicts, as rows of a table.
    changed: Vec<String>,
    /// The number of statements with the same verdict in all models.
    kept: usize,
}

impl ChangedVerdicts {
    /// Compares the verdicts in the paper's model with the verdicts in `others`.
    ///
    /// If `bases` is 1, compares the verdicts with a base of `L`; if it is 2, also with `2L`.
    pub(crate) fn compare(
        paper: &[CheckedClaim],
        others: &[&[CheckedClaim]],
        bases: usize,
    ) -> Self {
        // All models have the same claims in the same order.
        let changed = paper.iter().enumerate().flat_map(|(k, claim)| {
            let others: Vec<_> = others.iter().map(|claims| &claims[k]).collect();
            claim.rows_beside(&others, bases, differs)
        });
        let changed: Vec<_> = changed.collect();
        let all: usize = paper.iter().map(|claim| claim.statements.len()).sum();
        Self { kept: all - changed.len(), changed }
    }

    /// Returns a table of the statements for which a friction of 0.1 or 0.3 changes the verdict.
    pub(crate) fn friction_table(&self) -> String {
        let kept = self.kept;
        let setting = "With a friction of 0.1 and of 0.3, and the base L,";
        if self.changed.is_empty() {
            return format!("{setting} all {kept} statements of the claims\nkeep their verdict.\n");
        }
        format!(
            "{setting} {kept} statements of the claims keep their verdict, and these do not:\n\n| | No friction | 0.1 | 0.3 |\n|---|---|---|---|\n{}",
            lines(&self.changed, String::clone)
        )
    }

    /// Returns the parts of the page in Markdown: the rows, and the number of unchanged verdicts.
    pub(crate) fn parts(&self, [changed, kept]: [&'static str; 2]) -> [(&'static str, String); 2] {
        [(changed, lines(&self.changed, String::clone)), (kept, self.kept.to_string())]
    }
}

/// Returns true if the findings of a statement have different verdicts.
fn differs(found: &[&Finding]) -> bool {
    found.windows(2).any(|pair| pair[0].verdict != pair[1].verdict)
}
