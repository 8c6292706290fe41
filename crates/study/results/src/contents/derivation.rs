//! Records of products derived from the tables of a folder, with the SHA-256 of these tables.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf};

use journal::{OutputError, read_text, sha256};
use serde::{Deserialize, Serialize};

use crate::folder::ResultsFolder;

/// Record of a product of the tables of a results folder: ranking, workbook, figures or page.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Derivation {
    /// Name of the product, of one or two words.
    pub product: String,
    /// Command that makes the product again.
    pub command: String,
    /// SHA-256 of the source tables, see `Contents::digest`.
    ///
    /// Empty if the source was a definition.
    pub from: String,
    /// Part of the run that the tables covered, if the run was incomplete.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made_from: Option<String>,
    /// SHA-256 of the files of the product, by name.
    ///
    /// Files outside the folder are listed by path.
    pub files: BTreeMap<String, String>,
}

impl Derivation {
    /// Writes this record to the file `derived/{record}.toml` in `folder`.
    ///
    /// # Errors
    ///
    /// If the folder cannot be written.
    pub fn write(&self, folder: &ResultsFolder, record: &str) -> Result<(), OutputError> {
        let records = ResultsFolder::new(folder.file(ResultsFolder::DERIVED));
        records.make()?;
        // Texts always have a TOML form, so serialization cannot fail.
        let table = toml::to_string(self).unwrap_or_default();
        let text = format!("# A product of the tables, with the SHA-256 of these tables.\n{table}");
        records.write_text(&format!("{record}.toml"), &text)?;
        Ok(())
    }

    /// Reads the record with the name `record` from `folder`.
    ///
    /// `None` if the record does not exist or is damaged.
    pub fn read(folder: &ResultsFolder, record: &str) -> Option<Self> {
        toml::from_str(&read_text(&Self::path(folder, record)).ok()?).ok()
    }

    /// Returns the path of the record with the name `record` in `folder`.
    pub(super) fn path(folder: &ResultsFolder, record: &str) -> PathBuf {
        folder.file(ResultsFolder::DERIVED).join(format!("{record}.toml"))
    }

    /// Returns all readable records of `folder`, in the order of their names.
    pub fn all(folder: &ResultsFolder) -> Vec<Self> {
        Self::records(folder).iter().filter_map(|record| Self::read(folder, record)).collect()
    }

    /// Returns the sorted names of the records of `folder`.
    fn records(folder: &ResultsFolder) -> Vec<String> {
        let entries = fs::read_dir(folder.file(ResultsFolder::DERIVED)).into_iter().flatten();
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        let mut records: Vec<_> =
            names.filter_map(|name| name.strip_suffix(".toml").map(str::to_owned)).collect();
        // Sort the names, because the order of directory entries depends on the file system.
        records.sort();
        records
    }

    /// Returns true if any file of the product still exists.
    pub fn any_file_exists(&self, folder: &ResultsFolder) -> bool {
        self.files.keys().any(|name| folder.file(name).is_file())
    }

    /// Removes the unchanged files of the product in `folder`, and returns their names.
    ///
    /// Files outside the folder and files that a user has changed are kept.
    pub(super) fn remove(&self, folder: &ResultsFolder) -> Vec<String> {
        // An empty digest marks an unfinished file, which squama may remove in any state.
        let may_remove = |(name, digest): &(&String, &String)| {
            let path = folder.file(name);
            let is_unchanged =
                || digest.is_empty() || fs::read(&path).map(sha256).ok().as_ref() == Some(digest);
            // A record from another user may name any path, so remove only files in the folder.
            let is_inside =
                Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
            is_inside && path.is_file() && is_unchanged()
        };
        let removed: Vec<_> =
            self.files.iter().filter(may_remove).map(|(name, _)| name.clone()).collect();
        for name in &removed {
            folder.remove(name);
        }
        removed
    }
    /// Removes the unchanged files of all products of `folder`, and all records.
    ///
    /// Returns the names of the removed files.
    pub fn remove_all(folder: &ResultsFolder) -> Vec<String> {
        let removed = Self::all(folder).iter().flat_map(|made| made.remove(folder)).collect();
        let records = ResultsFolder::new(folder.file(ResultsFolder::DERIVED));
        for record in Self::records(folder) {
            records.remove(&format!("{record}.toml"));
        }
        // Removal fails, as intended, if the user has put other files into the folder.
        let _ = fs::remove_dir(records.path());
        removed
    }
}
