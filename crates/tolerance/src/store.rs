//! Samples that were solved, kept so that none is solved twice.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;
use results::{Cell, Column, CsvFormat, OutputError, RunFolder, write_rows};
use run::{JournalHeader, Start, WorkMeter};
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

/// A folder of samples: under each label a journal for each definition, to which every sample is added as it is solved, and its
/// table.
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
        self.folder.make()?;
        // Another definition or program has files of its own: who comes back to the first finds its samples, and no table of one
        // stands under the name of another.
        let name = format!("{label}-{}", &header.digest()[..DIGITS]);
        let path = self.folder.file(&format!("{name}.jsonl"));
        let journal = Mutex::new(Journal::<KeptSamples>::begin(&path, header, Start::Resume)?);
        let lock = || journal.lock().unwrap_or_else(PoisonError::into_inner);
        let mut missing: Vec<u64> = (1..=count as u64).collect();
        missing.retain(|number| !lock().records().values.contains_key(number));
        self.work.leave_out((count - missing.len()) as u64);
        missing.into_par_iter().try_for_each(|number| {
            // No error yet: samples in hand are kept first, and what is missing is counted behind.
            if stop.load(Ordering::Relaxed) {
                return Ok(());
            }
            let values = self.work.told(&format!("{label}, sample {number}"), || solve(number));
            self.work.count(1);
            lock().append(SolvedSample { number, values })
        })?;
        let mut journal = lock();
        journal.sync()?;
        // An analysis of more samples may have been here before: its others are left alone.
        let kept = journal.records().values.range(..=count as u64);
        let samples = kept.map(|(&number, values)| SolvedSample { number, values: values.clone() });
        let samples: Vec<SolvedSample> = samples.collect();
        if samples.len() < count {
            return Err(NoAnalysis::Stopped { done: samples.len(), of: count });
        }
        // Each time, from the journal: a table that somebody has changed does not stay.
        self.write(&format!("{name}.csv"), columns, &samples)?;
        Ok(samples)
    }

    /// Writes the table of samples called `name`.
    fn write(
        &self,
        name: &str,
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
        write_rows(&self.folder, name, CsvFormat::Plain, &columns, samples).map(|_| ())
    }
}
