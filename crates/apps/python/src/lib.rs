//! The extension module of the Python package squama; the Python part is in `python/squama/`.
//!
//! | Module | Role |
//! |---|---|
//! | `skin` | a skin, made from keywords or a definition, and solved |
//! | `solved` | results, column by column |
//! | `gradient` | values with their derivatives |
//! | `many` | many skins on all cores |
//! | `names` | keywords that name a material or body |
//! | `study` | runs, rankings, searches and tolerances in folders |
//! | `work` | interruptible work with progress |
//! | `value`, `error` | values and errors between the two languages |

#![expect(clippy::needless_pass_by_value, reason = "PyO3 passes arguments by value")]

mod error;
mod gradient;
mod many;
mod names;
mod skin;
mod solved;
mod study;
mod value;
mod work;

use error::OrFailed as _;
use names::NAMES;
use pyo3::prelude::*;
use results::columns::{design_columns, name};
use sweep::{PARAMETERS, Role, Sweep};

/// Documentation of a parameter: key, section, unit, meaning, valid values and default as text.
///
/// Geometry has no default.
type Explained = (&'static str, &'static str, &'static str, &'static str, String, Option<String>);

/// Returns the documentation of all parameters.
#[pyfunction]
fn parameters() -> Vec<Explained> {
    PARAMETERS
        .iter()
        .map(|p| {
            let is_given = !p.has(Role::Geometry) && p.is_given(&sweep::Case::default());
            let default = is_given.then(|| p.default().to_toml());
            (p.key, p.section, p.unit, p.meaning, p.expected(), default)
        })
        .collect()
}

/// Returns the keywords that name materials or a body.
///
/// Each keyword has its section, its possible names, and the parameters that these names supply.
#[pyfunction]
fn named() -> Vec<(&'static str, &'static str, Vec<&'static str>, Vec<&'static str>)> {
    let named = NAMES.iter().map(|name| {
        let mut keys: Vec<_> = name.known.iter().flat_map(|of| of.values).map(|of| of.0).collect();
        keys.sort_unstable();
        keys.dedup();
        (name.keyword, name.section, name.known.iter().map(|of| of.name).collect(), keys)
    });
    named.collect()
}

/// The keys of `[material]`, in the order in which messages list them.
const MATERIAL: [&str; 4] =
    ["thickness_mm", "substrate_modulus_MPa", "membrane_modulus_MPa", "scale_density_kg_m3"];

/// Returns name, unit and meaning of every column for a skin with this material.
fn columns_with(material: &[&str]) -> PyResult<Vec<(String, &'static str, &'static str)>> {
    let material: Vec<_> = material.iter().map(|key| format!("{key} = 1")).collect();
    let text = format!(
        "name = 'x'\nmaterial = {{ {} }}\nimperfection.gap_cv = 0.1\ncontact.friction = 0.1\n\
         flexure.unbend = true\npuncture = {{ needle = 'guided', depth_over_t = 1, places = 3, \
         unload = true }}",
        material.join(", ")
    );
    let sweep = Sweep::parse(&text, "x.toml", &[]);
    let columns = design_columns(&sweep.or_failed("columns")?).into_iter().skip(1);
    Ok(columns.map(|column| (column.name.into_owned(), column.unit, column.meaning)).collect())
}

/// Returns name, unit and meaning of every column, including columns that need a material.
#[pyfunction]
fn columns() -> PyResult<Vec<(String, &'static str, &'static str)>> {
    columns_with(&MATERIAL)
}

/// Returns the keys of `[material]` that the column `name` needs.
#[pyfunction]
fn needs(name: &str) -> PyResult<Vec<&'static str>> {
    let mut needed = Vec::new();
    for key in MATERIAL {
        let others: Vec<_> = MATERIAL.into_iter().filter(|other| *other != key).collect();
        if !columns_with(&others)?.iter().any(|(column, ..)| column == name) {
            needed.push(key);
        }
    }
    Ok(needed)
}

#[pymodule]
mod _squama {
    #[pymodule_export]
    use super::{
        columns,
        gradient::gradients,
        many::solve_many,
        named, needs, parameters,
        skin::Skin,
        solved::Solved,
        study::{optimise, rank, read, run, tolerance},
        value::arrow,
    };

    #[expect(non_upper_case_globals, reason = "Python's name")]
    #[pymodule_export]
    const __version__: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_export]
    const FOLD_FORCE: &str = super::name::FOLD_FORCE;

    #[pymodule_export]
    const CRITERIA: [&str; 4] = [
        super::name::COVERAGE,
        super::name::CRITICAL_FORCE,
        super::name::PENETRATION,
        super::name::COMPLIANCE,
    ];
}
