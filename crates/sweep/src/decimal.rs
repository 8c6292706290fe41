//! Decimal numbers, so that ranges give what a person would type.

use std::fmt;
use std::str::FromStr;

/// Exponents beyond this are outside of what an `f64` holds.
const LARGEST_EXPONENT: i32 = 400;

/// A number as it is typed, `digits × 10^exponent`, without trailing zeros.
///
/// ```
/// use sweep::Decimal;
///
/// let step: Decimal = "0.10".parse()?;
/// assert_eq!(step.to_string(), "0.1");
/// # Ok::<(), sweep::NotDecimal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decimal {
    digits: i128,
    exponent: i32,
}

/// A text that is no decimal number, or one with more than 38 digits.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{found} is no decimal number of at most 38 digits")]
pub struct NotDecimal {
    /// The text.
    pub found: String,
}

impl Decimal {
    fn new(mut digits: i128, mut exponent: i32) -> Self {
        if digits == 0 {
            return Self { digits, exponent: 0 };
        }
        while digits % 10 == 0 {
            digits /= 10;
            exponent += 1;
        }
        Self { digits, exponent }
    }

    /// The nearest `f64`.
    pub fn to_f64(self) -> f64 {
        // The standard parser rounds correctly, arithmetic with powers of ten does not.
        format!("{}e{}", self.digits, self.exponent).parse().unwrap_or(f64::NAN)
    }

    /// The value if it is a whole number that is not negative.
    pub fn to_usize(self) -> Option<usize> {
        usize::try_from(self.over(0)?).ok()
    }

    /// The value in units of `10^exponent`, if it is a whole number of them.
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
    if fraction.starts_with(['+', '-']) {
        return None;
    }
    let digits: i128 = format!("{whole}{fraction}").parse().ok()?;
    let exponent = power.checked_sub(i32::try_from(fraction.len()).ok()?)?;
    let decimal = Decimal::new(digits, exponent);
    (decimal.exponent.abs() <= LARGEST_EXPONENT).then_some(decimal)
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let short = crate::number::text(self.to_f64());
        if short.parse() == Ok(*self) {
            f.write_str(&short)
        } else {
            write!(f, "{}e{}", self.digits, self.exponent)
        }
    }
}

/// The numbers `from, from + step … to`, computed as decimals and never stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DecimalRange {
    from: Decimal,
    to: Decimal,
    step: Decimal,
    /// `from` and `step` in units of `10^exponent`.
    first: i128,
    stride: i128,
    exponent: i32,
    count: u64,
}

/// A range that cannot be walked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InvalidRange {
    /// The step is zero or negative.
    #[error("the step is {step}, expected one above 0")]
    Step {
        /// The step.
        step: Decimal,
    },
    /// The range ends before it begins.
    #[error("`to` is below `from`, expected a `to` of at least {from}")]
    Backwards {
        /// Where it begins.
        from: Decimal,
    },
    /// The steps pass by the end.
    #[error("{to} is not reached in steps of {step}, expected a `to` of {below} or {above}")]
    Missed {
        /// The end.
        to: String,
        /// The step.
        step: String,
        /// The last number before the end.
        below: String,
        /// The first number after it.
        above: String,
    },
    /// More numbers or more digits than can be told apart.
    #[error("the step {step} is too fine, expected numbers that an f64 tells apart")]
    TooFine {
        /// The step.
        step: Decimal,
    },
}

impl DecimalRange {
    /// The range from `from` to `to`, both included.
    ///
    /// # Errors
    /// If the step is not positive, `to` lies below `from` or is not reached, or neighbouring
    /// numbers are the same `f64`.
    pub fn new(from: Decimal, to: Decimal, step: Decimal) -> Result<Self, InvalidRange> {
        if step.digits <= 0 {
            return Err(InvalidRange::Step { step });
        }
        let too_fine = InvalidRange::TooFine { step };
        let exponent = from.exponent.min(to.exponent).min(step.exponent);
        let scaled = (from.over(exponent), to.over(exponent), step.over(exponent));
        let (Some(first), Some(last), Some(stride)) = scaled else {
            return Err(too_fine);
        };
        let Some(length) = last.checked_sub(first) else {
            return Err(too_fine);
        };
        if length < 0 {
            return Err(InvalidRange::Backwards { from });
        }
        if length % stride != 0 {
            let below = last - length % stride;
            let [below, above] = [below, below.saturating_add(stride)];
            let [below, above] = [below, above].map(|x| Decimal::new(x, exponent).to_string());
            let (to, step) = (to.to_string(), step.to_string());
            return Err(InvalidRange::Missed { to, step, below, above });
        }
        let Ok(count) = u64::try_from(length / stride + 1) else {
            return Err(too_fine);
        };
        let range = Self { from, to, step, first, stride, exponent, count };
        if range.tells_apart() { Ok(range) } else { Err(too_fine) }
    }

