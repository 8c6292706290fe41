//! Atomic files: they appear whole or not at all.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use sweep::reason;

/// A file or a folder that cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot be written ({reason}), {advice}", path.display())]
pub struct OutputError {
    path: PathBuf,
    reason: String,
    advice: &'static str,
}

impl OutputError {
    /// A folder that cannot be made or written.
    pub fn folder(path: &Path, error: &io::Error) -> Self {
        let advice = "expected a folder that can be written, e.g. with --out DIR";
        Self { path: path.to_owned(), reason: reason(error), advice }
    }

    /// A file that cannot be written.
    pub fn file(path: &Path, error: &io::Error) -> Self {
        Self { path: path.to_owned(), reason: reason(error), advice: "check free space" }
    }

    /// A journal that cannot be written.
    pub fn journal(path: &Path, error: &io::Error) -> Self {
        let advice = "check free space; --resume then goes on with the run";
        Self { path: path.to_owned(), reason: reason(error), advice }
    }
}

/// A file that is written beside its place and moved there when it is complete, so that its name
/// never stands for half of it.
#[derive(Debug)]
pub struct AtomicFile {
    path: PathBuf,
    partial: PathBuf,
    file: Option<File>,
}

impl AtomicFile {
    /// Begins the file `name` in `folder`.
    ///
    /// # Errors
    /// If the folder cannot be written.
    pub fn create(folder: &Path, name: &str) -> Result<Self, OutputError> {
        let partial = partial(folder, name);
        let file = File::create(&partial).map_err(|error| OutputError::folder(folder, &error))?;
        Ok(Self { path: folder.join(name), partial, file: Some(file) })
    }

    /// The path of the file once it is complete.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// If it does not reach the disk.
    pub fn finish(mut self) -> Result<(), OutputError> {
        let moved = match self.file.take() {
            Some(file) => file.sync_all().and_then(|()| fs::rename(&self.partial, &self.path)),
            None => Ok(()),
        };
        moved.map_err(|error| {
            let _ = fs::remove_file(&self.partial);
            OutputError::file(&self.path, &error)
        })
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.as_mut().map_or(Ok(0), |file| file.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), Write::flush)
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if self.file.is_some() {
            let _ = fs::remove_file(&self.partial);
        }
    }
}

fn partial(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!(".{name}.partial"))
}

/// Removes what a killed process left of the file `name`.
pub fn remove_partial(folder: &Path, name: &str) {
    // Nearly always there is none.
    let _ = fs::remove_file(partial(folder, name));
}

/// Makes `folder` and the folders above it.
///
/// # Errors
/// If it cannot be made.
pub fn make_folder(folder: &Path) -> Result<(), OutputError> {
    fs::create_dir_all(folder).map_err(|error| OutputError::folder(folder, &error))
}

/// Writes `text` as the file `name` in `folder`.
///
/// # Errors
/// If it cannot be written.
pub fn write_text(folder: &Path, name: &str, text: &str) -> Result<(), OutputError> {
    let mut file = AtomicFile::create(folder, name)?;
    let written = file.write_all(text.as_bytes());
    written.map_err(|error| OutputError::file(&file.path, &error))?;
    file.finish()
}

/// Asks the system to keep the moves in `folder`.
pub fn sync_folder(folder: &Path) {
    // Not every system can; the files themselves are on the disk already.
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_not_finished_leaves_the_old_one() {
        let folder = tempfile::tempdir().expect("a folder");
        write_text(folder.path(), "x.csv", "old").expect("writable");
        let mut file = AtomicFile::create(folder.path(), "x.csv").expect("writable");
        file.write_all(b"new").expect("writable");
        drop(file);
        assert_eq!(fs::read_to_string(folder.path().join("x.csv")).expect("there"), "old");
        assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 1);
    }
}
