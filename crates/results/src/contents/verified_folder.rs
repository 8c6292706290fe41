//! A results folder whose contents are checked: what every command reads is read through it.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{ErrorKind, Read as _, Seek as _};
use std::path::{Path, PathBuf};

use store::{read_text, sha256, sha256_of};
use sweep::reason;

use super::derivation::Derivation;
use super::{Contents, JournalExtent};
use crate::folder::{FileEntry, Maker, RunFolder};
use crate::shell::shell_word;

/// Whether results are used that are not whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Completeness {
    /// Only results of all designs, as the journal has them.
    #[default]
    Whole,
    /// Results of those designs, too, that are done so far.
    Partial,
}

/// A results folder whose contents are as its run states them. A folder with neither contents nor journal holds tables
/// alone, of which nobody states anything.
#[derive(Clone, Debug)]
pub struct VerifiedFolder {
    folder: RunFolder,
    contents: Option<Contents>,
    /// Whether the journal goes on beyond the tables.
    behind: bool,
}

/// A results folder that is not as its run states it. Each message is one line that says what mends it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InvalidFolder {
    /// A journal, and nothing that says what its tables are.
    #[error("{}: holds a journal but no contents.toml, which a run writes last; {} writes the tables of the designs that are solved", .0.display(), mend(.0))]
    Unfinished(PathBuf),
    /// The statement of the contents was damaged.
    #[error("{}: was changed after squama wrote it ({problem}); {} writes it again", folder.join(RunFolder::CONTENTS).display(), mend(folder))]
    Contents {
        /// The folder.
        folder: PathBuf,
        /// The fault.
        problem: String,
    },
    /// The journal is not the one that the tables were written from.
    #[error("{}: is not the journal from which the tables beside it were written ({problem}); {} writes the tables of the designs that it has", folder.join(RunFolder::JOURNAL).display(), mend(folder))]
    Journal {
        /// The folder.
        folder: PathBuf,
        /// The fault.
        problem: String,
    },
    /// A table is not the one that was written.
    #[error("{}: was changed after squama wrote it; {} writes it again", folder.join(file).display(), mend(folder))]
    Changed {
        /// The folder.
        folder: PathBuf,
        /// The name of the table.
        file: String,
    },
    /// The record of a run was changed.
    #[error("{}: was edited; copy it under another name to use it as a definition; {} writes it again", .0.join(RunFolder::RUN_INFO).display(), mend(.0))]
    Record(PathBuf),
    /// A table of a ranking that did not come to its end, or of other tables.
    #[error("{}: {problem}; squama rank {} writes it again", folder.join(file).display(), shell_word(&folder.display().to_string()))]
    Ranking {
        /// The folder.
        folder: PathBuf,
        /// The name of the table.
        file: String,
        /// The fault.
        problem: &'static str,
    },
    /// A table of a ranking that no record names.
    #[error("{}: no record in derived says that squama rank wrote it; move it out of the folder", folder.join(file).display())]
    Unrecorded {
        /// The folder.
        folder: PathBuf,
        /// The name of the table.
        file: String,
    },
    /// A file of a search or an analysis that did not come to its end, or one that was changed.
    #[error("{}: {problem}; {again} writes it again", folder.join(file).display())]
    Claimed {
        /// The folder.
        folder: PathBuf,
        /// The name of the file.
        file: String,
        /// The fault.
        problem: &'static str,
        /// What writes it again.
        again: &'static str,
    },
    /// A file cannot be read.
    #[error("{}: cannot be read ({reason}), expected the file that squama run writes", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// The message of the system.
        reason: String,
    },
    /// Some designs are not done.
    #[error("{}: holds {done} of {designs} designs; squama run --resume solves the others, --partial uses those that are there", folder.display())]
    Incomplete {
        /// The folder.
        folder: PathBuf,
        /// The number of designs that are done.
        done: u64,
        /// The number of designs of the run.
        designs: u64,
    },
    /// The journal goes on beyond the tables.
    #[error("{}: the journal has more designs than the tables, because a run is going on or was ended before it wrote them; {} writes them, --partial uses the designs of the tables", .0.display(), mend(.0))]
    Behind(PathBuf),
}

