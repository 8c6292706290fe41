//! Texts as they are shown to people: nothing in them is hidden, turns the line around or fills the screen.

use std::borrow::Cow;

/// Characters of a message, at most.
const LONGEST: usize = 600;

/// Characters at the end of a message that is cut, where it says what would be right.
const END: usize = 250;

/// `text` with the characters escaped that a terminal or a page would obey instead of showing them.
pub fn visible(text: &str) -> Cow<'_, str> {
    // Nearly every text is as it should be, and is not copied.
    if !text.contains(is_hidden) {
        return text.into();
    }
    let shown = |c: char| if is_hidden(c) { c.escape_unicode().to_string() } else { c.to_string() };
    text.chars().map(shown).collect::<String>().into()
}

/// Whether a character controls the text around it: control characters but for the end of a line, the marks of writing
/// direction of Unicode's bidirectional algorithm (UAX 9), and what has no width.
fn is_hidden(c: char) -> bool {
    (c.is_control() && c != '\n')
        || matches!(c, '\u{61c}' | '\u{200b}' | '\u{200e}' | '\u{200f}' | '\u{feff}')
        || matches!(c, '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// A message of at most a few hundred characters: of a longer one the middle is left out and counted.
pub fn shortened(message: &str) -> Cow<'_, str> {
    // Characters, because cutting between the bytes of one would panic.
    let count = message.chars().count();
    if count <= LONGEST {
        return message.into();
    }
    let begin: String = message.chars().take(LONGEST - END).collect();
    let end: String = message.chars().skip(count - END).collect();
    format!("{begin} … {} more characters … {end}", count - LONGEST).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_seen_is_escaped() {
        let texts = ["größe 1\n", "a\u{202e}b", "\u{1b}[31mred", "tab\there"];
        let shown = ["größe 1\n", "a\\u{202e}b", "\\u{1b}[31mred", "tab\\u{9}here"];
        assert_eq!(texts.map(visible), shown);
    }

    #[test]
    fn a_long_message_keeps_both_ends() {
        let message = format!("x.toml:1: name: {}, expected a name", "a".repeat(100_000));
        let short = shortened(&message);
        assert!(short.starts_with("x.toml:1: name: aaa") && short.ends_with("a, expected a name"));
        assert!(short.contains("… 99433 more characters …"), "{short}");
        assert_eq!(shortened("short"), "short");
    }
}
