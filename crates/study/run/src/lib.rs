//! Runs: solves the designs of a sweep and writes their results into a folder.
//!
//! Designs are solved in parallel, each by one thread. A design is appended to a journal as soon as
//! it is solved. The tables are written from the journal, in the order of the designs, one row at a
//! time. The tables are therefore identical for any number of threads, shards and interruptions,
//! and the memory use hardly depends on the number of designs.
//!
//! ```text
//! Sweep ─► Groups ─► workers ─► Evaluator ─► JournalEntry ─► Journal ─► TableWriter ─► tables
//! ```
//!
//! | Item | Content |
//! |---|---|
//! | [`run()`] | solves the designs of a sweep and writes the tables |
//! | [`Options`], [`Program`] | options of a run; version of the program that solves it |
//! | [`Progress`], [`Finished`] | progress and result of a run |
//! | [`Evaluator`] | solves one design, or its curve at given points |
//! | [`CurvePoints`] | a curve at given points, with its derivatives |
//! | [`WorkMeter`] | completed fraction of the work, including parts of designs |
//! | [`Start`] | treatment of existing results |
//! | [`Archive`], [`JournalEntry`], [`Line`] | contents of a journal, and its lines |
//! | [`Rerun`], [`Filter`], [`ColumnFilter`] | solves selected designs again with other settings |
//! | [`RunStatus`] | numbers of finished, failed and missing designs |
//! | [`merge()`] | merges shards |
//! | [`Estimate`] | estimated time and disk space of a sweep |
//! | [`Audit`], [`LargestDifference`], [`SecondMethod`] | solves designs again by a second method |
//! | [`Summary`], [`Best`] | counts and best values of the designs |
//! | [`GapChange`], [`MeasureChange`] | measures of a design with a gap 10 % smaller and larger |
//! | [`CouplingChange`], [`CoupledMeasure`] | measures of a design with full substrate coupling |
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//! use std::time::Duration;
//!
//! use run::{Options, Program, Start, WorkMeter};
//! use sweep::{Subset, Sweep};
//!
//! let text = "name = 'two'\nmeasures = 'coverage'\n[designs]\ngap_over_t = 0.1\nlength_over_t = 1\n\
//!             slant_deg = [0, 45]";
//! let sweep = Sweep::parse(text, "two.toml", &[])?;
//! let folder = tempfile::tempdir()?;
//! let stop = AtomicBool::new(false);
//! let options = Options {
//!     threads: 1,
//!     format: None,
//!     fail_fast: false,
//!     tables_every: Duration::MAX,
//!     stop: &stop,
//!     work: &WorkMeter::default(),
//! };
//! let program = Program { version: "1.0", revision: "none" };
//! let all = Subset::default();
//! let finished = run::run(&sweep, all, folder.path(), Start::New, &options, &program, |_| ())?;
//! assert_eq!((finished.summary.designs, finished.missing), (2, 0));
//! assert!(folder.path().join("coverage.csv").exists());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod audit;
mod bare_needle;
mod coupling_change;
mod curved_body;
mod estimate;
mod filter;
mod gap_change;
mod merge;
mod options;
mod progress;
mod rerun;
mod run;
mod run_journal;
mod solve;
mod status;
mod tables;
mod warnings;
mod weakest_place;

pub use audit::{Audit, LargestDifference, SecondMethod};
pub use bare_needle::{BareNeedle, bare_needle};
pub use coupling_change::{CoupledMeasure, CouplingChange};
pub use curved_body::{curved_body_warning, flat_design_warning};
pub use estimate::Estimate;
pub use filter::{ColumnFilter, Filter, InvalidColumnFilter, InvalidFilter};
pub use gap_change::{GapChange, MeasureChange, Patience, solved_row};
pub use journal::{JournalError, Program, Start};
pub use merge::{MergeError, Merged, merge};
pub use options::Options;
pub use progress::{Finished, Progress, RunError};
pub use rerun::{InvalidRerun, Rerun};
pub use run::run;
pub use run_journal::{Archive, JournalEntry, JournalHeader, LatestSession, Line, SessionStart};
pub use skin::puncture::PunctureEnd;
pub use solve::curve::CurvePoints;
pub use solve::evaluator::Evaluator;
pub use solve::work::{WorkMeter, WorkPiece, report_slow};
pub use solver::{interrupt_paths, uninterrupted};
pub use status::RunStatus;
pub use tables::summary::{Best, Summary};
pub use warnings::{design_warnings, validity_warnings};
pub use weakest_place::{PLACES, WeakestPlace};
