//! Protects the user's own files from being replaced by output of squama.
//!
//! Every output file contains the word squama as a mark in a comment, a header or the document
//! properties, except the records of a results folder and PNG files. A command replaces only files
//! with this mark.

use std::fs::{self, File};
use std::io::{self, Read, Seek as _, SeekFrom};
use std::path::Path;

use results::OutputError;
use zip::ZipArchive;

/// The word that marks a file as written by squama.
const MARK: &[u8] = b"squama";

/// Number of bytes at the start and at the end of a file that are searched for the mark.
const SEARCHED: u64 = 8192;

/// Entries that contain the mark in zip archives: in a workbook, and in a 3MF file.
const ZIP_ENTRIES: [&str; 2] = ["docProps/core.xml", "3D/3dmodel.model"];

/// Rejects the file at `path` if it was not written by squama.
///
/// Accepts an empty file, and a `path` at which nothing exists. Rejects links, folders and devices.
pub fn require_own(path: &Path) -> Result<(), OutputError> {
    let Ok(metadata) = fs::symlink_metadata(path) else { return Ok(()) };
    // A PNG file contains no mark, so search the SVG file of the same drawing.
    let marked = if path.extension().is_some_and(|extension| extension == "png") {
        path.with_extension("svg")
    } else {
        path.to_owned()
    };
    let is_own = metadata.is_file() && (metadata.len() == 0 || has_mark(&marked).unwrap_or(false));
    if is_own { Ok(()) } else { Err(OutputError::foreign(path)) }
}

fn has_mark(path: &Path) -> io::Result<bool> {
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    let mut start = Vec::new();
    (&mut file).take(SEARCHED).read_to_end(&mut start)?;
    if start.starts_with(b"PK") {
        return Ok(zip_has_mark(file));
    }
    let mut end = Vec::new();
    file.seek(SeekFrom::Start(length.saturating_sub(SEARCHED)))?;
    file.take(SEARCHED).read_to_end(&mut end)?;
    Ok(contains_mark(&start) || contains_mark(&end))
}

fn zip_has_mark(file: File) -> bool {
    let Ok(mut archive) = ZipArchive::new(file) else { return false };
    ZIP_ENTRIES.iter().any(|name| {
        let Ok(entry) = archive.by_name(name) else { return false };
        let mut start = Vec::new();
        entry.take(SEARCHED).read_to_end(&mut start).is_ok() && contains_mark(&start)
    })
}

fn contains_mark(bytes: &[u8]) -> bool {
    bytes.windows(MARK.len()).any(|window| window == MARK)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_with_the_mark_of_squama_are_replaced() {
        let folder = tempfile::tempdir().expect("the folder is created");
        let path = folder.path().join("x.svg");
        let image = path.with_extension("png");
        require_own(&path).expect("a missing file is accepted");
        fs::write(&path, "").expect("the file is written");
        require_own(&path).expect("an empty file is accepted");
        fs::write(&path, "mine").expect("the file is written");
        fs::write(&image, "mine").expect("the file is written");
        assert!(require_own(&path).is_err() && require_own(&image).is_err());
        fs::write(&path, format!("{}<!-- squama -->", " ".repeat(100_000)))
            .expect("the file is written");
        assert!(require_own(&path).is_ok() && require_own(&image).is_ok());
        assert!(require_own(folder.path()).is_err(), "a folder must be rejected");
    }
}
