//! Formats the report of an audit, which solves designs again by a second method.

use std::fmt::Write as _;

use run::{Audit, LargestDifference, SecondMethod};

use crate::print::{aligned, counted, digits};

/// Maximum number of differences, and of contradictions, that the report lists.
const LISTED: usize = 8;

/// Largest relative difference at which two methods agree.
const AGREES: f64 = 1e-6;

/// Returns true if the first and the second method agree for all designs.
pub fn agrees(audit: &Audit) -> bool {
    audit.contradictions.is_empty()
        && audit.differences.iter().all(|found| found.relative <= AGREES)
}

/// Formats the largest relative difference of each column and method, and the contradictions.
///
/// A contradiction is a cell with different texts, or with a value in only one of both methods.
pub fn report(audit: &Audit) -> String {
    let designs = counted(audit.designs, "design");
    let mut text =
        format!("audit: {designs} solved again by a second method; largest relative differences\n");
    // The differences are in descending order, so the report omits the smallest ones.
    let rows: Vec<_> = audit.differences.iter().take(LISTED).map(row).collect();
    text.push_str(&aligned(&rows));
    let texts =
        audit.contradictions.iter().take(LISTED).map(|(column, design, [first, second])| {
            [column.clone(), format!("design {design}"), format!("{first:?} against {second:?}")]
        });
    text.push_str(&aligned(&texts.collect::<Vec<_>>()));
    let more = audit.contradictions.len().saturating_sub(LISTED);
    if more > 0 {
        let _ = writeln!(text, "  and {more} more");
    }
    text
}

/// Returns the cells of a difference: size, column, second method, design and both values.
fn row(found: &LargestDifference) -> [String; 5] {
    let method = match found.method {
        SecondMethod::SmallerSteps => "steps a tenth as large",
        SecondMethod::Chain => "chain against unit cell",
    };
    let [first, second] = found.values.map(digits);
    let values = format!("{first} against {second}");
    [
        digits(found.relative),
        found.column.clone(),
        method.to_owned(),
        format!("design {}", found.design),
        values,
    ]
}
