//! A results folder with verified contents, through which every command reads results.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{Cursor, ErrorKind, Read, Seek};
use std::path::{Path, PathBuf};

use journal::{read_text, sha256, sha256_of};
use text::reason;

use super::derivation::Derivation;
use super::{Contents, JournalExtent};
use crate::folder::{FileEntry, Maker, ResultsFolder};
use crate::tables::resaved;
use text::shell_word;

/// Selects whether incomplete results are accepted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Completeness {
    /// Requires the results of all designs, and tables that are not older than the journal.
    #[default]
    Whole,
    /// Also accepts the results of the designs finished so far.
    Partial,
}

/// A results folder that agrees with its `contents.toml`.
///
/// A folder with neither `contents.toml` nor journal contains only tables, which are used without
/// verification.
#[derive(Clone, Debug)]
pub struct VerifiedFolder {
    folder: ResultsFolder,
    contents: Option<Contents>,
    /// Whether the journal is longer than stated in the contents.
    behind: bool,
    /// Function for warnings about tables that another program saved again.
    ///
    /// If `None`, such tables are refused.
    warn: Option<fn(&str)>,
}

/// Bytes of a table as squama wrote them: from a file or from memory.
pub(crate) trait TableText: Read + Seek {}

impl<T: Read + Seek> TableText for T {}

/// Error: a results folder contradicts its contents.
///
/// The message has one line and names the repair.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {problem}", path.display())]
pub struct InvalidFolder {
    /// The folder, or the faulty file in it.
    pub path: PathBuf,
    /// The problem and its repair.
    pub problem: String,
}

impl InvalidFolder {
    fn new(path: impl Into<PathBuf>, problem: impl Into<String>) -> Self {
        Self { path: path.into(), problem: problem.into() }
    }

    fn unreadable(path: &Path, reason: &str) -> Self {
        let problem =
            format!("cannot be read ({reason}), expected the file that squama run writes");
        Self::new(path, problem)
    }
}

/// Returns the command that rebuilds tables and contents from the journal.
fn repair_command(folder: &Path) -> String {
    let folder = shell_word(&folder.display().to_string());
    format!("squama merge {folder} --out {folder}")
}

impl VerifiedFolder {
    /// Opens the results in `folder`. Each file is verified when it is opened.
    ///
    /// # Errors
    ///
    /// If the folder has a journal but no `contents.toml`, or `contents.toml` is damaged or
    /// contradicts the journal. Unless partial results are accepted, also if designs are missing or
    /// the journal has more designs than the tables.
    pub fn open(folder: &Path, completeness: Completeness) -> Result<Self, InvalidFolder> {
        let folder = ResultsFolder::new(folder);
        let contents = read(&folder)?;
        // Tables may be valid but lack designs that were added to the journal later.
        let behind = match &contents {
            Some(contents) => is_behind(&folder, &contents.journal)?,
            None => false,
        };
        let opened = Self { folder, contents, behind, warn: None };
        if completeness == Completeness::Whole {
            opened.require_whole()?;
        }
        Ok(opened)
    }

    fn require_whole(&self) -> Result<(), InvalidFolder> {
        match &self.contents {
            Some(contents) if !contents.is_whole() => {
                let Contents { done, designs, .. } = contents;
                Err(InvalidFolder::new(
                    self.path(),
                    format!(
                        "holds {done} of {designs} designs; squama run --resume solves the others, --partial uses those that are there"
                    ),
                ))
            }
            _ => self.behind().map_or(Ok(()), Err),
        }
    }

