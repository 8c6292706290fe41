//! Claims about the distribution of the load over the scales (Fig. 9).

use super::digits;
use super::evidence::{Evidence, LoadedRow};
use super::statement::{Measured, Statement};
use super::verdict::Limits;

pub(super) const UNSLANTED: [Statement; 1] = [Statement::number(
    "",
    "scales that carry at least 5 % of the load",
    |evidence| row(evidence, 0, |row| row.carrying),
    Limits::between([1.0, 1.0], [1.0, 2.0]),
)];

/// "About eight".
const EIGHT: Limits = Limits::between([7.0, 9.0], [6.0, 10.0]);

pub(super) const DOMINO: [Statement; 2] = [
    Statement::number(
        "share the load",
        "scales that carry at least 5 % of it",
        |evidence| row(evidence, 1, |row| row.carrying),
        EIGHT,
    ),
    Statement::number(
        "tilt and contact",
        "scales that touch a neighbour",
        |evidence| row(evidence, 1, |row| row.touching),
        EIGHT,
    ),
];

fn row(evidence: &Evidence, which: usize, count: fn(&LoadedRow) -> usize) -> Option<Measured> {
    let row = evidence.loaded.as_ref()?.get(which)?;
    let count = count(row);
    let [force, displacement] = [row.force, row.displacement].map(digits);
    Some(Measured {
        value: count as f64,
        shown: format!("{count}, at F* = {force} and u* = {displacement}"),
    })
}
