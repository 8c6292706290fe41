//! Templates of HTML pages: placeholders, and the text and data that fill them.

use std::io::{self, Write};

use serde::Serialize;
use text::visible;

/// The script with basic functions for HTML elements, which every page contains.
pub(crate) const ELEMENTS: &str = include_str!("../assets/page/scripts/elements.js");

/// Writes `template` to `out`, and calls `filled` to write each placeholder `{{place}}`.
pub(crate) fn fill<W: Write>(
    out: &mut W,
    template: &str,
    mut filled: impl FnMut(&mut W, &str) -> io::Result<()>,
) -> io::Result<()> {
    let mut parts = template.split("{{");
    out.write_all(parts.next().unwrap_or_default().as_bytes())?;
    for part in parts {
        let (place, text) = part.split_once("}}").unwrap_or((part, ""));
        filled(out, place)?;
        out.write_all(text.as_bytes())?;
    }
    Ok(())
}

/// Writes the title of a page if `place` is `title`, otherwise the version of the program.
pub(crate) fn fill_head(
    out: &mut impl Write,
    place: &str,
    title: &str,
    version: &str,
) -> io::Result<()> {
    let text = if place == "title" { escaped(&visible(title)) } else { escaped(version) };
    out.write_all(text.as_bytes())
}

/// Writes data as JSON, with `<` escaped, so that the data cannot end the script element.
pub(crate) fn fill_json(out: &mut impl Write, data: &impl Serialize) -> io::Result<()> {
    out.write_all(serde_json::to_string(data)?.replace('<', "\\u003c").as_bytes())
}

/// Escapes text for elements and attributes of HTML.
pub(crate) fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    text.replace('"', "&quot;").replace('\'', "&#39;")
}
