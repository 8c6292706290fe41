//! Text for people.

use std::io::{self, ErrorKind, Write as _};
use std::time::Duration;

use results::VerifiedFolder;

/// Prints `text` for people.
pub fn print(text: &str) -> io::Result<()> {
    // A terminal would obey control characters in the name of a folder or in a table of others.
    print_raw(&sweep::visible(text))
}

/// Prints `text` as it is. A reader that has seen enough and closed the pipe is no error.
pub fn print_raw(text: &str) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    // Flushed here, because at the end of the process nobody is left to tell of an error.
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// A line that says how much of a run the results hold, if they are not the whole.
pub fn shortfall(results: &VerifiedFolder) -> String {
    let line = |held| format!("  made from {held}, {}\n", results.path().display());
    results.shortfall().map_or_else(String::new, line)
}

/// Says what a person should know besides what was asked for.
pub fn note(text: &str) {
    // With nowhere left to say it, the results say it too.
    let _ = writeln!(io::stderr(), "note: {}", sweep::visible(text));
}

/// `rows` with their columns aligned, each line indented by two spaces.
pub fn aligned<R: AsRef<[String]>>(rows: &[R]) -> String {
    let mut widths = Vec::new();
    for row in rows.iter().map(AsRef::as_ref) {
        widths.resize(widths.len().max(row.len()), 0);
        for (width, cell) in widths.iter_mut().zip(row) {
            // Characters, not bytes: `×` takes one column.
            *width = cell.chars().count().max(*width);
        }
    }
    let line = |row: &R| {
        let cells = row.as_ref().iter().zip(&widths).map(|(cell, width)| format!("{cell:width$}"));
        let cells: Vec<_> = cells.collect();
        format!("  {}\n", cells.join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

/// `value` to five digits.
pub fn digits(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e5).contains(&size) {
        // At most 7 decimals, so the conversion keeps the value.
        let decimals = (4.0 - size.log10().floor()).max(0.0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.4e}")
    }
}

/// `value` to six digits, without the zeros at its end.
pub fn rounded(value: f64) -> String {
    sweep::number::rounded(value, 6)
}

/// A change of `percent` with its sign and so many decimals, never `-0`.
pub fn change(percent: f64, decimals: usize) -> String {
    let unit = 10_f64.powi(-(decimals as i32));
    let rounded = (percent / unit).round() * unit + 0.0;
    format!("{rounded:+.decimals$} %")
}

/// `duration` to the hundredth of a second, or to the second if it is long.
pub fn time(duration: Duration) -> String {
    if duration < Duration::from_secs(60) {
        format!("{:.2} s", duration.as_secs_f64())
    } else {
        // Otherwise `humantime` tells a long time to the nanosecond.
        humantime::format_duration(Duration::from_secs(duration.as_secs())).to_string()
    }
}

/// `count` things, in words.
pub fn counted(count: u64, thing: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {thing}{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let rows = [["a", "1"], ["long", "2"]].map(|row| row.map(str::to_owned));
        assert_eq!(aligned(&rows), "  a     1\n  long  2\n");
    }

    #[test]
    fn round_off_is_not_shown() {
        let numbers = [0.799_999_999_625_268_6, 0.1, 2.0, 8.479_998_7, -1.234_567_8e-9, 1e6];
        assert_eq!(numbers.map(rounded).join(" "), "0.8 0.1 2 8.48 -1.23457e-9 1000000");
    }

    #[test]
    fn numbers_have_five_digits() {
        let numbers = [0.0, 0.7, 64.123_456, 12345.6, -0.001, 1.5e-7, 123_456.7];
        let texts = numbers.map(digits).join(" ");
        assert_eq!(texts, "0 0.70000 64.123 12346 -0.0010000 1.5000e-7 1.2346e5");
    }
}
