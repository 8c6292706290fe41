//! Command-line options and definitions that reproduce a design.

use ranking::Requirement;
use sweep::{Axis, Case, PARAMETERS, Scalar, Setting, Sweep};
use text::toml_source::quoted;

use super::Closest;

/// Keys of axes with their own options of `squama design`, and these options.
const OPTIONS: [(&str, &str); 3] =
    [("gap_over_t", "--gap"), ("length_over_t", "--length"), ("slant_deg", "--slant")];

/// Returns the options with which `squama design` solves `case` instead of `base`.
pub(crate) fn settings(sweep: &Sweep, base: &Case, case: &Case) -> Vec<String> {
    let mut options: Vec<String> = Vec::new();
    let by_option = OPTIONS.map(|(key, _)| sweep.grid().axis_in_any_unit(key).map(Axis::parameter));
    for ((_, option), parameter) in OPTIONS.iter().zip(&by_option) {
        options.extend(parameter.map(|parameter| format!("{option} {}", parameter.get(case))));
    }
    let axes = sweep.grid().axes().iter().map(Axis::parameter);
    let axes = axes.filter(|one| !by_option.contains(&Some(one)) && one.is_given(case));
    options.extend(axes.map(|axis| format!("--set designs.{}={}", axis.key, axis.get(case))));
    options.extend(others(sweep, base, case).map(|setting| format!("--set {setting}")));
    options
}

/// Returns a sweep that contains only the design `case`.
///
/// # Errors
/// If the definition is rejected, with the message of the commands.
pub(crate) fn alone(sweep: &Sweep, base: &Case, case: &Case) -> Result<Sweep, String> {
    let settings: Result<Vec<_>, _> =
        others(sweep, base, case).map(|text| Setting::parse(&text)).collect();
    let settings = settings.map_err(|error| error.to_string())?;
    let on_axes = sweep.at(case);
    if settings.is_empty() {
        return Ok(on_axes);
    }
    Sweep::parse(&on_axes.to_toml(), "definition", &settings).map_err(|error| error.to_string())
}

/// Returns the definition of a sweep of one design, with the requirements in a comment.
///
/// The requirements have the form of options of `squama rank`. The name contains a hash of the
/// definition, so that its results have their own folder.
pub(crate) fn definition(single: &Sweep, requirements: &[Requirement]) -> String {
    let toml = single.to_toml();
    // FNV-1a, folded to 16 bits.
    let hash = toml
        .bytes()
        .fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    let name = format!("{}-{:04x}", single.name(), (hash >> 16) ^ (hash & 0xffff));
    let (_, rest) = toml.split_once('\n').unwrap_or(("", &toml));
    let mut text = String::new();
    if !requirements.is_empty() {
        text.push_str("# Requirements:\n");
        text.extend(requirements.iter().map(|one| format!("#     --require '{one}'\n")));
        text.push('\n');
    }
    text + &format!("name = {}\n{rest}", quoted(&name))
}

/// Returns the settings of `case` that differ from `base`, except settings of axes.
fn others(sweep: &Sweep, base: &Case, case: &Case) -> impl Iterator<Item = String> {
    // Omit parameters that follow from other parameters: a definition with both is rejected.
    PARAMETERS
        .iter()
        .filter(|one| {
            let is_axis = sweep.grid().axis(one.key).is_some()
                || OPTIONS.iter().any(|(key, _)| one.key == *key);
            let is_changed = one.get(case) != one.get(base) || one.supersedes(base, case);
            !is_axis && one.is_given(case) && !one.follows(case) && is_changed
        })
        .map(|one| format!("{}={}", one.path(), one.get(case)))
}

/// Returns the grid design nearest to `case` on every axis; `None` for a single design.
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
    let of_case = axis.parameter().get(case);
    let distance = |value: &Scalar| match (value.number(), of_case.number()) {
        (Some(one), Some(other)) => (one - other).abs(),
        _ => f64::from(u8::from(*value != of_case)),
    };
    let values = (0..axis.len()).map(|index| axis.value(index));
    values.min_by(|one, other| distance(one).total_cmp(&distance(other))).unwrap_or(of_case)
}
