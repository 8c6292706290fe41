//! Lengths in mm whose skins cannot be made: too thin, too thick, or scales longer than their pitch.

use super::invalid::Problem;
use crate::case::Case;
use crate::grid::{Axis, Grid};
use crate::number;
use crate::parameter::{Parameter, Scalar, key};
use crate::variable::{Variable, VariableValues};

/// What is wrong with the length `in_mm` in the designs of a grid and of its variables, if something is.
///
/// A length over the thickness is monotone in each of the lengths that it is made of, so the corners of their ranges tell.
pub(super) fn check(in_mm: &Parameter, grid: &Grid, variables: &[Variable]) -> Result<(), Problem> {
    let Some(of) = in_mm.said_in(grid.base()) else { return Ok(()) };
    let matters = |p: &Parameter| {
        let is_pitch = in_mm.key == key::PITCH;
        let makes_pitch = [key::GAP, key::LENGTH, "base"].iter().any(|key| p.is_or_says(key));
        p == in_mm || p.key == key::THICKNESS || (is_pitch && makes_pitch)
    };
    let axes = grid.axes().iter().filter(|axis| matters(axis.parameter()));
    let axes: Vec<_> = axes.map(|axis| (axis.parameter(), ends(axis, variables))).collect();
    let mut corners = vec![grid.case(0)];
    for (parameter, ends) in &axes {
        let at = |case: &Case| ends.iter().map(|end| parameter.put(case, *end)).collect::<Vec<_>>();
        corners = corners.iter().flat_map(at).collect();
    }
    let Some(wrong) = corners.iter().find(|case| !of.contains(of.get(case))) else { return Ok(()) };
    let mut beside: Vec<_> = axes.iter().map(|(parameter, _)| *parameter).collect();
    beside.retain(|parameter| parameter.key != in_mm.key && parameter.key != key::THICKNESS);
    beside.extend(Parameter::named(key::THICKNESS));
    let beside = beside.into_iter().map(|p| format!("{} {}", p.key, p.get(wrong)));
    Err(Problem::LengthInMm {
        value: in_mm.get(wrong).to_string(),
        beside: beside.collect::<Vec<_>>().join(", "),
        key: of.key,
        found: of.get(wrong).number().map(number::text).unwrap_or_default(),
        expected: of.expected(),
    })
}

/// The values of an axis, or of the variable that stands for it, between which the others are.
fn ends(axis: &Axis, variables: &[Variable]) -> Vec<Scalar> {
    let own = variables.iter().find(|variable| variable.parameter() == axis.parameter());
    match own.map(Variable::values) {
        Some(VariableValues::Between(from, to)) => vec![Scalar::Number(*from), Scalar::Number(*to)],
        Some(VariableValues::OneOf(values)) => values.clone(),
        None if axis.parameter().takes_numbers() => {
            let (low, high) = axis.span();
            vec![Scalar::Number(low), Scalar::Number(high)]
        }
        None => (0..axis.len()).map(|index| axis.value(index)).collect(),
    }
}
