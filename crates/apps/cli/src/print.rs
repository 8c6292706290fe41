//! Formats and prints text for the terminal.

use std::fmt::Write as _;
use std::io::{self, ErrorKind, Write as _};
use std::time::Duration;

use results::VerifiedFolder;

/// Prints `text` with control characters escaped.
pub fn print(text: &str) -> io::Result<()> {
    // Folder names and the tables of other programs may contain control characters, which a
    // terminal would execute.
    print_raw(&text::visible(text))
}

/// Prints `text` unchanged; a closed pipe is not an error.
pub fn print_raw(text: &str) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    // Flush here, because Rust ignores an error of the flush at the end of the process.
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// Returns a line that states how many designs an incomplete run has.
///
/// The line is empty if the run is complete.
pub fn shortfall(results: &VerifiedFolder) -> String {
    results.shortfall().map_or_else(String::new, |designs| {
        format!("  made from {designs}, {}\n", results.path().display())
    })
}

/// Prints a note to stderr.
pub fn note(text: &str) {
    // Ignore a closed stderr: the results contain the same information.
    let _ = writeln!(io::stderr(), "note: {}", text::visible(text));
}

/// Mark of a design under which the surface of the substrate folds.
pub const FOLDED: char = '⚠';

/// Mark of a design that fails a check.
pub const FAILED: char = '✗';

/// Formats `sentences`, one per line, each after `mark` and a space.
pub fn marked(mark: char, sentences: &[String]) -> String {
    let mut text = String::new();
    for sentence in sentences {
        text.extend([&mark.to_string(), " ", sentence, "\n"]);
    }
    text
}

/// Prints a warning to stderr.
pub fn warning(text: &str) {
    // Ignore a closed stderr, because there is no other output for messages.
    let _ = writeln!(io::stderr(), "warning: {}", text::visible(text));
}

/// Aligns the columns of `rows` and indents each line by two spaces.
pub fn aligned<R: AsRef<[String]>>(rows: &[R]) -> String {
    let mut widths = Vec::new();
    for row in rows.iter().map(AsRef::as_ref) {
        widths.resize(widths.len().max(row.len()), 0);
        for (width, cell) in widths.iter_mut().zip(row) {
            // Count characters, not bytes: `×` has two bytes but is one character wide.
            *width = cell.chars().count().max(*width);
        }
    }
    let mut text = String::new();
    for row in rows.iter().map(AsRef::as_ref) {
        let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:width$}"));
        let _ = writeln!(text, "  {}", cells.collect::<Vec<_>>().join("  ").trim_end());
    }
    text
}

/// Formats `value` with five significant digits, including trailing zeros.
pub fn digits(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e5).contains(&size) {
        // The number of decimals is an integer from 0 to 7, so the conversion is exact.
        let decimals = (4.0 - size.log10().floor()).max(0.0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.4e}")
    }
}

/// Formats `value` with at most six significant digits, without trailing zeros.
pub fn rounded(value: f64) -> String {
    text::number::rounded(value, 6)
}

/// Formats a change in percent with its sign, never as `-0`.
pub fn change(percent: f64, decimals: usize) -> String {
    let unit = 10_f64.powi(-(decimals as i32));
    let rounded = (percent / unit).round() * unit + 0.0;
    format!("{rounded:+.decimals$} %")
}

/// Formats a duration in steps of 0.01 s below one minute, and of 1 s from one minute on.
pub fn time(duration: Duration) -> String {
    if duration < Duration::from_secs(60) {
        format!("{:.2} s", duration.as_secs_f64())
    } else {
        // Drop the fraction of a second, because `humantime` would print it in nanoseconds.
        humantime::format_duration(Duration::from_secs(duration.as_secs())).to_string()
    }
}

/// Formats `count` followed by the noun `thing` in the singular or plural.
pub fn counted(count: u64, thing: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {thing}{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_a_column_begin_at_the_same_position() {
        let rows = [["a", "1"], ["long", "2"]].map(|row| row.map(str::to_owned));
        assert_eq!(aligned(&rows), "  a     1\n  long  2\n");
    }

    #[test]
    fn rounded_numbers_show_no_round_off() {
        let numbers = [0.799_999_999_625_268_6, 0.1, 2.0, 8.479_998_7, -1.234_567_8e-9, 1e6];
        assert_eq!(numbers.map(rounded).join(" "), "0.8 0.1 2 8.48 -1.23457e-9 1000000");
    }

    #[test]
    fn numbers_have_five_significant_digits() {
        let numbers = [0.0, 0.7, 64.123_456, 12345.6, -0.001, 1.5e-7, 123_456.7];
        let texts = numbers.map(digits).join(" ");
        assert_eq!(texts, "0 0.70000 64.123 12346 -0.0010000 1.5000e-7 1.2346e5");
    }
}
