//! Exact decimal numbers, so that ranges contain the same values as typed lists.

use std::fmt;
use std::str::FromStr;

/// Maximum magnitude of an exponent. Larger exponents are outside the range of `f64`.
const LARGEST_EXPONENT: i32 = 400;

/// Maximum number of values in a range.
const LONGEST: i128 = 1_000_000;

/// A decimal number, `digits × 10^exponent`, without trailing zeros.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Decimal {
    digits: i128,
    exponent: i32,
}

/// A text that is not a decimal number, or has more than 38 digits.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{found} is not a decimal number of at most 38 digits")]
pub(crate) struct NotDecimal {
    pub found: String,
}

impl Decimal {
    fn new(mut digits: i128, mut exponent: i32) -> Self {
        if digits == 0 {
            return Self { digits, exponent: 0 };
        }
        // Equal numbers must have equal fields: `0.10` is `0.1`.
        while digits % 10 == 0 {
            digits /= 10;
            exponent += 1;
        }
        Self { digits, exponent }
    }

    /// Returns the nearest `f64`.
    pub fn to_f64(self) -> f64 {
        // The standard parser rounds correctly; arithmetic with powers of ten does not.
        format!("{}e{}", self.digits, self.exponent).parse().unwrap_or(f64::NAN)
    }

    /// Returns the value if it is a whole number and not negative.
    pub fn to_usize(self) -> Option<usize> {
        usize::try_from(self.over(0)?).ok()
    }

    /// Returns the value divided by `10^exponent`, if the quotient is a whole number.
    fn over(self, exponent: i32) -> Option<i128> {
        let power = u32::try_from(self.exponent.checked_sub(exponent)?).ok()?;
        10_i128.checked_pow(power)?.checked_mul(self.digits)
    }
}

impl FromStr for Decimal {
    type Err = NotDecimal;

    fn from_str(text: &str) -> Result<Self, NotDecimal> {
        parse(text).ok_or_else(|| NotDecimal { found: text.to_owned() })
    }
}

fn parse(text: &str) -> Option<Decimal> {
    let (mantissa, power) = match text.split_once(['e', 'E']) {
        Some((mantissa, power)) => (mantissa, power.parse().ok()?),
        None => (text, 0_i32),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    // If no digits precede the point, a sign after the point would parse as the sign of the number.
    if fraction.starts_with(['+', '-']) {
        return None;
    }
    let digits: i128 = format!("{whole}{fraction}").parse().ok()?;
    let exponent = power.checked_sub(i32::try_from(fraction.len()).ok()?)?;
    let decimal = Decimal::new(digits, exponent);
    // Check after `new`, which moves trailing zeros of the digits into the exponent.
    (decimal.exponent.abs() <= LARGEST_EXPONENT).then_some(decimal)
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let short = text::number::text(self.to_f64());
        // A decimal may have more digits than the nearest `f64`; print all of them.
        if short.parse() == Ok(*self) {
            f.write_str(&short)
        } else {
            write!(f, "{}e{}", self.digits, self.exponent)
        }
    }
}

/// An invalid range.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum InvalidRange {
    /// The step is zero or negative.
    #[error("the step is {step}, expected one above 0")]
    Step { step: Decimal },
    /// The range ends before it begins.
    #[error("`to` is below `from`, expected a `to` of at least {from}")]
    Backwards { from: Decimal },
    /// The end is not a whole number of steps from the start.
    #[error("{to} is not reached in steps of {step}, expected a `to` of {below} or {above}")]
    Missed { to: String, step: String, below: String, above: String },
    /// The range has too many values for a list in memory.
    #[error("the range has {count} values, expected at most {LONGEST}; choose a larger step")]
    TooLong { count: i128 },
    /// Neighbouring numbers are equal up to round-off, or have too many digits.
    #[error(
        "the step {step} is too fine, expected numbers that differ by more than a part in 10^9"
    )]
    TooFine { step: Decimal },
}

