//! Describes the statistics over new samples of the designs that a search found.

use std::fmt::Write as _;

use optimisation::{BestDesign, Confirmation, MissedRequirement};
use ranking::{Requirement, Unmet};

use super::super::rank::distance;
use crate::print::{aligned, counted, digits, rounded};

/// Formats the statistics of the best design over the samples of the search and over new samples.
pub fn text(confirmation: &Confirmation) -> String {
    let header = ["", "search", "new samples", "95 % interval"].map(str::to_owned);
    let rows: Vec<_> = [header]
        .into_iter()
        .chain(confirmation.estimates.iter().map(|of| {
            let [low, high] = of.interval.map(value);
            [of.name.clone(), value(of.seen), value(of.value), format!("{low} to {high}")]
        }))
        .collect();
    let mut text = format!(
        "\nSamples of the best design: {} in the search, {} new\n{}",
        confirmation.seen,
        text::number::text(confirmation.fresh as f64),
        aligned(&rows)
    );
    if !confirmation.missed.is_empty() {
        let _ = write!(text, "  {}", missed(&confirmation.missed));
    }
    let broken = confirmation.broken.iter();
    let (open, broken): (Vec<_>, Vec<_>) = broken.partition(|r| confirmation.is_open(r));
    if !broken.is_empty() {
        let _ = writeln!(
            text,
            "  (!) The new samples do not meet {}, because the search selects designs that suit its own samples. Require a little more, or solve more samples in the search (goal.skins)",
            joined(&broken)
        );
    }
    if !open.is_empty() {
        let _ = writeln!(
            text,
            "  (?) The new samples are too few to decide whether {} is met: require a little more to be safe",
            joined(&open)
        );
    }
    text
}

/// Returns a sentence on the requirements that samples miss; an empty text if `missed` is empty.
pub fn missed(missed: &[MissedRequirement]) -> String {
    let (mut parts, mut invalid) = (Vec::new(), None);
    for MissedRequirement { requirement, share } in missed {
        let percent = format!("{} %", text::number::rounded(100.0 * share, 3));
        let Some(Requirement { column, relation, limit }) = requirement else {
            invalid = Some(percent);
            continue;
        };
        let limit = format!("{column} {} {}", relation.sign(), rounded(*limit));
        parts.push(if parts.is_empty() {
            format!("{limit} is missed by {percent} of the samples")
        } else {
            format!("{limit} by {percent}")
        });
    }
    parts.extend(invalid.map(|percent| format!("{percent} of the samples have no valid path")));
    if parts.is_empty() { String::new() } else { format!("{}.\n", parts.join(", ")) }
}

/// Lists how far the nearest design is from each requirement.
///
/// Adds a sentence on the requirements that the samples of this design miss.
pub fn shortfalls(unmet: &Unmet, of_samples: &[MissedRequirement]) -> String {
    let header = ["requirement", "nearest", "short by"].map(str::to_owned);
    let rows: Vec<_> =
        [header].into_iter().chain(unmet.requirements.iter().map(distance)).collect();
    format!("{}\n{}", aligned(&rows), missed(of_samples))
}

fn joined(requirements: &[&Requirement]) -> String {
    requirements.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// Returns the names and values of the statistics of a design over its new samples.
pub fn row(confirmation: &Confirmation) -> Vec<[String; 2]> {
    confirmation.estimates.iter().map(|of| [of.name.clone(), value(of.value)]).collect()
}

/// Explains the statistics in the table of a front; an empty text if no design has statistics.
pub fn of_all(designs: &[BestDesign]) -> String {
    let all: Vec<&Confirmation> =
        designs.iter().filter_map(|best| best.confirmation.as_ref()).collect();
    let Some(first) = all.first() else { return String::new() };
    let fresh = text::number::text(first.fresh as f64);
    let mut text = format!(
        "  Quantiles and yields come from {fresh} new samples of each design; front.csv has their intervals and the values of the search. Differences smaller than an interval are not significant\n"
    );
    let broken = all.iter().filter(|of| !of.broken.is_empty()).count();
    if broken > 0 {
        let _ = writeln!(
            text,
            "  (!) {}: the new samples do not meet a requirement that the samples of the search meet",
            counted(broken as u64, "design")
        );
    }
    text
}

fn value(value: Option<f64>) -> String {
    value.map_or("none".to_owned(), digits)
}
