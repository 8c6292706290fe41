//! Results: what the folder of a run holds, and how it is written and read.
//!
//! A design result is everything that is known of a solved design. Columns make cells of it; tables
//! are rows of cells, written in one of two CSV formats and read back from either.
//!
//! ```text
//! DesignResult ─► columns ─► Cell ─► CsvFile ─► designs.csv ─► Results
//! ```

pub mod columns;
mod design;
mod folder;
mod path_tables;
mod reader;
pub mod row;
mod tables;

pub use columns::Column;
pub use columns::cell::Cell;
pub use design::design_result::{FlexureRecord, PunctureRecord, Record, Solved};
pub use design::failure::{FAILURES, Failure, SEPARATOR};
pub use design::failure::{names as failure_names, rows as failure_rows};
pub use design::outcome::Outcome;
pub use design::rerun_change::{Change, RERUN_COLUMNS};
pub use design::sample_statistics::{Spread, Spreads};
pub use folder::{AtomicFile, OutputError, RunFolder, make_folder, sync_folder, write_text};
pub use path_tables::write_course;
pub use reader::{InvalidResults, Results, words};
pub use tables::csv_file::{Table, write_rows, write_table};
pub use tables::csv_format::{Dialect, NoDialect};