    /// Returns the error if the journal has more designs than the tables.
    pub fn behind(&self) -> Option<InvalidFolder> {
        self.behind.then(|| {
            let problem = format!(
                "the journal has more designs than the tables, because a run is in progress or was ended before it wrote them; {} writes them, --partial uses the designs of the tables",
                repair_command(self.path())
            );
            InvalidFolder::new(self.path(), problem)
        })
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Returns true if a file, or anything else with the name `name`, exists in the folder.
    pub fn holds(&self, name: &str) -> bool {
        self.folder.file(name).exists()
    }

    /// Returns the names of all tables that exist or should exist, in reading order.
    pub fn tables(&self) -> Vec<String> {
        let stated = self.contents.iter().flat_map(|contents| contents.files.keys());
        let ranking = Derivation::read(&self.folder, ResultsFolder::RANKING_RECORD);
        // A ranking that was removed completely does not count as missing.
        let ranking = ranking
            .filter(|record| self.contents.is_some() && record.any_file_exists(&self.folder));
        let ranked = ranking.iter().flat_map(|record| record.files.keys());
        let expected: BTreeSet<&str> = stated.chain(ranked).map(String::as_str).collect();
        let tables =
            ResultsFolder::tables().filter(|name| expected.contains(name) || self.holds(name));
        tables.map(str::to_owned).collect()
    }

    /// Returns one SHA-256 over all tables, if the folder has contents.
    pub fn digest(&self) -> Option<String> {
        self.contents.as_ref().map(Contents::digest)
    }

    /// Returns the extent of incomplete results as text, such as `24 of 720 designs`.
    ///
    /// `None` if the results are complete or cannot be verified.
    pub fn shortfall(&self) -> Option<String> {
        let contents = self.contents.as_ref()?;
        let Contents { done, designs, .. } = contents;
        let behind = if self.behind { ", without the latest designs of the journal" } else { "" };
        let is_short = !contents.is_whole() || self.behind;
        is_short.then(|| format!("{done} of {designs} designs{behind}"))
    }

    /// Opens the file `name` after verifying its bytes.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, or differs from the file that its command wrote.
    pub fn file(&self, name: &str) -> Result<File, InvalidFolder> {
        let path = self.folder.file(name);
        let unreadable = |error| InvalidFolder::unreadable(&path, &reason(&error));
        // Refuse anything but a regular file, because reading a named pipe may never end.
        if fs::metadata(&path).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir()) {
            return Err(InvalidFolder::unreadable(&path, "it is not a regular file"));
        }
        // Verify and read through one handle, so that a file replaced after the verification is not
        // read.
        let mut file = File::open(&path).map_err(unreadable)?;
        if let Some(expected) = self.expected(name)? {
            let found = sha256_of(&file).map_err(unreadable)?;
            if found != expected {
                return Err(self.changed(name));
            }
            file.rewind().map_err(unreadable)?;
        }
        Ok(file)
    }

    /// Accepts tables that a spreadsheet saved again with the same values.
    ///
    /// Calls `warn` with a message for each of these tables.
    #[must_use]
    pub fn warning(self, warn: fn(&str)) -> Self {
        Self { warn: Some(warn), ..self }
    }

    /// Opens the table `name` after verifying its bytes or, after [`Self::warning`], its values.
    pub(crate) fn table(&self, name: &str) -> Result<Box<dyn TableText>, InvalidFolder> {
        let refusal = match self.file(name) {
            Ok(file) => return Ok(Box::new(file)),
            Err(refusal) => refusal,
        };
        let path = self.folder.file(name);
        let Some(warn) = self.warn.filter(|_| path.is_file()) else { return Err(refusal) };
        let (Some(digest), Ok(bytes)) = (self.expected(name)?, fs::read(&path)) else {
            return Err(refusal);
        };
        let Some(written) = resaved::as_written(&bytes, &digest) else { return Err(refusal) };
        warn(&format!(
            "{}: was saved again by another program; its values have not changed",
            path.display()
        ));
        Ok(Box::new(Cursor::new(written)))
    }

    /// Returns the text of the file `name` after verifying its bytes.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, or differs from the file that its command wrote.
    pub fn text(&self, name: &str) -> Result<String, InvalidFolder> {
        let mut text = String::new();
        let read = self.file(name)?.read_to_string(&mut text);
        let unreadable =
            |error| InvalidFolder::unreadable(&self.folder.file(name), &reason(&error));
        read.map_err(unreadable)?;
        Ok(text)
    }

    /// Returns the recorded SHA-256 of the file `name`, if there is one.
    fn expected(&self, name: &str) -> Result<Option<String>, InvalidFolder> {
        let entry = FileEntry::named(name).filter(|file| file.is_stated);
        // `contents.toml` lists the files of a run. Other commands have their own records.
        if let Some(file) = entry.filter(|file| !matches!(file.maker, Maker::Run | Maker::Ranking))
        {
            return self.claimed(file);
        }
        // Without `contents.toml` no SHA-256 of the tables is recorded.
        let Some(contents) = &self.contents else { return Ok(None) };
        if let Some(digest) = contents.files.get(name) {
            return Ok(Some(digest.clone()));
        }
        match entry.map(|file| file.maker) {
            None => Ok(None),
            Some(Maker::Ranking) => self.ranked(name, contents).map(Some),
            // The run was killed before it wrote the contents, or never wrote this file.
            Some(_) => Err(self.changed(name)),
        }
    }

