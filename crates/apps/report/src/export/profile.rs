//! Statistics of the columns of a table, collected before its sheet is written.

use csv::StringRecord;
use results::CsvFormat;

/// Statistics of the cells of a column.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ColumnProfile {
    /// Length of the longest text, characters.
    text: usize,
    /// Number of numeric cells.
    numbers: u32,
    /// The smallest and the largest number.
    span: Option<(f64, f64)>,
    /// The smallest nonzero magnitude.
    smallest: Option<f64>,
    /// True if any number is not whole.
    has_fractions: bool,
    /// Largest number of decimals in the table; `usize::MAX` for a number with a power of ten.
    decimals: usize,
}

/// A column with at most this many decimals is displayed as written.
///
/// Columns with more decimals hold computed values.
const WRITTEN: usize = 4;
/// Number of significant digits displayed for the smallest number of a column.
const DIGITS: i32 = 3;
/// Maximum number of decimals of a column; smaller numbers use powers of ten.
const MOST_DECIMALS: i32 = 6;
/// Numbers below this fraction of the largest one in their column are round-off.
const ROUND_OFF: f64 = 1e-9;

impl ColumnProfile {
    /// Adds a row to the profiles of the columns of its table.
    pub fn add(profiles: &mut [Self], format: CsvFormat, row: &StringRecord) {
        for (profile, cell) in profiles.iter_mut().zip(row).filter(|(_, cell)| !cell.is_empty()) {
            match format.number(cell) {
                Some(number) => profile.number(number, cell),
                None => profile.text = profile.text.max(cell.chars().count()),
            }
        }
    }

    fn number(&mut self, number: f64, cell: &str) {
        self.numbers += 1;
        let (low, high) = self.span.unwrap_or((number, number));
        self.span = Some((low.min(number), high.max(number)));
        let size = number.abs();
        if size > 0.0 {
            self.smallest = Some(self.smallest.map_or(size, |smallest| smallest.min(size)));
        }
        self.has_fractions |= number.fract() != 0.0;
        // Some tables have decimal commas.
        let decimals = cell.split(['.', ',']).nth(1).map_or(0, str::len);
        // Only computed values are written with powers of ten.
        self.decimals = self.decimals.max(if cell.contains('e') { usize::MAX } else { decimals });
    }

    /// Returns the largest magnitude.
    fn largest(&self) -> f64 {
        self.span.map_or(0.0, |(low, high)| low.abs().max(high.abs()))
    }

    /// Returns the smallest magnitude, or the largest magnitude if the smallest is round-off.
    fn least(&self) -> f64 {
        let smallest = self.smallest.unwrap_or(1.0);
        if smallest < ROUND_OFF * self.largest() { self.largest() } else { smallest }
    }

    /// Returns the number format of the column in the notation of spreadsheets.
    ///
    /// The format displays significant digits without round-off. The cells hold all digits.
    pub fn number_format(&self) -> String {
        let decimals = DIGITS - 1 - self.least().log10().floor() as i32;
        // Spreadsheets keep 15 digits, so whole numbers below 1e15 are exact.
        if !self.has_fractions && self.largest() < 1e15 {
            "0".to_owned()
        } else if self.decimals <= WRITTEN {
            format!("0.{}", "0".repeat(self.decimals))
        } else if decimals <= MOST_DECIMALS {
            // At least one decimal is displayed, because some numbers are not whole.
            format!("0.{}", "0".repeat(decimals.max(1) as usize))
        } else {
            self.scientific()
        }
    }

    /// Returns a format with powers of ten that shows round-off as 0.
    fn scientific(&self) -> String {
        let is_positive = self.span.is_none_or(|(low, _)| low >= 0.0);
        let round_off = ROUND_OFF * self.largest();
        // In a column over several decades, large values are legible as decimals, but small values
        // need powers of ten.
        let is_plain = is_positive && self.largest() < 1e5;
        let digits = if is_plain { "[<0.001]0.000E+00;0.0000" } else { "0.000E+00" };
        if is_positive && round_off > 0.0 && self.smallest.is_some_and(|least| least < round_off) {
            // Conditions in formats accept no powers of ten, so write one digit as a decimal
            // fraction.
            let limit: f64 = format!("{round_off:.0e}").parse().unwrap_or(round_off);
            format!("[<{limit}]0;{digits}")
        } else {
            digits.to_owned()
        }
    }

    /// Returns the width of the widest cell as displayed, characters.
    pub fn width(&self) -> usize {
        let format = self.number_format();
        let number = if format.contains('E') {
            "-0.000E+00".len()
        } else {
            let whole = self.largest().max(1.0).log10().floor() as usize + 1;
            let sign = usize::from(self.span.is_some_and(|(low, _)| low < 0.0));
            sign + whole + format.len() - 1
        };
        self.text.max(if self.numbers > 0 { number } else { 0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(cells: &[&str]) -> ColumnProfile {
        let mut profile = [ColumnProfile::default()];
        for cell in cells {
            ColumnProfile::add(&mut profile, CsvFormat::Plain, &StringRecord::from(vec![*cell]));
        }
        profile[0].clone()
    }

    #[test]
    fn number_formats_show_significant_digits() {
        for (cells, format) in [
            (&["1", "800", "12"][..], "0"),
            (&["0.025", "0.1", "1"], "0.000"),
            (&["0.7999999996252686", "0.5"], "0.000"),
            (&["22.412345678", "0.00291427547"], "0.00000"),
            (&["22.4", "0.00000291427547"], "[<0.001]0.000E+00;0.0000"),
            (&["0.3333", "2.9e-9"], "[<0.001]0.000E+00;0.0000"),
            (&["-22.4", "0.00000291427547"], "0.000E+00"),
            (&["0.12345678", "7.9e-27"], "0.000"),
            (&["1.5e-7", "7.9e-27"], "[<0.0000000000000001]0;[<0.001]0.000E+00;0.0000"),
            (&["-1.5e-7", "7.9e-27"], "0.000E+00"),
        ] {
            assert_eq!(profile(cells).number_format(), format, "{cells:?}");
        }
    }

    #[test]
    fn column_widths_fit_displayed_cells() {
        assert_eq!(profile(&["0.7999999996252686", "-12.3"]).width(), "-12.300".len());
        assert_eq!(profile(&["no convergence", ""]).width(), 14);
        assert_eq!(profile(&["1", "800"]).width(), 3);
        assert_eq!(profile(&["1.5e-9"]).width(), 10);
    }
}
