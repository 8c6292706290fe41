//! The journal of a run: every finished design, one line each, from which the tables are written.
//!
//! Each line is a JSON object with a checksum. The first names what is solved, by which program;
//! a line of its own begins every session; the rest are designs, in the order in which they were
//! done. A design that stands there several times was solved again: its lines carry the number of their
//! rerun, and the largest counts, wherever it stands.
//!
//! A line is handed to the system in one piece before its design counts as done, so a process that
//! is killed loses the designs in hand and nothing else. The file is forced to the disk once a second and
//! at the end, so a machine that loses its power loses about a second of work. What is then
//! missing or torn at the end is cut off once a copy of it is kept, and solved again. A damaged line before intact
//! ones is refused by name: nothing after it can be trusted to be complete.
//!
//! The file is locked while a run writes it. The lock dies with its process.

mod archive;
mod entry;
mod error;
mod header;
mod index;
mod lines;
mod seal;
mod tail;
mod windows;

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};

pub(crate) use archive::Entries;
pub use archive::{Archive, LatestSession};
pub use entry::{JournalEntry, SessionStart};
pub use error::JournalError;
pub use header::JournalHeader;
pub(crate) use seal::Line;
pub use seal::Seal;

use results::{OutputError, RunFolder, sync_folder};

/// The interval at which the file is forced to the disk.
const SYNC: Duration = Duration::from_secs(1);

/// The time for which a lock is waited for: a reader of the journal holds it for a moment.
const PATIENCE: Duration = Duration::from_millis(500);

/// The advice to a run that is to go on with another journal.
const GO_ON: &str = "no difference, or --fresh to throw the results away";

/// The way in which a run begins: what it does with the results that it finds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// Refuses to touch them.
    #[default]
    New,
    /// Goes on where they end, if the first line of the journal names the same definition, designs and program. Every line whose
    /// checksum holds is trusted; a torn end is cut off and solved again, a damaged line before intact ones is refused.
    Resume,
    /// Throws them away.
    Fresh,
}

/// A journal that is being written.
#[derive(Debug)]
pub struct Journal {
    archive: Archive,
    path: PathBuf,
    file: File,
    synced: Instant,
    /// Lines that were cut off or lost.
    notes: Vec<String>,
}

impl Journal {
    /// The journal of the run that `header` describes in `folder`: a new one, or the one that is there.
    ///
    /// # Errors
    /// If it is in use, damaged, of another run, or there and `start` says nothing of it.
    pub fn begin(
        folder: &RunFolder,
        header: JournalHeader,
        start: Start,
    ) -> Result<Self, JournalError> {
        if folder.file(RunFolder::EVALUATIONS).exists() {
            return Err(JournalError::HoldsSearch { folder: folder.path().to_owned() });
        }
        let path = folder.journal();
        if start != Start::Fresh && !path.exists() {
            refuse_strays(folder)?;
        }
        let file = open(&path)?;
        lock(&file, &path)?;
        let found = if start == Start::Fresh { None } else { Archive::read(&path)? };
        match found {
            Some(archive) if start == Start::New && archive.done() > 0 => {
                Err(JournalError::Exists { folder: folder.path().to_owned() })
            }
            Some(archive) if start == Start::Resume => {
                archive.header().require(&header, &path, GO_ON)?;
                Self::at_end(archive, folder, file)
            }
            _ if start == Start::Fresh => {
                let journal = Self::at_end(create(&file, &path, header)?, folder, file)?;
                // What was there is thrown away, as it was asked for.
                Ok(Self { notes: Vec::new(), ..journal })
            }
            _ => {
                let cut = tail::keep(&path, 0)?;
                let mut journal = Self::at_end(create(&file, &path, header)?, folder, file)?;
                journal.notes.extend(cut);
                Ok(journal)
            }
        }
    }

    /// The journal that is there in `folder`, to go on with whatever it is of.
    ///
    /// # Errors
    /// If there is none, or it is in use or damaged.
    pub fn resume(folder: &RunFolder) -> Result<Self, JournalError> {
        let path = folder.journal();
        let missing = || JournalError::Missing { folder: folder.path().to_owned() };
        if !path.exists() {
            return Err(missing());
        }
        let file = open(&path)?;
        lock(&file, &path)?;
        let archive = Archive::read(&path)?.ok_or_else(missing)?;
        Self::at_end(archive, folder, file)
    }