    /// Returns the record with the name `name` in `derived/`, if there is one.
    fn derivation(&self, name: &str) -> Result<Option<Derivation>, InvalidFolder> {
        let path = Derivation::path(&self.folder, name);
        match read_text(&path) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                Err(InvalidFolder::unreadable(&path, &reason(&error)))
            }
            _ => Ok(Derivation::read(&self.folder, name)),
        }
    }

    /// Returns the recorded SHA-256 of a file of the ranking.
    fn ranked(&self, name: &str, contents: &Contents) -> Result<String, InvalidFolder> {
        let ranking = self.derivation(ResultsFolder::RANKING_RECORD)?;
        let ranking = ranking.ok_or_else(|| {
            let problem =
                "no record in derived says that squama rank wrote it; move it out of the folder";
            InvalidFolder::new(self.folder.file(name), problem)
        })?;
        // Intact files of a ranking are outdated if the designs were solved again afterwards.
        if ranking.from != contents.digest() {
            return Err(self.refusal(name, Maker::Ranking, "was made from other tables"));
        }
        let stated = ranking.files.get(name).cloned();
        stated.ok_or_else(|| {
            self.refusal(name, Maker::Ranking, "is not a file of the ranking in this folder")
        })
    }

    /// Returns the recorded SHA-256 of a file that a command has claimed.
    ///
    /// `None` if the folder contains neither a record of the command nor the journal of a search;
    /// the file is then used without verification.
    fn claimed(&self, file: &FileEntry) -> Result<Option<String>, InvalidFolder> {
        let record = self.derivation(file.maker.key())?;
        // A search writes its journal from the start and its record with its results. A journal
        // without a record therefore means that the search was interrupted.
        if record.is_none() && !self.folder.file(ResultsFolder::EVALUATIONS).exists() {
            return Ok(None);
        }
        let stated = record.as_ref().and_then(|record| record.files.get(file.name).cloned());
        let problem = match (&record, &stated) {
            // The record does not list this file, because the last command did not write it.
            (Some(_), None) => "was not written by the last command",
            // There is no record, or the record has an empty digest.
            _ => "its command was interrupted",
        };
        let stated = stated.filter(|digest| !digest.is_empty());
        stated.map(Some).ok_or_else(|| self.refusal(file.name, file.maker, problem))
    }

    /// Returns the error for the file `name`: `problem`, and the command that writes the file
    /// again.
    fn refusal(&self, name: &str, maker: Maker, problem: &str) -> InvalidFolder {
        let again = match maker {
            Maker::Run => repair_command(self.path()),
            Maker::Ranking => format!("squama rank {}", shell_word(&self.path().to_string_lossy())),
            // Without `--resume` a search refuses a folder with the journal of a search.
            Maker::Search => "the same command with --resume".to_owned(),
            _ => "the same command".to_owned(),
        };
        InvalidFolder::new(self.folder.file(name), format!("{problem}; {again} writes it again"))
    }

    /// Returns the error for the missing file `name`, with the command that writes the file again.
    pub fn missing(&self, name: &str) -> InvalidFolder {
        let maker = FileEntry::named(name).map_or(Maker::Run, |entry| entry.maker);
        self.refusal(name, maker, "is missing, but files beside it were made with it")
    }

    fn changed(&self, name: &str) -> InvalidFolder {
        let maker = FileEntry::named(name).map_or(Maker::Run, |entry| entry.maker);
        self.refusal(name, maker, "was changed after squama wrote it")
    }

    /// Returns the errors of all files that `contents.toml` lists.
    pub fn problems(&self) -> Vec<InvalidFolder> {
        let names = self.contents.iter().flat_map(|contents| contents.files.keys());
        names.filter_map(|name| self.file(name).err()).collect()
    }

    /// Creates the record of a product of this folder that `command` makes.
    ///
    /// `None` if the folder has no `contents.toml`.
    pub fn derive(&self, product: &str, command: String) -> Option<Derivation> {
        let (from, made_from) = (self.digest()?, self.shortfall());
        let (product, files) = (product.to_owned(), BTreeMap::new());
        Some(Derivation { product, command, from, made_from, files })
    }

    /// Returns the records of the existing products that were made from other tables.
    ///
    /// A record contains the command that makes the product again.
    pub fn outdated(&self) -> Vec<Derivation> {
        let Some(digest) = self.digest() else { return Vec::new() };
        let all = Derivation::all(&self.folder).into_iter();
        // A product of a definition does not become outdated when tables are rewritten.
        let is_older = |record: &Derivation| !record.from.is_empty() && record.from != digest;
        all.filter(|record| is_older(record) && record.any_file_exists(&self.folder)).collect()
    }
}

