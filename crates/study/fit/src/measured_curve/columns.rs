//! Names and units of measured columns.

use super::Test;

/// A known column: its name, its test, its axis (0 or 1) and its unit.
///
/// The unit is in mm, N, 1/mm or N mm. `None` stands for the units of the model (`u*`, `F*`, `κ*`,
/// `M*`), as in the tables of `squama design`.
type Column = (&'static str, Test, usize, Option<f64>);

const COLUMNS: [Column; 21] = [
    ("displacement_mm", Test::Puncture, 0, Some(1.0)),
    ("displacement_um", Test::Puncture, 0, Some(1e-3)),
    ("displacement_cm", Test::Puncture, 0, Some(10.0)),
    ("displacement_m", Test::Puncture, 0, Some(1e3)),
    ("displacement_in", Test::Puncture, 0, Some(25.4)),
    ("displacement", Test::Puncture, 0, None),
    ("force_N", Test::Puncture, 1, Some(1.0)),
    ("force_mN", Test::Puncture, 1, Some(1e-3)),
    ("force_cN", Test::Puncture, 1, Some(1e-2)),
    ("force_kN", Test::Puncture, 1, Some(1e3)),
    ("force_gf", Test::Puncture, 1, Some(9.806_65e-3)),
    ("force_kgf", Test::Puncture, 1, Some(9.806_65)),
    ("force_lbf", Test::Puncture, 1, Some(4.448_221_615_260_5)),
    ("force", Test::Puncture, 1, None),
    ("curvature_per_mm", Test::Bending, 0, Some(1.0)),
    ("curvature_per_m", Test::Bending, 0, Some(1e-3)),
    ("curvature", Test::Bending, 0, None),
    ("moment_N_mm", Test::Bending, 1, Some(1.0)),
    ("moment_mN_m", Test::Bending, 1, Some(1.0)),
    ("moment_N_m", Test::Bending, 1, Some(1e3)),
    ("moment", Test::Bending, 1, None),
];

/// Words by which testing machines name the displacement, in English, German and French.
const DISPLACEMENTS: [&str; 14] = [
    "displacement",
    "extension",
    "crosshead",
    "stroke",
    "position",
    "travel",
    "deflection",
    "weg",
    "standardweg",
    "traversenweg",
    "verschiebung",
    "déplacement",
    "deplacement",
    "course",
];
/// Words by which testing machines name the force.
const FORCES: [&str; 8] =
    ["force", "load", "last", "kraft", "standardkraft", "prüfkraft", "effort", "charge"];
/// Words before the name of a quantity.
const QUALIFIERS: [&str; 6] =
    ["tensile", "compressive", "compression", "axial", "standard", "machine"];
/// Words of columns that hold another quantity.
const OTHERS: [&str; 11] = [
    "rate", "speed", "time", "max", "maximum", "peak", "break", "absolute", "absolue", "strain",
    "stress",
];

/// Normalises a column name.
///
/// `Force [N]`, `force (N)` and `Force, N` become `force_N`; `Curvature (1/m)` becomes
/// `curvature_per_m`.
pub(super) fn spelled(name: &str) -> String {
    let name = name.replace("1/", "per ").replace(['µ', 'μ'], "u");
    let mut words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let first = words.next().unwrap_or_default().to_lowercase();
    words.fold(first, |name, word| format!("{name}_{word}"))
}

/// Translates the name that a testing machine gives to a force or displacement with a unit.
///
/// `extension_mm` and `traversenweg_mm` become `displacement_mm`, `standardkraft_N` becomes
/// `force_N`. Other names stay.
fn translated(name: &str) -> String {
    let words: Vec<_> = name.split('_').collect();
    let (Some((unit, words)), false) = (words.split_last(), words.len() < 2) else {
        return name.to_owned();
    };
    let words: Vec<_> = words.iter().map(|word| word.to_lowercase()).collect();
    let is_other = words.iter().any(|word| OTHERS.contains(&word.as_str()));
    let named = words.iter().find(|word| !QUALIFIERS.contains(&word.as_str()));
    let quantity = match named.map(String::as_str) {
        _ if is_other => None,
        Some(word) if DISPLACEMENTS.contains(&word) => Some("displacement"),
        Some(word) if FORCES.contains(&word) => Some("force"),
        _ => None,
    };
    let translated = quantity.map(|quantity| format!("{quantity}_{unit}"));
    let is_known = |name: &String| COLUMNS.iter().any(|column| column.0 == name);
    translated.filter(is_known).unwrap_or_else(|| name.to_owned())
}

/// Columns of one curve, by index, with the units in which they are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CurveColumns {
    pub(super) indices: [usize; 2],
    pub(super) test: Test,
    /// `None` for the units of the model.
    pub(super) units: Option<[f64; 2]>,
}

