//! The claim of a command to the files that it writes into a folder.
//!
//! A record in `derived/` names them before the first of them is written, and their SHA-256 after the last: so what a kill leaves
//! is known for what it is, a changed file is noticed, and no file is written over that squama has not written.

use std::collections::BTreeMap;
use std::fs::{self, File};

use journal::{OutputError, lock_folder, sha256_of};

use super::derivation::Derivation;
use crate::folder::{FileEntry, Maker, ResultsFolder};

/// The claim of one command to its files in one folder, which it writes alone.
#[derive(Debug)]
pub struct Claim<'f> {
    folder: &'f ResultsFolder,
    maker: Maker,
    made: Derivation,
    // Held as long as the claim: the system gives it back when the file is closed.
    lock: File,
}

impl<'f> Claim<'f> {
    /// Refuses to write the files of `maker` into `folder` where a file of such a name is a stranger's.
    ///
    /// # Errors
    /// If there is one.
    pub fn check(folder: &ResultsFolder, maker: Maker) -> Result<(), OutputError> {
        let stated = Self::stated(folder, maker);
        // A record that was damaged tells no names, but that there were some.
        if stated.is_none()
            && folder.holds(&format!("{}/{}.toml", ResultsFolder::DERIVED, maker.key()))
        {
            return Ok(());
        }
        let known = stated.unwrap_or_default();
        let mut strange = FileEntry::products(maker).filter(|file| !known.contains_key(file.name));
        strange.try_for_each(|file| require_none(folder, file.name))
    }

    /// SHA-256 of the files that `maker` states in `folder`, by their names; `None` if it states nothing.
    pub fn stated(folder: &ResultsFolder, maker: Maker) -> Option<BTreeMap<String, String>> {
        Derivation::read(folder, maker.key()).map(|made| made.files)
    }

    /// The claim of `maker` to its files in `folder`. Those of an earlier time are removed, unless somebody has changed them: no
    /// table of one definition stands beside one of another.
    ///
    /// # Errors
    /// If a file is a stranger's, another process is writing there, or the disk does not take the record.
    pub fn take(folder: &'f ResultsFolder, maker: Maker) -> Result<Self, OutputError> {
        folder.make()?;
        let lock = lock_folder(folder.path())?;
        // Asked under the lock, although a command may have asked before: somebody may have written since.
        Self::check(folder, maker)?;
        Self::release(folder, maker);
        // Without a digest until `state`: so what a kill leaves is known as unfinished.
        let names = FileEntry::products(maker).map(|file| (file.name.to_owned(), String::new()));
        let (product, command) = maker.names();
        let (product, command) = (product.to_owned(), command.to_owned());
        let (from, files) = (String::new(), names.collect());
        let made = Derivation { product, command, from, made_from: None, files };
        made.write(folder, maker.key())?;
        Ok(Self { folder, maker, made, lock })
    }

    /// Claims one more file.
    ///
    /// # Errors
    /// If it is a stranger's, or the disk does not take the record.
    pub fn add(&mut self, name: &str) -> Result<(), OutputError> {
        require_none(self.folder, name)?;
        // Named before it is written: what a kill leaves in between would be a stranger's for ever.
        self.made.files.insert(name.to_owned(), String::new());
        self.made.write(self.folder, self.maker.key())
    }

    /// States that `files` were written, and no other: one of an earlier time that somebody has changed is his. Returns the lock of the
    /// folder, for whoever has more to do with the files before another command may remove them.
    ///
    /// # Errors
    /// If a file cannot be read, or the disk does not take the record.
    pub fn state(mut self, files: &[impl AsRef<str>]) -> Result<File, OutputError> {
        let folder = self.folder;
        self.made.files.retain(|name, _| files.iter().any(|file| file.as_ref() == name));
        for (name, digest) in &mut self.made.files {
            let path = folder.file(name);
            let read = File::open(&path).and_then(sha256_of);
            *digest = read.map_err(|error| OutputError::file(&path, &error))?;
        }
        self.made.write(folder, self.maker.key())?;
        folder.sync();
        Ok(self.lock)
    }

    /// Removes the files of `maker` in `folder` that are as they were written, and its record.
    pub fn release(folder: &ResultsFolder, maker: Maker) {
        if let Some(made) = Derivation::read(folder, maker.key()) {
            made.remove(folder);
            ResultsFolder::new(folder.file(ResultsFolder::DERIVED))
                .remove(&format!("{}.toml", maker.key()));
        }
    }
}

/// Refuses to write the file `name` if there is anything of that name.
fn require_none(folder: &ResultsFolder, name: &str) -> Result<(), OutputError> {
    let path = folder.file(name);
    // No link is followed: one is a stranger's, wherever it leads.
    let is_there = fs::symlink_metadata(&path).is_ok();
    if is_there { Err(OutputError::strange(&path)) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folder::FILES;

    #[test]
    fn no_command_claims_a_file_of_a_stranger_and_every_one_its_own() {
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
                assert!(!folder.holds(file.name), "that of before is gone");
                write(text);
                claim.state(&[file.name]).expect("written");
            }
            // What a kill leaves between the claim and the statement is its own, too.
            drop(Claim::take(&folder, file.maker).expect(file.name));
            write("half of it");
            Claim::take(&folder, file.maker).expect(file.name);
            assert!(!folder.holds(file.name));
        }
    }

    #[test]
    fn what_somebody_has_changed_is_not_removed_with_the_rest() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = ResultsFolder::new(place.path());
        let claim = Claim::take(&folder, Maker::Tolerance).expect("a claim");
        let files = ["tolerance.csv", "yield.csv"];
        let write = |name: &str, text: &str| fs::write(folder.file(name), text).expect("writable");
        for name in files {
            write(name, "written");
        }
        claim.state(&files).expect("written");
        write("yield.csv", "changed");
        let claim = Claim::take(&folder, Maker::Tolerance).expect("a claim");
        assert!(!folder.holds("tolerance.csv") && folder.holds("yield.csv"));
        // Nor does it count as written if nobody writes it again.
        write("tolerance.csv", "again");
        claim.state(&files[..1]).expect("written");
        let refused = Claim::take(&folder, Maker::Tolerance).expect_err("a stranger's").to_string();
        assert!(refused.contains("yield.csv"), "{refused}");
    }

    #[test]
    fn one_command_writes_at_a_time() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = ResultsFolder::new(place.path());
        let _claim = Claim::take(&folder, Maker::Comparison).expect("a claim");
        let refused = Claim::take(&folder, Maker::Design).expect_err("in use").to_string();
        assert!(refused.contains("another squama is writing there"), "{refused}");
    }
}
