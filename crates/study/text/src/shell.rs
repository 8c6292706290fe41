//! Quotes words for a POSIX shell, in commands that users copy.

/// Returns `text` as one word of a POSIX shell, quoted only if necessary.
pub fn shell_word(text: &str) -> String {
    // An empty text needs quotes: the shell would otherwise drop the argument.
    if !text.is_empty() && text.chars().all(is_plain) {
        text.to_owned()
    } else {
        shell_quoted(text)
    }
}

/// Returns true for characters without a special meaning in a shell.
fn is_plain(c: char) -> bool {
    c.is_ascii_alphanumeric() || "-_./:,+@%=".contains(c)
}

/// Returns `text` in single quotes, as one word of a POSIX shell.
pub fn shell_quoted(text: &str) -> String {
    // A shell interprets nothing between single quotes, not even a backslash.
    format!("'{}'", text.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_only_if_a_shell_would_change_them() {
        let words = ["results/paper", "it's; rm -rf $HOME", "", "a b", "designs.base=[\"L\"]"];
        let quoted =
            ["results/paper", r"'it'\''s; rm -rf $HOME'", "''", "'a b'", "'designs.base=[\"L\"]'"];
        assert_eq!(words.map(shell_word), quoted);
    }
}
