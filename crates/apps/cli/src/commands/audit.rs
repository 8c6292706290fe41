//! The report of an audit.

use std::fmt::Write as _;

use run::{Audit, LargestDifference, SecondMethod};

use crate::print::{aligned, counted, digits};

/// Maximum number of listed columns and contradictions.
const LISTED: usize = 8;

/// Tolerance on the relative difference between the two methods.
const AGREES: f64 = 1e-6;

/// Returns true if the two methods agree.
pub fn agrees(audit: &Audit) -> bool {
    audit.contradictions.is_empty()
        && audit.differences.iter().all(|found| found.relative <= AGREES)
}

/// Formats the largest differences.
pub fn report(audit: &Audit) -> String {
    let designs = counted(audit.designs, "design");
    let mut text =
        format!("audit: {designs} solved again by a second method; largest relative differences\n");
    // Sorted by size, so that truncation hides the smallest.
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

fn row(found: &LargestDifference) -> [String; 5] {
    let way = match found.method {
        SecondMethod::SmallerSteps => "steps a tenth as large",
        SecondMethod::Chain => "chain against unit cell",
    };
    let [first, second] = found.values.map(digits);
    let values = format!("{first} against {second}");
    [
        digits(found.relative),
        found.column.clone(),
        way.to_owned(),
        format!("design {}", found.design),
        values,
    ]
}
