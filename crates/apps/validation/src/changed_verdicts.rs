//! Claims with a different verdict in another model.

use crate::page::lines;
use crate::{CheckedClaim, Finding};

/// The claims with another verdict in another model than the paper's.
#[derive(Clone, Debug)]
pub struct ChangedVerdicts {
    /// The statements with another verdict, as rows of their table.
    changed: Vec<String>,
    /// The number of statements with the same verdict.
    kept: usize,
}

impl ChangedVerdicts {
    /// Compares the verdicts in the paper's model with the verdicts in `others`.
    ///
    /// With two `bases`, for a base of `L` and of `2L`; otherwise for `L` only.
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

    /// Returns a table of the statements with another verdict for a friction of 0.1 or 0.3.
    pub(crate) fn in_words(&self) -> String {
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
