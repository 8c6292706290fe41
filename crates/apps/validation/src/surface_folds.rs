//! Folds of the surface, and the claims on a substrate that cannot fold.

use crate::claims::{CheckedClaim, DesignValue, digits, named};
use crate::page::lines;
use crate::study::{MeasuredDesign, Study};

/// The claims about the strongest and most slanted designs.
const CONCERNED: [&str; 6] = ["C12", "C13", "C15", "C18", "C27", "C28"];

/// Number of strongest designs among which designs with a fold are counted.
const STRONGEST: usize = 60;

/// Folds with both laws of the substrate, and the claims that the folds concern.
#[derive(Clone, Debug)]
pub struct SurfaceFolds {
    /// Rows of the page: quantity, linear and neo-Hookean with base `L`, the same with base `2L`.
    rows: Vec<[String; 5]>,
    /// Rows for the statements of the claims in [`CONCERNED`].
    claims: Vec<String>,
    /// Numbers of the other claims for which the law changes the verdict.
    changed: Vec<String>,
}

impl SurfaceFolds {
    /// Compares studies on a linear and on a neo-Hookean substrate.
    ///
    /// On each substrate, there is a study with a base of `L` and one with `2L`. `claims` are the
    /// checked claims on the linear and on the neo-Hookean substrate.
    pub(crate) fn compare(
        linear: &[Study; 2],
        neo_hookean: &[Study; 2],
        claims: [&[CheckedClaim]; 2],
    ) -> Self {
        let (mut rows_of_claims, mut changed) = (Vec::new(), Vec::new());
        for (claim, other) in claims[0].iter().zip(claims[1]) {
            if CONCERNED.contains(&claim.claim.id.as_str()) {
                rows_of_claims.extend(claim.rows_beside(&[other], 2, |_| true));
            } else if claim.verdicts != other.verdicts {
                changed.push(claim.claim.id.clone());
            }
        }
        Self { rows: rows(linear, neo_hookean), claims: rows_of_claims, changed }
    }

    /// Returns the parts of the page in Markdown, by their names.
    pub(crate) fn parts(&self) -> [(&'static str, String); 3] {
        let changed = match self.changed.as_slice() {
            [] => "No other claim has another verdict.".to_owned(),
            changed => format!("Other claims with another verdict: {}.", changed.join(", ")),
        };
        [
            ("folds", lines(&self.rows, |row| format!("| {} |", row.join(" | ")))),
            ("claims on folds", lines(&self.claims, String::clone)),
            ("other claims", changed),
        ]
    }
}

/// A function that returns a quantity of a study as the text of a cell.
type Count = fn(&Study) -> String;

/// Returns a row for each quantity, with the values in all studies.
fn rows(linear: &[Study; 2], neo_hookean: &[Study; 2]) -> Vec<[String; 5]> {
    let studies = [&linear[0], &neo_hookean[0], &linear[1], &neo_hookean[1]];
    let counts: [(&str, Count); 7] = [
        ("designs with a surface fold before 10°", |study| {
            study.designs.iter().filter(|design| folds(design)).count().to_string()
        }),
        ("of the 60 with the largest `F_c*`", |study| {
            strongest(study).into_iter().filter(|design| folds(design)).count().to_string()
        }),
        ("force at the fold divided by `F_c*`: smallest, median, largest", |study| {
            spread(
                study.designs.iter().filter_map(|d| Some(d.fold_force? / d.critical_force?)),
                digits,
            )
        }),
        ("width of the narrowest gap at 10°, divided by its width at rest", |study| {
            spread(study.designs.iter().filter_map(|d| d.gap_stretch_min).reduce(f64::min), digits)
        }),
        ("width of the widest gap at 10°, divided by its width at rest", |study| {
            spread(study.designs.iter().filter_map(|d| d.gap_stretch_max).reduce(f64::max), digits)
        }),
        ("largest `F_c*`", |study| largest(study, |design| design.critical_force)),
        ("largest force before a fold", |study| largest(study, |d| d.sound_force)),
    ];
    let rows = counts.into_iter().map(|(what, count)| {
        let [a, b, c, d] = studies.map(count);
        [what.to_owned(), a, b, c, d]
    });
    let mut rows: Vec<[String; 5]> = rows.collect();
    for (what, folded) in [("that fold", true), ("that do not fold", false)] {
        let changes = [0, 1].map(|base| changes(&linear[base], &neo_hookean[base], folded));
        let [paper, as_written] = changes;
        let what = format!(
            "change of `F_c*` compared with linear springs, for designs {what} on linear springs: smallest, median, largest"
        );
        // The columns of linear springs stay empty, because linear springs are the reference.
        rows.push([what, String::new(), paper, String::new(), as_written]);
    }
    rows
}

fn folds(design: &MeasuredDesign) -> bool {
    design.fold_force.is_some()
}

/// Returns the designs with the largest critical force.
fn strongest(study: &Study) -> Vec<&MeasuredDesign> {
    let mut designs: Vec<_> = study.designs.iter().collect();
    // Designs without a critical force sort last.
    designs.sort_by(|a, b| {
        let [a, b] = [a, b].map(|design| design.critical_force.unwrap_or(f64::NEG_INFINITY));
        b.total_cmp(&a)
    });
    designs.truncate(STRONGEST);
    designs
}

/// Formats the largest value in a study with its design; empty without values.
fn largest(study: &Study, value: DesignValue) -> String {
    let values = study.designs.iter().filter_map(|design| Some((value(design)?, design)));
    let best = values.max_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or_else(String::new, |(value, design)| format!("{} {}", digits(value), named(design)))
}

/// Formats the changes of the critical force of the designs with (or without) a fold in `from`.
fn changes(from: &Study, to: &Study, folded: bool) -> String {
    // Both studies have the same designs in the same order.
    let pairs = from.designs.iter().zip(&to.designs).filter(|(a, _)| folds(a) == folded);
    // Adding 0 replaces −0 by 0, which would be printed as -0.0 %.
    spread(
        pairs.filter_map(|(a, b)| Some(100.0 * (b.critical_force? / a.critical_force? - 1.0))),
        |percent| format!("{:+.1} %", percent + 0.0),
    )
}

/// Formats the smallest, median and largest value.
///
/// A single value is shown once; without values, the text is empty.
fn spread(values: impl IntoIterator<Item = f64>, format: impl Fn(f64) -> String) -> String {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    let mut indices = vec![0, values.len() / 2, last];
    // Print the median once if it is also the smallest or the largest value.
    indices.dedup();
    let shown = indices.into_iter().filter_map(|index| values.get(index).copied().map(&format));
    shown.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::{digits, spread};

    #[test]
    fn a_spread_shows_the_smallest_the_median_and_the_largest_value() {
        assert_eq!(spread([3.0, 1.0, 2.0, 5.0, 4.0], digits), "1.000, 3.000, 5.000");
        assert_eq!(spread([2.0], digits), "2.000");
        assert_eq!(spread([], digits), "");
    }
}
