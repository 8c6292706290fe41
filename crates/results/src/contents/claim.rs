//! The claim of a command to the files that it writes into a folder.
//!
//! A record in `derived/` names them before the first of them is written, and their SHA-256 after the last: so what a kill leaves
//! is known for what it is, a changed file is noticed, and no file is written over that squama has not written.

use std::fs::{self, File};

use store::{OutputError, lock_folder, sha256_of};

use super::derivation::Derivation;
use crate::folder::{FileEntry, Maker, RunFolder};

/// The claim of one command to its files in one folder, which it writes alone.
#[derive(Debug)]
pub struct Claim<'f> {
    folder: &'f RunFolder,
    maker: Maker,
    made: Derivation,
    _lock: File,
}

impl<'f> Claim<'f> {
    /// Refuses to write the files of `maker` into `folder` where a file of such a name is a stranger's.
    ///
    /// # Errors
    /// If there is one.
    pub fn check(folder: &RunFolder, maker: Maker) -> Result<(), OutputError> {
        let made = Derivation::read(folder, maker.key());
        // A record that was damaged tells no names, but that there were some.
        if made.is_none() && folder.holds(&format!("{}/{}.toml", RunFolder::DERIVED, maker.key())) {
            return Ok(());
        }
        let known = made.map(|made| made.files).unwrap_or_default();
        let mut strange = FileEntry::products(maker).filter(|file| !known.contains_key(file.name));
        strange.try_for_each(|file| require_none(folder, file.name))
    }

    /// The claim of `maker` to its files in `folder`. Those of an earlier time are removed, unless somebody has changed them: no
    /// table of one definition stands beside one of another.
    ///
    /// # Errors
    /// If a file is a stranger's, another process is writing there, or the disk does not take the record.
    pub fn take(folder: &'f RunFolder, maker: Maker) -> Result<Self, OutputError> {
        folder.make()?;
        let lock = lock_folder(folder.path())?;
        Self::check(folder, maker)?;
        Self::release(folder, maker);
        let names = FileEntry::products(maker).map(|file| (file.name.to_owned(), String::new()));
        let (product, command) = maker.names();
        let (product, command) = (product.to_owned(), command.to_owned());
        let (from, files) = (String::new(), names.collect());
        let made = Derivation { product, command, from, made_from: None, files };
        made.write(folder, maker.key())?;
        Ok(Self { folder, maker, made, _lock: lock })
    }

    /// Claims one more file.
    ///
    /// # Errors
    /// If it is a stranger's, or the disk does not take the record.
    pub fn add(&mut self, name: &str) -> Result<(), OutputError> {
        require_none(self.folder, name)?;
        self.made.files.insert(name.to_owned(), String::new());
        self.made.write(self.folder, self.maker.key())
    }

    /// States what was written.
    ///
    /// # Errors
    /// If a file cannot be read, or the disk does not take the record.
    pub fn state(mut self) -> Result<(), OutputError> {
        let folder = self.folder;
        self.made.files.retain(|name, _| folder.holds(name));
        for (name, digest) in &mut self.made.files {
            let path = folder.file(name);
            let read = File::open(&path).and_then(sha256_of);
            *digest = read.map_err(|error| OutputError::file(&path, &error))?;
        }
        self.made.write(folder, self.maker.key())?;
        folder.sync();
        Ok(())
    }

    /// Removes the files of `maker` in `folder` that are as they were written, and its record.
    pub fn release(folder: &RunFolder, maker: Maker) {
        if let Some(made) = Derivation::read(folder, maker.key()) {
            made.remove(folder);
            RunFolder::new(folder.file(RunFolder::DERIVED))
                .remove(&format!("{}.toml", maker.key()));
        }
    }
}

/// Refuses to write the file `name` if there is anything of that name.
fn require_none(folder: &RunFolder, name: &str) -> Result<(), OutputError> {
    let path = folder.file(name);
    let is_there = fs::symlink_metadata(&path).is_ok();
    if is_there { Err(OutputError::strange(&path)) } else { Ok(()) }
}
