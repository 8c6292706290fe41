//! Output for programs, or for people.

use std::io;
use std::path::Path;

use serde_json::Value;

/// Prints `value` as JSON.
pub fn print(value: &Value) -> io::Result<()> {
    // What people would not see is a part of a text for programs.
    crate::print::print_raw(&format!("{value:#}\n"))
}

/// Prints an answer: its record for programs, or its text for people with the files in a folder that it was written to.
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
