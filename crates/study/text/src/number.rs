//! Compares numbers up to round-off and writes them as text.
//!
//! Equal quantities that are computed in different ways differ in their last digits. Therefore
//! squama compares values with [`same`]: in axes, filters, comparisons of runs, ranks and fronts.

use std::fmt::{self, Write};

/// Relative difference up to which two numbers count as equal.
///
/// The value is far above the round-off of a solved value and far below measurable differences.
pub const ROUND_OFF: f64 = 1e-9;

/// Returns true if `a` and `b` are equal up to round-off; zero equals only zero.
pub fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUND_OFF * a.abs().max(b.abs())
}

/// Rounds `value` to 12 significant digits if this changes only its round-off.
///
/// Returns any other `value` unchanged. For example, `0.3/3` is `0.09999999999999999` as an `f64`,
/// and becomes `0.1`. `size` is the largest operand in the computation of `value`. The tolerance is
/// proportional to `size`, because the difference of two numbers has the round-off of its operands.
pub fn short_decimal(value: f64, size: f64) -> f64 {
    if is_far_from_short_decimals(value, size) {
        return value;
    }
    let short = format!("{value:.11e}").parse().unwrap_or(value);
    if (short - value).abs() <= 4.0 * f64::EPSILON * size.abs() { short } else { value }
}

/// Returns true if no decimal number with 12 significant digits is near `value`.
///
/// The test is a fast filter for [`short_decimal`], which otherwise formats and parses a text in a
/// hundred times as much time.
fn is_far_from_short_decimals(value: f64, size: f64) -> bool {
    let exponent = value.abs().log10().floor() as i32;
    let scale = 10_f64.powi(11_i32.saturating_sub(exponent));
    let short = (value * scale).round() / scale;
    // For zero and very small numbers `short` is NaN. The comparison is then false, and
    // `short_decimal` decides.
    (short - value).abs() > 8.0 * f64::EPSILON * size.abs()
}

/// A list of distinct numbers in ascending order.
///
/// Numbers that are equal up to round-off form a group, which the list contains once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DistinctNumbers {
    /// The smallest number of each group.
    numbers: Vec<f64>,
}

impl DistinctNumbers {
    /// Returns the smallest number of each group, in ascending order.
    pub fn as_slice(&self) -> &[f64] {
        &self.numbers
    }

    /// Returns the index of the group of `number`; `None` if no group contains `number`.
    pub fn position(&self, number: f64) -> Option<usize> {
        let above = self.numbers.partition_point(|other| *other < number);
        // Check the smaller neighbour first, because the list contains the smallest number of each
        // group.
        let neighbours = above.saturating_sub(1)..(above + 1).min(self.numbers.len());
        neighbours.into_iter().find(|&index| same(self.numbers[index], number))
    }
}

impl FromIterator<f64> for DistinctNumbers {
    fn from_iter<I: IntoIterator<Item = f64>>(numbers: I) -> Self {
        let mut numbers: Vec<f64> = numbers.into_iter().collect();
        numbers.sort_by(f64::total_cmp);
        // `dedup_by` compares `next` with `kept`, the smallest number of the group. A long chain of
        // nearly equal numbers therefore does not become one group.
        numbers.dedup_by(|next, kept| same(*next, *kept));
        Self { numbers }
    }
}

/// Returns the shortest text that parses as `value`, such as `0.3`, `1` or `1e-7`.
///
/// Numbers below 1e-5 and from 1e15 on have an exponent, in a notation that spreadsheets can read.
pub fn text(value: f64) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write(&mut text, value);
    text
}

/// Rounds `value` to `digits` significant digits and omits trailing zeros.
pub fn rounded(value: f64, digits: usize) -> String {
    // Round by formatting: multiplication by a power of ten would add round-off digits.
    let rounded = format!("{value:.0$e}", digits.saturating_sub(1)).parse();
    rounded.map_or_else(|_| value.to_string(), text)
}

/// Writes the shortest text that parses as `value`; see [`text`].
///
/// # Errors
///
/// Returns an error if writing to `to` fails.
pub fn write(to: &mut impl Write, value: f64) -> fmt::Result {
    let size = value.abs();
    // This branch includes minus zero, which Rust would write as `-0`.
    if size == 0.0 {
        to.write_char('0')
    } else if (1e-5..1e15).contains(&size) {
        write!(to, "{value}")
    } else {
        // Without `:e`, Rust would write 1e300 with 301 digits.
        write!(to, "{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{DistinctNumbers, rounded, same, short_decimal, text};

    #[test]
    fn zero_equals_only_zero() {
        assert!(same(0.0, -0.0));
        assert!(!same(0.0, 1e-300));
        assert!(same(1e20, 1e20 + 1e10));
        assert!(!same(1.0, 1.0 + 1e-8));
    }

    #[test]
    fn quotients_of_short_decimals_are_short() {
        assert_eq!([0.3 / 3.0, 2.1 / 3.0, 0.6 / 3.0].map(|x| short_decimal(x, x)), [0.1, 0.7, 0.2]);
        // The difference 1.1 - 1.0 has the round-off of 1.1.
        assert_eq!(short_decimal(1.1 - 1.0, 1.1), 0.1);
        for long in [1.0 / 3.0, std::f64::consts::PI, 0.1 + 1e-13, f64::NAN] {
            assert_eq!(short_decimal(long, long).to_bits(), long.to_bits());
        }
    }

    #[test]
    fn numbers_equal_up_to_round_off_share_a_position() {
        let distinct: DistinctNumbers = [0.3, 0.1 + 0.2, 0.1, -0.0, 0.0, 0.7].into_iter().collect();
        assert_eq!(distinct.as_slice(), [0.0, 0.1, 0.3, 0.7]);
        let positions = [0.1 + 0.2, 0.3, 0.0, 0.7 - 1e-16, 0.4].map(|x| distinct.position(x));
        assert_eq!(positions, [Some(2), Some(2), Some(0), Some(3), None]);
    }

    #[test]
    fn numbers_are_written_as_their_shortest_text() {
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
        fn a_quotient_equal_to_a_short_decimal_becomes_that_decimal(units in 1_u32..10_000, thickness in 1_u32..1000) {
            let (length, thickness) = (f64::from(units) / 100.0, f64::from(thickness) / 10.0);
            let (over_t, expected) = (length / thickness, format!("{:.11e}", length / thickness));
            let is_short = (over_t * 1e11).round() == over_t * 1e11;
            if is_short {
                let found = short_decimal(over_t, over_t);
                prop_assert_eq!(Ok(found), expected.parse());
            }
        }

        #[test]
        fn decimals_of_twelve_digits_are_restored_after_round_off(
            digits in 1_u64..1_000_000_000_000, exponent in -18_i32..6, ulps in 0_u64..3
        ) {
            let decimal: f64 = format!("{digits}e{exponent}").parse().unwrap();
            let computed = f64::from_bits(decimal.to_bits() + ulps);
            prop_assert_eq!(short_decimal(computed, computed).to_bits(), decimal.to_bits());
        }

        #[test]
        fn the_text_of_a_number_parses_as_the_same_number(value in proptest::num::f64::NORMAL) {
            prop_assert_eq!(text(value).parse::<f64>().map(f64::to_bits), Ok(value.to_bits()));
        }
    }
}
