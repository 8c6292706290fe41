//! Prints results as JSON.

use std::io;
use std::path::Path;

use serde_json::{Map, Value};
use sweep::JudgedModes;

/// Prints `value` as JSON.
pub fn print(value: &Value) -> io::Result<()> {
    // Do not escape control characters with `text::visible`: programs need the unchanged data.
    crate::print::print_raw(&format!("{value:#}\n"))
}

/// Prints the result of a command: `record` as JSON, or `text` followed by the written files.
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

/// Returns a JSON object with a key for each failure mode.
///
/// The value is null if the mode is judged, otherwise the reason why it is not judged.
pub fn failure_modes(modes: &JudgedModes) -> Value {
    modes
        .reasons()
        .map(|(mode, reason)| (mode.to_owned(), reason.into()))
        .collect::<Map<_, _>>()
        .into()
}
