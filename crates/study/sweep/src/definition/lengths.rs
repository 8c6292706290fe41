//! Checks lengths in mm, moduli and strengths of the scales, radii and the load position.
//!
//! Refuses lengths in mm with an invalid ratio to the thickness, scales longer than their pitch,
//! scales softer than the material below, bodies with radii near zero, and sharp needles between
//! two scales.

use super::invalid::Problem;
use crate::grid::{Axis, Grid};
use crate::parameter::{Parameter, WrongValue, key};
use crate::scalar::Scalar;
use crate::variable::{Variable, VariableValues};
use text::number;

/// Checks the values of the parameter `given` in all designs and in the ranges of the variables.
///
/// Only lengths in mm, radii, moduli and strengths in `MPa`, forces in N and load positions are
/// checked; other parameters are accepted.
pub(super) fn check(given: &Parameter, grid: &Grid, variables: &[Variable]) -> Result<(), Problem> {
    if given.key == key::LOAD_POSITION {
        return check_load_position(given, grid, variables);
    }
    if given.is_or_determines(key::RADIUS) || given.is_or_determines(key::RADIUS_TO) {
        check_radius(given, grid, variables)?;
    }
    let length = given.determines(grid.base()).map(|of| (of, key::THICKNESS));
    let mut all = length.into_iter().chain(given.ratios());
    all.try_for_each(|(of, unit)| check_one(given, (of, unit), grid, variables))
}

/// Refuses a load position between two scales unless the needle has a round tip.
fn check_load_position(
    given: &Parameter,
    grid: &Grid,
    variables: &[Variable],
) -> Result<(), Problem> {
    let axis = grid.axes().iter().find(|axis| axis.parameter() == given);
    let positions = axis.map_or_else(|| vec![given.get(grid.base())], |axis| ends(axis, variables));
    let case = grid.case(0);
    match positions.iter().find(|x| !given.put(&case, **x).has_valid_load_position()) {
        Some(position) => Err(Problem::Value(WrongValue::OutOfRange {
            found: position.to_string(),
            expected: "a number of at least 0 and at most 1; a load above 1, between two scales, needs puncture.needle_radius_over_t".to_owned(),
        })),
        None => Ok(()),
    }
}

/// Minimum radius of a body, divided by the thickness (first) and in mm (second).
///
/// The radius must be at least the thickness of the scales. The minimum in mm is small, because the
/// thickness may be small.
const LEAST_RADIUS: [f64; 2] = [1.0, 1e-3];

/// Refuses a radius near zero, and a variable with a range that contains zero.
fn check_radius(given: &Parameter, grid: &Grid, variables: &[Variable]) -> Result<(), Problem> {
    let axis = grid.axes().iter().find(|axis| axis.parameter() == given);
    let variable = variables.iter().find(|variable| variable.parameter() == given);
    let least = LEAST_RADIUS[usize::from(given.is_in_mm())];
    let is_short = |radius: &Scalar| radius.number().is_some_and(|radius| radius.abs() < least);
    let found = match (variable.map(Variable::values), axis) {
        (Some(VariableValues::Between(from, to)), _)
            if from * to <= 0.0 || from.abs().min(to.abs()) < least =>
        {
            Some(format!("{} to {}", number::text(*from), number::text(*to)))
        }
        (Some(VariableValues::Between(..)), _) => None,
        (_, Some(axis)) => {
            let mut radii = (0..axis.len()).map(|index| axis.value(index));
            radii.find(is_short).map(|radius| radius.to_string())
        }
        _ => Some(given.get(grid.base())).filter(is_short).map(|radius| radius.to_string()),
    };
    let Some(found) = found else { return Ok(()) };
    let expected = format!(
        "a radius of at least {least} {} for a convex body, or of at most -{least} for a concave \
         one; curvature_times_t may pass through 0, a flat body",
        given.unit
    );
    Err(Problem::Value(WrongValue::OutOfRange { found, expected }))
}

/// Checks the parameter `of`, which is computed from `given` and the parameter `unit`.
///
/// `of` is monotonic in `given` and `unit`; if `given` is a pitch, also in gap, length and base. So
/// checking the corners of the ranges of these parameters suffices.
fn check_one(
    given: &Parameter,
    (of, unit): (&'static Parameter, &str),
    grid: &Grid,
    variables: &[Variable],
) -> Result<(), Problem> {
    let axes = grid.axes().iter().filter(|axis| {
        let (p, is_pitch) = (axis.parameter(), given.key == key::PITCH);
        let makes_pitch = [key::GAP, key::LENGTH, "base"].iter().any(|key| p.is_or_determines(key));
        p == given || p.key == unit || (is_pitch && makes_pitch)
    });
    let axes: Vec<_> = axes.map(|axis| (axis.parameter(), ends(axis, variables))).collect();
    // Start from any design: the loop overwrites all parameters that affect `of`.
    let mut corners = vec![grid.case(0)];
    for (parameter, ends) in &axes {
        corners = corners
            .iter()
            .flat_map(|case| ends.iter().map(|end| parameter.put(case, *end)).collect::<Vec<_>>())
            .collect();
    }
    let Some(wrong) = corners.iter().find(|case| !of.contains(of.get(case))) else { return Ok(()) };
    let mut beside: Vec<_> = axes.iter().map(|(parameter, _)| *parameter).collect();
    beside.retain(|parameter| parameter.key != given.key && parameter.key != unit);
    beside.extend(Parameter::named(unit));
    let beside = beside.into_iter().map(|p| format!("{} {}", p.key, p.get(wrong)));
    Err(Problem::LengthInMm {
        value: given.get(wrong).to_string(),
        beside: beside.collect::<Vec<_>>().join(", "),
        key: of.key,
        found: of.get(wrong).number().map(number::text).unwrap_or_default(),
        expected: of.expected(),
    })
}

/// Returns the smallest and the largest value of an axis, or of the variable on this axis.
///
/// For words and lists of a variable, returns all values.
fn ends(axis: &Axis, variables: &[Variable]) -> Vec<Scalar> {
    let variable = variables.iter().find(|variable| variable.parameter() == axis.parameter());
    match variable.map(Variable::values) {
        Some(VariableValues::Between(from, to)) => vec![Scalar::Number(*from), Scalar::Number(*to)],
        Some(VariableValues::OneOf(values)) => values.clone(),
        None if axis.parameter().takes_numbers() => {
            let (low, high) = axis.span();
            vec![Scalar::Number(low), Scalar::Number(high)]
        }
        // Words have no order, so check all of them.
        None => (0..axis.len()).map(|index| axis.value(index)).collect(),
    }
}
