//! Writes numbers as text.

use std::fmt::{self, Write};

/// Returns the shortest text that reads back as `value`: `0.3`, `1`, `1e-7`.
///
/// Very small and very large numbers are written with an exponent, which spreadsheets read as well.
pub fn text(value: f64) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write(&mut text, value);
    text
}

/// Rounds `value` to `digits` significant digits and omits trailing zeros.
pub fn rounded(value: f64, digits: usize) -> String {
    // Round in decimal text: scaling by a power of ten would add round-off digits.
    let rounded = format!("{value:.0$e}", digits.saturating_sub(1)).parse();
    rounded.map_or_else(|_| value.to_string(), text)
}

/// Writes the shortest text of `value`; see [`text`].
///
/// # Errors
///
/// Returns the errors of the writer.
pub fn write(to: &mut impl Write, value: f64) -> fmt::Result {
    let size = value.abs();
    // Includes minus zero, which Rust writes as `-0`.
    if size == 0.0 {
        to.write_char('0')
    } else if (1e-5..1e15).contains(&size) {
        write!(to, "{value}")
    } else {
        // Without an exponent Rust would write all zeros of 1e300.
        write!(to, "{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{rounded, text};

    #[test]
    fn numbers_take_their_shortest_text() {
        let texts = [0.1 + 0.2, 1.0, -0.0, 1e-7, 12345.0, 1e15, 9677.0, -1.5e-12].map(text);
        assert_eq!(texts.join(" "), "0.30000000000000004 1 0 1e-7 12345 1e15 9677 -1.5e-12");
    }

    #[test]
    fn rounded_numbers_have_no_trailing_zeros() {
        let texts = [0.114_362_956_956, 0.3, 57.670_830_9, 1_234_567.0, 0.0, f64::INFINITY];
        let texts = texts.map(|value| rounded(value, 6));
        assert_eq!(texts.join(" "), "0.114363 0.3 57.6708 1234570 0 inf");
    }

    proptest! {
        #[test]
        fn the_text_reads_back_as_the_number(value in proptest::num::f64::NORMAL) {
            prop_assert_eq!(text(value).parse::<f64>().map(f64::to_bits), Ok(value.to_bits()));
        }
    }
}
