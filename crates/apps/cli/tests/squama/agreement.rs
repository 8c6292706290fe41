//! Compares two pages: words must be equal, and computed numbers equal up to round-off.
//!
//! A number with a decimal point and at least three digits or an exponent counts as computed. The
//! last digit of a computed number may differ by one, because machines round differently. All other
//! numbers (designs, settings, bands, years, counts) must be equal.

use std::iter::{from_fn, zip};

/// A part of a line: a number, or the words between two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Piece<'t> {
    Words(&'t str),
    Number(Number<'t>),
}

/// A number as written.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Number<'t> {
    text: &'t str,
    value: f64,
    /// Number of digits after the decimal point.
    decimals: usize,
    /// Number of significant digits.
    significant: usize,
    /// Power of ten after `e`; `None` if the number has no exponent.
    exponent: Option<i32>,
}

impl<'t> Number<'t> {
    fn new(text: &'t str) -> Self {
        let (mantissa, exponent) = match text.split_once('e') {
            Some((mantissa, exponent)) => (mantissa, Some(exponent.parse().expect("an exponent"))),
            None => (text, None),
        };
        let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
        Self {
            text,
            value: text.parse().expect("a number"),
            decimals: mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len()),
            significant: digits.trim_start_matches('0').len(),
            exponent,
        }
    }

    /// Returns true if the number counts as computed, so that its last digit may differ.
    fn computed(&self) -> bool {
        self.decimals > 0 && (self.exponent.is_some() || self.significant >= 3)
    }

    /// Returns the value of one unit in the last digit.
    fn unit(&self) -> f64 {
        10_f64.powi(self.exponent.unwrap_or(0) - self.decimals as i32)
    }

    /// Returns true if two numbers are equal.
    ///
    /// Two computed numbers may differ by one unit in the last digit.
    fn agrees(&self, other: &Self) -> bool {
        if !(self.computed() && other.computed()) {
            return self.text == other.text;
        }
        let alike = self.decimals == other.decimals || self.significant == other.significant;
        let difference = (self.value - other.value).abs();
        // Allow 1.5 units: the difference of two decimal fractions has a rounding error, so the
        // limit must not be exactly one unit.
        alike && difference < 1.5 * self.unit().max(other.unit())
    }
}

/// Returns the length of the number at the start of `text`; 0 if there is none.
fn number_length(text: &str) -> usize {
    let sign = usize::from(text.starts_with(['+', '-']));
    let whole = leading_digits(&text[sign..]);
    if whole == 0 {
        return 0;
    }
    let mut length = sign + whole;
    if let Some(rest) = text[length..].strip_prefix('.') {
        let decimals = leading_digits(rest);
        length += if decimals > 0 { 1 + decimals } else { 0 };
    }
    if let Some(rest) = text[length..].strip_prefix('e') {
        let sign = usize::from(rest.starts_with(['+', '-']));
        let exponent = leading_digits(&rest[sign..]);
        length += if exponent > 0 { 1 + sign + exponent } else { 0 };
    }
    length
}

/// Returns the number of digits at the start of `text`.
fn leading_digits(text: &str) -> usize {
    text.bytes().take_while(u8::is_ascii_digit).count()
}

/// Splits a line into words and numbers.
fn pieces(mut line: &str) -> impl Iterator<Item = Piece<'_>> {
    from_fn(move || {
        let length = number_length(line);
        let (piece, rest) = if length > 0 {
            (Piece::Number(Number::new(&line[..length])), &line[length..])
        } else {
            let next =
                line.char_indices().map(|(at, _)| at).find(|&at| number_length(&line[at..]) > 0);
            let (words, rest) = line.split_at(next.unwrap_or(line.len()));
            (Piece::Words(words), rest)
        };
        (!line.is_empty()).then(|| line = rest).map(|()| piece)
    })
}

/// Returns true if two lines have equal words and numbers that agree.
fn lines_agree(ours: &str, theirs: &str) -> bool {
    let (ours, theirs): (Vec<_>, Vec<_>) = (pieces(ours).collect(), pieces(theirs).collect());
    ours.len() == theirs.len()
        && zip(&ours, &theirs).all(|pair| match pair {
            (Piece::Number(ours), Piece::Number(theirs)) => ours.agrees(theirs),
            (ours, theirs) => ours == theirs,
        })
}

/// Returns the first pair of lines that disagree; `None` if all lines agree.
///
/// If one text has more lines, its first additional line is compared with an empty line.
pub fn disagreement<'t>(ours: &'t str, theirs: &'t str) -> Option<[&'t str; 2]> {
    let (mut one, mut other) = (ours.lines(), theirs.lines());
    loop {
        match (one.next(), other.next()) {
            (None, None) => return None,
            (Some(ours), Some(theirs)) if lines_agree(ours, theirs) => {}
            (ours, theirs) => return Some([ours.unwrap_or(""), theirs.unwrap_or("")]),
        }
    }
}

#[test]
fn a_line_is_split_into_words_and_numbers() {
    let texts: Vec<_> = pieces("| C08 | -3.4e-5 | (0.1, 45°), M = 16820. | 2L |")
        .map(|piece| match piece {
            Piece::Words(words) => words,
            Piece::Number(number) => number.text,
        })
        .collect();
    let expected = [
        "| C",
        "08",
        " | ",
        "-3.4e-5",
        " | (",
        "0.1",
        ", ",
        "45",
        "°), M = ",
        "16820",
        ". | ",
        "2",
        "L |",
    ];
    assert_eq!(texts, expected);
}

#[test]
fn the_last_digit_of_computed_numbers_may_differ_by_one() {
    for (one, other) in [
        ("| 2.30452 |", "| 2.30453 |"),
        ("| +2.5e-8 |", "| +2.4e-8 |"),
        ("| +1.0e-3 |", "| +9.9e-4 |"),
        ("**reproduced**: 0.9999, 13.3 %", "**reproduced**: 1.0000, 13.4 %"),
        ("9.999", "10.00"),
    ] {
        assert_eq!(disagreement(one, other), None);
    }
}

#[test]
fn differences_beyond_the_last_digit_are_disagreements() {
    for (one, other) in [
        ("| 2.30452 |", "| 2.30454 |"),
        ("| 2.30452 |", "| 2.3045 |"),
        ("| +2.5e-8 |", "| -2.5e-8 |"),
        ("| +2.5e-8 |", "| +2.5e-7 |"),
        ("**reproduced**: 0.9000", "in part: 0.9000"),
        ("best at (0.1, 0.9, 45°)", "best at (0.1, 0.8, 45°)"),
        ("best at (1, 0.025, 75°)", "best at (1, 0.026, 75°)"),
        ("18 reproduced, 8 in part", "17 reproduced, 9 in part"),
        ("| 1e-4 |", "| 2e-4 |"),
        ("Mattiasson 1981", "Mattiasson 1982"),
        ("× 16820", "× 16821"),
        ("| < 1e-9 |", "| +1.0e-9 |"),
        ("one line", "one line\nand another"),
        ("one line\nand another", "one line"),
        ("| 1.00 | |", "| 1.00 |"),
    ] {
        assert!(disagreement(one, other).is_some(), "{one} {other}");
    }
}
