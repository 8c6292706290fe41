//! Names and units of measured columns.

use super::Test;

/// A known column: its name, its test, its axis (0 or 1) and its unit.
///
/// The unit is a factor to mm, N, 1/mm or N mm. `None` stands for the units of the model (`u*`,
/// `F*`, `κ*`, `M*`), as in the tables of `squama design`.
type Column = (&'static str, Test, usize, Option<f64>);

static COLUMNS: [Column; 21] = [
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

/// Words with which testing machines name the displacement, in English, German and French.
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
/// Words with which testing machines name the force, in English, German and French.
const FORCES: [&str; 8] =
    ["force", "load", "last", "kraft", "standardkraft", "prüfkraft", "effort", "charge"];
/// Other spellings of units. A µ of a DOS code page reads as æ in Windows-1252.
const UNITS: [(&str, &str); 6] =
    [("inch", "in"), ("inches", "in"), ("lb", "lbf"), ("lbs", "lbf"), ("kp", "kgf"), ("æm", "um")];
/// Words that may precede the name of a quantity.
const QUALIFIERS: [&str; 6] =
    ["tensile", "compressive", "compression", "axial", "standard", "machine"];
/// Words that exclude a column: it holds neither the displacement nor the force of a curve.
const OTHERS: [&str; 11] = [
    "rate", "speed", "time", "max", "maximum", "peak", "break", "absolute", "absolue", "strain",
    "stress",
];

/// Normalises a column name.
///
/// `Force [N]`, `force (N)` and `Force, N` become `force_N`; `Curvature (1/m)` becomes
/// `curvature_per_m`. The symbols µ, %, ″ and 1/ become `u`, `percent`, `in` and `per`.
pub(super) fn spelled(name: &str) -> String {
    let name = name.replace("1/", "per ").replace(['µ', 'μ'], "u").replace('%', " percent ");
    let name = name.replace("(\")", " in ").replace("[\"]", " in ").replace('″', " in ");
    let mut words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let first = words.next().unwrap_or_default().to_lowercase();
    words.fold(first, |name, word| format!("{name}_{word}"))
}

/// Translates the name that a testing machine gives to a force or displacement with a unit.
///
/// `extension_mm` and `traversenweg_mm` become `displacement_mm`, `standardkraft_N` becomes
/// `force_N`. Other names are returned unchanged.
fn translated(name: &str) -> String {
    let words: Vec<_> = name.split('_').collect();
    let (Some((unit, words)), false) = (words.split_last(), words.len() < 2) else {
        return name.to_owned();
    };
    let unit = UNITS.iter().find(|(other, _)| other == unit).map_or(*unit, |(_, unit)| unit);
    let words: Vec<_> = words.iter().map(|word| word.to_lowercase()).collect();
    let quantity = quantity(&words);
    let translated = quantity.map(|quantity| format!("{quantity}_{unit}"));
    translated
        .filter(|name| COLUMNS.iter().any(|column| column.0 == name))
        .unwrap_or_else(|| name.to_owned())
}

/// Returns the quantity that the words of a column name state, e.g. `force` for `axial load`.
fn quantity(words: &[String]) -> Option<&'static str> {
    if words.iter().any(|word| OTHERS.contains(&word.as_str())) {
        return None;
    }
    let word = words.iter().find(|word| !QUALIFIERS.contains(&word.as_str()))?.as_str();
    let quantities = ["displacement", "force", "curvature", "moment"];
    match word {
        _ if DISPLACEMENTS.contains(&word) => Some("displacement"),
        _ if FORCES.contains(&word) => Some("force"),
        _ => quantities.into_iter().find(|quantity| *quantity == word),
    }
}

/// Returns the quantity that a normalised column name states, with or without a unit.
fn quantity_of(name: &str) -> Option<&'static str> {
    quantity(&name.split('_').map(str::to_lowercase).collect::<Vec<_>>())
}

/// Counts the different quantities that column names state.
///
/// Among unknown rows of text, the row with the largest count counts as the header.
pub(super) fn quantities(names: &[String]) -> usize {
    let mut quantities: Vec<_> = names.iter().filter_map(|name| quantity_of(name)).collect();
    quantities.sort_unstable();
    quantities.dedup();
    quantities.len()
}

