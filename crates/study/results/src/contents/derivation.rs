//! A product of the tables of a folder, and the tables that it was made from.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path};

use journal::{OutputError, read_text, sha256};
use serde::{Deserialize, Serialize};

use super::verified_folder::VerifiedFolder;
use crate::folder::ResultsFolder;

/// A product of the tables of a results folder: a ranking, a workbook, figures, a page.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Derivation {
    /// The name of the product, in a word or two.
    pub product: String,
    /// The command that makes it again.
    pub command: String,
    /// SHA-256 of the tables that it was made from, see `Contents::digest`; empty if it was made from a definition.
    pub from: String,
    /// How much of the run it was made from, if it was not the whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made_from: Option<String>,
    /// SHA-256 of its files, by their names in the folder, or by their paths if they are elsewhere.
    pub files: BTreeMap<String, String>,
}

impl Derivation {
    /// A product of `results` which `command` makes, none if nobody states what the tables are.
    pub fn new(results: &VerifiedFolder, product: &str, command: String) -> Option<Self> {
        let (from, made_from) = (results.digest()?, results.shortfall());
        Some(Self { product: product.to_owned(), command, from, made_from, files: BTreeMap::new() })
    }

    /// Notes the product in `folder` under the name `record`.
    ///
    /// # Errors
    /// If the folder or the disk does not take it.
    pub fn write(&self, folder: &ResultsFolder, record: &str) -> Result<(), OutputError> {
        let records = ResultsFolder::new(folder.file(ResultsFolder::DERIVED));
        records.make()?;
        // Texts always have a form in TOML.
        let table = toml::to_string(self).unwrap_or_default();
        let text = format!("# What was made from the tables, and from which of them.\n{table}");
        records.write_text(&format!("{record}.toml"), &text)?;
        Ok(())
    }

    /// The product in `folder` that is noted under the name `record`.
    pub fn read(folder: &ResultsFolder, record: &str) -> Option<Self> {
        let path = folder.file(ResultsFolder::DERIVED).join(format!("{record}.toml"));
        // A record that is damaged speaks for nothing.
        toml::from_str(&read_text(&path).ok()?).ok()
    }

    /// All products of `folder`, in the order of their records.
    pub fn all(folder: &ResultsFolder) -> Vec<Self> {
        Self::records(folder).iter().filter_map(|record| Self::read(folder, record)).collect()
    }

    /// The names of the records of `folder`, in their order.
    fn records(folder: &ResultsFolder) -> Vec<String> {
        let entries = fs::read_dir(folder.file(ResultsFolder::DERIVED)).into_iter().flatten();
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        let mut records: Vec<_> =
            names.filter_map(|name| name.strip_suffix(".toml").map(str::to_owned)).collect();
        // A file system lists a folder in an order of its own.
        records.sort();
        records
    }

    /// Whether any of its files is still there.
    pub fn is_there(&self, folder: &ResultsFolder) -> bool {
        self.files.keys().any(|name| folder.file(name).is_file())
    }

    /// Removes those of its files in `folder` that are as they were made, and returns their names. What stands elsewhere,
    /// or was changed by somebody, is not squama's to remove.
    pub(super) fn remove(&self, folder: &ResultsFolder) -> Vec<String> {
        // Without a digest it was not finished, and whatever is there of it is ours.
        let is_ours = |(name, digest): &(&String, &String)| {
            let path = folder.file(name);
            let is_own =
                || digest.is_empty() || fs::read(&path).map(sha256).ok().as_ref() == Some(digest);
            // A record that came with somebody's results may name anything.
            let is_inside =
                Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
            is_inside && path.is_file() && is_own()
        };
        let removed: Vec<_> =
            self.files.iter().filter(is_ours).map(|(name, _)| name.clone()).collect();
        for name in &removed {
            folder.remove(name);
        }
        removed
    }
    /// Removes all products of `folder` that are as they were made, and the records of all; returns the names of the files.
    pub fn remove_all(folder: &ResultsFolder) -> Vec<String> {
        let removed = Self::all(folder).iter().flat_map(|made| made.remove(folder)).collect();
        let records = ResultsFolder::new(folder.file(ResultsFolder::DERIVED));
        for record in Self::records(folder) {
            records.remove(&format!("{record}.toml"));
        }
        // It stays where somebody has put something else into it.
        let _ = fs::remove_dir(records.path());
        removed
    }
}
