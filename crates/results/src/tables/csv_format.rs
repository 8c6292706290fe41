//! How tables are written for the spreadsheets of different countries.

use std::borrow::Cow;
use std::fmt;
use std::io::{self, Write};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// How a CSV file is written. All of it is RFC 4180 but for the separator: UTF-8, lines that end
/// with CR LF, quotes where a cell needs them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Dialect {
    /// A comma between cells, a point in decimals.
    #[default]
    Plain,
    /// A semicolon between cells, a comma in decimals, a byte-order mark: what Excel opens right
    /// where the comma is the decimal sign.
    ExcelEu,
}

/// A text that names no dialect.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is no dialect, expected plain or excel-eu")]
pub struct NoDialect(String);

/// Says that a file is UTF-8.
const MARK: &[u8] = "\u{feff}".as_bytes();

impl Dialect {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Plain, Self::ExcelEu];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::ExcelEu => "excel-eu",
        }
    }

    /// A writer of such a file.
    ///
    /// # Errors
    /// If the file does not take its first bytes.
    pub fn writer<W: Write>(self, mut file: W) -> io::Result<csv::Writer<W>> {
        if self == Self::ExcelEu {
            file.write_all(MARK)?;
        }
        let mut csv = csv::WriterBuilder::new();
        csv.delimiter(self.delimiter()).terminator(csv::Terminator::CRLF);
        Ok(csv.from_writer(file))
    }

    fn delimiter(self) -> u8 {
        match self {
            Self::Plain => b',',
            Self::ExcelEu => b';',
        }
    }

    /// A cell as it stands in such a file.
    pub fn cell(self, cell: &str) -> Cow<'_, str> {
        let is_decimal = self == Self::ExcelEu && cell.contains('.') && is_number(cell);
        if is_decimal { cell.replace('.', ",").into() } else { cell.into() }
    }

    /// The dialect of a file that begins so, and where its text begins.
    pub fn of(beginning: &[u8]) -> (Self, usize) {
        if beginning.starts_with(MARK) { (Self::ExcelEu, MARK.len()) } else { (Self::Plain, 0) }
    }

    /// A reader of the text of such a file.
    pub fn reader<R: io::Read>(self, text: R) -> csv::Reader<R> {
        csv::ReaderBuilder::new().delimiter(self.delimiter()).from_reader(text)
    }

    /// The number that a cell of such a file holds.
    pub fn number(self, cell: &str) -> Option<f64> {
        let plain = match self {
            Self::Plain => Cow::from(cell),
            Self::ExcelEu => cell.replace(',', ".").into(),
        };
        is_number(&plain).then(|| plain.parse().ok()).flatten()
    }
}

/// Whether it is a number in digits: `inf` and `nan` are words.
fn is_number(cell: &str) -> bool {
    cell.ends_with(|c: char| c.is_ascii_digit()) && cell.parse::<f64>().is_ok_and(f64::is_finite)
}

impl FromStr for Dialect {
    type Err = NoDialect;

    fn from_str(text: &str) -> Result<Self, NoDialect> {
        let known = Self::ALL.into_iter().find(|dialect| dialect.name() == text);
        known.ok_or_else(|| NoDialect(text.to_owned()))
    }
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_numbers_take_the_decimal_comma() {
        let cells = ["0.3", "1e-7", "1.5e-12", "0417", "solver.max_step=0.01", "complete", ""];
        let written = cells.map(|cell| Dialect::ExcelEu.cell(cell).into_owned());
        assert_eq!(
            written,
            ["0,3", "1e-7", "1,5e-12", "0417", "solver.max_step=0.01", "complete", ""]
        );
        assert_eq!(cells.map(|cell| Dialect::Plain.cell(cell).into_owned()), cells);
    }

    #[test]
    fn numbers_are_read_back() {
        assert_eq!(Dialect::ExcelEu.number("0,3"), Some(0.3));
        assert_eq!(Dialect::Plain.number("0.3"), Some(0.3));
        for word in ["", "nan", "inf", "2L", "complete"] {
            assert_eq!(Dialect::Plain.number(word), None);
        }
    }
}
