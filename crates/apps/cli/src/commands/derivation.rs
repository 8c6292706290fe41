//! Records of the products made from the tables of a folder.
//!
//! `squama status` uses them to list products that are out of date.

use std::path::{Path, PathBuf};
use std::{fs, io};

use anyhow::Context as _;
use results::{Derivation, OutputError, ResultsFolder, VerifiedFolder, sha256};
use text::shell_word;

/// Digits of the SHA-256 of a path in the name of a record.
const DIGITS: usize = 8;

/// Records in `results` the files that this command made from its tables.
///
/// The files are `names` in `folder`.
pub fn record(
    results: &VerifiedFolder,
    product: &str,
    folder: &Path,
    names: &[impl AsRef<str>],
) -> anyhow::Result<()> {
    // Without checksums of the tables, later changes could not be detected.
    let Some(mut derivation) = results.derive(product, command()) else { return Ok(()) };
    let inside = path_within(results.path(), folder);
    for name in names.iter().map(AsRef::as_ref) {
        let path = folder.join(name);
        let bytes =
            fs::read(&path).with_context(|| format!("{}: cannot be read", path.display()))?;
        derivation.files.insert(key(inside.as_deref(), folder, name), sha256(bytes));
    }
    // Readers verify the tables of a ranking by this record. A ranking in another folder is a
    // product like any other.
    let is_ranking = product == ResultsFolder::RANKING_RECORD && inside.as_deref() == Some("");
    let record = if is_ranking { product.to_owned() } else { record_name(product, &derivation) };
    let written = derivation.write(&ResultsFolder::new(results.path()), &record);
    // A results folder may be read-only; products in other folders are written all the same.
    written.or_else(|error: OutputError| if inside.is_some() { Err(error.into()) } else { Ok(()) })
}

/// Returns the command line of this process, quoted for a shell.
fn command() -> String {
    // Names that are not UTF-8 are recorded as displayed.
    let words = std::env::args_os().skip(1).map(|word| shell_word(&word.to_string_lossy()));
    std::iter::once("squama".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// Returns the path of `folder` relative to `results`, if it is inside.
fn path_within(results: &Path, folder: &Path) -> Option<String> {
    // Links are resolved, because the same folder may have several names.
    let (results, folder) = (absolute(results).ok()?, absolute(folder).ok()?);
    Some(folder.strip_prefix(results).ok()?.to_string_lossy().into_owned())
}

/// Returns the absolute path of a folder; an empty path is the working directory.
fn absolute(folder: &Path) -> io::Result<PathBuf> {
    fs::canonicalize(if folder.as_os_str().is_empty() { Path::new(".") } else { folder })
}

/// Returns the name of a file in the record: relative inside the results, otherwise absolute.
fn key(inside: Option<&str>, folder: &Path, name: &str) -> String {
    let path = match inside {
        // Relative, so that the folder can be moved.
        Some(place) => Path::new(place).join(name),
        None => absolute(folder).unwrap_or_else(|_| folder.to_owned()).join(name),
    };
    path.to_string_lossy().into_owned()
}

/// Returns the name of the record of a product, from the path of its first file.
fn record_name(product: &str, derivation: &Derivation) -> String {
    let first = derivation.files.keys().next().map_or("", String::as_str);
    let digest = sha256(first);
    format!("{product}-{}", digest.get(..DIGITS).unwrap_or_default())
}
