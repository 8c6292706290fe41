//! CSV formats: one for programs, one for spreadsheets with decimal commas.

use std::borrow::Cow;
use std::fmt;
use std::io::{self, Write};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Format of a CSV file.
///
/// Both formats follow RFC 4180 except for the separator: UTF-8, CR LF line ends, and quotes around
/// cells that need them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CsvFormat {
    /// Comma between cells, decimal point.
    #[default]
    Plain,
    /// Semicolon between cells, decimal comma, byte-order mark.
    ///
    /// Excel opens files in this format correctly in locales with a decimal comma.
    ExcelEu,
}

/// Error: a text is not the name of a CSV format.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is not a CSV format, expected plain or excel-eu")]
pub struct UnknownCsvFormat(String);

/// Byte-order mark of UTF-8.
const MARK: &[u8] = "\u{feff}".as_bytes();

/// Apostrophe before a text that a spreadsheet would otherwise evaluate as a formula.
// Spreadsheets hide this apostrophe, but other programs show it, so numbers are never marked.
const TEXT_MARK: char = '\'';

impl CsvFormat {
    /// All formats.
    pub const ALL: [Self; 2] = [Self::Plain, Self::ExcelEu];

    /// Returns the name of the format on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::ExcelEu => "excel-eu",
        }
    }

    /// Returns the first bytes of a file in this format.
    pub fn mark(self) -> &'static [u8] {
        match self {
            Self::Plain => &[],
            Self::ExcelEu => MARK,
        }
    }

    /// Creates a writer of cells in this format.
    pub fn writer<W: Write>(self, to: W) -> csv::Writer<W> {
        let mut csv = csv::WriterBuilder::new();
        csv.delimiter(self.delimiter()).terminator(csv::Terminator::CRLF);
        csv.from_writer(to)
    }

    fn delimiter(self) -> u8 {
        match self {
            Self::Plain => b',',
            Self::ExcelEu => b';',
        }
    }

    /// Returns the text `cell` as it is written in a file of this format.
    ///
    /// An apostrophe marks texts that a spreadsheet would evaluate as formulas. [`Self::text`]
    /// removes this mark.
    pub fn cell(self, cell: &str) -> Cow<'_, str> {
        if needs_mark(cell) {
            return format!("{TEXT_MARK}{cell}").into();
        }
        // Keep the decimal points in texts: `solver.max_step=0,01` would not be a valid setting.
        let is_decimal = self == Self::ExcelEu && cell.contains('.') && is_number(cell);
        if is_decimal { cell.replace('.', ",").into() } else { cell.into() }
    }

    /// Returns the text of the written `cell` without the mark that [`Self::cell`] adds.
    pub fn text(cell: &str) -> &str {
        cell.strip_prefix(TEXT_MARK).filter(|text| needs_mark(text)).unwrap_or(cell)
    }

    /// Detects the format of a file and the offset of its text from the first bytes.
    ///
    /// The separator in the header decides, because a spreadsheet may add or remove the byte-order
    /// mark with either separator.
    pub fn detect(beginning: &[u8]) -> (Self, usize) {
        let start = if beginning.starts_with(MARK) { MARK.len() } else { 0 };
        let header = beginning[start..].split(|byte| matches!(byte, b'\r' | b'\n')).next();
        let header = header.unwrap_or_default();
        // A header of one cell has no separator. Then the byte-order mark decides, because squama
        // writes this mark only in the format for spreadsheets.
        let is_plain = header.contains(&b',') || (start == 0 && !header.contains(&b';'));
        (if is_plain { Self::Plain } else { Self::ExcelEu }, start)
    }

    /// Creates a reader of text in this format.
    pub fn reader<R: io::Read>(self, text: R) -> csv::Reader<R> {
        csv::ReaderBuilder::new().delimiter(self.delimiter()).from_reader(text)
    }

    /// Returns the number in a cell of a file in this format.
    pub fn number(self, cell: &str) -> Option<f64> {
        let plain = match self {
            Self::Plain => Cow::from(cell),
            Self::ExcelEu => cell.replace(',', ".").into(),
        };
        is_number(&plain).then(|| plain.parse().ok()).flatten()
    }
}

