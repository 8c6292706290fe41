//! Samples that were solved, kept so that none is solved twice.

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use results::{Cell, Column, CsvFormat, OutputError, RunFolder, finite, sha256, write_rows};
use serde::{Deserialize, Serialize};

use crate::no_analysis::NoAnalysis;

/// Samples that are solved between two looks at whether to stop, at least, and as a part of those that are done.
const BLOCK: usize = 100;
const BLOCK_PART: usize = 4;

/// A solved sample.
#[derive(Clone, Debug, PartialEq)]
pub struct SolvedSample {
    /// Number of the sample, from 1.
    pub number: u64,
    /// Its values, `None` where there is none.
    pub values: Vec<Option<f64>>,
}

/// A folder of samples, with two files under each label: the table of the samples, and a record of what they are samples of.
///
/// The table is written as it grows, whole or not at all, and the record after it. A table is taken up again if its record names
/// the same definition, program and table; otherwise the samples are solved again.
#[derive(Clone, Debug)]
pub struct SampleStore {
    folder: RunFolder,
}

/// The origin of a table of samples, and its digest.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Record {
    /// Digest of the definition and of the program.
    of: String,
    /// SHA-256 of the table.
    sha256: String,
}

impl SampleStore {
    /// The store in `folder`, which is made when there is something to keep.
    pub fn new(folder: &Path) -> Self {
        Self { folder: RunFolder::new(folder) }
    }

    /// The first `count` samples under a label: those that are kept, if they are `of` the same definition, and behind them those
    /// that `solve` makes of their numbers, in parallel. They are kept again and again as they come, until `stop` is set.
    ///
    /// # Errors
    /// If the work is to stop, or the disk does not take the samples.
    pub(crate) fn samples(
        &self,
        (label, of): (&str, &str),
        columns: &[String],
        count: usize,
        stop: &AtomicBool,
        solve: impl Fn(u64) -> Vec<Option<f64>> + Sync,
    ) -> Result<Vec<SolvedSample>, NoAnalysis> {
        let mut samples = self.kept(label, of, columns).unwrap_or_default();
        while samples.len() < count {
            let done = samples.len();
            if stop.load(Ordering::Relaxed) {
                return Err(NoAnalysis::Stopped { done, of: count });
            }
            let block = BLOCK.max(done / BLOCK_PART).min(count - done);
            let numbers: Vec<u64> = (done as u64 + 1..).take(block).collect();
            let sample = |number: u64| SolvedSample { number, values: solve(number) };
            samples.par_extend(numbers.into_par_iter().map(sample));
            self.write(label, of, columns, &samples)?;
        }
        samples.truncate(count);
        Ok(samples)
    }

    /// The samples under a label that are kept, if they are `of` the same definition.
    fn kept(&self, label: &str, of: &str, columns: &[String]) -> Option<Vec<SolvedSample>> {
        let record = fs::read_to_string(self.folder.file(&format!("{label}.toml"))).ok()?;
        let record: Record = toml::from_str(&record).ok()?;
        let table = fs::read(self.folder.file(&format!("{label}.csv"))).ok()?;
        let is_it = record.of == of && record.sha256 == sha256(&table);
        let mut reader = CsvFormat::Plain.reader(table.as_slice());
        let header: Vec<String> =
            reader.headers().ok()?.iter().skip(1).map(str::to_owned).collect();
        if !is_it || header != columns {
            return None;
        }
        let cell = |text: &str| text.parse().ok().and_then(finite);
        let mut samples = Vec::new();
        for (row, number) in reader.records().zip(1..) {
            let values = row.ok()?.iter().skip(1).map(cell).collect();
            samples.push(SolvedSample { number, values });
        }
        Some(samples)
    }

    /// Keeps samples under a label.
    fn write(
        &self,
        label: &str,
        of: &str,
        columns: &[String],
        samples: &[SolvedSample],
    ) -> Result<(), OutputError> {
        self.folder.make()?;
        let number = Column::new("sample", "-", "number of the sample", |sample: &SolvedSample| {
            Cell::Count(sample.number as i64)
        });
        let others = columns.iter().enumerate().map(|(index, name)| {
            Column::made(name.clone().into(), "", "", move |sample: &SolvedSample| {
                sample.values[index].into()
            })
        });
        let columns: Vec<_> = std::iter::once(number).chain(others).collect();
        let name = format!("{label}.csv");
        let sha256 = write_rows(&self.folder, &name, CsvFormat::Plain, &columns, samples)?;
        let record = format!("of = \"{of}\"\nsha256 = \"{sha256}\"\n");
        self.folder.write_text(&format!("{label}.toml"), &record).map(|_| ())
    }
}
