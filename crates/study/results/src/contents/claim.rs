//! The claim of a command to the files that it writes into a folder.
//!
//! A record in `derived/` lists the files before the first file is written, and their SHA-256 after
//! the last file is written. Therefore the files of a killed command count as unfinished, changed
//! files are detected, and squama never overwrites a file that it did not write.

use std::collections::BTreeMap;
use std::fs::{self, File};

use journal::{OutputError, lock_folder, sha256_of};

use super::derivation::Derivation;
use crate::folder::{FileEntry, Maker, ResultsFolder};

/// The exclusive claim of one command to its files in one folder.
#[derive(Debug)]
pub struct Claim<'f> {
    folder: &'f ResultsFolder,
    maker: Maker,
    record: Derivation,
    // Locked for the lifetime of the claim. Closing the file releases the lock.
    lock: File,
}

impl<'f> Claim<'f> {
    /// Checks that `maker` would not overwrite a file that squama did not write.
    ///
    /// # Errors
    ///
    /// If `maker` would overwrite such a file.
    pub fn check(folder: &ResultsFolder, maker: Maker) -> Result<(), OutputError> {
        let recorded = Self::recorded(folder, maker);
        // A damaged record lists no files, but proves that the command wrote some.
        if recorded.is_none()
            && folder.holds(&format!("{}/{}.toml", ResultsFolder::DERIVED, maker.key()))
        {
            return Ok(());
        }
        let known = recorded.unwrap_or_default();
        let mut unknown = FileEntry::products(maker).filter(|file| !known.contains_key(file.name));
        unknown.try_for_each(|file| require_none(folder, file.name))
    }

    /// Returns the recorded SHA-256 of each file of `maker`, by name.
    ///
    /// `None` if `maker` has no record, or a damaged one.
    pub fn recorded(folder: &ResultsFolder, maker: Maker) -> Option<BTreeMap<String, String>> {
        Derivation::read(folder, maker.key()).map(|record| record.files)
    }

    /// Claims the files of `maker` in `folder`.
    ///
    /// Removes unchanged files of an earlier run, so that tables of two definitions never mix.
    ///
    /// # Errors
    ///
    /// If squama did not write one of the files, another process is writing there, or the record
    /// cannot be written.
    pub fn take(folder: &'f ResultsFolder, maker: Maker) -> Result<Self, OutputError> {
        folder.make()?;
        let lock = lock_folder(folder.path())?;
        // Check after locking, because another process may have written since an earlier check.
        Self::check(folder, maker)?;
        Self::release(folder, maker);
        // Leave the digests empty until `finish`, so that the files of a killed command count as
        // unfinished.
        let names = FileEntry::products(maker).map(|file| (file.name.to_owned(), String::new()));
        let (product, command) = maker.names();
        let (product, command) = (product.to_owned(), command.to_owned());
        let (from, files) = (String::new(), names.collect());
        let record = Derivation { product, command, from, made_from: None, files };
        record.write(folder, maker.key())?;
        Ok(Self { folder, maker, record, lock })
    }

    /// Adds the file `name` to the claim.
    ///
    /// # Errors
    ///
    /// If squama did not write the file, or the record cannot be written.
    pub fn add(&mut self, name: &str) -> Result<(), OutputError> {
        require_none(self.folder, name)?;
        // Record the name before the file is written. Otherwise the file of a killed command would
        // count as foreign and block every later run.
        self.record.files.insert(name.to_owned(), String::new());
        self.record.write(self.folder, self.maker.key())
    }

