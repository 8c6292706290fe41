//! A design in the words of commands and definitions.

use sweep::{Axis, Case, PARAMETERS, Parameter, Scalar, Sweep};

use super::Closest;

/// The three axes that `squama design` has options for.
const OPTIONS: [(&str, &str); 3] =
    [("gap_over_t", "--gap"), ("length_over_t", "--length"), ("slant_deg", "--slant")];

/// The options with which `squama design` solves `case`, where the definition alone has `base`.
pub(crate) fn settings(sweep: &Sweep, base: &Case, case: &Case) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for (key, option) in OPTIONS {
        let value = Parameter::named(key).map(|parameter| parameter.get(case));
        words.extend(value.map(|value| format!("{option} {value}")));
    }
    let others = PARAMETERS.iter().filter(|one| OPTIONS.iter().all(|(key, _)| one.key != *key));
    for parameter in others {
        let is_axis = sweep.grid().axis(parameter.key).is_some();
        if is_axis || parameter.get(case) != parameter.get(base) {
            let section = if is_axis { "designs" } else { parameter.section };
            words.push(format!("--set {section}.{}={}", parameter.key, parameter.get(case)));
        }
    }
    words
}

/// The design of `sweep` whose value on every axis is closest to that of `case`; none of a definition of one design.
pub(crate) fn closest(sweep: &Sweep, case: &Case) -> Option<Closest> {
    let grid = sweep.grid();
    let on_grid = grid
        .axes()
        .iter()
        .fold(grid.case(0), |near, axis| axis.parameter().put(&near, nearest(axis, case)));
    let index = grid.find(&on_grid).filter(|_| grid.len() > 1)?;
    let value =
        |axis: &Axis| Some((axis.parameter().key, axis.parameter().get(&on_grid).number()?));
    Some(Closest {
        design: grid.number(index).to_string(),
        values: grid.axes().iter().filter_map(value).collect(),
    })
}

fn nearest(axis: &Axis, case: &Case) -> Scalar {
    let own = axis.parameter().get(case);
    let distance = |value: &Scalar| match (value.number(), own.number()) {
        (Some(one), Some(other)) => (one - other).abs(),
        _ => f64::from(u8::from(*value != own)),
    };
    let values = (0..axis.len()).map(|index| axis.value(index));
    values.min_by(|one, other| distance(one).total_cmp(&distance(other))).unwrap_or(own)
}
