//! Prepares text for messages: escapes, shortens and joins it.

use std::borrow::Cow;

/// Number of characters of a message that [`shortened`] keeps.
const LONGEST: usize = 600;

/// Number of characters kept at the end of a shortened message.
///
/// The end of an error message states the expected value.
const END: usize = 250;

/// Escapes the characters that a terminal or a browser would interpret.
pub fn visible(text: &str) -> Cow<'_, str> {
    // Most texts have no such characters, so they are not copied.
    if !text.contains(is_hidden) {
        return text.into();
    }
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        if is_hidden(c) {
            escaped.extend(c.escape_unicode());
        } else {
            escaped.push(c);
        }
    }
    escaped.into()
}

/// Returns true for invisible characters, except the newline.
///
/// Invisible characters are control characters, zero-width characters, line and paragraph
/// separators, and the direction marks of Unicode's bidirectional algorithm (UAX 9).
fn is_hidden(c: char) -> bool {
    (c.is_control() && c != '\n')
        || matches!(c, '\u{61c}' | '\u{200b}' | '\u{200e}' | '\u{200f}' | '\u{feff}')
        || matches!(c, '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Replaces the middle of a long message with the number of omitted characters.
pub fn shortened(message: &str) -> Cow<'_, str> {
    // Count characters, not bytes: slicing at a byte offset within a character panics.
    let count = message.chars().count();
    if count <= LONGEST {
        return message.into();
    }
    let begin: String = message.chars().take(LONGEST - END).collect();
    let end: String = message.chars().skip(count - END).collect();
    format!("{begin} … {} more characters … {end}", count - LONGEST).into()
}

/// Joins the lines of `message`, without surrounding spaces, with commas.
pub fn one_line(message: &str) -> String {
    message.lines().map(str::trim).collect::<Vec<_>>().join(", ")
}

/// Returns the message of an operating system error without `(os error N)`.
pub fn reason(error: &std::io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error").next().unwrap_or(&text).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invisible_characters_are_escaped() {
        let texts = ["größe 1\n", "a\u{202e}b", "\u{1b}[31mred", "tab\there"];
        let shown = ["größe 1\n", "a\\u{202e}b", "\\u{1b}[31mred", "tab\\u{9}here"];
        assert_eq!(texts.map(visible), shown);
    }

    #[test]
    fn a_shortened_message_keeps_both_ends() {
        let message = format!("x.toml:1: name: {}, expected a name", "a".repeat(100_000));
        let short = shortened(&message);
        assert!(short.starts_with("x.toml:1: name: aaa") && short.ends_with("a, expected a name"));
        assert!(short.contains("… 99433 more characters …"), "{short}");
        assert_eq!(shortened("short"), "short");
    }
}
