//! The content of a table, column by column, before it is written as a sheet.

use csv::StringRecord;
use results::CsvFormat;

/// The facts about a column once all its cells have been seen.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ColumnProfile {
    /// Characters of the longest text.
    text: usize,
    /// Cells that are numbers.
    numbers: u32,
    /// The smallest and the largest number.
    span: Option<(f64, f64)>,
    /// The smallest size of a number that is not 0.
    smallest: Option<f64>,
    /// Whether there are fractions.
    has_fractions: bool,
    /// Decimals of the number that has most, as it is written.
    decimals: usize,
}

/// Decimals with which numbers are still shown as they are written: what has more is measured.
const WRITTEN: usize = 4;
/// Digits that the smallest number of a column shows.
const DIGITS: i32 = 3;
/// Decimals that a column shows, at most; what needs more is shown as a power of ten.
const MOST_DECIMALS: i32 = 6;
/// A number below this part of the largest one of its column is round-off.
const ROUND_OFF: f64 = 1e-9;

impl ColumnProfile {
    /// The profiles of the columns of a table, from all its rows.
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
        // Decimals stand behind a comma in tables of the other format.
        let decimals = cell.split(['.', ',']).nth(1).map_or(0, str::len);
        // Nobody writes a power of ten by hand: the column is measured.
        self.decimals = self.decimals.max(if cell.contains('e') { usize::MAX } else { decimals });
    }

    /// The largest size of a number.
    fn largest(&self) -> f64 {
        self.span.map_or(0.0, |(low, high)| low.abs().max(high.abs()))
    }

    /// The smallest size of a number that is more than round-off.
    fn least(&self) -> f64 {
        let smallest = self.smallest.unwrap_or(1.0);
        if smallest < ROUND_OFF * self.largest() { self.largest() } else { smallest }
    }

    /// How numbers of the column are shown, in the notation of spreadsheets: digits that a person needs, and none that are
    /// round-off. The cells hold all digits.
    pub fn number_format(&self) -> String {
        let decimals = DIGITS - 1 - self.least().log10().floor() as i32;
        // Spreadsheets keep fifteen digits.
        if !self.has_fractions && self.largest() < 1e15 {
            "0".to_owned()
        } else if self.decimals <= WRITTEN {
            format!("0.{}", "0".repeat(self.decimals))
        } else if decimals <= MOST_DECIMALS {
            // At least one: there are fractions.
            format!("0.{}", "0".repeat(decimals.max(1) as usize))
        } else {
            self.scientific()
        }
    }

    /// Powers of ten, in which what is round-off against the rest of the column is 0.
    fn scientific(&self) -> String {
        let is_positive = self.span.is_none_or(|(low, _)| low >= 0.0);
        let round_off = ROUND_OFF * self.largest();
        // Most of a column over decades can be read as it is; what is small keeps its digits by a power of ten.
        let is_plain = is_positive && self.largest() < 1e5;
        let digits = if is_plain { "[<0.001]0.000E+00;0.0000" } else { "0.000E+00" };
        if is_positive && round_off > 0.0 && self.smallest.is_some_and(|least| least < round_off) {
            // As a decimal fraction of one digit: conditions of formats know no powers of ten.
            let limit: f64 = format!("{round_off:.0e}").parse().unwrap_or(round_off);
            format!("[<{limit}]0;{digits}")
        } else {
            digits.to_owned()
        }
    }

    /// Characters that the widest cell takes as it is shown.
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
    fn numbers_show_what_a_person_needs() {
        let format = |cells: &[&str]| profile(cells).number_format();
        assert_eq!(format(&["1", "800", "12"]), "0");
        assert_eq!(format(&["0.025", "0.1", "1"]), "0.000");
        assert_eq!(format(&["0.7999999996252686", "0.5"]), "0.000");
        assert_eq!(format(&["22.412345678", "0.00291427547"]), "0.00000");
        assert_eq!(format(&["22.4", "0.00000291427547"]), "[<0.001]0.000E+00;0.0000");
        assert_eq!(format(&["0.3333", "2.9e-9"]), "[<0.001]0.000E+00;0.0000");
        assert_eq!(format(&["-22.4", "0.00000291427547"]), "0.000E+00");
        assert_eq!(format(&["0.12345678", "7.9e-27"]), "0.000");
        assert_eq!(
            format(&["1.5e-7", "7.9e-27"]),
            "[<0.0000000000000001]0;[<0.001]0.000E+00;0.0000"
        );
        assert_eq!(format(&["-1.5e-7", "7.9e-27"]), "0.000E+00");
    }

    #[test]
    fn columns_are_as_wide_as_what_they_show() {
        assert_eq!(profile(&["0.7999999996252686", "-12.3"]).width(), "-12.300".len());
        assert_eq!(profile(&["no convergence", ""]).width(), 14);
        assert_eq!(profile(&["1", "800"]).width(), 3);
        assert_eq!(profile(&["1.5e-9"]).width(), 10);
    }
}
