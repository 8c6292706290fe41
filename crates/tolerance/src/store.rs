//! Samples that were solved, kept so that none is solved twice.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;
use results::{Cell, Column, CsvFormat, OutputError, RunFolder, write_rows};
use run::{JournalError, JournalHeader, Start, WorkMeter};
use serde::{Deserialize, Serialize};
use store::{Journal, Records};

use crate::no_analysis::NoAnalysis;

/// Digits of a digest that tell the journals of one label apart: two of ten thousand definitions share them once in a hundred
/// times, and are then refused.
const DIGITS: usize = 8;

/// A solved sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolvedSample {
    /// Number of the sample, from 1.
    pub number: u64,
    /// Its values, `None` where there is none.
    pub values: Vec<Option<f64>>,
}

/// A folder of samples: under each label a journal for each definition, to which every sample is added as it is solved, and the
/// table of the samples that were asked for last.
#[derive(Clone, Debug)]
pub struct SampleStore {
    folder: RunFolder,
    work: Arc<WorkMeter>,
}

/// The samples of one definition that are kept, by their numbers.
struct KeptSamples {
    header: JournalHeader,
    values: BTreeMap<u64, Vec<Option<f64>>>,
}

impl Records for KeptSamples {
    type Line = SolvedSample;

    const KEY: &'static str = "samples";

    fn begin(header: JournalHeader, _length: u64, _path: &Path) -> Result<Self, String> {
        Ok(Self { header, values: BTreeMap::new() })
    }

    fn take(&mut self, line: SolvedSample, _bytes: Range<u64>) -> Result<(), String> {
        self.values.insert(line.number, line.values);
        Ok(())
    }

    fn header(&self) -> &JournalHeader {
        &self.header
    }

    fn is_empty(&self) -> bool {
        self.values.is_empty()
    }
}

impl SampleStore {
    /// The store in `folder`, which is made when there is something to keep.
    pub fn new(folder: &Path) -> Self {
        Self { folder: RunFolder::new(folder), work: Arc::default() }
    }

    /// How far the work is, in samples; whoever asks for them says first how many there will be.
    pub fn work(&self) -> &Arc<WorkMeter> {
        &self.work
    }

    /// The first `count` samples under a label of what `header` describes: those that are kept, and those that `solve` makes of the
    /// other numbers, in parallel until `stop` is set. Each is kept as soon as it is solved.
    ///
    /// # Errors
    /// If the work is to stop, or the samples cannot be kept.
    pub(crate) fn samples(
        &self,
        (label, header): (&str, JournalHeader),
        columns: &[String],
        count: usize,
        stop: &AtomicBool,
        solve: impl Fn(u64) -> Vec<Option<f64>> + Sync,
    ) -> Result<Vec<SolvedSample>, NoAnalysis> {
        if count == 0 {
            return Ok(Vec::new());
        }
        let journal = Mutex::new(self.open(label, header)?);
        let lock = || journal.lock().unwrap_or_else(PoisonError::into_inner);
        let mut missing: Vec<u64> = (1..=count as u64).collect();
        missing.retain(|number| !lock().records().values.contains_key(number));
        self.work.leave_out((count - missing.len()) as u64);
        missing.into_par_iter().try_for_each(|number| {
            if stop.load(Ordering::Relaxed) {
                return Ok(());
            }
            let values = solve(number);
            self.work.count(1);
            lock().append(SolvedSample { number, values })
        })?;
        let mut journal = lock();
        journal.sync()?;
        let kept = journal.records().values.range(..=count as u64);
        let samples = kept.map(|(&number, values)| SolvedSample { number, values: values.clone() });
        let samples: Vec<SolvedSample> = samples.collect();
        if samples.len() < count {
            return Err(NoAnalysis::Stopped { done: samples.len(), of: count });
        }
        self.write(label, columns, &samples)?;
        Ok(samples)
    }

    /// The journal of what `header` describes, one that is there or a new one.
    fn open(&self, label: &str, header: JournalHeader) -> Result<Journal<KeptSamples>, NoAnalysis> {
        // Samples of format 1 had a record of this name beside their table.
        let record = self.folder.file(&format!("{label}.toml"));
        if record.exists() {
            let by = "0.1.0 of an earlier revision".to_owned();
            return Err(JournalError::OtherFormat { path: record, found: 1, by }.into());
        }
        self.folder.make()?;
        // Another definition or program has a journal of its own: who comes back to the first finds its samples.
        let digest = header.digest();
        let name = format!("{label}-{}.jsonl", &digest[..DIGITS]);
        Ok(Journal::begin(&self.folder.file(&name), header, Start::Resume)?)
    }

    /// Writes the table of the samples under a label.
    fn write(
        &self,
        label: &str,
        columns: &[String],
        samples: &[SolvedSample],
    ) -> Result<(), OutputError> {
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
        write_rows(&self.folder, &name, CsvFormat::Plain, &columns, samples).map(|_| ())
    }
}
