//! The commands, one file each.

mod audit;
mod calibrate;
mod check;
mod compare;
mod completions;
mod derived;
mod design;
mod draw;
mod export;
mod figure_file;
mod init;
mod man;
mod merge;
mod optimise;
mod plot;
mod rank;
mod report;
mod rerun;
mod results_folder;
mod run;
mod selection;
mod sensitivity;
mod slurm;
mod source;
mod status;
mod tolerance;
mod validate;

pub use calibrate::calibrate;
pub use check::check;
pub use compare::compare;
pub use completions::completions;
pub use design::design;
pub use draw::draw;
pub use export::export;
pub use init::init;
pub use man::man;
pub use merge::merge;
pub use optimise::optimise;
pub use plot::plot;
pub use rank::rank;
pub use report::report;
pub use rerun::rerun;
pub use run::run;
pub use sensitivity::sensitivity;
pub use slurm::slurm;
pub use status::status;
pub use tolerance::tolerance;
pub use validate::validate;

use ::run::Program;

/// This program.
const PROGRAM: Program =
    Program { version: env!("CARGO_PKG_VERSION"), revision: env!("SQUAMA_REVISION") };

/// Exit code of a command that was done.
const DONE: u8 = 0;
/// Exit code when designs failed or are missing.
const INCOMPLETE: u8 = 1;
/// Exit code when two runs differ and the exit code is to say so.
const DIFFERENT: u8 = 1;
