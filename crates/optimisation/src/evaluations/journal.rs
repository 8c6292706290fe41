//! The journal of an optimisation: every point that was solved, a sealed line each.
//!
//! The search itself is not written down: it does the same again, and finds what it asks for in the journal until it comes to
//! points that nobody has solved yet. The file is forced to the disk once a second and at the end, as the journal of a run is.

use std::fs::{File, OpenOptions};
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use results::{DesignResult, OutputError, RunFolder, make_folder, sha256};
use run::{Program, Seal, Start};
use serde::{Deserialize, Serialize};

use crate::error::OptimisationError;

/// The interval at which it is forced to the disk.
const SYNC: Duration = Duration::from_secs(1);

/// The format of its lines.
const FORMAT: u32 = 1;

/// The first line: what is searched for, by which program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SearchHeader {
    optimisation: u32,
    program: String,
    goal_sha256: String,
}

/// A line of the journal behind the first.
#[derive(Clone, Debug)]
pub(super) enum JournalLine {
    Solved(Box<SolvedLine>),
    Skins(SkinsLine),
}

/// A point that was solved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SolvedLine {
    /// Whether its measures have derivatives.
    pub differentiated: bool,
    /// The number of the skin made of its design, with the deviations of the batch; none of the design as it is drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skin: Option<u64>,
    /// Shares of the intervals.
    pub shares: Vec<f64>,
    /// Indices of the choices.
    pub chosen: Vec<usize>,
    /// The result.
    pub result: DesignResult,
}

/// Skins made of the design of a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SkinsLine {
    /// The number of the first skin.
    pub first: u64,
    /// Shares of the intervals.
    pub shares: Vec<f64>,
    /// Indices of the choices.
    pub chosen: Vec<usize>,
    /// The values of each skin in the columns that it is judged by.
    pub values: Vec<Vec<Option<f64>>>,
}

/// A journal that is being written.
pub(super) struct EvaluationJournal {
    path: PathBuf,
    file: File,
    seal: Seal,
    length: u64,
    synced: Instant,
}

impl EvaluationJournal {
    /// The journal in `folder` of the search for `goal`, and the lines that it has.
    pub fn begin(
        folder: &Path,
        goal: &str,
        program: &Program,
        start: Start,
    ) -> Result<(Self, Vec<JournalLine>), OptimisationError> {
        if RunFolder::new(folder).journal().exists() {
            return Err(OptimisationError::HoldsRun { folder: folder.to_owned() });
        }
        make_folder(folder)?;
        let path = folder.join(RunFolder::EVALUATIONS);
        let header = SearchHeader {
            optimisation: FORMAT,
            program: format!("{} ({})", program.version, program.revision),
            goal_sha256: sha256(goal),
        };
        let seal = Seal::over(&[&header.goal_sha256, &header.program]);
        let found = if start == Start::Fresh { None } else { read(&path, &header, &seal)? };
        if let Some(found) = &found
            && start == Start::New
            && !found.lines.is_empty()
        {
            return Err(OptimisationError::Exists { folder: folder.to_owned() });
        }
        let opened = OpenOptions::new().append(true).create(true).open(&path);
        let file = opened.map_err(|error| OutputError::folder(folder, &error))?;
        lock(&file, folder)?;
        let found = found.unwrap_or_default();
        file.set_len(found.length).map_err(|error| OutputError::file(&path, &error))?;
        let synced = Instant::now();
        let mut journal = Self { path, file, seal, length: found.length, synced };
        if journal.length == 0 {
            journal.write(&Seal::default().seal(&header))?;
        }
        Ok((journal, found.lines))
    }

    /// Adds a line, which then counts as solved.
    pub fn append(&mut self, line: &impl Serialize) -> Result<(), OutputError> {
        let bytes = self.seal.seal(line);
        self.write(&bytes)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), OutputError> {
        if let Err(error) = self.file.write_all(bytes) {
            // Half a line would be cut off by whoever goes on; it is cleaner not to leave it.
            let _ = self.file.set_len(self.length);
            return Err(OutputError::journal(&self.path, &error));
        }
        self.length += bytes.len() as u64;
        if self.synced.elapsed() > SYNC { self.sync() } else { Ok(()) }
    }

    /// Forces it to the disk.
    pub fn sync(&mut self) -> Result<(), OutputError> {
        self.synced = Instant::now();
        self.file.sync_data().map_err(|error| OutputError::journal(&self.path, &error))
    }
}

/// Refuses a journal that another process writes.
fn lock(file: &File, folder: &Path) -> Result<(), OptimisationError> {
    match file.try_lock() {
        Err(std::fs::TryLockError::WouldBlock) => {
            Err(OptimisationError::InUse { folder: folder.to_owned() })
        }
        // A file system without locks cannot tell.
        Ok(()) | Err(std::fs::TryLockError::Error(_)) => Ok(()),
    }
}

/// The evaluations that a journal holds.
#[derive(Default)]
struct Found {
    lines: Vec<JournalLine>,
    /// The bytes up to the end of its last whole line.
    length: u64,
}

/// The lines of the journal at `path` up to the first that is torn; `None` if there is no journal.
fn read(
    path: &Path,
    wanted: &SearchHeader,
    seal: &Seal,
) -> Result<Option<Found>, OptimisationError> {
    let Ok(file) = File::open(path) else { return Ok(None) };
    let mut source = BufReader::new(file);
    let mut found = Found::default();
    loop {
        let mut bytes = Vec::new();
        let unreadable = |error| OptimisationError::Unreadable {
            path: path.to_owned(),
            reason: sweep::reason(&error),
        };
        let read = source.read_until(b'\n', &mut bytes).map_err(unreadable)?;
        if found.length == 0 {
            let header: Option<SearchHeader> = opened(&Seal::default(), &mut bytes);
            let Some(header) = header else { return Ok(None) };
            require(path, &header, wanted)?;
        } else if let Some(line) = line(seal, &mut bytes) {
            found.lines.push(line);
        } else {
            return Ok(Some(found));
        }
        found.length += read as u64;
    }
}

/// The point or the skins that a sealed line holds; `None` if it is torn.
fn line(seal: &Seal, bytes: &mut [u8]) -> Option<JournalLine> {
    let text = seal.open(bytes).ok()?;
    let skins = || serde_json::from_slice(text).ok().map(JournalLine::Skins);
    serde_json::from_slice(text).ok().map(|line| JournalLine::Solved(Box::new(line))).or_else(skins)
}

/// The object that a sealed line holds; `None` if it is torn.
fn opened<T: for<'d> Deserialize<'d>>(seal: &Seal, bytes: &mut [u8]) -> Option<T> {
    serde_json::from_slice(seal.open(bytes).ok()?).ok()
}

/// Refuses a journal of another goal or program.
fn require(
    path: &Path,
    found: &SearchHeader,
    wanted: &SearchHeader,
) -> Result<(), OptimisationError> {
    let difference = if found.optimisation != wanted.optimisation || found.program != wanted.program
    {
        format!("is by squama {}, this is squama {}", found.program, wanted.program)
    } else if found.goal_sha256 != wanted.goal_sha256 {
        "belongs to a search for another goal".to_owned()
    } else {
        return Ok(());
    };
    Err(OptimisationError::Different { path: path.to_owned(), difference })
}
