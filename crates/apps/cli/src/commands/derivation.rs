//! Records which files were made from the tables of a results folder.
//!
//! `squama status` reads these records to find files that were made from earlier tables.

use std::path::{Path, PathBuf};
use std::{fs, io};

use anyhow::Context as _;
use results::{Derivation, OutputError, ResultsFolder, VerifiedFolder, sha256};
use text::shell_word;

/// Number of hexadecimal digits of a SHA-256 in the name of a record.
const DIGITS: usize = 8;

/// Records that the files `names` in `folder` were made from the tables of `results`.
///
/// `product` is the kind of the files, such as `figures`. The record is written to the folder of
/// `results`.
pub fn record(
    results: &VerifiedFolder,
    product: &str,
    folder: &Path,
    names: &[impl AsRef<str>],
) -> anyhow::Result<()> {
    // `derive` returns `None` if the folder has no checksums of its tables. Without checksums,
    // later changes of the tables could not be detected.
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

/// Returns the path of `folder` relative to `results`; `None` if `folder` is not in `results`.
fn path_within(results: &Path, folder: &Path) -> Option<String> {
    // Resolve links, because a folder may have several paths.
    let (results, folder) = (absolute(results).ok()?, absolute(folder).ok()?);
    Some(folder.strip_prefix(results).ok()?.to_string_lossy().into_owned())
}

/// Returns the absolute path of a folder; an empty path is the working directory.
fn absolute(folder: &Path) -> io::Result<PathBuf> {
    fs::canonicalize(if folder.as_os_str().is_empty() { Path::new(".") } else { folder })
}

/// Returns the path under which the record lists the file `name` of `folder`.
///
/// `inside` is the path of `folder` relative to the results folder; the returned path is then
/// relative to the results folder, too. If `inside` is `None`, the returned path is absolute.
fn key(inside: Option<&str>, folder: &Path, name: &str) -> String {
    let path = match inside {
        // A relative path remains valid if the results folder is moved.
        Some(inside) => Path::new(inside).join(name),
        None => absolute(folder).unwrap_or_else(|_| folder.to_owned()).join(name),
    };
    path.to_string_lossy().into_owned()
}

/// Returns the name of a record: `product`, and digits of the hash of the path of the first file.
fn record_name(product: &str, derivation: &Derivation) -> String {
    let first = derivation.files.keys().next().map_or("", String::as_str);
    let digest = sha256(first);
    format!("{product}-{}", digest.get(..DIGITS).unwrap_or_default())
}
