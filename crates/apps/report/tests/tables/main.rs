//! Tests of the guide to the tables, and of the workbook.

mod documentation;

#[cfg(feature = "xlsx")]
#[path = "../../../../study/results/tests/samples/mod.rs"]
mod samples;
#[cfg(feature = "xlsx")]
mod workbooks;
