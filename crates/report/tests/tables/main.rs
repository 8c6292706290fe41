//! What people read of the tables: the guide to them, and the workbook.

mod documentation;

#[cfg(feature = "xlsx")]
#[path = "../../../results/tests/samples/mod.rs"]
mod samples;
#[cfg(feature = "xlsx")]
mod workbooks;
