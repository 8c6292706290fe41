//! Contents of a results folder: the checksums that a run writes last.
//!
//! `contents.toml` states the extent of the journal and the SHA-256 of every table. Tables are
//! moved into place one by one, so a run killed between two moves leaves tables that contradict
//! `contents.toml`. Every reading command detects this before it uses a number.

pub mod claim;
pub mod derivation;
pub mod verified_folder;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use journal::{OutputError, read_text, sha256, sha256_of};
use serde::{Deserialize, Serialize};

use crate::folder::ResultsFolder;

/// Key of the first line; its value is the SHA-256 of all lines below it.
///
/// The name of the key contains "above" by mistake. It is kept, because a new name would make
/// existing folders unreadable.
const DIGEST_KEY: &str = "sha256_of_the_above = ";

/// Contents of a results folder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contents {
    /// Program that wrote the folder.
    pub program: String,
    /// Number of designs of the run.
    pub designs: u64,
    /// Number of finished designs.
    pub done: u64,
    /// Extent of the journal when the tables were written.
    pub journal: JournalExtent,
    /// SHA-256 of each file, by the name of the file.
    pub files: BTreeMap<String, String>,
}

/// Length and checksum of the part of a journal from which the tables were written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JournalExtent {
    /// Length in bytes.
    pub bytes: u64,
    /// Number of lines.
    pub lines: u64,
    /// SHA-256 of the first `bytes` bytes.
    pub sha256: String,
}

impl JournalExtent {
    /// Returns the extent of the first `bytes` bytes of a journal with `lines` lines.
    ///
    /// # Errors
    ///
    /// If the file cannot be read.
    pub fn read(path: &Path, bytes: u64, lines: u64) -> io::Result<Self> {
        Ok(Self { bytes, lines, sha256: sha256_of(File::open(path)?.take(bytes))? })
    }
}

impl Contents {
    /// Writes `contents.toml` to `folder`.
    ///
    /// Call this after all other files have been written.
    ///
    /// # Errors
    ///
    /// If the folder cannot be written.
    pub fn write(&self, folder: &ResultsFolder) -> Result<(), OutputError> {
        // Numbers and texts always have a TOML form, so serialization cannot fail.
        let table = toml::to_string(self).unwrap_or_default();
        let text = format!(
            "# Checksums of the files in this folder. Commands that read the folder verify its files against them.\n\
             {table}"
        );
        // Hash the text, not the parsed values: an edit that keeps the values must be detected too.
        let sealed = format!("# {DIGEST_KEY}{}\n{text}", sha256(&text));
        folder.write_text(ResultsFolder::CONTENTS, &sealed).map(|_| ())
    }

    /// Reads the contents of `folder`. `None` if they are missing or damaged.
    pub fn read(folder: &ResultsFolder) -> Option<Self> {
        // Damaged contents count as missing here; `VerifiedFolder` reports the damage.
        let text = read_text(&folder.file(ResultsFolder::CONTENTS)).ok()?;
        Self::parse(&text).ok()
    }

    /// Parses the text of `contents.toml` after verifying its checksum.
    fn parse(text: &str) -> Result<Self, String> {
        let sealed = text.split_once('\n').and_then(|(seal, text)| {
            let digest = seal.strip_prefix("# ")?.strip_prefix(DIGEST_KEY)?;
            (digest == sha256(text)).then_some(text)
        });
        let text = sealed.ok_or("its checksum does not match")?;
        toml::from_str(text).map_err(|error| text::one_line(error.message()))
    }

    /// Returns true if every design of the run is finished.
    pub fn is_whole(&self) -> bool {
        self.done == self.designs
    }

    /// Returns one SHA-256 over all tables, which does not depend on the time of writing.
    pub fn digest(&self) -> String {
        // Leave out the record of the run, because it contains times.
        let tables = self.files.iter().filter(|(name, _)| *name != ResultsFolder::RUN_INFO);
        let lines = tables.map(|(name, digest)| format!("{digest}  {name}\n"));
        sha256(lines.collect::<String>())
    }
}
