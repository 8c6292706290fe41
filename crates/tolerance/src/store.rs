//! Samples that were solved, kept in a file for each design so that none is solved twice.

use std::fs;
use std::path::Path;

use results::{Cell, Column, CsvFormat, OutputError, RunFolder, finite, sha256, write_rows};
use serde::{Deserialize, Serialize};

/// A solved sample of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Number of the sample, from 1.
    pub number: u64,
    /// Its deviations and measured values, in the order of [`DesignTolerance::columns`](crate::DesignTolerance::columns).
    pub values: Vec<Option<f64>>,
}

/// A folder of samples, with two files for each design: the table of its samples, and a record of what they are samples of.
///
/// The table is written as it grows, whole or not at all, and the record after it. A table is taken up again if its record names
/// the same definition, program and table; otherwise the samples are solved again.
#[derive(Clone, Debug)]
pub struct SampleStore {
    folder: RunFolder,
}

/// What the table of a design holds.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Record {
    /// SHA-256 of the definition of the design and of the program.
    of: String,
    /// SHA-256 of the table.
    sha256: String,
}

impl SampleStore {
    /// The store in `folder`, which is made if it is not there.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn new(folder: &Path) -> Result<Self, OutputError> {
        let folder = RunFolder::new(folder);
        folder.make()?;
        Ok(Self { folder })
    }

    /// The samples of the design `label` that are kept, if they are `of` the same definition; none otherwise.
    pub(crate) fn read(&self, label: &str, of: &str, columns: &[String]) -> Vec<Sample> {
        self.kept(label, of, columns).unwrap_or_default()
    }

    fn kept(&self, label: &str, of: &str, columns: &[String]) -> Option<Vec<Sample>> {
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
            samples.push(Sample { number, values });
        }
        Some(samples)
    }

    /// Keeps the samples of the design `label`.
    ///
    /// # Errors
    /// If the disk does not take them.
    pub(crate) fn write(
        &self,
        label: &str,
        of: &str,
        columns: &[String],
        samples: &[Sample],
    ) -> Result<(), OutputError> {
        let number = Column::new("sample", "-", "number of the sample", |sample: &Sample| {
            Cell::Count(sample.number as i64)
        });
        let others = columns.iter().enumerate().map(|(index, name)| {
            Column::indexed(name.clone(), "", "", index, |sample: &Sample, index| {
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