/// Checks that a definition file is not the changed record of a run.
///
/// # Errors
///
/// If `path` is the record of a run and differs from the record that the run wrote.
pub fn verify_record(path: &Path) -> Result<(), InvalidFolder> {
    let (Some(name), Some(folder)) = (path.file_name(), path.parent()) else { return Ok(()) };
    // Check only a file with the name of the record: a copy under another name may be edited.
    let is_record = name == ResultsFolder::RUN_INFO && path.is_file();
    let stated = is_record.then(|| Contents::read(&ResultsFolder::new(folder))).flatten();
    let expected = stated.and_then(|contents| contents.files.get(ResultsFolder::RUN_INFO).cloned());
    let Some(expected) = expected else { return Ok(()) };
    // Report a file that cannot be read as unreadable, not as edited.
    let found = fs::read(path).map_err(|error| InvalidFolder::unreadable(path, &reason(&error)))?;
    if sha256(found) == expected {
        return Ok(());
    }
    let repair_command = repair_command(folder);
    let problem = format!(
        "was edited; copy it under another name to use it as a definition; {repair_command} writes it again"
    );
    Err(InvalidFolder::new(folder.join(ResultsFolder::RUN_INFO), problem))
}

/// Reads `contents.toml` of `folder`. `None` if the folder has neither contents nor journal.
fn read(folder: &ResultsFolder) -> Result<Option<Contents>, InvalidFolder> {
    let repair_command = repair_command(folder.path());
    let path = folder.file(ResultsFolder::CONTENTS);
    let parsed = match read_text(&path) {
        Ok(text) => Contents::parse(&text),
        Err(error) if error.kind() == ErrorKind::NotFound && folder.journal().exists() => {
            let problem = format!(
                "holds a journal but no {}, which a run writes last; {repair_command} writes the tables of the designs that are solved",
                ResultsFolder::CONTENTS
            );
            return Err(InvalidFolder::new(folder.path(), problem));
        }
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) if error.kind() == ErrorKind::InvalidData => Err(reason(&error)),
        // Report a file that cannot be opened as unreadable, not as changed.
        Err(error) => return Err(InvalidFolder::unreadable(&path, &reason(&error))),
    };
    parsed.map(Some).map_err(|problem| {
        let problem = format!(
            "was changed after squama wrote it ({problem}); {repair_command} writes it again"
        );
        InvalidFolder::new(path, problem)
    })
}