/// The command that writes tables and contents of a folder again, from its journal.
fn mend(folder: &Path) -> String {
    let folder = shell_word(&folder.display().to_string());
    format!("squama merge {folder} --out {folder}")
}

impl VerifiedFolder {
    /// The results in `folder`; what its contents name is checked when it is opened.
    ///
    /// # Errors
    /// If the contents are missing though there is a journal, are damaged or do not fit the journal; and, unless partial
    /// results will do, if designs are missing or the journal goes on beyond the tables.
    pub fn open(folder: &Path, completeness: Completeness) -> Result<Self, InvalidFolder> {
        let folder = RunFolder::new(folder);
        let contents = read(&folder)?;
        // Tables that are sound by themselves would hide the designs that are in the journal alone.
        let behind = match &contents {
            Some(contents) => is_behind(&folder, &contents.journal)?,
            None => false,
        };
        let opened = Self { folder, contents, behind };
        if completeness == Completeness::Whole {
            opened.require_whole()?;
        }
        Ok(opened)
    }

    fn require_whole(&self) -> Result<(), InvalidFolder> {
        match &self.contents {
            Some(contents) if !contents.is_whole() => {
                let Contents { done, designs, .. } = *contents;
                Err(InvalidFolder::Incomplete { folder: self.path().to_owned(), done, designs })
            }
            _ => self.behind().map_or(Ok(()), Err),
        }
    }

    /// The message if the journal goes on beyond the tables.
    pub fn behind(&self) -> Option<InvalidFolder> {
        self.behind.then(|| InvalidFolder::Behind(self.path().to_owned()))
    }

    /// The path of the folder.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Whether it holds anything of the name `name`: what is no file is refused when it is opened.
    pub fn holds(&self, name: &str) -> bool {
        self.folder.file(name).exists()
    }

    /// The names of the tables that are there, and of those that should be, in the order in which people read them.
    pub fn tables(&self) -> Vec<String> {
        let stated = self.contents.iter().flat_map(|contents| contents.files.keys());
        let ranking = Derivation::read(&self.folder, RunFolder::RANKING_RECORD);
        // A ranking that was removed as a whole is not missed.
        let ranking = ranking.filter(|made| self.contents.is_some() && made.is_there(&self.folder));
        let ranked = ranking.iter().flat_map(|made| made.files.keys());
        let expected: BTreeSet<&str> = stated.chain(ranked).map(String::as_str).collect();
        let tables = RunFolder::tables().filter(|name| expected.contains(name) || self.holds(name));
        tables.map(str::to_owned).collect()
    }

    /// The tables as one SHA-256, if the run states it.
    pub fn digest(&self) -> Option<String> {
        self.contents.as_ref().map(Contents::digest)
    }

    /// How much of the run it holds, in words, if it is not the whole: `24 of 720 designs`.
    pub fn shortfall(&self) -> Option<String> {
        let contents = self.contents.as_ref()?;
        let Contents { done, designs, .. } = contents;
        let behind = if self.behind { ", before the journal went on" } else { "" };
        let is_short = !contents.is_whole() || self.behind;
        is_short.then(|| format!("{done} of {designs} designs{behind}"))
    }