    /// The journal with what is torn at its end cut off, once a copy of that is kept.
    fn at_end(archive: Archive, folder: &RunFolder, file: File) -> Result<Self, JournalError> {
        let path = folder.journal();
        let mut notes: Vec<_> = tail::keep(&path, archive.length())?.into_iter().collect();
        let lost = archive.lost_lines(folder);
        notes.extend(lost.map(|lost| format!("{}: {lost}", path.display())));
        let cut = file.set_len(archive.length());
        cut.map_err(|error| OutputError::file(&path, &error))?;
        Ok(Self { archive, path, file, synced: Instant::now(), notes })
    }

    /// Lines that were cut off or lost, for people.
    pub(crate) fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The content so far.
    pub fn archive(&self) -> &Archive {
        &self.archive
    }

    /// Adds the beginning of a session.
    ///
    /// # Errors
    /// If the disk does not take it.
    pub fn begin_session(&mut self, session: SessionStart) -> Result<(), OutputError> {
        self.write(&Line::Session(session))
    }

    /// Adds a design, which then counts as done.
    ///
    /// # Errors
    /// If the disk does not take it.
    pub fn append(&mut self, entry: JournalEntry) -> Result<(), OutputError> {
        self.write(&Line::Design(Box::new(entry)))
    }

    fn write(&mut self, line: &Line) -> Result<(), OutputError> {
        let bytes = self.archive.seal().write(line);
        let written = self.file.write_all(&bytes);
        if let Err(error) = written {
            // Half a line would be cut off by whoever goes on; it is cleaner not to leave it.
            let _ = self.file.set_len(self.archive.length());
            return Err(OutputError::journal(&self.path, &error));
        }
        self.archive.add(line, bytes.len() as u64);
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

/// Refuses to write where files of our names stand without a journal: nobody knows whose they are.
fn refuse_strays(folder: &RunFolder) -> Result<(), JournalError> {
    folder.stray_file().map_or(Ok(()), |file| {
        Err(JournalError::NoJournal { folder: folder.path().to_owned(), file })
    })
}

fn open(path: &Path) -> Result<File, JournalError> {
    require_file(path)?;
    let file = OpenOptions::new().read(true).append(true).create(true).open(path);
    let folder = path.parent().unwrap_or(path);
    file.map_err(|error| OutputError::folder(folder, &error).into())
}

/// Refuses a pipe, a device or a folder in place of a journal: opening one may never return.
fn require_file(path: &Path) -> Result<(), JournalError> {
    match path.metadata() {
        Ok(metadata) if !metadata.is_file() => Err(JournalError::NoFile { path: path.to_owned() }),
        _ => Ok(()),
    }
}

/// A journal with its first line.
fn create(mut file: &File, path: &Path, header: JournalHeader) -> Result<Archive, JournalError> {
    let line = Line::Header(header);
    let bytes = Seal::default().write(&line);
    let written =
        file.set_len(0).and_then(|()| file.write_all(&bytes)).and_then(|()| file.sync_all());
    if let Err(error) = written {
        let _ = file.set_len(0);
        return Err(OutputError::journal(path, &error).into());
    }
    sync_folder(path.parent().unwrap_or(path));
    Archive::read(path)?.ok_or_else(|| JournalError::Missing { folder: path.to_owned() })
}

/// Locks the file, for this process and as long as it lives.
fn lock(file: &File, path: &Path) -> Result<(), JournalError> {
    let begun = Instant::now();
    loop {
        match file.try_lock() {
            Ok(()) => return Ok(()),
            // A file system without locks cannot tell whether another run is there.
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {
                return Ok(());
            }
            Err(TryLockError::Error(error)) => return Err(OutputError::file(path, &error).into()),
            Err(TryLockError::WouldBlock) if begun.elapsed() < PATIENCE => {
                sleep(Duration::from_millis(20));
            }
            Err(TryLockError::WouldBlock) => {
                let folder = path.parent().unwrap_or(path).to_owned();
                return Err(JournalError::InUse { folder });
            }
        }
    }
}

/// Whether a run is writing the journal in `folder`.
pub(crate) fn in_use(folder: &RunFolder) -> bool {
    if require_file(&folder.journal()).is_err() {
        return false;
    }
    let is_locked = |file: io::Result<File>| match file.map(|file| file.try_lock_shared()) {
        Ok(Err(TryLockError::WouldBlock)) => true,
        Ok(_) | Err(_) => false,
    };
    is_locked(File::open(folder.journal()))
}
