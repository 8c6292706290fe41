//! JSON output.

use std::io;
use std::path::Path;

use serde_json::{Map, Value};
use sweep::JudgedModes;

/// Prints `value` as JSON.
pub fn print(value: &Value) -> io::Result<()> {
    // Not escaped: control characters are data for a program.
    crate::print::print_raw(&format!("{value:#}\n"))
}

/// Prints the result of a command as JSON, or as text followed by its files.
pub fn answer(
    is_json: bool,
    record: impl FnOnce() -> Value,
    text: impl FnOnce() -> String,
    (folder, files): (&Path, &[impl AsRef<str>]),
) -> io::Result<()> {
    if is_json {
        return print(&record());
    }
    let files: Vec<_> = files.iter().map(AsRef::as_ref).collect();
    crate::print::print(&format!("{}\n{}: {}\n", text(), folder.display(), files.join(" ")))
}

/// Returns the failure modes as JSON.
///
/// Each mode has the reason for which it is not judged, or null.
pub fn failure_modes(modes: &JudgedModes) -> Value {
    modes
        .reasons()
        .map(|(mode, reason)| (mode.to_owned(), reason.into()))
        .collect::<Map<_, _>>()
        .into()
}
