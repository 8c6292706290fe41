//! Equality of numbers up to round-off, and numbers as text.
//!
//! Two numbers that are computed in different ways differ in their last digits. Every comparison of
//! values in squama uses [`same`]: axes, filters, the matching of two runs, ranks and fronts.

use std::fmt::{self, Write};

/// Relative difference up to which two numbers count as equal.
///
/// It is far above the round-off of a solved value and far below any difference that can be
/// measured.
pub const ROUND_OFF: f64 = 1e-9;

/// Returns true if `a` and `b` are equal up to round-off. Zero equals only zero.
pub fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUND_OFF * a.abs().max(b.abs())
}

/// Rounds `value` to 12 significant digits if this changes only its round-off.
///
/// Otherwise returns `value` unchanged. For example, `0.3/3` is `0.09999999999999999` as an `f64`,
/// and becomes `0.1`. `size` is the largest number in the computation of `value`; it sets the
/// tolerance, because a difference has the round-off of its operands.
pub fn short_decimal(value: f64, size: f64) -> f64 {
    if is_far_from_short_decimals(value, size) {
        return value;
    }
    let short = format!("{value:.11e}").parse().unwrap_or(value);
    if (short - value).abs() <= 4.0 * f64::EPSILON * size.abs() { short } else { value }
}

/// Returns true if no decimal number with 12 significant digits is near `value`.
///
/// This test rejects most numbers. The exact test formats the number as text, which takes a hundred
/// times as long.
fn is_far_from_short_decimals(value: f64, size: f64) -> bool {
    let exponent = value.abs().log10().floor() as i32;
    let scale = 10_f64.powi(11_i32.saturating_sub(exponent));
    let short = (value * scale).round() / scale;
    // Zero and very small numbers give NaN, so the comparison is false and the exact test decides.
    (short - value).abs() > 8.0 * f64::EPSILON * size.abs()
}

/// Distinct numbers in ascending order.
///
/// Numbers that are equal up to round-off count as one number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DistinctNumbers {
    /// The smallest number of each group.
    numbers: Vec<f64>,
}

impl DistinctNumbers {
    /// Returns the numbers, in ascending order.
    pub fn as_slice(&self) -> &[f64] {
        &self.numbers
    }

    /// Returns the index of `number`; `None` if the list does not contain it.
    pub fn position(&self, number: f64) -> Option<usize> {
        let above = self.numbers.partition_point(|other| *other < number);
        // Check the smaller neighbour first, because it represents its group.
        let neighbours = above.saturating_sub(1)..(above + 1).min(self.numbers.len());
        neighbours.into_iter().find(|&index| same(self.numbers[index], number))
    }
}

impl FromIterator<f64> for DistinctNumbers {
    fn from_iter<I: IntoIterator<Item = f64>>(numbers: I) -> Self {
        let mut numbers: Vec<f64> = numbers.into_iter().collect();
        numbers.sort_by(f64::total_cmp);
        // `dedup_by` compares with the last number that stays, the smallest of its group. Many
        // small steps therefore do not make all numbers equal.
        numbers.dedup_by(|next, kept| same(*next, *kept));
        Self { numbers }
    }
}

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
        // A difference has the round-off of its operands.
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
        fn a_quotient_of_decimals_is_the_nearest_number(units in 1_u32..10_000, thickness in 1_u32..1000) {
            let (length, thickness) = (f64::from(units) / 100.0, f64::from(thickness) / 10.0);
            let (over_t, expected) = (length / thickness, format!("{:.11e}", length / thickness));
            let is_short = (over_t * 1e11).round() == over_t * 1e11;
            if is_short {
                let found = short_decimal(over_t, over_t);
                prop_assert_eq!(Ok(found), expected.parse());
            }
        }

        #[test]
        fn decimals_with_twelve_digits_survive_round_off(
            digits in 1_u64..1_000_000_000_000, exponent in -18_i32..6, ulps in 0_u64..3
        ) {
            let decimal: f64 = format!("{digits}e{exponent}").parse().unwrap();
            let computed = f64::from_bits(decimal.to_bits() + ulps);
            prop_assert_eq!(short_decimal(computed, computed).to_bits(), decimal.to_bits());
        }

        #[test]
        fn the_text_reads_back_as_the_number(value in proptest::num::f64::NORMAL) {
            prop_assert_eq!(text(value).parse::<f64>().map(f64::to_bits), Ok(value.to_bits()));
        }
    }
}
