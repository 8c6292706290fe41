//! Words of a shell, for commands that people copy.

/// `text` as one word of a POSIX shell; in quotes only where it needs them.
pub fn shell_word(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:,+@%=".contains(c);
    // An empty text would be no word at all without quotes.
    if !text.is_empty() && text.chars().all(plain) { text.to_owned() } else { quoted(text) }
}

/// `text` in quotes, as one word of a POSIX shell.
pub fn quoted(text: &str) -> String {
    // Between single quotes a shell obeys nothing, not even a backslash before a quote.
    format!("'{}'", text.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_a_shell_would_change_is_quoted() {
        let words = ["results/paper", "it's; rm -rf $HOME", "", "a b", "designs.base=[\"L\"]"];
        let quoted =
            ["results/paper", r"'it'\''s; rm -rf $HOME'", "''", "'a b'", "'designs.base=[\"L\"]'"];
        assert_eq!(words.map(shell_word), quoted);
    }
}
