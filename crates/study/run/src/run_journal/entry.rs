//! Lines of a journal: starts of sessions, and designs.

use std::time::SystemTime;

use results::{CsvFormat, DesignResult};
use serde::{Deserialize, Serialize};

/// A line of the journal of a run, except the header.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Line {
    /// A session begins.
    Session(SessionStart),
    /// A design was finished.
    Design(Box<JournalEntry>),
}

/// Journal entry of a finished design.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JournalEntry {
    /// Number of the design in the grid, from 1.
    pub design: u64,
    /// Number of the rerun: 0 for the first result of the design, then counting up.
    ///
    /// Of several entries for one design, the entry with the largest number is valid.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub rerun: u64,
    /// Seconds from the start of the session to the end of this design.
    pub at: f64,
    /// Seconds that were spent on this design.
    pub seconds: f64,
    /// Result of the design.
    pub result: DesignResult,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
fn is_zero(number: &u64) -> bool {
    *number == 0
}

impl JournalEntry {
    /// Returns the index of the design in the grid, from 0.
    pub(crate) fn index(&self) -> Option<u64> {
        self.design.checked_sub(1)
    }
}

/// Start of a session: a new, resumed or repeated run, or a merge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SessionStart {
    /// Time of the start in UTC, as in RFC 3339.
    pub started: String,
    /// Number of threads.
    pub threads: usize,
    /// Format of the tables of this session.
    pub csv: CsvFormat,
}

impl SessionStart {
    /// Creates the start of a session at the present time.
    pub(crate) fn now(threads: usize, csv: CsvFormat) -> Self {
        let started = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
        Self { started, threads, csv }
    }
}

#[cfg(test)]
mod tests {
    use journal::Seal;
    use proptest::prelude::*;

    use super::*;

    fn line(result: DesignResult) -> Line {
        let entry = JournalEntry { design: 417, rerun: 1, at: 1.5, seconds: 0.25, result };
        Line::Design(Box::new(entry))
    }

    #[test]
    fn a_line_is_json_and_is_read_back() {
        let settings = "solver.max_step=0.01".to_owned();
        let coverage = Some(0.1 + 0.2);
        let line = line(DesignResult { coverage, settings, ..DesignResult::default() });
        let mut bytes = Seal::default().seal(&line);
        insta::assert_snapshot!(String::from_utf8_lossy(&bytes), @r#"
        {"crc":"bbd5f1e4","design":{"design":417,"rerun":1,"at":1.5,"seconds":0.25,"result":{"coverage":0.30000000000000004,"settings":"solver.max_step=0.01"}}}
        "#);
        assert_eq!(Seal::default().read(&mut bytes), Ok(line));
    }

    proptest! {
        /// The number has the same bits after writing and reading.
        #[test]
        fn numbers_are_read_back_bit_by_bit(number in any::<f64>().prop_filter("finite", |x| x.is_finite())) {
            let result = DesignResult { coverage: Some(number), ..DesignResult::default() };
            let mut bytes = Seal::default().seal(&line(result));
            let Ok(Line::Design(entry)) = Seal::default().read(&mut bytes) else {
                return Err(TestCaseError::fail("no design"));
            };
            prop_assert_eq!(entry.result.coverage.map(f64::to_bits), Some(number.to_bits()));
        }
    }
}
