//! The contents of the lines of a journal.

use std::time::SystemTime;

use results::{CsvFormat, DesignResult};
use serde::{Deserialize, Serialize};

/// A finished design.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JournalEntry {
    /// The 1-based position of the design in the grid.
    pub design: u64,
    /// The number of the rerun: 0 for the first solution, then counting up. The largest counts,
    /// wherever its line stands.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub rerun: u64,
    /// Seconds since its session began.
    pub at: f64,
    /// Seconds that it took.
    pub seconds: f64,
    /// The result of the design.
    pub result: DesignResult,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
fn is_zero(number: &u64) -> bool {
    *number == 0
}

impl JournalEntry {
    /// The index of the design in the grid, from 0.
    pub(crate) fn index(&self) -> Option<u64> {
        self.design.checked_sub(1)
    }
}

/// The beginning of a run, of its continuation, of a rerun or of a merger.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SessionStart {
    /// The moment at which it began, in UTC.
    pub started: String,
    /// The number of threads.
    pub threads: usize,
    /// The format of the tables.
    pub csv: CsvFormat,
}

impl SessionStart {
    /// A session that begins now.
    pub(crate) fn now(threads: usize, csv: CsvFormat) -> Self {
        let started = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
        Self { started, threads, csv }
    }
}