/// Returns true for a number in digits; `inf` and `nan` count as words.
fn is_number(cell: &str) -> bool {
    cell.ends_with(|c: char| c.is_ascii_digit()) && cell.parse::<f64>().is_ok_and(f64::is_finite)
}

/// Returns true for a text that a spreadsheet evaluates, or that looks like a marked text.
fn needs_mark(cell: &str) -> bool {
    let text = cell.trim_start_matches(TEXT_MARK);
    // A single sign, such as `-` for a missing unit, is not evaluated.
    text.len() > 1 && text.starts_with(['=', '+', '-', '@', '\t', '\r']) && !is_number(text)
}

impl FromStr for CsvFormat {
    type Err = UnknownCsvFormat;

    fn from_str(text: &str) -> Result<Self, UnknownCsvFormat> {
        let known = Self::ALL.into_iter().find(|format| format.name() == text);
        known.ok_or_else(|| UnknownCsvFormat(text.to_owned()))
    }
}

impl fmt::Display for CsvFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_numbers_are_written_with_a_decimal_comma() {
        let cells = ["0.3", "1e-7", "1.5e-12", "0417", "solver.max_step=0.01", "complete", ""];
        let written = cells.map(|cell| CsvFormat::ExcelEu.cell(cell).into_owned());
        assert_eq!(
            written,
            ["0,3", "1e-7", "1,5e-12", "0417", "solver.max_step=0.01", "complete", ""]
        );
        assert_eq!(cells.map(|cell| CsvFormat::Plain.cell(cell).into_owned()), cells);
    }

    #[test]
    fn texts_that_spreadsheets_evaluate_are_marked_and_read_back() {
        for text in ["=1+1", "+cmd", "-x", "@sum", "\t=1", "\r=1", "'=1", "''-x", "-1.5 to 2"] {
            for format in CsvFormat::ALL {
                let written = format.cell(text).into_owned();
                assert_eq!(written, format!("'{text}"));
                assert_eq!(CsvFormat::text(&written), text);
            }
        }
        for text in ["", "-", "-0.5", "+3", "-1e-7", "'tis", "a=b", "=", "'", "x"] {
            assert_eq!(CsvFormat::Plain.cell(text), text);
            assert_eq!(CsvFormat::text(text), text);
        }
        assert_eq!(CsvFormat::ExcelEu.cell("-0.5"), "-0,5");
        assert_eq!(CsvFormat::text("-0,5"), "-0,5");
    }

    #[test]
    fn the_header_determines_the_format_with_and_without_a_mark() {
        use CsvFormat::{ExcelEu, Plain};
        let of = |text: &str| CsvFormat::detect(text.as_bytes());
        assert_eq!(of("design,gap\r\n1,\"2;3\""), (Plain, 0));
        assert_eq!(of("design;gap\r\n1;2,3"), (ExcelEu, 0));
        assert_eq!(of("\u{feff}design,gap\r\n1;2"), (Plain, 3));
        assert_eq!(of("\u{feff}design;gap\r\n1;2,3"), (ExcelEu, 3));
        assert_eq!((of("design\r\n1"), of("\u{feff}design\r\n1")), ((Plain, 0), (ExcelEu, 3)));
        assert_eq!(of(""), (Plain, 0));
    }

    #[test]
    fn numbers_are_read_back() {
        assert_eq!(CsvFormat::ExcelEu.number("0,3"), Some(0.3));
        assert_eq!(CsvFormat::Plain.number("0.3"), Some(0.3));
        for word in ["", "nan", "inf", "2L", "complete"] {
            assert_eq!(CsvFormat::Plain.number(word), None);
        }
    }
}
