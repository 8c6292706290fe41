//! Journals of random or damaged bytes cause an error message, but no panic.
//!
//! `scripts/fuzz` runs these tests for a given time.

use std::fmt::Write as _;
use std::io::Cursor;
use std::path::Path;
use std::sync::OnceLock;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;
use run::Archive;

/// Returns the lines of a valid journal without their checksums.
fn journal() -> &'static [String] {
    static LINES: OnceLock<Vec<String>> = OnceLock::new();
    LINES.get_or_init(|| {
        let place = tempfile::tempdir().expect("a folder");
        crate::journals::resume(place.path()).expect("a run");
        let text = std::fs::read_to_string(place.path().join("journal.jsonl")).expect("text");
        text.lines().take(8).map(|line| line[CHECKSUM..].to_owned()).collect()
    })
}

/// Length of the start of a line that holds its checksum, `{"crc":"01234567",`.
const CHECKSUM: usize = 18;

/// Returns a journal of these lines, each with its correct checksum.
fn sealed(contents: &[String]) -> Vec<u8> {
    let header: serde_json::Value =
        serde_json::from_str(&format!("{{{}", contents[0])).unwrap_or_default();
    let mut seal = crc32fast::Hasher::new();
    for key in ["definition_sha256", "version", "revision"] {
        seal.update(header["journal"][key].as_str().unwrap_or_default().as_bytes());
    }
    let mut text = String::new();
    for (line, content) in contents.iter().enumerate() {
        let mut hasher = if line == 0 { crc32fast::Hasher::new() } else { seal.clone() };
        hasher.update(content.as_bytes());
        let _ = writeln!(text, "{{\"crc\":\"{:08x}\",{content}", hasher.finalize());
    }
    text.into_bytes()
}

/// Reads a journal; an error must be one line of text and state the number of a journal line.
fn open(bytes: Vec<u8>) -> Result<(), TestCaseError> {
    match Archive::read_from(Cursor::new(bytes), Path::new("journal.jsonl")) {
        Ok(None) => {}
        Ok(Some(archive)) => {
            let missing: u64 = archive.missing().iter().map(|range| range.end - range.start).sum();
            prop_assert_eq!(archive.done() + missing, archive.designs().len());
        }
        Err(error) => {
            let error = error.to_string();
            prop_assert_eq!(error.lines().count(), 1, "{}", error);
            let line = error.strip_prefix("journal.jsonl:").and_then(|rest| rest.split(':').next());
            prop_assert!(line.is_some_and(|line| line.parse::<u64>().is_ok()), "{}", error);
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn random_bytes_never_panic(bytes in vec(any::<u8>(), 0..200)) {
        open(bytes)?;
    }

    #[test]
    fn damaged_journals_never_panic(
        at: Index, length in 0..30_usize, piece in vec(any::<u8>(), 0..30)
    ) {
        let mut bytes = sealed(journal());
        let at = at.index(bytes.len());
        let end = (at + length).min(bytes.len());
        bytes.splice(at..end, piece);
        open(bytes)?;
    }

    /// The checksums are valid, so that the edited content of the line is parsed.
    #[test]
    fn edited_journals_with_valid_checksums_never_panic(
        line: Index, at: Index, length in 0..12_usize, piece in "[-0-9a-z{}\\[\\]:,.\"\\\\]{0,12}"
    ) {
        let mut contents = journal().to_vec();
        let line = line.index(contents.len());
        let content = &mut contents[line];
        let at = at.index(content.len());
        let end = (at + length).min(content.len());
        content.replace_range(at..end, &piece);
        open(sealed(&contents))?;
    }

    #[test]
    fn extreme_numbers_in_journals_never_panic(
        line: Index, at: Index, number: u64, shift in 0..64_u32
    ) {
        let mut contents = journal().to_vec();
        let line = line.index(contents.len());
        let content = &mut contents[line];
        let digits: Vec<_> = content.match_indices(|c: char| c.is_ascii_digit()).collect();
        let at = digits[at.index(digits.len())].0;
        content.replace_range(at..=at, &(number >> shift).to_string());
        open(sealed(&contents))?;
    }
}
