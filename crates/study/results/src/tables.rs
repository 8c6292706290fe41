//! Reading and writing of tables as CSV files.

pub mod csv_file;
pub mod csv_format;
pub mod resaved;
pub mod written_table;
