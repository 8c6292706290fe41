//! Files that are written atomically: they appear under their names only when complete.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use sha2::{Digest as _, Sha256};
use text::reason;

use crate::digest::digits;
use crate::partial_file::{PartialFile, remove_abandoned_files};

/// Error: a file or folder cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot be written ({reason}), {advice}", path.display())]
pub struct OutputError {
    path: PathBuf,
    reason: String,
    advice: &'static str,
}

impl OutputError {
    /// Creates the error for a folder that cannot be created or written.
    pub fn folder(path: &Path, error: &io::Error) -> Self {
        let advice = "expected a folder that can be written, e.g. with --out DIR";
        Self { path: path.to_owned(), reason: reason(error), advice }
    }

    /// Creates the error for a file that cannot be written.
    pub fn file(path: &Path, error: &io::Error) -> Self {
        Self { path: path.to_owned(), reason: reason(error), advice: "check free space" }
    }

    /// Creates the error for an existing file that squama did not write and therefore keeps.
    pub fn foreign(path: &Path) -> Self {
        let advice = "move the file, or choose another folder with --out DIR";
        let reason = "there is a file of that name that squama has not written".to_owned();
        Self { path: path.to_owned(), reason, advice }
    }

    /// Creates the error for a folder that another process is writing to.
    pub fn in_use(path: &Path) -> Self {
        let (reason, advice) = ("another squama process is writing there", "wait for it to end");
        Self { path: path.to_owned(), reason: reason.to_owned(), advice }
    }

    /// Creates the error for a journal that cannot be written.
    pub fn journal(path: &Path, error: &io::Error) -> Self {
        let advice = "check free space, then continue with --resume";
        Self { path: path.to_owned(), reason: reason(error), advice }
    }
}

/// A file that is written under a temporary name and renamed when it is complete.
#[derive(Debug)]
pub struct AtomicFile {
    path: PathBuf,
    partial: PartialFile,
    hasher: Sha256,
}

impl AtomicFile {
    /// Creates a temporary file in `folder`; [`Self::finish`] renames it to `name`.
    ///
    /// # Errors
    ///
    /// If the folder cannot be written.
    pub fn create(folder: &Path, name: &str) -> Result<Self, OutputError> {
        let partial = PartialFile::create(folder, name);
        let partial = partial.map_err(|error| OutputError::folder(folder, &error))?;
        Ok(Self { path: folder.join(name), partial, hasher: Sha256::new() })
    }

    /// Returns the final path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Renames the file to its final path and returns its SHA-256.
    ///
    /// # Errors
    ///
    /// If the file cannot be written to the disk or renamed.
    pub fn finish(self) -> Result<String, OutputError> {
        let moved = self.partial.move_to(&self.path);
        moved.map_err(|error| OutputError::file(&self.path, &error))?;
        Ok(digits(self.hasher))
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.partial.file().write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.partial.file().flush()
    }
}

/// Creates `folder` and its parents, and removes the partial files of killed processes in `folder`.
///
/// # Errors
///
/// If the folder cannot be created.
pub fn make_folder(folder: &Path) -> Result<(), OutputError> {
    fs::create_dir_all(folder).map_err(|error| OutputError::folder(folder, &error))?;
    remove_abandoned_files(folder);
    Ok(())
}

/// Reads the text file at `path`.
///
/// # Errors
///
/// If the file cannot be read or is not a regular file. Reading a pipe or device may never end.
pub fn read_text(path: &Path) -> io::Result<String> {
    if fs::metadata(path)?.is_file() {
        fs::read_to_string(path)
    } else {
        Err(io::Error::other("it is not a regular file"))
    }
}

/// Writes `text` to the file `name` in `folder`, and returns the SHA-256 of `text`.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_text(folder: &Path, name: &str, text: &str) -> Result<String, OutputError> {
    let mut file = AtomicFile::create(folder, name)?;
    let written = file.write_all(text.as_bytes());
    written.map_err(|error| OutputError::file(&file.path, &error))?;
    file.finish()
}

/// Flushes the entries (file names) of `folder` to the disk.
pub fn sync_folder(folder: &Path) {
    // Ignore errors: not all systems can flush a folder, and the files are already on the disk.
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unfinished_file_does_not_replace_the_existing_file() {
        let folder = tempfile::tempdir().expect("a folder");
        write_text(folder.path(), "x.csv", "old").expect("writable");
        let mut file = AtomicFile::create(folder.path(), "x.csv").expect("writable");
        file.write_all(b"new").expect("writable");
        drop(file);
        assert_eq!(fs::read_to_string(folder.path().join("x.csv")).expect("readable"), "old");
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1);
    }

    #[test]
    fn concurrent_writers_of_one_file_do_not_interfere() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut files = ["one", "other"].map(|text| {
            let mut file = AtomicFile::create(folder.path(), "x.csv").expect("writable");
            file.write_all(text.as_bytes()).expect("writable");
            Some(file)
        });
        let read = || fs::read_to_string(folder.path().join("x.csv")).expect("readable");
        for (file, text) in files.iter_mut().zip(["one", "other"]) {
            let digest = file.take().expect("a file").finish().expect("writable");
            assert_eq!((read().as_str(), digest), (text, crate::sha256(text)));
        }
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1);
    }
}