/// Finds the columns of the curves in a table, one pair for each specimen side by side.
///
/// Names of squama come first, then names of testing machines.
///
/// # Errors
///
/// If no two columns belong to one test, or several could be the displacement or the force.
pub(super) fn curves(names: &[String]) -> Result<Vec<CurveColumns>, String> {
    if let Some(curves) = pairs(names)? {
        return Ok(curves);
    }
    let translations: Vec<_> = names.iter().map(|name| translated(name)).collect();
    for axis in ["displacement_", "force_"] {
        let mut alike: Vec<_> = names
            .iter()
            .zip(&translations)
            .filter(|(_, translation)| translation.starts_with(axis))
            .map(|(name, _)| name.as_str())
            .collect();
        alike.sort_unstable();
        alike.dedup();
        if alike.len() > 1 {
            let all = alike.join(" and ");
            let quantity = axis.trim_end_matches('_');
            return Err(format!(
                "the columns {all} could all be the {quantity}, expected one: name the columns with columns = [...] in [[curve]], or --measured-columns"
            ));
        }
    }
    pairs(&translations)?.ok_or_else(|| {
        let all = COLUMNS.map(|(name, ..)| name).join(" ");
        let names = if names.is_empty() { "none".to_owned() } else { names.join(" ") };
        format!(
            "its columns are {names}, expected two of one test: {all}; \
             columns = [...] in [[curve]], or --measured-columns, names the columns otherwise"
        )
    })
}

/// Returns the first two columns of one test in one system of units, for each specimen.
///
/// # Errors
///
/// If one of the names occurs more often than the other.
fn pairs(names: &[String]) -> Result<Option<Vec<CurveColumns>>, String> {
    let known = |axis: usize| {
        names.iter().filter_map(move |name| COLUMNS.iter().find(|c| c.0 == name && c.2 == axis))
    };
    let mut both = known(0).flat_map(|x| known(1).map(move |y| [x, y]));
    let Some([x, y]) = both.find(|[x, y]| x.1 == y.1 && x.3.is_some() == y.3.is_some()) else {
        return Ok(None);
    };
    let [xs, ys] = [x, y].map(|column| {
        let alike = names.iter().enumerate().filter(|(_, name)| *name == column.0);
        alike.map(|(index, _)| index).collect::<Vec<_>>()
    });
    if xs.len() != ys.len() {
        // Taking the first of several columns might be wrong.
        let column = if xs.len() > ys.len() { x } else { y };
        return Err(format!(
            "has several columns {0}, expected one: give the others another name",
            column.0
        ));
    }
    let (test, units) = (x.1, x.3.zip(y.3).map(|(x, y)| [x, y]));
    let curve = |(x, y)| CurveColumns { indices: [x, y], test, units };
    Ok(Some(xs.into_iter().zip(ys).map(curve).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_testing_machines_are_translated() {
        for (name, translation) in [
            ("Extension (mm)", "displacement_mm"),
            ("Compressive load [N]", "force_N"),
            ("Standardkraft kN", "force_kN"),
            ("Standardweg mm", "displacement_mm"),
            ("Course standard mm", "displacement_mm"),
            ("Déplacement (µm)", "displacement_um"),
            ("Crosshead Rate (mm)", "crosshead_Rate_mm"),
            ("Traverse absolue mm", "traverse_absolue_mm"),
            ("Maximum Load (N)", "maximum_Load_N"),
            ("Load", "load"),
            ("Load (oz)", "load_oz"),
        ] {
            assert_eq!(translated(&spelled(name)), translation, "{name}");
        }
    }

    #[test]
    fn specimens_side_by_side_are_found() {
        let names = ["Extension (mm)", "Load (N)", "Extension (mm)", "Load (N)"].map(spelled);
        let found: Vec<_> = curves(&names).expect("curves").iter().map(|c| c.indices).collect();
        assert_eq!(found, [[0, 1], [2, 3]]);
        let names = ["Extension (mm)", "Stroke (mm)", "Load (N)"].map(spelled);
        let refused = curves(&names).expect_err("two displacements");
        assert!(
            refused.starts_with(
                "the columns extension_mm and stroke_mm could all be the displacement"
            ),
            "{refused}"
        );
    }
}
