//! What is made of the designs that a search has found, for people and for programs.

use std::fmt::Write as _;

use optimisation::{BestDesign, Confirmation, Estimate};
use ranking::{Requirement, Unmet};
use serde_json::{Value, json};

use super::super::rank::distance;
use crate::print::{aligned, counted, digits};

/// What is made of the best design.
pub fn text(made: &Confirmation) -> String {
    let header = ["", "search", "others", "95 % interval of the others"].map(str::to_owned);
    let row = |of: &Estimate| {
        let [low, high] = of.interval.map(value);
        [of.name.clone(), value(of.seen), value(of.value), format!("{low} to {high}")]
    };
    let rows: Vec<_> = [header].into_iter().chain(made.estimates.iter().map(row)).collect();
    let mut text = format!(
        "\nMade of it: {} that the search saw, and {} others\n{}",
        counted(made.seen as u64, "skin"),
        sweep::number::text(made.fresh as f64),
        aligned(&rows)
    );
    let (open, broken): (Vec<_>, Vec<_>) = made.broken.iter().partition(|r| made.is_open(r));
    if !broken.is_empty() {
        let _ = writeln!(
            text,
            "  (!) The others do not keep {}: a design looks a little better on the skins that it was chosen by. Ask for more, or let the search see more skins (goal.skins)",
            joined(&broken)
        );
    }
    if !open.is_empty() {
        let _ = writeln!(
            text,
            "  (?) So many others cannot tell whether {} is kept: ask for a little more to be on the safe side",
            joined(&open)
        );
    }
    text
}

/// How far the design that comes nearest is from each requirement.
pub fn shortfalls(unmet: &Unmet) -> String {
    let header = ["requirement", "nearest has", "short by"].map(str::to_owned);
    let rows: Vec<_> =
        [header].into_iter().chain(unmet.requirements.iter().map(distance)).collect();
    format!("{}\n", aligned(&rows))
}

fn joined(requirements: &[&Requirement]) -> String {
    requirements.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// What is made of a design of a front: the values of the skins that the search did not see.
pub fn row(made: &Confirmation) -> Vec<[String; 2]> {
    made.estimates.iter().map(|of| [of.name.clone(), value(of.value)]).collect()
}

/// What is to be said of the skins of a whole front.
pub fn of_all(designs: &[BestDesign]) -> String {
    let made: Vec<&Confirmation> =
        designs.iter().filter_map(|best| best.confirmation.as_ref()).collect();
    let Some(first) = made.first() else { return String::new() };
    let fresh = sweep::number::text(first.fresh as f64);
    let mut text = format!(
        "  Quantiles and yields are those of {fresh} skins of each design that the search did not see; front.csv has their intervals, and what it saw. Designs of a front that differ by less than that may beat each other\n"
    );
    let broken = made.iter().filter(|made| !made.broken.is_empty()).count();
    if broken > 0 {
        let _ = writeln!(
            text,
            "  (!) Of {} these skins do not keep a requirement that those of the search do",
            counted(broken as u64, "design")
        );
    }
    text
}

/// What is made of a best design, for programs.
pub fn record(made: &Confirmation) -> Value {
    let estimate = |of: &Estimate| json!({"quantity": of.name, "seen": of.seen, "value": of.value, "interval": of.interval});
    json!({
        "seen": made.seen,
        "fresh": made.fresh,
        "estimates": made.estimates.iter().map(estimate).collect::<Vec<_>>(),
        "broken": made.broken.iter().map(ToString::to_string).collect::<Vec<_>>(),
    })
}

fn value(value: Option<f64>) -> String {
    value.map_or("none".to_owned(), digits)
}
