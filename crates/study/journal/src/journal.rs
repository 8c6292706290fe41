//! Journals that are open for writing.
//!
//! Each line is written with one system call before its result counts as done, so a killed process
//! loses only the designs in progress. The file is synchronised to the disk once a second and at
//! the end, so a power failure costs about a second of work. A torn end is copied to a file, cut
//! off and solved again. A damaged line before intact ones is an error, because lines after it may
//! be missing.
//!
//! The file is locked before it is read and while it is written. The lock ends with its process.

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

/// Interval between synchronisations to the disk.
///
/// A power failure costs this much work; each synchronisation takes about ten milliseconds.
const SYNC: Duration = Duration::from_secs(1);

/// Maximum time to wait for a lock. Readers hold a lock only briefly.
const PATIENCE: Duration = Duration::from_millis(500);

/// Advice if an existing journal has another definition, subset of designs or program.
const ADVICE: &str = "no difference, or --fresh to discard the results";

/// Treatment of existing results.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// Starts anew; refuses if there are results.
    #[default]
    New,
    /// Continues from existing results if definition, designs and program are the same.
    ///
    /// Lines with a valid checksum are trusted. An incomplete last line is cut off, and its design
    /// is solved again. A damaged line before intact lines is an error.
    Resume,
    /// Discards existing results.
    Fresh,
}

/// A journal that is open for writing.
#[derive(Debug)]
pub struct Journal<R> {
    records: R,
    path: PathBuf,
    file: File,
    /// Number of intact bytes.
    length: u64,
    synced: Instant,
    /// Messages about lines that were cut off or lost.
    notes: Vec<String>,
}

impl<R: Records> Journal<R> {
    /// Creates or continues the journal at `path` for the work in `header`.
    ///
    /// # Errors
    ///
    /// If the journal is in use, is damaged, has another header, or exists and `start` is `New`.
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
                Self::at_end(records, length, path, file)
            }
            _ => {
                let cut = tail::keep(path, 0)?;
                let journal = Self::create(path, file, header)?;
                Ok(Self { notes: cut.into_iter().collect(), ..journal })
            }
        }
    }

    /// Continues the existing journal at `path` with any definition.
    ///
    /// # Errors
    ///
    /// If there is no journal, or it is in use or damaged.
    pub fn resume(path: &Path) -> Result<Self, JournalError> {
        let missing = || JournalError::Missing(folder(path));
        if !path.exists() {
            return Err(missing());
        }
        let file = lock_journal(path)?;
        let (records, length) = intact(path)?.ok_or_else(missing)?;
        Self::at_end(records, length, path, file)
    }

    /// Copies the bytes after `length` to a file, cuts them off and opens the journal.
    fn at_end(records: R, length: u64, path: &Path, file: File) -> Result<Self, JournalError> {
        let notes = tail::keep(path, length)?.into_iter().collect();
        file.set_len(length).map_err(|error| OutputError::file(path, &error))?;
        Ok(Self { records, path: path.to_owned(), file, length, synced: Instant::now(), notes })
    }

    /// Creates an empty journal with its first line.
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
        Self::at_end(records, length, path, file)
    }

    /// Returns messages about lines that were cut off or lost.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Adds a note about the journal for the user.
    pub fn note(&mut self, note: String) {
        self.notes.push(note);
    }

    /// Returns the content so far.
    pub fn records(&self) -> &R {
        &self.records
    }

    /// Appends a line; its result then counts as done.
    ///
    /// # Errors
    ///
    /// If the line cannot be written.
    pub fn append(&mut self, line: R::Line) -> Result<(), OutputError> {
        let bytes = self.records.header().seal().seal(&line);
        if let Err(error) = self.file.write_all(&bytes) {
            // Removes a partial line at once; otherwise the next reader would cut it off.
            let _ = self.file.set_len(self.length);
            return Err(OutputError::journal(&self.path, &error));
        }
        let begin = self.length;
        self.length += bytes.len() as u64;
        // The line is in the file even if it is not accepted here; the next reader reports it.
        let _ = self.records.take(line, begin..self.length);
        if self.synced.elapsed() > SYNC { self.sync() } else { Ok(()) }
    }

    /// Synchronises the file to the disk.
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

/// Locks a file or folder until it is closed.
///
/// Returns false if another process holds the lock.
fn locked(file: &File) -> io::Result<bool> {
    let begun = Instant::now();
    loop {
        match file.try_lock() {
            Ok(()) => return Ok(true),
            // The file system has no locks, so other processes cannot be detected.
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

/// Locks a folder while several related files are written.
///
/// Dropping the file releases the lock.
///
/// # Errors
///
/// If another process writes there, or the folder cannot be opened.
pub fn lock_folder(folder: &Path) -> Result<File, OutputError> {
    let file = File::open(folder).map_err(|error| OutputError::folder(folder, &error))?;
    // Some systems cannot lock folders. Each file is then complete, but files of two writers may
    // mix.
    if locked(&file).unwrap_or(true) { Ok(file) } else { Err(OutputError::in_use(folder)) }
}

/// Opens or creates the journal at `path`, and locks it until it is closed.
///
/// # Errors
///
/// If it is not a regular file, cannot be opened, or another process writes to it.
pub fn lock_journal(path: &Path) -> Result<File, JournalError> {
    // A link may point to a file that squama did not write.
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