    /// Opens the file `name`, once its bytes are checked.
    ///
    /// # Errors
    /// If it cannot be read, or is not as its run has written it.
    pub fn file(&self, name: &str) -> Result<File, InvalidFolder> {
        let path = self.folder.file(name);
        let unreadable = |reason| InvalidFolder::Unreadable { file: path.clone(), reason };
        // A pipe of that name would never come to its end.
        if fs::metadata(&path).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir()) {
            return Err(unreadable("it is no regular file".to_owned()));
        }
        // One handle for checking and reading: a file that is replaced in between is not read.
        let mut file = File::open(&path).map_err(|error| unreadable(reason(&error)))?;
        if let Some(expected) = self.expected(name)? {
            let found = sha256_of(&file).map_err(|error| unreadable(reason(&error)))?;
            if found != expected {
                return Err(self.changed(name));
            }
            file.rewind().map_err(|error| unreadable(reason(&error)))?;
        }
        Ok(file)
    }

    /// The text of the file `name`, once its bytes are checked.
    ///
    /// # Errors
    /// If it cannot be read, or is not as its run has written it.
    pub fn text(&self, name: &str) -> Result<String, InvalidFolder> {
        let mut text = String::new();
        let read = self.file(name)?.read_to_string(&mut text);
        read.map_err(|error| InvalidFolder::Unreadable {
            file: self.folder.file(name),
            reason: reason(&error),
        })?;
        Ok(text)
    }

    /// The SHA-256 that the file `name` must have, if anybody states it.
    fn expected(&self, name: &str) -> Result<Option<String>, InvalidFolder> {
        let entry = FileEntry::of(name).filter(|file| file.is_stated);
        // The contents are those of a run: other commands have records of their own.
        if let Some(file) = entry.filter(|file| !matches!(file.maker, Maker::Run | Maker::Ranking))
        {
            return self.claimed(file);
        }
        // Tables alone are used as they are: nobody states what they have to be.
        let Some(contents) = &self.contents else { return Ok(None) };
        if let Some(digest) = contents.files.get(name) {
            return Ok(Some(digest.clone()));
        }
        match entry.map(|file| file.maker) {
            None => return Ok(None),
            Some(Maker::Ranking) => {}
            // Of a run that was ended before it stated it, or of one that never made it.
            Some(_) => return Err(self.changed(name)),
        }
        let refuse = |problem| InvalidFolder::Ranking {
            folder: self.path().to_owned(),
            file: name.to_owned(),
            problem,
        };
        let ranking = Derivation::read(&self.folder, RunFolder::RANKING_RECORD);
        let unrecorded =
            || InvalidFolder::Unrecorded { folder: self.path().to_owned(), file: name.to_owned() };
        let ranking = ranking.ok_or_else(unrecorded)?;
        // Its tables may be sound, and still rank designs that were solved again since.
        if ranking.from != contents.digest() {
            return Err(refuse("was made from other tables"));
        }
        let stated = ranking.files.get(name).cloned();
        stated.map(Some).ok_or_else(|| refuse("is no file of the ranking beside it"))
    }

    /// The SHA-256 that a file must have that a command has claimed. A folder without a journal of a search and without a record
    /// holds tables alone.
    fn claimed(&self, file: &FileEntry) -> Result<Option<String>, InvalidFolder> {
        let made = Derivation::read(&self.folder, file.maker.key());
        // A search has its journal from the beginning, and a record only once it writes what it has
        // found: a journal without a record is that of a search that was ended.
        if made.is_none() && !self.folder.file(RunFolder::EVALUATIONS).exists() {
            return Ok(None);
        }
        let stated = made.and_then(|made| made.files.get(file.name).cloned());
        // Without a digest the command was ended before it stated what it had written.
        let stated = stated.filter(|digest| !digest.is_empty());
        stated.map(Some).ok_or_else(|| self.refusal(file, "its command did not come to its end"))
    }

    fn refusal(&self, file: &FileEntry, problem: &'static str) -> InvalidFolder {
        let again = match file.maker {
            // Without it a search refuses a folder in which its journal stands.
            Maker::Search => "the same command with --resume",
            _ => "the same command",
        };
        let (folder, file) = (self.path().to_owned(), file.name.to_owned());
        InvalidFolder::Claimed { folder, file, problem, again }
    }

    fn changed(&self, name: &str) -> InvalidFolder {
        let (folder, file) = (self.path().to_owned(), name.to_owned());
        let problem = "was changed after squama wrote it";
        match FileEntry::of(name) {
            Some(entry) if entry.maker == Maker::Ranking => {
                InvalidFolder::Ranking { folder, file, problem }
            }
            Some(entry) if entry.maker != Maker::Run => self.refusal(entry, problem),
            _ => InvalidFolder::Changed { folder, file },
        }
    }

    /// The faults of any of the files that the contents name.
    pub fn problems(&self) -> Vec<InvalidFolder> {
        let names = self.contents.iter().flat_map(|contents| contents.files.keys());
        names.filter_map(|name| self.file(name).err()).collect()
    }

    /// The products of the folder that are out of date: each, and the command that makes it again.
    pub fn outdated(&self) -> Vec<Derivation> {
        let Some(digest) = self.digest() else { return Vec::new() };
        let all = Derivation::all(&self.folder).into_iter();
        // What was made from a definition does not grow old when tables are written again.
        let is_older = |made: &Derivation| !made.from.is_empty() && made.from != digest;
        all.filter(|made| is_older(made) && made.is_there(&self.folder)).collect()
    }
}

