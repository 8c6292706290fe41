//! The header of a journal: definition, designs and program.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;
use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use text::one_line;
use text::toml_source::{self, Value};

use crate::digest::sha256;
use crate::error::JournalError;
use crate::seal::Seal;

/// Current format of journals.
///
/// Format 1 stored results as rows of text. Format 2 stores typed results.
const FORMAT: u64 = 2;

/// Version and source revision of the program that wrote a journal.
#[derive(Clone, Copy, Debug)]
pub struct Program {
    /// Version of the program.
    pub version: &'static str,
    /// Source revision of the program.
    pub revision: &'static str,
}

/// Requirements on the type that states which designs a journal contains.
///
/// The subset of the designs is written to the header and shown in messages.
pub trait Designs: Clone + Default + Display + PartialEq + Serialize + DeserializeOwned {}

impl<D: Clone + Default + Display + PartialEq + Serialize + DeserializeOwned> Designs for D {}

/// Header of a journal: definition, subset of the designs, and program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, bound(deserialize = "D: Designs"))]
pub struct JournalHeader<D> {
    /// Number of the format of the lines.
    format: u64,
    /// Version of the program.
    version: String,
    /// Source revision of the program.
    revision: String,
    /// SHA-256 of the definition.
    definition_sha256: String,
    /// Subset of the designs.
    #[serde(default)]
    subset: D,
    /// Complete text of the definition.
    definition: String,
}

impl<D: Designs> JournalHeader<D> {
    /// Creates the header for `subset` of the designs of `definition`.
    pub fn new(definition: String, subset: D, program: &Program) -> Self {
        Self {
            format: FORMAT,
            version: program.version.to_owned(),
            revision: program.revision.to_owned(),
            definition_sha256: sha256(&definition),
            subset,
            definition,
        }
    }

    /// Returns the first line of a journal, including its line end.
    ///
    /// The line is a JSON object that contains the header under `key`.
    pub(crate) fn line(&self, key: &str) -> Vec<u8> {
        Seal::default().seal(&BTreeMap::from([(key, self)]))
    }

    /// Parses `bytes`, the first line of the journal at `path`.
    ///
    /// The line is a JSON object that contains the header under `key`.
    pub(crate) fn read(bytes: &mut [u8], key: &str, path: &Path) -> Result<Self, JournalError> {
        let refuse = |problem: String| JournalError::NoHeader { path: path.to_owned(), problem };
        let object = Seal::default().open(bytes).map_err(refuse)?;
        if let Some((found, by)) = other_format(object, key) {
            let (path, expected) = (path.to_owned(), FORMAT);
            return Err(JournalError::OtherFormat { path, found, expected, by });
        }
        let read: Result<BTreeMap<String, Self>, _> = serde_json::from_slice(object);
        let mut read = read.map_err(|error| refuse(one_line(&error.to_string())))?;
        let header = read.remove(key).filter(Self::is_sound);
        header.ok_or_else(|| refuse("expected the header that squama writes".to_owned()))
    }

    /// Returns the seal that computes the checksums of all lines after the header.
    pub fn seal(&self) -> Seal {
        Seal::over(&[&self.definition_sha256, &self.version, &self.revision])
    }

    /// Returns the SHA-256 of a text that combines definition, subset of the designs and program.
    pub fn digest(&self) -> String {
        sha256(format!("{} {}\n{}\n{}", self.version, self.revision, self.subset, self.definition))
    }

    /// Returns the complete text of the definition.
    pub fn definition(&self) -> &str {
        &self.definition
    }

    /// Returns true if the SHA-256 in the header matches the definition.
    fn is_sound(&self) -> bool {
        self.definition_sha256 == sha256(&self.definition)
    }

    /// Returns the subset of the designs.
    pub fn subset(&self) -> &D {
        &self.subset
    }

    /// Returns the SHA-256 of the definition.
    pub fn definition_sha256(&self) -> &str {
        &self.definition_sha256
    }

    /// Returns version and revision of the program, e.g. "1.0.0 (abc123)".
    pub fn program(&self) -> String {
        format!("{} ({})", self.version, self.revision)
    }

    /// Returns this header with another subset of the designs.
    #[must_use]
    pub fn with_subset(self, subset: D) -> Self {
        Self { subset, ..self }
    }

    /// Checks that this header of the journal at `path` equals the header `wanted`.
    ///
    /// # Errors
    ///
    /// If program, definition or subset differ. The message contains the difference and the text
    /// `expected`.
    pub fn require(
        &self,
        wanted: &Self,
        path: &Path,
        expected: &'static str,
    ) -> Result<(), JournalError> {
        let path = path.to_owned();
        self.difference(wanted).map_or(Ok(()), |difference| {
            Err(JournalError::Different { path, difference, expected })
        })
    }

    /// Describes the first difference between this header and `wanted`; `None` if they are equal.
    fn difference(&self, wanted: &Self) -> Option<String> {
        if self.program() != wanted.program() {
            let (here, there) = (self.program(), wanted.program());
            return Some(format!("was written by squama {here}, this is squama {there}"));
        }
        if self.definition != wanted.definition {
            let changes = changes(&self.definition, &wanted.definition);
            return Some(format!("has another definition: {changes}"));
        }
        // No need to compare format and SHA-256: `read` has checked them.
        (self.subset != wanted.subset)
            .then(|| format!("contains {} instead of {}", self.subset, wanted.subset))
    }
}

/// Returns format and program of a journal if its format is not the current one.
///
/// `object` is the first line of the journal, with the header under `key`. In format 1 the first
/// line of a search contained the number of the format under `key`, and the program under
/// `program`.
fn other_format(object: &[u8], key: &str) -> Option<(u64, String)> {
    let line: serde_json::Value = serde_json::from_slice(object).ok()?;
    let header = line.get(key)?;
    let found = header.as_u64().or_else(|| header.get("format")?.as_u64())?;
    let texts = [&line["program"], &header["version"], &header["revision"]];
    let program = match texts.map(serde_json::Value::as_str) {
        [Some(program), ..] => program.to_owned(),
        [_, Some(version), Some(revision)] => format!("{version} ({revision})"),
        _ => "unknown".to_owned(),
    };
    (found != FORMAT).then_some((found, program))
}

/// Lists the keys with different values in `here`, the definition of a journal, and in `there`.
fn changes(here: &str, there: &str) -> String {
    let (here, there) = (keys(here), keys(there));
    let names: BTreeSet<_> = here.keys().chain(there.keys()).collect();
    let changes = names.into_iter().filter_map(|name| {
        let [old, new] = [&here, &there].map(|keys| keys.get(name).map_or("not set", |v| v));
        (old != new).then(|| format!("{name} is {old} in the journal and {new} now"))
    });
    changes.collect::<Vec<_>>().join("; ")
}

/// Returns the values of a definition by dotted key, e.g. `designs.gap_over_t`.
fn keys(definition: &str) -> BTreeMap<String, String> {
    let mut keys = BTreeMap::new();
    for entry in toml_source::parse(definition, "").unwrap_or_default() {
        match &entry.value {
            Value::Table(section) => keys.extend(
                section
                    .iter()
                    .map(|inner| (format!("{}.{}", entry.key, inner.key), inner.value.to_string())),
            ),
            value => {
                keys.insert(entry.key.clone(), value.to_string());
            }
        }
    }
    keys
}
