//! A record of each thing that a command makes from the tables of a folder, kept there so that `squama status` can tell when it is out of date.

use std::path::{Path, PathBuf};
use std::{fs, io};

use anyhow::Context as _;
use results::{Derivation, OutputError, RunFolder, VerifiedFolder, sha256, shell_word};

/// Digits of the SHA-256 of a path that tell records apart.
const DIGITS: usize = 8;

/// Notes in the folder `results` that the files `names` in `folder` are a `product` of its tables, made by the command that
/// this process is.
pub fn record(
    results: &VerifiedFolder,
    product: &str,
    folder: &Path,
    names: &[impl AsRef<str>],
) -> anyhow::Result<()> {
    // Without a statement of the tables nobody could tell later whether they have changed.
    let Some(mut derivation) = Derivation::of(results, product, command()) else { return Ok(()) };
    let inside = path_within(results.path(), folder);
    for name in names.iter().map(AsRef::as_ref) {
        let path = folder.join(name);
        let bytes =
            fs::read(&path).with_context(|| format!("{}: cannot be read", path.display()))?;
        derivation.files.insert(key(inside.as_deref(), folder, name), sha256(bytes));
    }
    // Readers check the tables of a ranking by this one record; one that was written elsewhere is
    // a product like others.
    let is_ranking = product == RunFolder::RANKING_RECORD && inside.as_deref() == Some("");
    let record = if is_ranking { product.to_owned() } else { record_name(product, &derivation) };
    let written = derivation.write(&RunFolder::new(results.path()), &record);
    // Results that belong to somebody else can be used all the same.
    written.or_else(|error: OutputError| if inside.is_some() { Err(error.into()) } else { Ok(()) })
}

/// The command that this process is, as a shell takes it.
fn command() -> String {
    // A name that is no text is told as it is shown.
    let words = std::env::args_os().skip(1).map(|word| shell_word(&word.to_string_lossy()));
    std::iter::once("squama".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// The path of `folder` from within the folder `results`, if it is inside of it.
fn path_within(results: &Path, folder: &Path) -> Option<String> {
    // Links are resolved, since a folder may be named in one way here and in another there.
    let (results, folder) = (absolute(results).ok()?, absolute(folder).ok()?);
    Some(folder.strip_prefix(results).ok()?.to_string_lossy().into_owned())
}

/// The absolute path of a folder; without a name it is the one that we are in.
fn absolute(folder: &Path) -> io::Result<PathBuf> {
    fs::canonicalize(if folder.as_os_str().is_empty() { Path::new(".") } else { folder })
}

/// The name of a file in the record: from within the results, or its whole path.
fn key(inside: Option<&str>, folder: &Path, name: &str) -> String {
    let path = match inside {
        // A record without the path of its folder still holds where that is moved to.
        Some(place) => Path::new(place).join(name),
        None => absolute(folder).unwrap_or_else(|_| folder.to_owned()).join(name),
    };
    path.to_string_lossy().into_owned()
}

/// The name of the record of a product, which depends on where its first file is.
fn record_name(product: &str, derivation: &Derivation) -> String {
    let first = derivation.files.keys().next().map_or("", String::as_str);
    let digest = sha256(first);
    format!("{product}-{}", digest.get(..DIGITS).unwrap_or_default())
}