/// Returns true if the journal in `folder` is longer than `extent`, the part in the tables.
///
/// Returns false if there is no journal, because tables may be copied without it.
fn is_behind(folder: &ResultsFolder, extent: &JournalExtent) -> Result<bool, InvalidFolder> {
    let path = folder.journal();
    let Ok(metadata) = fs::metadata(&path) else { return Ok(false) };
    let refuse = |problem: &str| {
        let problem = format!(
            "is not the journal from which the tables beside it were written ({problem}); {} writes the tables of the designs that it has",
            repair_command(folder.path())
        );
        InvalidFolder::new(&path, problem)
    };
    if !metadata.is_file() {
        return Err(refuse("it is not a regular file"));
    }
    if metadata.len() < extent.bytes {
        return Err(refuse(&format!(
            "it had {} bytes and now has {}",
            extent.bytes,
            metadata.len()
        )));
    }
    // A resumed run appends to the journal, so only the stated extent must be unchanged.
    let found = JournalExtent::read(&path, extent.bytes, extent.lines);
    let found = found.map_err(|error| InvalidFolder::unreadable(&path, &reason(&error)))?;
    if found != *extent {
        return Err(refuse("its beginning has changed"));
    }
    Ok(metadata.len() > extent.bytes)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::folder::FILES;

    /// Creates a results folder at `place` with a `contents.toml` that lists `files`.
    fn folder(place: &Path, files: BTreeMap<String, String>) -> ResultsFolder {
        let folder = ResultsFolder::new(place);
        let journal = JournalExtent { bytes: 0, lines: 0, sha256: sha256("") };
        let program = "0 (none)".to_owned();
        let contents = Contents { program, designs: 0, done: 0, journal, files };
        contents.write(&folder).expect("writable");
        folder
    }

    /// The test replaces the file by a folder, which even root cannot read as a file.
    #[test]
    fn unreadable_files_are_not_reported_as_changed() {
        let records = [
            ResultsFolder::CONTENTS.to_owned(),
            ResultsFolder::RUN_INFO.to_owned(),
            format!("{}/ranking.toml", ResultsFolder::DERIVED),
        ];
        for name in records {
            let place = tempfile::tempdir().expect("a folder");
            let written = BTreeMap::from([(ResultsFolder::RUN_INFO.to_owned(), sha256("name"))]);
            let folder = folder(place.path(), written);
            fs::write(folder.file("ranking.csv"), "rank").expect("writable");
            let _ = fs::remove_file(folder.file(&name));
            fs::create_dir_all(folder.file(&name)).expect("writable");
            let opened = VerifiedFolder::open(folder.path(), Completeness::Whole);
            let read = opened.and_then(|folder| {
                folder.text(ResultsFolder::RUN_INFO).and_then(|_| folder.text("ranking.csv"))
            });
            let message = read.expect_err("unreadable").to_string();
            assert!(message.contains("cannot be read"), "{name}: {message}");
            assert!(
                !message.contains("changed") && !message.contains("no record"),
                "{name}: {message}"
            );
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn an_unreadable_record_is_not_reported_as_edited() {
        let place = tempfile::tempdir().expect("a folder");
        let written = BTreeMap::from([(ResultsFolder::RUN_INFO.to_owned(), sha256("name"))]);
        let record = folder(place.path(), written).file(ResultsFolder::RUN_INFO);
        // The link leads to process memory, and reading address zero fails even for root.
        std::os::unix::fs::symlink("/proc/self/mem", &record).expect("writable");
        let message = verify_record(&record).expect_err("unreadable").to_string();
        assert!(message.contains("cannot be read") && !message.contains("edited"), "{message}");
    }

    #[test]
    fn changed_files_are_refused_if_their_checksum_is_recorded() {
        for file in FILES.iter().filter(|file| file.is_stated) {
            let place = tempfile::tempdir().expect("a folder");
            let folder = folder(place.path(), BTreeMap::new());
            fs::write(folder.file(file.name), "forged").expect("writable");
            fs::write(folder.file(ResultsFolder::EVALUATIONS), "").expect("writable");
            let open = || VerifiedFolder::open(folder.path(), Completeness::Whole);
            let refused = open().and_then(|folder| folder.text(file.name)).expect_err(file.name);
            assert!(refused.to_string().contains(file.name), "{refused}");
            let written = BTreeMap::from([(file.name.to_owned(), sha256("as it was written"))]);
            if file.maker == Maker::Run {
                self::folder(place.path(), written);
            } else {
                let from = open().expect("a folder").digest().expect("a digest");
                let (product, command) = file.maker.names();
                let (product, command) = (product.to_owned(), command.to_owned());
                let record = Derivation { product, command, from, made_from: None, files: written };
                record.write(&folder, file.maker.key()).expect("writable");
            }
            let refused = open().and_then(|folder| folder.text(file.name)).expect_err(file.name);
            assert!(refused.to_string().contains("was changed after"), "{refused}");
            fs::write(folder.file(file.name), "as it was written").expect("writable");
            let read = open().and_then(|folder| folder.text(file.name)).expect("readable");
            assert_eq!(read, "as it was written", "{}", file.name);
        }
    }
}
