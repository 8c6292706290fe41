//! The contents of a results folder: what a run states, last of all, of what it has written there.
//!
//! `contents.toml` names how far the journal had come, and the SHA-256 of every table. Tables are moved to their places one
//! by one, so a run that is killed between two of them leaves a folder that is not as its contents say: every command that
//! reads a folder finds that out before it uses a number.

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

/// The line that seals the text before it.
const SEAL: &str = "sha256_of_the_above = ";

/// The content of a results folder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contents {
    /// The program that wrote it.
    pub program: String,
    /// The number of designs of the run.
    pub designs: u64,
    /// The number of designs that are done.
    pub done: u64,
    /// How far the journal had come.
    pub journal: JournalExtent,
    /// SHA-256 of each file, by its name.
    pub files: BTreeMap<String, String>,
}

/// The extent of a journal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JournalExtent {
    /// Its bytes.
    pub bytes: u64,
    /// Its lines.
    pub lines: u64,
    /// SHA-256 of these bytes.
    pub sha256: String,
}

impl JournalExtent {
    /// The extent of the first `bytes` bytes of the journal at `path`, which are `lines` lines.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn read(path: &Path, bytes: u64, lines: u64) -> io::Result<Self> {
        Ok(Self { bytes, lines, sha256: sha256_of(File::open(path)?.take(bytes))? })
    }
}

impl Contents {
    /// Writes the contents to `folder`, as the last of its files.
    ///
    /// # Errors
    /// If the folder or the disk does not take them.
    pub fn write(&self, folder: &ResultsFolder) -> Result<(), OutputError> {
        // Numbers and texts always have a form in TOML.
        let table = toml::to_string(self).unwrap_or_default();
        let text = format!(
            "# What this folder held when its tables were written. Commands that read it check every file against this.\n\
             {table}"
        );
        // Over the text as it stands, not over what it says: an edit that keeps the meaning is one too.
        let sealed = format!("# {SEAL}{}\n{text}", sha256(&text));
        folder.write_text(ResultsFolder::CONTENTS, &sealed).map(|_| ())
    }

    /// The contents that are stated in `folder`, if they are there and sound.
    pub fn stated_in(folder: &ResultsFolder) -> Option<Self> {
        // What is wrong with a damaged statement `VerifiedFolder` says; here it is as good as none.
        let text = read_text(&folder.file(ResultsFolder::CONTENTS)).ok()?;
        Self::parse(&text).ok()
    }

    /// The contents that `text` states.
    fn parse(text: &str) -> Result<Self, String> {
        let sealed = text.split_once('\n').and_then(|(seal, text)| {
            let digest = seal.strip_prefix("# ")?.strip_prefix(SEAL)?;
            (digest == sha256(text)).then_some(text)
        });
        let text = sealed.ok_or("its checksum does not match")?;
        toml::from_str(text).map_err(|error| text::one_line(error.message()))
    }

    /// Whether every design is done.
    pub fn is_whole(&self) -> bool {
        self.done == self.designs
    }

    /// The tables that it states, as one SHA-256: the same for equal tables, whenever they were written.
    pub fn digest(&self) -> String {
        // The record of the run says when it was.
        let tables = self.files.iter().filter(|(name, _)| *name != ResultsFolder::RUN_INFO);
        let lines = tables.map(|(name, digest)| format!("{digest}  {name}\n"));
        sha256(lines.collect::<String>())
    }
}
