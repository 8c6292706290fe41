//! A journal that is being written.
//!
//! A line is handed to the system in one piece before what it holds counts as done, so a process that is killed loses what is in
//! hand and nothing else. The file is forced to the disk once a second and at the end, so a machine that loses its power loses
//! about a second of work. What is then missing or torn at the end is cut off once a copy of it is kept, and solved again. A
//! damaged line before intact ones is refused by name: nothing after it can be trusted to be complete.
//!
//! The file is locked before it is read and for as long as it is written. The lock dies with its process.

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

/// The interval at which the file is forced to the disk: what a loss of power may cost, against a write of some ten milliseconds.
const SYNC: Duration = Duration::from_secs(1);

/// The time for which a lock is waited for: a reader of the journal holds it for a moment.
const PATIENCE: Duration = Duration::from_millis(500);

/// The advice to a command that is to go on with another journal.
const GO_ON: &str = "no difference, or --fresh to throw the results away";

/// What becomes of the results that are there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// They are refused.
    #[default]
    New,
    /// They are gone on with, if the first line of the journal names the same definition, designs and program. Every line whose
    /// checksum holds is trusted; a torn end is cut off and solved again, a damaged line before intact ones is refused.
    Resume,
    /// They are thrown away.
    Fresh,
}

/// A journal that is being written.
#[derive(Debug)]
pub struct Journal<R> {
    records: R,
    path: PathBuf,
    file: File,
    /// Bytes that are intact.
    length: u64,
    synced: Instant,
    /// Lines that were cut off or lost.
    notes: Vec<String>,
}

impl<R: Records> Journal<R> {
    /// The journal at `path` of what `header` describes: a new one, or the one that is there.
    ///
    /// # Errors
    /// If it is in use, damaged, of something else, or there and `start` says nothing of it.
    pub fn begin(
        path: &Path,
        header: JournalHeader<R::Designs>,
        start: Start,
    ) -> Result<Self, JournalError> {
        let file = lock_journal(path)?;
        if start == Start::Fresh {
            // What was there is thrown away, as it was asked for.
            return Self::create(path, file, header);
        }
        match intact::<R>(path)? {
            Some((records, _)) if start == Start::New && !records.is_empty() => {
                Err(JournalError::Exists(folder(path)))
            }
            Some((records, length)) if start == Start::Resume => {
                records.header().require(&header, path, GO_ON)?;
                Self::at_end(records, length, path, file)
            }
            _ => {
                let cut = tail::keep(path, 0)?;
                let journal = Self::create(path, file, header)?;
                Ok(Self { notes: cut.into_iter().collect(), ..journal })
            }
        }
    }

    /// The journal that is there at `path`, to go on with whatever it is of.
    ///
    /// # Errors
    /// If there is none, or it is in use or damaged.
    pub fn resume(path: &Path) -> Result<Self, JournalError> {
        let missing = || JournalError::Missing(folder(path));
        if !path.exists() {
            return Err(missing());
        }
        let file = lock_journal(path)?;
        let (records, length) = intact(path)?.ok_or_else(missing)?;
        Self::at_end(records, length, path, file)
    }

    /// The journal with what is torn at its end cut off, once a copy of that is kept.
    fn at_end(records: R, length: u64, path: &Path, file: File) -> Result<Self, JournalError> {
        let notes = tail::keep(path, length)?.into_iter().collect();
        file.set_len(length).map_err(|error| OutputError::file(path, &error))?;
        Ok(Self { records, path: path.to_owned(), file, length, synced: Instant::now(), notes })
    }

    /// An empty file with its first line.
    fn create(
        path: &Path,
        mut file: File,
        header: JournalHeader<R::Designs>,
    ) -> Result<Self, JournalError> {
        let bytes = header.line::<R>();
        let written =
            file.set_len(0).and_then(|()| file.write_all(&bytes)).and_then(|()| file.sync_all());
        if let Err(error) = written {
            let _ = file.set_len(0);
            return Err(OutputError::journal(path, &error).into());
        }
        sync_folder(path.parent().unwrap_or(path));
        let refuse = |problem| JournalError::NoHeader { path: path.to_owned(), problem };
        let length = bytes.len() as u64;
        let records = R::begin(header, length, path).map_err(refuse)?;
        Self::at_end(records, length, path, file)
    }

    /// Lines that were cut off or lost, for people.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Adds something that people are to be told of the journal.
    pub fn note(&mut self, note: String) {
        self.notes.push(note);
    }

    /// The content so far.
    pub fn records(&self) -> &R {
        &self.records
    }

    /// Adds a line, which then counts as done.
    ///
    /// # Errors
    /// If the disk does not take it.
    pub fn append(&mut self, line: R::Line) -> Result<(), OutputError> {
        let bytes = self.records.header().seal().seal(&line);
        if let Err(error) = self.file.write_all(&bytes) {
            // Half a line would be cut off by whoever goes on; it is cleaner not to leave it.
            let _ = self.file.set_len(self.length);
            return Err(OutputError::journal(&self.path, &error));
        }
        let begin = self.length;
        self.length += bytes.len() as u64;
        // Whoever writes a line that no reader would take has it in the file all the same: the next reader says so.
        let _ = self.records.take(line, begin..self.length);
        if self.synced.elapsed() > SYNC { self.sync() } else { Ok(()) }
    }

    /// Forces it to the disk.
    ///
    /// # Errors
    /// If the disk does not take it.
    pub fn sync(&mut self) -> Result<(), OutputError> {
        self.synced = Instant::now();
        self.file.sync_data().map_err(|error| OutputError::journal(&self.path, &error))
    }
}

/// The folder of the journal at `path`.
fn folder(path: &Path) -> PathBuf {
    path.parent().unwrap_or(path).to_owned()
}

/// Locks a file or a folder, for this process and as long as it is open; whether that came to pass.
fn locked(file: &File) -> io::Result<bool> {
    let begun = Instant::now();
    loop {
        match file.try_lock() {
            Ok(()) => return Ok(true),
            // A file system without locks cannot tell whether another process is there.
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

/// Locks a folder for who writes several files there that belong together; the lock ends with what is returned.
///
/// # Errors
/// If another process writes there, or the folder cannot be opened.
pub fn lock_folder(folder: &Path) -> Result<File, OutputError> {
    let file = File::open(folder).map_err(|error| OutputError::folder(folder, &error))?;
    // Not every system locks folders; then two writers make the files of one of them, each file whole.
    if locked(&file).unwrap_or(true) { Ok(file) } else { Err(OutputError::in_use(folder)) }
}

/// The journal at `path`, made if there is none, and locked for this process until it is closed.
///
/// # Errors
/// If it is no regular file, cannot be opened, or another process writes it.
pub fn lock_journal(path: &Path) -> Result<File, JournalError> {
    // What a link points to is not ours to write.
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

/// Whether another process is writing the journal at `path`.
pub fn in_use(path: &Path) -> bool {
    let file = require_file(path).ok().and_then(|()| File::open(path).ok());
    file.is_some_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}
