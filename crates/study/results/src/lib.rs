//! Results: what the folder of a run holds, and how it is written and read.
//!
//! A design result is everything that is known of a solved design. Columns make cells of it; tables
//! are rows of cells, written in one of two CSV formats and read back from either.
//!
//! ```text
//! DesignResult ─► columns ─► Cell ─► CsvFile ─► designs.csv ─► Results
//! ```
//!
//! | Type | Role |
//! |---|---|
//! | [`DesignResult`], [`PunctureResult`], [`FlexureResult`], [`Outcome`], [`Failure`] | everything that is known of a solved design, and why it failed |
//! | [`SolvedDesign`] | the result of a design with its paths |
//! | [`SampleStatistics`], [`Statistics`] | mean and quantiles over imperfect samples |
//! | [`DesignRow`], [`FailureRow`], [`RerunChange`] | the rows of `designs.csv`, `failures.csv` and `reruns.csv` |
//! | [`ParameterDerivative`], [`DerivativeRow`] | the derivative of a measure, and the row of `sensitivity.csv` |
//! | [`SlopeSide`] | which of two one-sided derivatives a neighbouring row is extrapolated by |
//! | [`mod@columns`], [`Column`], [`Cell`] | the list of everything that stands in a table |
//! | [`Quantity`], [`areal_mass()`], [`puncture_units`], [`bending_units`] | from dimensionless values to millimetres, newtons and kilograms |
//! | [`CsvFormat`], [`CsvFile`] | how tables are written |
//! | [`ResultsFolder`], [`FILES`], [`FileEntry`] | the folder, and an entry for every file in it: name, maker, whether its SHA-256 is stated |
//! | [`write_measures`] | writes the measures of one design, a row each |
//! | [`path_tables()`], [`PathTable`], [`write_path_tables`] | the paths, events, scales and iterations of one design, in memory and as files |
//! | [`round_off`] | which numbers are the same but for round-off, and which of them is the best |
//! | [`Results`], [`Table`] | the designs of a run read back, and their cells |
//! | [`Contents`], [`VerifiedFolder`], [`Completeness`] | what a run states of its folder, and the folder once that is checked |
//! | [`Derivation`], [`Claim`] | what was made from the tables, and from which; the right of a command to write its files |
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
pub use design::design_result::{DesignResult, FlexureResult, PunctureResult, SEPARATOR};
pub use design::extrapolated::SlopeSide;
pub use design::failure::{Failure, PathEnd, finite};
pub use design::outcome::Outcome;
pub use design::parameter_derivative::ParameterDerivative;
pub use design::rerun_change::RerunChange;
pub use design::row::{DerivativeRow, DesignRow, FailureRow, SolvedDesign};
pub use design::sample_statistics::{
    QUANTILES, SampleStatistics, Statistics, quantile, quantile_places,
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
pub use reader::{InvalidResults, Results, words};
pub use tables::csv_file::{CsvFile, write_rows};
pub use tables::csv_format::{CsvFormat, UnknownCsvFormat};
pub use tables::written_table::WrittenTable;
