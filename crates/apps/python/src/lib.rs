//! The part of the Python package squama that needs the solver. The rest of the package is Python, in `python/squama/`.
//!
//! | Module | Role |
//! |---|---|
//! | `skin` | a skin, made from keywords or a definition, and solved |
//! | `solved` | results, column by column |
//! | `gradient` | values with their derivatives |
//! | `many` | many skins on all cores |
//! | `study` | runs, rankings, searches and tolerances in folders |
//! | `work` | interruptible work with progress |
//! | `value`, `error` | values and errors between the two languages |

#![expect(clippy::needless_pass_by_value, reason = "what comes from Python is taken by value")]

mod error;
mod gradient;
mod many;
mod skin;
mod solved;
mod study;
mod value;
mod work;

use error::OrFailed as _;
use pyo3::prelude::*;
use results::columns::{design_columns, name};
use sweep::{PARAMETERS, Parameter, Role, Sweep};

/// Key, section, unit, meaning, values that it takes, and the default as text; geometry has none.
type Explained = (&'static str, &'static str, &'static str, &'static str, String, Option<String>);

/// Returns the documentation of all parameters.
#[pyfunction]
fn parameters() -> Vec<Explained> {
    let explained = |p: &'static Parameter| {
        let is_given = !p.has(Role::Geometry) && p.is_given(&sweep::Case::default());
        let default = is_given.then(|| p.default().to_toml());
        (p.key, p.section, p.unit, p.meaning, p.expected(), default)
    };
    PARAMETERS.iter().map(explained).collect()
}

/// Returns name, unit and meaning of every measure, including measures in physical units.
#[pyfunction]
fn columns() -> PyResult<Vec<(String, &'static str, &'static str)>> {
    let text = "name = 'x'\nmaterial = { thickness_mm = 1, substrate_modulus_MPa = 1, membrane_modulus_MPa = 1, \
                scale_density_kg_m3 = 1 }\nimperfection.gap_cv = 0.1\ncontact.friction = 0.1\nflexure.unbend = true\n\
                puncture = { needle = 'guided', depth_over_t = 1, places = 3, unload = true }";
    let sweep = Sweep::parse(text, "x.toml", &[]);
    let columns = design_columns(&sweep.or_failed("columns")?).into_iter().skip(1);
    Ok(columns.map(|column| (column.name.into_owned(), column.unit, column.meaning)).collect())
}

#[pymodule]
mod _squama {
    #[pymodule_export]
    use super::{
        columns,
        gradient::gradients,
        many::solve_many,
        parameters,
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
