//! Journals that are open for writing.
//!
//! Each line is written with one system call before its result counts as done, so a killed process
//! loses only the designs in progress. The journal is flushed to the disk once a second and at the
//! end, so a power failure costs about a second of work.
//!
//! Damaged lines at the end of a journal come from a crash. They are copied to another file and cut
//! off, and their designs are solved again. A damaged line before an intact line is an error,
//! because more lines may be missing between them.
//!
//! A writer locks the journal before it reads the lines, and holds the lock until it closes the
//! file. The operating system releases the lock when the process ends.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::atomic_file::{OutputError, sync_folder};
use crate::error::JournalError;
use crate::header::JournalHeader;
use crate::reader::{Records, intact, require_file};
use crate::tail;

/// Time between two flushes of the journal to the disk.
///
/// A power failure loses the results of about this time. A flush takes about ten milliseconds.
const SYNC: Duration = Duration::from_secs(1);

/// Maximum time to wait for a lock.
///
/// A process that only checks whether the journal is in use releases its lock sooner.
const PATIENCE: Duration = Duration::from_millis(500);

/// End of the error message if definition, subset or program of a journal differ.
const ADVICE: &str = "no difference, or --fresh to discard the results";

/// Action if results exist already: refuse, continue or discard them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// Starts a new journal. Existing results are an error.
    #[default]
    New,
    /// Continues from existing results. Another definition, subset or program is an error.
    ///
    /// Lines with a valid checksum are trusted. Damaged lines at the end are cut off, and their
    /// designs are solved again. A damaged line before an intact line is an error.
    Resume,
    /// Discards existing results and starts a new journal.
    Fresh,
}

/// A journal that is open for writing.
#[derive(Debug)]
pub struct Journal<R> {
    records: R,
    path: PathBuf,
    file: File,
    /// Length of the intact lines, in bytes.
    length: u64,
    /// Time of the last flush to the disk.
    synced: Instant,
    /// Messages about lines that were cut off or lost.
    notes: Vec<String>,
}

impl<R: Records> Journal<R> {
    /// Creates or continues the journal at `path` with this `header`.
    ///
    /// # Errors
    ///
    /// If the journal is in use or cannot be written. Unless `start` is `Fresh`, also if the
    /// journal is damaged. With `New`, if it contains results; with `Resume`, if it has another
    /// header.
    pub fn begin(
        path: &Path,
        header: JournalHeader<R::Designs>,
        start: Start,
    ) -> Result<Self, JournalError> {
        let file = lock_journal(path)?;
        if start == Start::Fresh {
            return Self::create(path, file, header);
        }
        match intact::<R>(path)? {
            Some((records, _)) if start == Start::New && !records.is_empty() => {
                Err(JournalError::Exists(folder(path)))
            }
            Some((records, length)) if start == Start::Resume => {
                records.header().require(&header, path, ADVICE)?;
                Self::truncated(records, length, path, file)
            }
            _ => {
                let cut = tail::keep(path, 0)?;
                let journal = Self::create(path, file, header)?;
                Ok(Self { notes: cut.into_iter().collect(), ..journal })
            }
        }
    }

    /// Continues the existing journal at `path`, with the header that it has.
    ///
    /// # Errors
    ///
    /// If the journal is missing, in use or damaged.
    pub fn resume(path: &Path) -> Result<Self, JournalError> {
        let missing = || JournalError::Missing(folder(path));
        if !path.exists() {
            return Err(missing());
        }
        let file = lock_journal(path)?;
        let (records, length) = intact(path)?.ok_or_else(missing)?;
        Self::truncated(records, length, path, file)
    }

    /// Creates the writer of the journal in `file`, and truncates the file to `length` bytes.
    ///
    /// The bytes after the first `length` are copied to another file before.
    fn truncated(records: R, length: u64, path: &Path, file: File) -> Result<Self, JournalError> {
        let notes = tail::keep(path, length)?.into_iter().collect();
        file.set_len(length).map_err(|error| OutputError::file(path, &error))?;
        Ok(Self { records, path: path.to_owned(), file, length, synced: Instant::now(), notes })
    }

