//! Samples that were solved, kept so that none is solved twice.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use journal::{Journal, Records};
use rayon::prelude::*;
use results::{Cell, Column, ResultsFolder, WrittenTable, write_rows};
use run::{JournalError, JournalHeader, Start, WorkMeter};
use serde::{Deserialize, Serialize};
use sweep::Subset;

use crate::analysis_error::AnalysisError;

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
    folder: ResultsFolder,
    work: Arc<WorkMeter>,
}

/// The samples of one definition that are kept, by their numbers.
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
    /// The store in `folder`, which is made when there is something to keep.
    pub fn new(folder: &Path) -> Self {
        Self { folder: ResultsFolder::new(folder), work: Arc::default() }
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
        names: &[String],
        count: usize,
        stop: &AtomicBool,
        solve: impl Fn(u64) -> Vec<Option<f64>> + Sync,
    ) -> Result<Vec<SolvedSample>, AnalysisError> {
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
        let columns = columns(names);
        let table = format!("{name}.csv");
        // By itself: the lock would be held as long as the loop, which takes it again.
        let differing = self.differing(&table, &columns, &lock().records().values);
        for number in differing {
            // Samples are drawn by their numbers: solved again, one tells which of the two was changed.
            let kept = lock().records().values[&number].clone();
            if !stop.load(Ordering::Relaxed) && solve(number) != kept {
                let (line, again) = (format!("sample {number}"), "by removing the journal");
                return Err(JournalError::Edited { path, line, table, again }.into());
            }
        }
        let mut missing: Vec<u64> = (1..=count as u64).collect();
        missing.retain(|number| !lock().records().values.contains_key(number));
        self.work.leave_out((count - missing.len()) as u64);
        missing.into_par_iter().try_for_each(|number| {
            // No error yet: samples in hand are kept first, and what is missing is counted behind.
            if stop.load(Ordering::Relaxed) {
                return Ok(());
            }
            let values = self.work.track(&format!("{label}, sample {number}"), || solve(number));
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
            return Err(AnalysisError::Stopped { done: samples.len(), of: count });
        }
        // Each time, from the journal: a table that somebody has changed does not stay.
        write_rows(&self.folder, &table, self.folder.csv_format(), &columns, &samples)?;
        Ok(samples)
    }

    /// The numbers of the samples that the table `name` has with other values than those that are kept.
    fn differing(
        &self,
        name: &str,
        columns: &[Column<SolvedSample>],
        kept: &BTreeMap<u64, Vec<Option<f64>>>,
    ) -> Vec<u64> {
        let Some(table) = WrittenTable::open(&self.folder, name) else { return Vec::new() };
        let number = |cell: &str| cell.parse::<u64>().ok();
        let changed = table.changed(columns, |record| {
            let number = number(&record[0]);
            let values = number.and_then(|number| kept.get(&number)).cloned();
            let sample = number.zip(values).map(|(number, values)| SolvedSample { number, values });
            Ok::<_, Infallible>(sample)
        });
        changed.into_iter().flatten().filter_map(|cell| number(&cell)).collect()
    }
}

/// The columns of a table of samples.
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
