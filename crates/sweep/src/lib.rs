//! Sweeps: from a definition in TOML to a table with one row per design.
//!
//! A sweep is a grid of designs, every combination of the values of its axes. It is never stored:
//! the number of a design gives its parameters, and its parameters give its number. Designs are
//! solved in parallel, each by one thread, and noted in a journal as they are done. The tables are
//! written from the journal, in the order of the designs, one row at a time: so they are the same
//! for any number of threads, shards and interruptions, and memory hardly grows with the grid.
//!
//! ```text
//! file ─► written ─► Sweep ─► Grid ─► Case ─► Workbench ─► Record ─► columns ─► Journal ─► tables
//!      settings ─┘  (valid)   index ─┘        (substrate, skin)
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`written`] | a definition as it is written: keys, values and their places |
//! | [`Setting`] | a key set from outside, in place of what is written |
//! | [`PARAMETERS`], [`Parameter`] | the list of everything that may be set, with what is right |
//! | [`Sweep`] | the validated definition |
//! | [`Grid`], [`Axis`], [`DesignNumber`] | the designs, by number |
//! | [`Case`] | one design with everything that it is solved with |
//! | [`Workbench`] | solves a case |
//! | [`Record`], [`Outcome`] | what is known of a solved design; how it ended |
//! | [`Spreads`], [`Spread`] | what imperfect samples of it gave |
//! | [`columns`], [`Column`], [`Cell`] | the list of everything that stands in a table |
//! | [`run()`] | solves the designs and writes the tables |
//! | [`Journal`], [`Entry`] | every finished design, a line each; the tables are written from it |
//! | [`Part`], [`Sample`], [`Shard`] | which of the designs a run solves |
//! | [`Failure`] | a measure without a value: why, and how far the path came |
//! | [`Rerun`], [`Choice`] | some designs solved again, with other settings |
//! | [`Status`] | how far a run is |
//! | [`merge()`] | puts shards together |
//! | [`write_course`] | writes the path, events, scales and iterations of one design |
//! | [`Results`] | the designs of a run read back |
//! | [`Ranking`], [`Weights`], [`pareto_front`] | the best designs, by weights and without |
//! | [`compare()`], [`Comparison`] | where two runs differ |
//! | [`export()`] | the tables as one workbook for spreadsheets |
//!
//! ```
//! use sweep::Sweep;
//!
//! let text = "name = 'thick'\ndesigns.slant_deg = { from = 0, to = 60, step = 15 }\nscale.width_over_t = 2";
//! let sweep = Sweep::parse(text, "thick.toml", &[])?;
//! assert_eq!(sweep.grid().len(), 10 * 12 * 5);
//! let case = sweep.grid().case(3);
//! assert_eq!((case.design.slant_deg, case.design.width), (45.0, 2.0));
//! assert_eq!(sweep.grid().find(&case), Some(3));
//! assert_eq!(sweep.grid().number(3).to_string(), "0004");
//!
//! let error = Sweep::parse("name = 'thin'\ncontact.c2 = 0", "thin.toml", &[]).unwrap_err();
//! assert_eq!(
//!     error.to_string(),
//!     "thin.toml:2: contact.c2: 0 is out of range, expected a number above 0 and at most 10"
//! );
//! # Ok::<(), sweep::InvalidDefinition>(())
//! ```

mod axes;
mod case;
mod cell;
mod choice;
pub mod columns;
mod compare;
mod criteria;
mod decimal;
mod definition;
mod dialect;
mod export;
mod failures;
mod grid;
mod hint;
mod invalid;
mod jobs;
mod journal;
mod measure;
mod merge;
mod number;
mod outcome;
mod parameter;
mod parameters;
mod pareto;
mod quaternary;
mod ranking;
mod reader;
mod record;
mod render;
mod report;
mod rerun;
mod reruns;
mod results;
mod row;
mod run;
mod scalar;
mod selection;
mod session;
mod setting;
mod spread;
mod status;
mod summary;
mod table;
mod tables;
mod trace;
mod whole_file;
mod workbench;
pub mod written;

pub use case::{Case, Samples};
pub use cell::Cell;
pub use choice::{Choice, Condition, NoCondition, WrongChoice};
pub use columns::Column;
pub use compare::{
    ColumnDifference, Comparison, Difference, Extreme, InvalidComparison, ParameterChange, compare,
    rank_correlation, write_comparison,
};
pub use criteria::{CRITERIA, Criterion, InvalidWeights, Weights};
pub use decimal::{Decimal, DecimalRange, InvalidRange, NotDecimal};
pub use definition::Sweep;
pub use dialect::{Dialect, NoDialect};
pub use export::{ExportError, Exported, export};
pub use failures::{FAILURES, Failure};
pub use grid::{Axis, DesignNumber, Grid, NoSuchDesign, TooManyDesigns};
pub use invalid::{InvalidDefinition, Problem};
pub use journal::{Archive, Entry, Header, Journal, JournalError, Latest, Start};
pub use measure::Measure;
pub use merge::{MergeError, Merged, merge};
pub use outcome::Outcome;
pub use parameter::{Parameter, WrongValue};
pub use parameters::PARAMETERS;
pub use pareto::pareto_front;
pub use quaternary::{InvalidResolution, Steps, TetrahedralGrid};
pub use ranking::{InvalidRanking, LeftOut, Ranking, Standing, write_ranking};
pub use record::{FlexureRecord, PunctureRecord, Record};
pub use rerun::{Rerun, WrongRerun};
pub use reruns::{Change, RERUN_COLUMNS};
pub use results::{InvalidResults, Results};
pub use run::{Finished, News, Options, Program, RunError, run};
pub use scalar::Scalar;
pub use selection::{NoShard, Part, Sample, SampleTooLarge, Selection, Shard};
pub use setting::{InvalidSetting, Setting};
pub use spread::{Spread, Spreads};
pub use status::Status;
pub use summary::{Best, Summary};
pub use table::write_table;
pub use trace::write_course;
pub use whole_file::{OutputError, WholeFile, make_folder, write_text};
pub use workbench::{Solved, Workbench, footprint};
