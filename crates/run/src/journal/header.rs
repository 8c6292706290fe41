//! The header of a journal: what was solved, by which program.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use results::sha256;
use serde::{Deserialize, Serialize};
use sweep::toml_source::{self, Value};
use sweep::{Subset, Sweep};

use super::error::JournalError;
use crate::options::Program;

/// The format of the journals that this program writes: typed results since 2, rows of text in 1.
pub(super) const FORMAT: u32 = 2;

/// The header of a journal: the definition, the subset of its designs, the program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JournalHeader {
    /// The format of the lines.
    pub(crate) format: u32,
    /// Version of the program.
    pub(crate) version: String,
    /// Revision of its source.
    pub(crate) revision: String,
    /// SHA-256 of the definition.
    pub(crate) definition_sha256: String,
    /// The designs that are solved.
    #[serde(default)]
    pub(crate) subset: Subset,
    /// The definition, complete.
    pub(crate) definition: String,
}

impl JournalHeader {
    /// The header of a journal of `subset` of `sweep`.
    pub fn new(sweep: &Sweep, subset: Subset, program: &Program) -> Self {
        let definition = sweep.to_toml();
        Self {
            format: FORMAT,
            version: program.version.to_owned(),
            revision: program.revision.to_owned(),
            definition_sha256: sha256(&definition),
            subset,
            definition,
        }
    }

    /// Whether its checksum is that of its definition.
    pub(crate) fn is_sound(&self) -> bool {
        self.definition_sha256 == sha256(&self.definition)
    }

    /// The designs that are solved.
    pub fn subset(&self) -> Subset {
        self.subset
    }

    /// SHA-256 of the definition.
    pub fn definition_sha256(&self) -> &str {
        &self.definition_sha256
    }

    /// Version and revision of the program.
    pub fn program(&self) -> String {
        format!("{} ({})", self.version, self.revision)
    }

    /// The header of the journal with all designs of all shards.
    pub(crate) fn of_all_shards(mut self) -> Self {
        self.subset.shard = None;
        self
    }

    /// Refuses a journal at `path` that has this header where `wanted` is wanted, and says what is
    /// `expected` instead.
    pub(crate) fn require(
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

    /// The difference between `wanted` and this header, in words.
    fn difference(&self, wanted: &Self) -> Option<String> {
        if self.program() != wanted.program() {
            let (here, there) = (self.program(), wanted.program());
            return Some(format!("is by squama {here}, this is squama {there}"));
        }
        if self.definition != wanted.definition {
            let changes = changes(&self.definition, &wanted.definition);
            return Some(format!("is of another definition: {changes}"));
        }
        // Of the rest, the format is this program's and the digest is the definition's.
        (self.subset != wanted.subset)
            .then(|| format!("is of {}, not of {}", self.subset, wanted.subset))
    }
}

/// The keys in which two definitions differ.
fn changes(here: &str, there: &str) -> String {
    let (here, there) = (keys(here), keys(there));
    let names: BTreeSet<_> = here.keys().chain(there.keys()).collect();
    let text = |keys: &BTreeMap<String, String>, name: &String| {
        keys.get(name).cloned().unwrap_or_else(|| "not set".to_owned())
    };
    let change = |name: &String| {
        let (old, new) = (text(&here, name), text(&there, name));
        (old != new).then(|| format!("{name} is {old} in it and {new} now"))
    };
    let changes: Vec<_> = names.iter().filter_map(|name| change(name)).collect();
    changes.join("; ")
}

/// The dotted keys of a definition with their values.
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