    /// Whether neighbours are different `f64`s; they are closest together, relative to their
    /// size, at the two ends.
    fn tells_apart(&self) -> bool {
        let last = self.count - 1;
        let differ = |i: u64, j: u64| self.value(i).to_f64() < self.value(j).to_f64();
        last == 0 || (differ(0, 1) && differ(last - 1, last))
    }

    /// How many numbers there are, at least one.
    #[expect(clippy::len_without_is_empty, reason = "a range is never empty")]
    pub fn len(&self) -> u64 {
        self.count
    }

    /// First number, last number and step.
    pub fn bounds(&self) -> [Decimal; 3] {
        [self.from, self.to, self.step]
    }

    /// Number `index`, from 0.
    pub fn value(&self, index: u64) -> Decimal {
        Decimal::new(self.first + self.stride * i128::from(index), self.exponent)
    }

    /// Which of the numbers `value` is.
    pub fn position(&self, value: f64) -> Option<u64> {
        let (mut low, mut high) = (0, self.count);
        while low < high {
            let middle = low + (high - low) / 2;
            if self.value(middle).to_f64() < value {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        // Exact: both come from the same decimal.
        #[expect(clippy::float_cmp)]
        let found = low < self.count && self.value(low).to_f64() == value;
        found.then_some(low)
    }
}

impl fmt::Display for DecimalRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{{ from = {}, to = {}, step = {} }}", self.from, self.to, self.step)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn range(from: &str, to: &str, step: &str) -> Result<DecimalRange, InvalidRange> {
        let decimal = |text: &str| text.parse().expect("a decimal");
        DecimalRange::new(decimal(from), decimal(to), decimal(step))
    }

    #[test]
    fn tenths_are_the_tenths_that_a_person_types() {
        let tenths = range("0.1", "1.0", "0.1").expect("valid");
        let texts: Vec<_> = (0..tenths.len()).map(|i| tenths.value(i).to_string()).collect();
        assert_eq!(texts.join(" "), "0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1");
        assert!((0..10).all(|i| tenths.position(tenths.value(i).to_f64()) == Some(i)));
        assert_eq!(tenths.position(0.35), None);
    }

    #[test]
    fn ranges_that_cannot_be_walked_say_why() {
        let message = |from, to, step| range(from, to, step).expect_err("invalid").to_string();
        insta::assert_snapshot!(message("0", "1", "0"), @"the step is 0, expected one above 0");
        insta::assert_snapshot!(message("0", "1", "-0.5"), @"the step is -0.5, expected one above 0");
        insta::assert_snapshot!(message("1", "0", "0.5"), @"`to` is below `from`, expected a `to` of at least 1");
        insta::assert_snapshot!(message("0.1", "1", "0.4"), @"1 is not reached in steps of 0.4, expected a `to` of 0.9 or 1.3");
        insta::assert_snapshot!(message("0", "1e30", "1e-30"), @"the step 1e-30 is too fine, expected numbers that an f64 tells apart");
        insta::assert_snapshot!(message("1", "1.000000000000000001", "1e-18"), @"the step 1e-18 is too fine, expected numbers that an f64 tells apart");
    }

    proptest! {
        #[test]
        fn a_decimal_is_the_number_it_was_typed_as(digits in -1_000_000_i64..1_000_000, exponent in -12_i32..12) {
            let text = format!("{digits}e{exponent}");
            let decimal: Decimal = text.parse().expect("a decimal");
            prop_assert_eq!(decimal.to_f64().to_bits() << 1, text.parse::<f64>().expect("a number").to_bits() << 1);
            prop_assert_eq!(decimal.to_string().parse::<Decimal>(), Ok(decimal));
        }

        #[test]
        fn every_position_of_a_range_is_found_again(first in -1000_i64..1000, stride in 1_i64..500, count in 1_u64..400, exponent in -6_i32..3) {
            let last = first + stride * (i64::try_from(count).expect("small") - 1);
            let text = |x: i64| format!("{x}e{exponent}");
            let range = range(&text(first), &text(last), &text(stride)).expect("valid");
            prop_assert_eq!(range.len(), count);
            for i in 0..count {
                prop_assert_eq!(range.position(range.value(i).to_f64()), Some(i));
            }
        }

        #[test]
        fn any_text_parses_or_is_refused(text in "[-+0-9.eE_]{0,50}") {
            let _ = text.parse::<Decimal>();
        }
    }
}