/// Removes the numbers of specimens: `extension_2_mm` becomes `extension_mm`.
fn unnumbered(name: &str) -> String {
    let words = name.split('_').filter(|word| !word.bytes().all(|byte| byte.is_ascii_digit()));
    words.collect::<Vec<_>>().join("_")
}

/// The two columns of a curve in a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CurveColumns {
    pub(super) indices: [usize; 2],
    pub(super) test: Test,
    /// Factors to mm and N, or to 1/mm and N mm; `None` for the units of the model.
    pub(super) units: Option<[f64; 2]>,
}

/// Finds the columns of the curves in a table, one pair for each specimen side by side.
///
/// Column names that squama writes take precedence over names of testing machines.
///
/// # Errors
///
/// If no two columns belong to one test, or several columns could be the displacement or the force.
pub(super) fn curves(names: &[String]) -> Result<Vec<CurveColumns>, String> {
    let unnumbered: Vec<_> = names.iter().map(|name| unnumbered(name)).collect();
    if let Ok(Some(curves)) = pairs(&unnumbered)
        && curves.len() > 1
    {
        return Ok(curves);
    }
    if let Some(curves) = pairs(names)? {
        return Ok(curves);
    }
    let translations: Vec<_> = unnumbered.iter().map(|name| translated(name)).collect();
    for axis in ["displacement_", "force_"] {
        let mut alike: Vec<_> = unnumbered
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
                "the columns {all} could all be the {quantity}, expected one: {OTHERWISE}"
            ));
        }
    }
    pairs(&translations)?.ok_or_else(|| missing(names))
}

/// Advice for files with unknown column names, as the end of an error message.
const OTHERWISE: &str = "name the columns with columns = [...] in [[curve]], or --measured-columns";

/// Returns the known column that `in_file` states, if its unit contradicts the name `given`.
///
/// `given` comes from the definition; `in_file` is the name or only the unit in the file.
pub(super) fn contradiction(given: &str, in_file: &str) -> Option<&'static str> {
    let quantity = given.split('_').next().unwrap_or_default();
    let (words, unit) =
        in_file.rsplit_once('_').map_or(("", in_file), |(words, unit)| (words, unit));
    let unit = UNITS.iter().find(|(other, _)| *other == unit).map_or(unit, |(_, unit)| unit);
    let in_file = format!("_{words}_{unit}");
    let mut stated: Option<&str> = None;
    for (name, ..) in &COLUMNS {
        let unit = name.strip_prefix(quantity).filter(|unit| unit.starts_with('_'));
        let is_stated = unit.is_some_and(|unit| in_file.ends_with(unit));
        if is_stated && stated.is_none_or(|other| other.len() < name.len()) {
            stated = Some(name);
        }
    }
    stated.filter(|name| *name != given)
}

/// Returns the known column for a name that squama or a testing machine writes.
fn known(name: &str) -> Option<&'static Column> {
    let name = translated(name);
    COLUMNS.iter().find(|column| column.0 == name)
}

/// Lists the columns of a quantity for a message, e.g. `force_N (_mN _cN)`.
fn units_of(quantity: &str) -> String {
    let of = COLUMNS.iter().filter_map(|column| column.0.strip_prefix(quantity)?.strip_prefix('_'));
    let mut units = of.map(|unit| format!("_{unit}"));
    let first = units.next().unwrap_or_default();
    format!("{quantity}{first} ({})", units.collect::<Vec<_>>().join(" "))
}

/// Returns the error message for names without two columns of one test.
pub(super) fn missing(names: &[String]) -> String {
    let mut units = names.iter().filter_map(|name| known(name)).map(|column| column.3);
    let has_units = units.any(|unit| unit.is_some());
    let mut reasons = Vec::new();
    for axis in [["displacement", "curvature"], ["force", "moment"]] {
        let named =
            names.iter().filter(|name| quantity_of(name).is_some_and(|q| axis.contains(&q)));
        let named: Vec<_> = named.collect();
        match named.first() {
            None => reasons.push(format!("no column is a {}", axis.join(" or a "))),
            Some(name) => {
                let mut columns = named.iter().filter_map(|name| known(name));
                if !columns.any(|column| column.3.is_some() == has_units) {
                    reasons.push(format!("{name} has no known unit"));
                }
            }
        }
    }
    if reasons.is_empty() {
        reasons.push("no two columns belong to one test".to_owned());
    }
    let shown = if names.is_empty() {
        "has no header".to_owned()
    } else {
        format!("its columns are {}: {}", names.join(" "), reasons.join(", "))
    };
    let [x, y, curvature, moment] = ["displacement", "force", "curvature", "moment"].map(units_of);
    format!("{shown}; expected {x} and {y}, or {curvature} and {moment}; otherwise {OTHERWISE}")
}

