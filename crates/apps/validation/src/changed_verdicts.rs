//! The claims in another model, beside those of the paper's.

use crate::page::lines;
use crate::{CheckedClaim, Finding};

/// The claims whose verdict another model changes.
#[derive(Clone, Debug)]
pub struct ChangedVerdicts {
    /// The statements with another verdict, as rows of their table.
    turned: Vec<String>,
    /// How many of the statements keep theirs.
    kept: usize,
}

impl ChangedVerdicts {
    /// Compares the claims of the paper's model with those of `others`, with a base of `L` and, if there are two `bases`, of `2L`.
    pub(crate) fn compare(
        paper: &[CheckedClaim],
        others: &[&[CheckedClaim]],
        bases: usize,
    ) -> Self {
        // All come from one table of claims, and so in one order.
        let turned = paper.iter().enumerate().flat_map(|(k, claim)| {
            let others: Vec<_> = others.iter().map(|claims| &claims[k]).collect();
            claim.rows_beside(&others, bases, turns)
        });
        let turned: Vec<_> = turned.collect();
        let all: usize = paper.iter().map(|claim| claim.statements.len()).sum();
        Self { kept: all - turned.len(), turned }
    }

    /// Returns which statements have another verdict with a friction of 0.1 or 0.3, as a table, or that none has.
    pub(crate) fn in_words(&self) -> String {
        let kept = self.kept;
        let setting = "With a friction of 0.1 and of 0.3, and the base L,";
        if self.turned.is_empty() {
            return format!("{setting} all {kept} statements of the claims keep their verdict.\n");
        }
        format!(
            "{setting} {kept} statements of the claims keep their verdict, and these do not:\n\n| | No friction | 0.1 | 0.3 |\n|---|---|---|---|\n{}",
            lines(&self.turned, String::clone)
        )
    }

    /// Returns the parts of the page in Markdown: the rows, and the count of what keeps its verdict, by these names.
    pub(crate) fn parts(&self, [turned, kept]: [&'static str; 2]) -> [(&'static str, String); 2] {
        [(turned, lines(&self.turned, String::clone)), (kept, self.kept.to_string())]
    }
}

/// Whether the findings of a statement have several verdicts.
fn turns(found: &[&Finding]) -> bool {
    found.windows(2).any(|pair| pair[0].verdict != pair[1].verdict)
}
