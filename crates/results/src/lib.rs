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
mod tables;

pub use columns::cell::Cell;
pub use columns::{Column, failure_columns};
pub use design::design_result::{
    DesignResult, DesignRow, FlexureResult, PunctureResult, SolvedDesign, finite,
};
pub use design::failure::{Failure, FailureRow, PathEnd, SEPARATOR, failure_detail_columns};
pub use design::outcome::Outcome;
pub use design::rerun_change::{RERUN_COLUMNS, RerunChange};
pub use design::sample_statistics::{SampleStatistics, Statistics};
pub use folder::{AtomicFile, OutputError, RunFolder, make_folder, sync_folder, write_text};
pub use path_tables::write_path_tables;
pub use reader::{InvalidResults, Results, words};
pub use tables::csv_file::{CsvFile, write_rows};
pub use tables::csv_format::{CsvFormat, UnknownCsvFormat};
