//! Writes the tables of a run from its journal.

mod changes;
mod open_tables;
mod ro_crate;
pub mod run_info;
pub mod summary;
pub mod table_writer;
