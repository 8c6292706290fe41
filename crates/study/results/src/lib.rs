//! Reads and writes the results folder of a run.
//!
//! A design result holds all measures and statuses of a solved design. Columns convert a result to
//! cells. Tables are rows of cells, which are written and read in one of two CSV formats.
//!
//! ```text
//! DesignResult ─► columns ─► Cell ─► CsvFile ─► designs.csv ─► Results
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`DesignResult`], [`PunctureResult`], [`FlexureResult`], [`Outcome`], [`Failure`] | all measures of a solved design, and the reasons for missing measures |
//! | [`SolvedDesign`] | the result of a design with its paths |
//! | [`SampleStatistics`], [`Statistics`] | mean and quantiles over imperfect samples |
//! | [`DesignRow`], [`FailureRow`], [`RerunChange`] | the rows of `designs.csv`, `failures.csv` and `reruns.csv` |
//! | [`ParameterDerivative`], [`DerivativeRow`] | the derivative of a measure, and the row of `sensitivity.csv` |
//! | [`SlopeSide`] | the one-sided derivative used to extrapolate a row to a neighbouring design |
//! | [`mod@columns`], [`Column`], [`Cell`] | the list of all columns of the tables |
//! | [`Quantity`], [`areal_mass()`], [`puncture_units`], [`bending_units`] | conversion of dimensionless values to millimetres, newtons and kilograms |
//! | [`CsvFormat`], [`CsvFile`] | CSV formats, and tables as files |
//! | [`ResultsFolder`], [`FILES`], [`FileEntry`] | the folder, and an entry for every file in it: name, maker, whether its SHA-256 is recorded |
//! | [`write_measures`] | writes a table with one row per measure of a design |
//! | [`path_tables()`], [`PathTable`], [`write_path_tables`] | the paths, events, scales and iterations of one design, in memory and as files |
//! | [`round_off`] | comparison of values that may be equal up to round-off |
//! | [`Results`], [`Table`] | the designs read from the folder of a run, and their cells |
//! | [`Contents`], [`VerifiedFolder`], [`Completeness`] | the checksums of a run, and a folder verified against them |
//! | [`Derivation`], [`Claim`] | products derived from the tables; the exclusive claim of a command to its files |
//!
//! ```
//! use results::columns::design_columns;
//! use results::{CsvFormat, DesignResult, DesignRow, Results, ResultsFolder, write_rows};
//! use sweep::Sweep;
//!
//! let sweep = Sweep::parse("name = 'x'\nmeasures = 'coverage'", "x.toml", &[])?;
//! let (number, case) = (sweep.grid().number(2), sweep.grid().case(2));
//! let result = DesignResult { coverage: Some(0.5), ..DesignResult::default() };
//! let place = tempfile::tempdir()?;
//! let (folder, columns) = (ResultsFolder::new(place.path()), design_columns(&sweep));
//! let rows = [DesignRow { number, case, result }];
//! write_rows(&folder, ResultsFolder::DESIGNS, CsvFormat::Plain, &columns, &rows)?;
//!
//! let results = Results::read(place.path())?;
//! assert_eq!(results.design(0), "0003");
//! assert_eq!(results.number(0, results.column("coverage")?)?, Some(0.5));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod columns;
mod comparability;
mod contents;
mod design;
mod folder;
mod measure_table;
mod path_tables;
mod quantity;
mod reader;
pub mod round_off;
mod tables;

pub use columns::cell::Cell;
pub use columns::{
    Column, DERIVATIVE_COLUMNS, RERUN_COLUMNS, failure_columns, failure_detail_columns,
};
pub use comparability::{incomparable_by, measurement_conditions};
pub use contents::claim::Claim;
pub use contents::derivation::Derivation;
pub use contents::verified_folder::{Completeness, InvalidFolder, VerifiedFolder, verify_record};
pub use contents::{Contents, JournalExtent};
pub use design::design_result::{DesignResult, SEPARATOR};
pub use design::extrapolated::{SlopeSide, changed_parameters, neighbours};
pub use design::failure::{Failure, PathEnd, finite};
pub use design::outcome::Outcome;
pub use design::parameter_derivative::ParameterDerivative;
pub use design::path_result::{FlexureResult, PunctureResult};
pub use design::rerun_change::RerunChange;
pub use design::row::{DerivativeRow, DesignRow, FailureRow, SolvedDesign};
pub use design::sample_statistics::{
    QUANTILES, SampleStatistics, Statistics, quantile, quantile_positions,
};
pub use folder::{FILES, FileEntry, MEASURE_TABLES, Maker, ResultsFolder, Role};
pub use journal::{
    AtomicFile, OutputError, exit_without_partial_files, make_folder, sha256, sync_folder,
    write_text,
};
pub use measure_table::{DesignMeasure, MEASURE_COLUMNS, write_measures};
pub use path_tables::{PathTable, path_tables, write_path_tables};
pub use quantity::{Quantity, areal_mass, bending_units, puncture_units};
pub use reader::table::Table;
pub use reader::{InvalidResults, Results, csv_error_text, definition};
pub use tables::csv_file::{CsvFile, write_rows};
pub use tables::csv_format::{CsvFormat, UnknownCsvFormat};
pub use tables::written_table::WrittenTable;
