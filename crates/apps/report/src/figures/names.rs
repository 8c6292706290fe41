//! Names of columns in titles, axis labels and legends.
//!
//! `$` starts and ends italics, as in [`crate::label`].

use results::columns::{explain_value, name};

/// Columns with a symbol: column name, words, symbol, and definition of the symbol.
///
/// A vertical axis label omits the definition if it is too long.
const NAMED: [(&str, &str, &str, &str); 15] = [
    (name::COVERAGE, "coverage", "$λ$", ""),
    (name::CRITICAL_FORCE, "critical force", "$F_c^*$", " = $F_c$(1 − $ν$^2)/($E_s L t$)"),
    (name::PENETRATION, "penetration", "$u_{max}/t$", ""),
    (name::COMPLIANCE, "flexural compliance", "$C_f^*$", " = $C_f E_m I_m/t$"),
    (name::MAX_STIFFNESS, "largest stiffness", "$K_{max}^*$", " = $K_{max}$/($E_s t$)"),
    (name::SECANT_STIFFNESS, "secant stiffness", "$K_{sec}^*$", " = $K_{sec}$/($E_s t$)"),
    ("gap_over_t", "gap", "$d/t$", ""),
    ("gap_mm", "gap", "$d$", ""),
    ("length_over_t", "aspect ratio", "$L/t$", ""),
    ("length_mm", "length", "$L$", ""),
    ("width_over_t", "width", "$b/t$", ""),
    ("membrane_thickness_over_t", "membrane thickness", "$h/t$", ""),
    ("critical_tilt_deg", "critical tilt", "$θ_c$", ""),
    ("slant_deg", "slant", "$α$", ""),
    ("thickness_mm", "thickness", "$t$", ""),
];

/// Unit suffixes of column names, with their printed form.
///
/// The first suffix that matches applies, so `_N_mm` precedes `_mm`.
const UNITS: [(&str, &str); 8] = [
    ("_N_mm2", "N mm²"),
    ("_kg_m2", "kg/m²"),
    ("_N_mm", "N mm"),
    ("_MPa", "MPa"),
    ("_kPa", "kPa"),
    ("_mm", "mm"),
    ("_N", "N"),
    ("_deg", "°"),
];

/// Quantile suffixes of column names, with their words.
const QUANTILES: [(&str, &str); 3] =
    [("_p05", "5 % quantile of "), ("_p50", "median of "), ("_p95", "95 % quantile of ")];

/// Splits a column name into the name without unit and the unit, which may be empty.
fn without_unit(column: &str) -> (&str, String) {
    let end = UNITS.iter().find_map(|(end, unit)| Some((column.strip_suffix(end)?, *unit)));
    let Some((name, unit)) = end else { return (column, String::new()) };
    // The suffix `_N_mm` means a moment or a force per width; the column's description decides.
    let described = explain_value(column).map(|(unit, _)| unit.replace("^2", "²"));
    let described = described.filter(|unit| !["-", "deg"].contains(&unit.as_str()));
    (name, described.unwrap_or(unit.to_owned()))
}

/// Returns the symbol of a column and the definition of this symbol, if the column has a symbol.
fn symbol(column: &str) -> Option<(&'static str, &'static str)> {
    NAMED.iter().find(|(name, ..)| *name == column).map(|(.., symbol, meaning)| (*symbol, *meaning))
}

/// Returns the readable name of a column, which is given without its unit.
fn plain_name(name: &str) -> String {
    let mut quantiles = QUANTILES.iter();
    let quantile = quantiles.find_map(|(end, words)| Some((name.strip_suffix(end)?, *words)));
    let (name, quantile) = quantile.unwrap_or((name, ""));
    let named = NAMED.iter().find(|(column, ..)| without_unit(column).0 == name);
    match named {
        Some((_, words, ..)) => format!("{quantile}{words}"),
        None => quantile.to_owned() + &name.replace("_over_t", "/t").replace('_', " "),
    }
}

/// Returns the readable name of a column, with the unit in parentheses.
pub(crate) fn name_with_unit(column: &str) -> String {
    match without_unit(column) {
        (name, unit) if unit.is_empty() => plain_name(name),
        (name, unit) => format!("{} ({unit})", plain_name(name)),
    }
}

/// Returns the short name of a parameter for titles: its symbol, or else words.
pub(crate) fn in_short(parameter: &str) -> String {
    let symbol = symbol(parameter).map(|(symbol, _)| symbol.to_owned());
    symbol.unwrap_or_else(|| plain_name(without_unit(parameter).0))
}

/// Formats a parameter with its value, for titles of figures and panels.
pub(crate) fn with_value((parameter, value): &(&str, impl AsRef<str>)) -> String {
    let value = value.as_ref();
    let unit = without_unit(parameter).1;
    let space = if ["", "°"].contains(&unit.as_str()) { "" } else { " " };
    format!("{} = {value}{space}{unit}", in_short(parameter))
}

/// Returns the label of an axis for a column.
pub(crate) fn axis_label(column: &str) -> String {
    let (name, unit) = without_unit(column);
    let (symbol, meaning) = symbol(column).unwrap_or_default();
    let text = [&plain_name(name), symbol].join(" ");
    match unit.as_str() {
        "" => format!("{}{meaning}, dimensionless", text.trim_end()),
        "°" => format!("{}, degrees", text.trim_end()),
        unit => format!("{} ({unit})", text.trim_end()),
    }
}

#[cfg(test)]
mod tests {
    use super::{axis_label, in_short, name_with_unit, with_value};

    #[test]
    fn column_names_are_spelled_out() {
        let words =
            ["critical_force_N", "critical_force_p50_N", "max_moment_N_mm", "peak_tilt_deg"];
        assert_eq!(
            words.map(name_with_unit),
            [
                "critical force (N)",
                "median of critical force (N)",
                "max moment (N mm)",
                "peak tilt (°)"
            ]
        );
        assert_eq!(["gap_over_t", "slant_deg", "gap_cv"].map(in_short), ["$d/t$", "$α$", "gap cv"]);
        let values = [("thickness_mm", "1"), ("slant_deg", "30"), ("gap_cv", "0.3")];
        assert_eq!(values.each_ref().map(with_value), ["$t$ = 1 mm", "$α$ = 30°", "gap cv = 0.3"]);
        assert_eq!(axis_label("slant_deg"), "slant $α$, degrees");
        assert_eq!(axis_label("penetration_mm"), "penetration (mm)");
        assert_eq!(axis_label("coverage"), "coverage $λ$, dimensionless");
    }
}
