//! The commands, one file each.

mod audit;
mod calibrate;
mod check;
mod compare;
mod derived;
mod design;
mod draw;
mod export;
mod figure_file;
mod merge;
mod plot;
mod rank;
mod report;
mod rerun;
mod results_folder;
mod run;
mod slurm;
mod status;
mod validate;

pub use calibrate::calibrate;
pub use check::check;
pub use compare::compare;
pub use design::design;
pub use draw::draw;
pub use export::export;
pub use merge::merge;
pub use plot::plot;
pub use rank::rank;
pub use report::report;
pub use rerun::rerun;
pub use run::run;
pub use slurm::slurm;
pub use status::status;
pub use validate::validate;

use std::path::{Path, PathBuf};

use ::run::Program;
use results::verify_record;
use sweep::{InvalidSetting, Setting, Sweep};

use crate::args::Definition;

/// This program.
const PROGRAM: Program =
    Program { version: env!("CARGO_PKG_VERSION"), revision: env!("SQUAMA_REVISION") };

/// Exit code of a command that was done.
const DONE: u8 = 0;
/// Exit code when designs failed or are missing.
const INCOMPLETE: u8 = 1;
/// Exit code when two runs differ and the exit code is to say so.
const DIFFERENT: u8 = 1;

fn settings(definition: &Definition) -> Result<Vec<Setting>, InvalidSetting> {
    definition.settings.iter().map(|text| Setting::parse(text)).collect()
}

fn read(definition: &Definition) -> anyhow::Result<Sweep> {
    verify_record(&definition.path)?;
    Ok(Sweep::read(&definition.path, &settings(definition)?)?)
}

/// Where the results of `sweep` go unless told otherwise.
fn folder_of(sweep: &Sweep, out: Option<&Path>) -> PathBuf {
    out.map_or_else(|| Path::new("results").join(sweep.name()), Path::to_owned)
}