/// Returns the numbers `from, from + step … to`, computed as decimals.
///
/// # Errors
///
/// If the step is not positive, `to` is below `from`, the steps do not reach `to`, there are more
/// than a million numbers, or neighbouring numbers are equal up to round-off.
pub(crate) fn range(
    from: Decimal,
    to: Decimal,
    step: Decimal,
) -> Result<Vec<Decimal>, InvalidRange> {
    if step.digits <= 0 {
        return Err(InvalidRange::Step { step });
    }
    // In units of `10^exponent`, `from`, `to` and `step` are whole numbers, so the steps have no
    // round-off.
    let exponent = from.exponent.min(to.exponent).min(step.exponent);
    let scaled = [from, to, step].map(|decimal| decimal.over(exponent));
    let [Some(first), Some(last), Some(stride)] = scaled else {
        return Err(InvalidRange::TooFine { step });
    };
    let length = last.checked_sub(first).ok_or(InvalidRange::TooFine { step })?;
    if length < 0 {
        return Err(InvalidRange::Backwards { from });
    }
    if length % stride != 0 {
        let below = last - length % stride;
        let [below, above] = [below, below.saturating_add(stride)]
            .map(|digits| Decimal::new(digits, exponent).to_string());
        let (to, step) = (to.to_string(), step.to_string());
        return Err(InvalidRange::Missed { to, step, below, above });
    }
    // Check the count before creating the numbers: a mistyped step must not fill the memory.
    let count = length / stride + 1;
    if count > LONGEST {
        return Err(InvalidRange::TooLong { count });
    }
    let numbers =
        (0..count).map(|i| Decimal::new(first + stride * i, exponent)).collect::<Vec<_>>();
    if are_distinct(&numbers) { Ok(numbers) } else { Err(InvalidRange::TooFine { step }) }
}

/// Returns true if neighbouring numbers of a range differ by more than round-off.
///
/// Checks only the first and the last pair, because one of them has the smallest relative
/// difference.
fn are_distinct(numbers: &[Decimal]) -> bool {
    let mut pairs = numbers.windows(2);
    let ends = [pairs.clone().next(), pairs.next_back()].into_iter().flatten();
    ends.map(|pair| [pair[0], pair[1]].map(Decimal::to_f64))
        .all(|[one, next]| !text::number::same(one, next))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn range(from: &str, to: &str, step: &str) -> Result<Vec<Decimal>, InvalidRange> {
        let [from, to, step] = [from, to, step].map(|text| text.parse().expect("a decimal"));
        super::range(from, to, step)
    }

    #[test]
    fn a_range_of_tenths_equals_typed_tenths() {
        let tenths = range("0.1", "1.0", "0.1").expect("valid");
        let texts: Vec<_> = tenths.iter().map(ToString::to_string).collect();
        assert_eq!(texts.join(" "), "0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1");
        let numbers = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
        assert!(tenths.into_iter().map(Decimal::to_f64).eq(numbers));
    }

    #[test]
    fn invalid_ranges_are_refused_with_a_reason() {
        let message = |from, to, step| range(from, to, step).expect_err("invalid").to_string();
        insta::assert_snapshot!(message("0", "1", "0"), @"the step is 0, expected one above 0");
        insta::assert_snapshot!(message("0", "1", "-0.5"), @"the step is -0.5, expected one above 0");
        insta::assert_snapshot!(message("1", "0", "0.5"), @"`to` is below `from`, expected a `to` of at least 1");
        insta::assert_snapshot!(message("0.1", "1", "0.4"), @"1 is not reached in steps of 0.4, expected a `to` of 0.9 or 1.3");
        insta::assert_snapshot!(message("0", "1", "1e-6"), @"the range has 1000001 values, expected at most 1000000; choose a larger step");
        insta::assert_snapshot!(message("0", "1e30", "1e-30"), @"the step 1e-30 is too fine, expected numbers that differ by more than a part in 10^9");
        insta::assert_snapshot!(message("1", "1.000000000000000001", "1e-18"), @"the step 1e-18 is too fine, expected numbers that differ by more than a part in 10^9");
    }

    proptest! {
        #[test]
        fn a_decimal_equals_the_parsed_f64(digits in -1_000_000_i64..1_000_000, exponent in -12_i32..12) {
            let text = format!("{digits}e{exponent}");
            let decimal: Decimal = text.parse().expect("a decimal");
            prop_assert_eq!(decimal.to_f64().to_bits() << 1, text.parse::<f64>().expect("a number").to_bits() << 1);
            prop_assert_eq!(decimal.to_string().parse::<Decimal>(), Ok(decimal));
        }

        #[test]
        fn a_range_contains_every_step_and_both_ends(first in -1000_i64..1000, stride in 1_i64..500, count in 1_i64..400, exponent in -6_i32..3) {
            let texts: Vec<_> = (0..count).map(|i| format!("{}e{exponent}", first + stride * i)).collect();
            let step = format!("{stride}e{exponent}");
            let range = range(&texts[0], &texts[texts.len() - 1], &step).expect("valid");
            let expected = texts.iter().map(|text| text.parse::<f64>().expect("a number"));
            prop_assert!(range.into_iter().map(Decimal::to_f64).eq(expected));
        }

        #[test]
        fn any_text_parses_or_is_refused(text in "[-+0-9.eE_]{0,50}") {
            let _ = text.parse::<Decimal>();
        }
    }
}
