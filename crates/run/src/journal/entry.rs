//! What the lines of a journal hold.

use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use results::Dialect;

/// A finished design.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Its 1-based position in the grid.
    pub design: u64,
    /// Seconds since its session began.
    pub at: f64,
    /// Seconds that it took.
    pub seconds: f64,
    /// Which solution of this design it is: 0 the first, then counting up.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub rerun: u64,
    /// Its row in `designs.csv`, the cells joined by commas.
    pub row: String,
    /// Its rows in `failures.csv`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub failures: Vec<String>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
fn is_zero(number: &u64) -> bool {
    *number == 0
}

impl Entry {
    /// Whether something that was asked for has no value.
    pub fn failed(&self) -> bool {
        !self.failures.is_empty()
    }

    /// Its place in the grid, from 0.
    pub(crate) fn index(&self) -> Option<u64> {
        self.design.checked_sub(1)
    }
}

/// The beginning of a run, of its continuation, of a re-run or of a merger.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Session {
    /// When, in UTC.
    pub started: String,
    /// With how many threads.
    pub threads: usize,
    /// How its tables are written.
    pub csv: Dialect,
}

impl Session {
    /// A session that begins now.
    pub(crate) fn now(threads: usize, csv: Dialect) -> Self {
        let started = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
        Self { started, threads, csv }
    }
}
