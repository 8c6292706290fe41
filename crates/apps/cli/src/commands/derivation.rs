//! Records which files were made from the tables of a results folder.
//!
//! By these records `squama status` finds files made from an earlier version of the tables.

use std::path::{Path, PathBuf};
use std::{fs, io};

use anyhow::Context as _;
use results::{Derivation, OutputError, ResultsFolder, VerifiedFolder, sha256};
use text::shell_word;

/// Number of digits of the SHA-256 of a path in the name of a record.
const DIGITS: usize = 8;

/// Records that the files `names` in `folder` were made from the tables of `results`.
///
/// `product` is the kind of files, such as `figures`; the record is written to `results`.
pub fn record(
    results: &VerifiedFolder,
    product: &str,
    folder: &Path,
    names: &[impl AsRef<str>],
) -> anyhow::Result<()> {
    // `derive` returns `None` if the folder has no checksums of its tables: later changes of the
    // tables could not be detected.
    let Some(mut derivation) = results.derive(product, command()) else { return Ok(()) };
    let inside = path_within(results.path(), folder);
    for name in names.iter().map(AsRef::as_ref) {
        let path = folder.join(name);
        let bytes =
            fs::read(&path).with_context(|| format!("{}: cannot be read", path.display()))?;
        derivation.files.insert(key(inside.as_deref(), folder, name), sha256(bytes));
    }
    // The record of a ranking in the results folder has a fixed name, because readers use it to
    // verify the tables of the ranking.
    let is_ranking = product == ResultsFolder::RANKING_RECORD && inside.as_deref() == Some("");
    let record = if is_ranking { product.to_owned() } else { record_name(product, &derivation) };
    let written = derivation.write(&ResultsFolder::new(results.path()), &record);
    // If the files are in another folder, ignore the error: the results folder may be read-only.
    written.or_else(|error: OutputError| if inside.is_some() { Err(error.into()) } else { Ok(()) })
}

/// Returns the command line of this process, quoted for a shell.
fn command() -> String {
    // Names that are not UTF-8 are recorded with replacement characters.
    let words = std::env::args_os().skip(1).map(|word| shell_word(&word.to_string_lossy()));
    std::iter::once("squama".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// Returns the path of `folder` relative to `results`; `None` if it lies outside.
fn path_within(results: &Path, folder: &Path) -> Option<String> {
    // Resolve links, because a folder may have several paths.
    let (results, folder) = (absolute(results).ok()?, absolute(folder).ok()?);
    Some(folder.strip_prefix(results).ok()?.to_string_lossy().into_owned())
}

/// Returns the absolute path of a folder; an empty path is the working directory.
fn absolute(folder: &Path) -> io::Result<PathBuf> {
    fs::canonicalize(if folder.as_os_str().is_empty() { Path::new(".") } else { folder })
}

/// Returns the path of a file as the record contains it.
///
/// `inside` is the path of `folder` relative to the results. The path of the file is then relative,
/// too; otherwise it is absolute.
fn key(inside: Option<&str>, folder: &Path, name: &str) -> String {
    let path = match inside {
        // A relative path remains valid if the results folder is moved.
        Some(place) => Path::new(place).join(name),
        None => absolute(folder).unwrap_or_else(|_| folder.to_owned()).join(name),
    };
    path.to_string_lossy().into_owned()
}

/// Returns the name of a record, which contains a hash of the path of the first file.
fn record_name(product: &str, derivation: &Derivation) -> String {
    let first = derivation.files.keys().next().map_or("", String::as_str);
    let digest = sha256(first);
    format!("{product}-{}", digest.get(..DIGITS).unwrap_or_default())
}
