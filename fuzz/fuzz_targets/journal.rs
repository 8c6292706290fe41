//! Fuzzes the reader of journals: it accepts an input, or rejects it with a one-line error.
//!
//! Half of the inputs get a valid header and correct checksums, so that the reader parses the
//! contents of their lines.
#![no_main]

use std::io::Cursor;
use std::path::Path;

use libfuzzer_sys::fuzz_target;
use results::sha256;
use run::Archive;
use sweep::Sweep;

fuzz_target!(|bytes: &[u8]| {
    let (is_sealed, bytes) = bytes.split_first().unwrap_or((&0, &[]));
    let journal = if is_sealed % 2 == 0 { bytes.to_vec() } else { sealed(bytes) };
    match Archive::read_from(Cursor::new(journal), Path::new("journal.jsonl")) {
        Ok(Some(archive)) => assert!(archive.done() <= archive.designs().len()),
        Ok(None) => {}
        Err(error) => assert_eq!(error.to_string().lines().count(), 1),
    }
});

/// Builds a journal from a valid header and the lines of `bytes`, all with correct checksums.
fn sealed(bytes: &[u8]) -> Vec<u8> {
    let definition = Sweep::parse("name = 'x'", "x.toml", &[]).expect("a sweep").to_toml();
    let digest = sha256(&definition);
    let header = serde_json::json!({
        "format": 2, "version": "0", "revision": "fuzz", "definition_sha256": digest, "definition": definition,
    });
    let seal = [digest.as_str(), "0", "fuzz"].concat();
    let mut journal = line("", format!("\"journal\":{header}}}").as_bytes());
    let begun = Archive::read_from(Cursor::new(journal.clone()), Path::new("journal.jsonl"));
    assert!(matches!(begun, Ok(Some(_))), "the reader accepts the header of every journal");
    for content in bytes.split(|byte| *byte == b'\n') {
        journal.extend(line(&seal, content));
    }
    journal
}

/// Builds a line of a journal: its checksum, computed from `seal` and `content`, and the content.
fn line(seal: &str, content: &[u8]) -> Vec<u8> {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(seal.as_bytes());
    hasher.update(content);
    let begin = format!("{{\"crc\":\"{:08x}\",", hasher.finalize());
    [begin.as_bytes(), content, b"\n"].concat()
}