    /// Records the digests of `files` and ends the claim.
    ///
    /// Files that are not listed, such as changed files of an earlier run, no longer belong to the
    /// command. Returns the lock of the folder, for callers that use the files before another
    /// command may remove them.
    ///
    /// # Errors
    ///
    /// If a file cannot be read, or the record cannot be written.
    pub fn finish(mut self, files: &[impl AsRef<str>]) -> Result<File, OutputError> {
        let folder = self.folder;
        self.record.files.retain(|name, _| files.iter().any(|file| file.as_ref() == name));
        for (name, digest) in &mut self.record.files {
            let path = folder.file(name);
            let read = File::open(&path).and_then(sha256_of);
            *digest = read.map_err(|error| OutputError::file(&path, &error))?;
        }
        self.record.write(folder, self.maker.key())?;
        folder.sync();
        Ok(self.lock)
    }

    /// Removes the unchanged files of `maker` in `folder`, and its record.
    pub fn release(folder: &ResultsFolder, maker: Maker) {
        if let Some(record) = Derivation::read(folder, maker.key()) {
            record.remove(folder);
            ResultsFolder::new(folder.file(ResultsFolder::DERIVED))
                .remove(&format!("{}.toml", maker.key()));
        }
    }
}

/// Refuses to write the file `name` if anything with that name exists.
fn require_none(folder: &ResultsFolder, name: &str) -> Result<(), OutputError> {
    let path = folder.file(name);
    // Do not follow links: squama did not write a link, even if its target does not exist.
    let exists = fs::symlink_metadata(&path).is_ok();
    if exists { Err(OutputError::foreign(&path)) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folder::FILES;

    #[test]
    fn a_command_claims_its_own_files_but_no_foreign_ones() {
        for file in FILES.iter().filter(|file| file.maker != Maker::Run) {
            let place = tempfile::tempdir().expect("a folder");
            let folder = ResultsFolder::new(place.path());
            let write = |text: &str| fs::write(folder.file(file.name), text).expect("writable");
            if FileEntry::products(file.maker).all(|product| product.name != file.name) {
                continue;
            }
            write("a stranger's");
            let refused = Claim::take(&folder, file.maker).expect_err(file.name).to_string();
            assert!(
                refused.contains(file.name) && refused.contains("has not written"),
                "{refused}"
            );
            assert_eq!(fs::read_to_string(folder.file(file.name)).expect("text"), "a stranger's");
            folder.remove(file.name);
            for text in ["first", "second"] {
                let claim = Claim::take(&folder, file.maker).expect(file.name);
                assert!(!folder.holds(file.name), "the file of the earlier run is removed");
                write(text);
                claim.finish(&[file.name]).expect("written");
            }
            // A command that is killed between `take` and `state` leaves files that it may remove
            // in the next run.
            drop(Claim::take(&folder, file.maker).expect(file.name));
            write("half of it");
            Claim::take(&folder, file.maker).expect(file.name);
            assert!(!folder.holds(file.name));
        }
    }

    #[test]
    fn changed_files_are_not_removed() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = ResultsFolder::new(place.path());
        let claim = Claim::take(&folder, Maker::Tolerance).expect("a claim");
        let files = ["tolerance.csv", "yield.csv"];
        let write = |name: &str, text: &str| fs::write(folder.file(name), text).expect("writable");
        for name in files {
            write(name, "written");
        }
        claim.finish(&files).expect("written");
        write("yield.csv", "changed");
        let claim = Claim::take(&folder, Maker::Tolerance).expect("a claim");
        assert!(!folder.holds("tolerance.csv") && folder.holds("yield.csv"));
        // The changed file counts as foreign after a run that did not write it.
        write("tolerance.csv", "again");
        claim.finish(&files[..1]).expect("written");
        let refused = Claim::take(&folder, Maker::Tolerance).expect_err("foreign file").to_string();
        assert!(refused.contains("yield.csv"), "{refused}");
    }

    #[test]
    fn only_one_command_at_a_time_claims_files_of_a_folder() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = ResultsFolder::new(place.path());
        let _claim = Claim::take(&folder, Maker::Comparison).expect("a claim");
        let refused = Claim::take(&folder, Maker::Design).expect_err("in use").to_string();
        assert!(refused.contains("another squama process is writing there"), "{refused}");
    }
}
