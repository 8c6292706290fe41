//! Journals: read, or refused in one line. The checksums of a text are put right first, so that all else is read too.
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

/// The header of a small sweep with its checksum, and the lines of `bytes` with theirs.
fn sealed(bytes: &[u8]) -> Vec<u8> {
    let definition = Sweep::parse("name = 'x'", "x.toml", &[]).expect("a sweep").to_toml();
    let digest = sha256(&definition);
    let header = serde_json::json!({
        "format": 2, "version": "0", "revision": "fuzz", "definition_sha256": digest, "definition": definition,
    });
    let seal = [digest.as_str(), "0", "fuzz"].concat();
    let mut journal = line("", format!("\"journal\":{header}}}").as_bytes());
    let begun = Archive::read_from(Cursor::new(journal.clone()), Path::new("journal.jsonl"));
    assert!(matches!(begun, Ok(Some(_))), "the header is one that squama writes");
    for content in bytes.split(|byte| *byte == b'\n') {
        journal.extend(line(&seal, content));
    }
    journal
}

/// A line with the checksum that it must have.
fn line(seal: &str, content: &[u8]) -> Vec<u8> {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(seal.as_bytes());
    hasher.update(content);
    let begin = format!("{{\"crc\":\"{:08x}\",", hasher.finalize());
    [begin.as_bytes(), content, b"\n"].concat()
}