    /// Creates a journal that contains only the header.
    fn create(
        path: &Path,
        mut file: File,
        header: JournalHeader<R::Designs>,
    ) -> Result<Self, JournalError> {
        let bytes = header.line(R::KEY);
        let written =
            file.set_len(0).and_then(|()| file.write_all(&bytes)).and_then(|()| file.sync_all());
        if let Err(error) = written {
            let _ = file.set_len(0);
            return Err(OutputError::journal(path, &error).into());
        }
        sync_folder(path.parent().unwrap_or(path));
        let length = bytes.len() as u64;
        let records = R::begin(header, length, path)
            .map_err(|problem| JournalError::NoHeader { path: path.to_owned(), problem })?;
        Self::truncated(records, length, path, file)
    }

    /// Returns messages about lines that were cut off or lost.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Adds a message for the user to [`Self::notes`].
    pub fn note(&mut self, note: String) {
        self.notes.push(note);
    }

    /// Returns the content of the lines in the journal.
    pub fn records(&self) -> &R {
        &self.records
    }

    /// Appends a line. If this succeeds, the result in the line counts as done.
    ///
    /// # Errors
    ///
    /// If the line cannot be written.
    pub fn append(&mut self, line: R::Line) -> Result<(), OutputError> {
        let bytes = self.records.header().seal().seal(&line);
        if let Err(error) = self.file.write_all(&bytes) {
            // Remove a partly written line immediately, so that later lines do not follow it.
            let _ = self.file.set_len(self.length);
            return Err(OutputError::journal(&self.path, &error));
        }
        let begin = self.length;
        self.length += bytes.len() as u64;
        // Ignore an invalid line: it is already in the file, and the next reader reports it.
        let _ = self.records.take(line, begin..self.length);
        if self.synced.elapsed() > SYNC { self.sync() } else { Ok(()) }
    }

    /// Flushes the file to the disk.
    ///
    /// # Errors
    ///
    /// If the data cannot be written.
    pub fn sync(&mut self) -> Result<(), OutputError> {
        self.synced = Instant::now();
        self.file.sync_data().map_err(|error| OutputError::journal(&self.path, &error))
    }
}

/// Returns the folder of the journal at `path`.
fn folder(path: &Path) -> PathBuf {
    path.parent().unwrap_or(path).to_owned()
}

/// Locks an open file or folder. The lock lasts until `file` is closed.
///
/// Waits for a lock of another process for at most `PATIENCE`. Returns false if the other process
/// still holds its lock after this time.
fn locked(file: &File) -> io::Result<bool> {
    let begun = Instant::now();
    loop {
        match file.try_lock() {
            Ok(()) => return Ok(true),
            // The file system does not support locks, so other processes cannot be detected.
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {
                return Ok(true);
            }
            Err(TryLockError::Error(error)) => return Err(error),
            Err(TryLockError::WouldBlock) if begun.elapsed() < PATIENCE => {
                sleep(Duration::from_millis(20));
            }
            Err(TryLockError::WouldBlock) => return Ok(false),
        }
    }
}

/// Locks a folder, so that only one process at a time writes its related files.
///
/// The lock lasts until the returned file is dropped.
///
/// # Errors
///
/// If another process has locked the folder, or the folder cannot be opened.
pub fn lock_folder(folder: &Path) -> Result<File, OutputError> {
    let file = File::open(folder).map_err(|error| OutputError::folder(folder, &error))?;
    // Ignore errors: some systems cannot lock folders. Then two processes may both write files to
    // the folder, but each file is complete.
    if locked(&file).unwrap_or(true) { Ok(file) } else { Err(OutputError::in_use(folder)) }
}

/// Opens or creates the journal at `path`, and locks it until the returned file is dropped.
///
/// # Errors
///
/// If the journal is not a regular file, cannot be opened, or is locked by another process.
pub fn lock_journal(path: &Path) -> Result<File, JournalError> {
    // Refuse symbolic links: they may point to a file that squama did not write.
    if path.is_symlink() {
        return Err(JournalError::NoFile(path.to_owned()));
    }
    require_file(path)?;
    let file = OpenOptions::new().read(true).append(true).create(true).open(path);
    let file = file.map_err(|error| OutputError::folder(&folder(path), &error))?;
    if locked(&file).map_err(|error| OutputError::file(path, &error))? {
        Ok(file)
    } else {
        Err(JournalError::InUse(folder(path)))
    }
}

/// Returns true if another process is writing to the journal at `path`.
pub fn in_use(path: &Path) -> bool {
    let file = require_file(path).ok().and_then(|()| File::open(path).ok());
    file.is_some_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}