/// Refuses the definition in the file `path` if it is the record of a run, and not as the run wrote it.
///
/// # Errors
/// If it is.
pub fn verify_record(path: &Path) -> Result<(), InvalidFolder> {
    let (Some(name), Some(folder)) = (path.file_name(), path.parent()) else { return Ok(()) };
    // Under another name a copy is a definition of its own, as the message advises.
    let is_record = name == RunFolder::RUN_INFO && path.is_file();
    let stated = is_record.then(|| Contents::stated_in(&RunFolder::new(folder))).flatten();
    let expected = stated.and_then(|contents| contents.files.get(RunFolder::RUN_INFO).cloned());
    let found = expected.is_some().then(|| fs::read(path).map(sha256).ok()).flatten();
    if found == expected {
        return Ok(());
    }
    Err(InvalidFolder::Record(folder.to_owned()))
}

/// The contents of `folder`; `None` if it holds tables alone.
fn read(folder: &RunFolder) -> Result<Option<Contents>, InvalidFolder> {
    let path = || folder.path().to_owned();
    match read_text(&folder.file(RunFolder::CONTENTS)) {
        Ok(text) => match Contents::parse(&text) {
            Ok(contents) => Ok(Some(contents)),
            Err(problem) => Err(InvalidFolder::Contents { folder: path(), problem }),
        },
        Err(error) if error.kind() == ErrorKind::NotFound => {
            let unfinished = folder.journal().exists();
            if unfinished { Err(InvalidFolder::Unfinished(path())) } else { Ok(None) }
        }
        Err(error) => Err(InvalidFolder::Contents { folder: path(), problem: reason(&error) }),
    }
}

/// Whether the journal in `folder` goes on beyond `extent`. Tables may be copied without their journal.
fn is_behind(folder: &RunFolder, extent: &JournalExtent) -> Result<bool, InvalidFolder> {
    let path = folder.journal();
    let Ok(metadata) = fs::metadata(&path) else { return Ok(false) };
    let refuse =
        |problem: String| InvalidFolder::Journal { folder: folder.path().to_owned(), problem };
    if !metadata.is_file() {
        return Err(refuse("it is no regular file".to_owned()));
    }
    if metadata.len() < extent.bytes {
        return Err(refuse(format!("it had {} bytes and has {}", extent.bytes, metadata.len())));
    }
    // A run that goes on appends to it: only what the tables were written from must not change.
    let found = JournalExtent::of(&path, extent.bytes, extent.lines);
    let found = found.map_err(|error| refuse(reason(&error)))?;
    if found != *extent {
        return Err(refuse("its beginning has changed".to_owned()));
    }
    Ok(metadata.len() > extent.bytes)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::folder::FILES;

    /// A folder whose run states these files.
    fn folder(place: &Path, files: BTreeMap<String, String>) -> RunFolder {
        let folder = RunFolder::new(place);
        let journal = JournalExtent { bytes: 0, lines: 0, sha256: sha256("") };
        let program = "0 (none)".to_owned();
        let contents = Contents { program, designs: 0, done: 0, journal, files };
        contents.write(&folder).expect("writable");
        folder
    }

    #[test]
    fn of_every_file_whose_maker_states_it_no_other_is_read() {
        for file in FILES.iter().filter(|file| file.is_stated) {
            let place = tempfile::tempdir().expect("a folder");
            let folder = folder(place.path(), BTreeMap::new());
            fs::write(folder.file(file.name), "forged").expect("writable");
            fs::write(folder.file(RunFolder::EVALUATIONS), "").expect("writable");
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
                let made = Derivation { product, command, from, made_from: None, files: written };
                made.write(&folder, file.maker.key()).expect("writable");
            }
            let refused = open().and_then(|folder| folder.text(file.name)).expect_err(file.name);
            assert!(refused.to_string().contains("was changed after"), "{refused}");
            fs::write(folder.file(file.name), "as it was written").expect("writable");
            let read = open().and_then(|folder| folder.text(file.name)).expect("a text");
            assert_eq!(read, "as it was written", "{}", file.name);
        }
    }
}
