//! Tables as CSV files: how they are written and read.

pub mod csv_file;
pub mod csv_format;
pub mod written_table;
