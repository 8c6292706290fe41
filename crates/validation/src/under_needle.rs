//! The claims under a needle that is guided, beside those under the paper's load.

use crate::page::lines;
use crate::{CheckedClaim, CheckedStatement};

/// The claims whose verdict a guided needle changes.
#[derive(Clone, Debug)]
pub struct UnderNeedle {
    /// The statements with another verdict, as rows of their table.
    turned: Vec<String>,
    /// How many of the statements keep theirs.
    kept: usize,
}

impl UnderNeedle {
    /// Compares the claims under the paper's load with those under a guided needle.
    pub(crate) fn of(paper: &[CheckedClaim], guided: &[CheckedClaim]) -> Self {
        // Both come from one table of claims, and so in one order.
        let pairs = paper.iter().zip(guided);
        let turned =
            pairs.flat_map(|(claim, other)| claim.rows_beside(other, CheckedStatement::turns));
        let turned: Vec<_> = turned.collect();
        let all: usize = paper.iter().map(|claim| claim.statements.len()).sum();
        Self { kept: all - turned.len(), turned }
    }

    /// Returns the parts of the page in Markdown, by their names.
    pub(crate) fn parts(&self) -> [(&'static str, String); 2] {
        let turned = lines(&self.turned, String::clone);
        [
            ("claims turned by the needle", turned),
            ("claims kept under the needle", self.kept.to_string()),
        ]
    }
}
