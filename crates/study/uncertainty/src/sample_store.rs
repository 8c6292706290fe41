//! Stores solved samples in files, so that no sample is solved twice.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use journal::{Journal, Records};
use rayon::prelude::*;
use results::{Cell, Column, OutputError, ResultsFolder, WrittenTable, write_rows};
use run::{JournalError, JournalHeader, Start, WorkMeter, uninterrupted};
use serde::{Deserialize, Serialize};
use sweep::Subset;

use crate::analysis_error::AnalysisError;

/// Number of hexadecimal digits of the definition's digest in a file name.
///
/// With ten thousand definitions of one label, the probability is 1 % that two of them have the
/// same digits. The store refuses the second of these definitions.
const DIGITS: usize = 8;

/// A solved sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolvedSample {
    /// Number of the sample, from 1.
    pub number: u64,
    /// Values of the columns; `None` for a failed measure.
    pub values: Vec<Option<f64>>,
}

/// A folder of samples. Each label, e.g. `global` or a design number, and each definition has a
/// journal and a table.
///
/// Every sample is appended to its journal as soon as it is solved.
#[derive(Clone, Debug)]
pub struct SampleStore {
    folder: ResultsFolder,
    work: Arc<WorkMeter>,
}

/// Stored samples of one definition, by number.
struct KeptSamples {
    header: JournalHeader,
    values: BTreeMap<u64, Vec<Option<f64>>>,
}

impl Records for KeptSamples {
    type Line = SolvedSample;

    type Designs = Subset;

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
    /// Creates a store in `folder`.
    ///
    /// The folder itself is created when the first samples are requested.
    pub fn new(folder: &Path) -> Self {
        Self { folder: ResultsFolder::new(folder), work: Arc::default() }
    }

    /// Returns the progress meter, which counts samples.
    ///
    /// The caller sets the expected number of samples before it requests them.
    pub fn work(&self) -> &Arc<WorkMeter> {
        &self.work
    }

    /// Returns samples 1 to `count` of the definition in `header`.
    ///
    /// `solve` computes the values of a sample from its number. It is called in parallel for
    /// samples that the journal lacks; each result is stored immediately. File names start with
    /// `label`; `names` are the column names of the values.
    ///
    /// # Errors
    ///
    /// If `stop` is set, samples cannot be read or written, or the journal was edited.
    pub(crate) fn samples(
        &self,
        (label, header): (&str, JournalHeader),
        names: &[String],
        count: usize,
        stop: &AtomicBool,
        solve: impl Fn(u64) -> Vec<Option<f64>> + Sync,
    ) -> Result<Vec<SolvedSample>, AnalysisError> {
        if count == 0 {
            return Ok(Vec::new());
        }
        self.folder.make()?;
        // Each definition and program version has its own files. Samples remain available when a
        // user returns to an earlier definition, and no table is overwritten by another definition.
        let name = format!("{label}-{}", &header.digest()[..DIGITS]);
        let path = self.folder.file(&format!("{name}.jsonl"));
        let journal = Mutex::new(Journal::begin(&path, header, Start::Resume)?);
        let samples = Samples { label, journal, stop, solve };
        let columns = columns(names);
        let table = format!("{name}.csv");
        let differing = self.differing(&table, &columns, &samples.lock().records().values);
        if let Some(number) = samples.first_edited(differing) {
            let (line, again) = (format!("sample {number}"), "by removing the journal");
            return Err(JournalError::Edited { path, line, table, again }.into());
        }
        samples.solve_missing(count, &self.work)?;
        let samples = samples.stored(count)?;
        if samples.len() < count {
            return Err(AnalysisError::Stopped { done: samples.len(), of: count });
        }
        // Always write the table from the journal, to replace edited tables.
        write_rows(&self.folder, &table, self.folder.csv_format(), &columns, &samples)?;
        Ok(samples)
    }

    /// Returns the numbers of samples that differ between the table `name` and the journal.
    ///
    /// `kept` are the samples of the journal.
    fn differing(
        &self,
        name: &str,
        columns: &[Column<SolvedSample>],
        kept: &BTreeMap<u64, Vec<Option<f64>>>,
    ) -> Vec<u64> {
        let Some(table) = WrittenTable::open(&self.folder, name) else { return Vec::new() };
        let changed = table.changed(columns, |record| {
            let number = record[0].parse().ok();
            let values = number.and_then(|number| kept.get(&number)).cloned();
            let sample = number.zip(values).map(|(number, values)| SolvedSample { number, values });
            Ok::<_, Infallible>(sample)
        });
        changed.into_iter().flatten().filter_map(|cell| cell.parse().ok()).collect()
    }
}

/// Samples of one label and definition, shared by the threads that solve samples.
struct Samples<'a, S> {
    label: &'a str,
    journal: Mutex<Journal<KeptSamples>>,
    stop: &'a AtomicBool,
    /// Computes the values of a sample from its number.
    solve: S,
}

impl<S: Fn(u64) -> Vec<Option<f64>> + Sync> Samples<'_, S> {
    fn lock(&self) -> MutexGuard<'_, Journal<KeptSamples>> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the first of `numbers` with values in the journal that cannot be reproduced.
    ///
    /// Each of these samples is solved again, until `stop` is set. Samples are reproducible, so a
    /// difference proves that somebody edited the journal. Otherwise only the table was edited.
    fn first_edited(&self, numbers: Vec<u64>) -> Option<u64> {
        numbers.into_iter().take_while(|_| !self.stop.load(Ordering::Relaxed)).find(|&number| {
            let stored = self.lock().records().values[&number].clone();
            uninterrupted(|| (self.solve)(number)).is_some_and(|again| again != stored)
        })
    }

    /// Solves samples up to number `count` that the journal lacks, until `stop` is set.
    fn solve_missing(&self, count: usize, work: &WorkMeter) -> Result<(), OutputError> {
        let mut missing: Vec<u64> = (1..=count as u64).collect();
        missing.retain(|number| !self.lock().records().values.contains_key(number));
        work.leave_out((count - missing.len()) as u64);
        missing.into_par_iter().try_for_each(|number| {
            // An interruption is not an error: samples that are being solved are still stored, and
            // the caller reports how many samples are missing.
            if self.stop.load(Ordering::Relaxed) {
                return Ok(());
            }
            let sample = format!("{}, sample {number}", self.label);
            match uninterrupted(|| work.track(&sample, || (self.solve)(number))) {
                Some(values) => {
                    work.count(1);
                    self.lock().append(SolvedSample { number, values })
                }
                None => Ok(()),
            }
        })
    }

    /// Flushes the journal to disk and returns its samples 1 to `count`.
    ///
    /// Samples with larger numbers come from an earlier analysis with more samples.
    fn stored(&self, count: usize) -> Result<Vec<SolvedSample>, OutputError> {
        let mut journal = self.lock();
        journal.sync()?;
        let stored = journal.records().values.range(..=count as u64);
        let samples =
            stored.map(|(&number, values)| SolvedSample { number, values: values.clone() });
        Ok(samples.collect())
    }
}

/// Returns the columns of a table of samples: the number, then the values called `names`.
fn columns(names: &[String]) -> Vec<Column<SolvedSample>> {
    let number = Column::new("sample", "-", "number of the sample", |sample: &SolvedSample| {
        Cell::Count(sample.number as i64)
    });
    let others = names.iter().enumerate().map(|(index, name)| {
        Column::computed(name.clone().into(), "", "", move |sample: &SolvedSample| {
            sample.values[index].into()
        })
    });
    std::iter::once(number).chain(others).collect()
}