/// Returns the first two columns of one test in one system of units, for each specimen.
///
/// Specimens side by side repeat both names. `None` if no two columns belong to one test.
///
/// # Errors
///
/// If one of the two names occurs more often than the other.
fn pairs(names: &[String]) -> Result<Option<Vec<CurveColumns>>, String> {
    let known = names.iter().filter_map(|name| COLUMNS.iter().find(|column| column.0 == name));
    let (xs, ys): (Vec<&Column>, Vec<_>) = known.partition(|column| column.2 == 0);
    let mut both = xs.into_iter().flat_map(|x| ys.iter().map(move |y| [x, *y]));
    let Some([x, y]) = both.find(|[x, y]| x.1 == y.1 && x.3.is_some() == y.3.is_some()) else {
        return Ok(None);
    };
    let [xs, ys] = [x, y].map(|column| {
        let alike = names.iter().enumerate().filter(|(_, name)| *name == column.0);
        alike.map(|(index, _)| index).collect::<Vec<_>>()
    });
    if xs.len() != ys.len() {
        // The first of several columns with one name might be the wrong one.
        let column = if xs.len() > ys.len() { x } else { y };
        return Err(format!("has several columns {0}, expected one: {OTHERWISE}", column.0));
    }
    let (test, units) = (x.1, x.3.zip(y.3).map(|(x, y)| [x, y]));
    let pairs = xs.into_iter().zip(ys);
    Ok(Some(pairs.map(|(x, y)| CurveColumns { indices: [x, y], test, units }).collect()))
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
            ("Travel (inch)", "displacement_in"),
            ("Load lbs", "force_lbf"),
            ("Weg [æm]", "displacement_um"),
            ("Travel (\")", "displacement_in"),
            ("Force (%)", "force_percent"),
            ("Load (oz)", "load_oz"),
        ] {
            assert_eq!(translated(&spelled(name)), translation, "{name}");
        }
    }

    #[test]
    fn given_names_may_not_contradict_units_in_the_file() {
        for (given, name, stated) in [
            ("displacement_mm", "Weg (mm)", None),
            ("displacement_mm", "(in)", Some("displacement_in")),
            ("displacement_mm", "inch", Some("displacement_in")),
            ("force_N", "Kraft [kN]", Some("force_kN")),
            ("force", "Load (N)", Some("force_N")),
            ("force_N", "Load", None),
            ("curvature_per_m", "Kappa (1/mm)", Some("curvature_per_mm")),
            ("moment_N_mm", "Moment (N mm)", None),
        ] {
            assert_eq!(contradiction(given, &spelled(name)), stated, "{given} {name}");
        }
    }

    #[test]
    fn specimens_side_by_side_are_found() {
        let names = ["Extension (mm)", "Load (N)", "Extension (mm)", "Load (N)"].map(spelled);
        let found: Vec<_> = curves(&names).expect("curves").iter().map(|c| c.indices).collect();
        assert_eq!(found, [[0, 1], [2, 3]]);
        let names = ["Extension 1 (mm)", "Load 1 (N)", "Extension 2 (mm)", "Load 2 (N)"];
        let found: Vec<_> =
            curves(&names.map(spelled)).expect("curves").iter().map(|c| c.indices).collect();
        assert_eq!(found, [[0, 1], [2, 3]]);
        let names = ["force_N", "displacement_mm", "force_N.1", "displacement_mm.1"].map(spelled);
        assert_eq!(curves(&names).expect("curves").len(), 2);
        // A second force sensor is not a specimen.
        let names = ["force_N", "force_2_N", "displacement_mm"].map(spelled);
        assert_eq!(curves(&names).expect("a curve").len(), 1);
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
