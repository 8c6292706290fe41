//! A parameter of a sweep: the values that it takes, and the field of a case that it sets.

mod continuous;
pub mod key;
pub(crate) mod length;
mod list;
mod modulus;
mod role;
mod scalar;

use std::fmt;

use skin::puncture::{MOST_NUMBERS, NumberList};

use crate::case::Case;
use crate::decimal::Decimal;
use text::number;
use text::toml_source::Value;

pub use list::PARAMETERS;
pub use role::Role;
pub use scalar::Scalar;

/// A scalar that a sweep definition may set, in its section or as an axis of the grid.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Key in the definition, the name of its axis and of its column.
    pub key: &'static str,
    /// Section in which it is set when it is no axis.
    pub section: &'static str,
    /// Unit, `-` if it has none.
    pub unit: &'static str,
    /// The meaning, in half a sentence.
    pub meaning: &'static str,
    /// What it is to the skin, beyond its value.
    pub(crate) roles: &'static [Role],
    /// The values that the parameter takes, and the field of a case that it sets.
    pub(crate) kind: ParameterKind,
}

impl PartialEq for Parameter {
    fn eq(&self, other: &Self) -> bool {
        // Keys are unique over all sections, and functions in a parameter cannot be compared.
        self.key == other.key
    }
}

/// The values that the parameter takes, and the field of a case that it sets.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ParameterKind {
    Number {
        range: Range,
        field: fn(&mut Case) -> &mut f64,
    },
    Count {
        range: CountRange,
        field: fn(&mut Case) -> &mut usize,
    },
    Word {
        words: &'static [&'static str],
        get: fn(&Case) -> usize,
        set: fn(&mut Case, usize),
    },
    /// A number whose sign tells the sense of a rotation: within bounds but for the sign.
    SignedNumber {
        size: Range,
        field: fn(&mut Case) -> &mut f64,
    },
    /// A number that need not be given.
    OptionalNumber {
        range: Range,
        field: fn(&mut Case) -> &mut Option<f64>,
    },
    /// A count, or the word for none.
    CountOrWord {
        range: CountRange,
        word: &'static str,
        get: fn(&Case) -> Option<usize>,
        set: fn(&mut Case, Option<usize>),
    },
    /// A number or a short list of them, ascending, or the word.
    Numbers {
        range: Range,
        word: Option<&'static str>,
        get: fn(&Case) -> Scalar,
        set: fn(&mut Case, Scalar),
    },
}

/// Bounds of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub low: Bound,
    pub high: Bound,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Bound {
    Included(f64),
    Excluded(f64),
}
use Bound::{Excluded, Included};

/// Bounds of a count, both included.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CountRange {
    pub low: usize,
    pub high: usize,
}

/// The word of a number that is not given. No definition has it.
const NOT_GIVEN: &str = "not given";

/// A value that a parameter does not take.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WrongValue {
    /// The right type, but outside of the bounds.
    #[error("{found} is out of range, expected {expected}")]
    OutOfRange {
        /// The value.
        found: String,
        /// The values that would be right.
        expected: String,
    },
    /// A key that changes nothing.
    #[error("has no effect: {0}")]
    NoEffect(String),
    /// Not what this key takes.
    #[error("{found} is not accepted, expected {expected}")]
    NotAccepted {
        /// The value.
        found: String,
        /// The values that would be right.
        expected: String,
    },
}

impl WrongValue {
    /// A value that is refused, beside what would be taken.
    pub fn not_accepted(found: impl fmt::Display, expected: impl Into<String>) -> Self {
        Self::NotAccepted { found: found.to_string(), expected: expected.into() }
    }
}

impl Parameter {
    /// The parameter of that name.
    pub fn named(key: &str) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.key == key)
    }

    /// `section.key`.
    pub fn path(&self) -> String {
        format!("{}.{}", self.section, self.key)
    }

    /// The value of this parameter in `case`.
    pub fn get(&self, case: &Case) -> Scalar {
        // One accessor reads and writes each field, so that reading needs a copy to lend.
        let mut case = *case;
        match &self.kind {
            ParameterKind::Number { field, .. } | ParameterKind::SignedNumber { field, .. } => {
                Scalar::Number(*field(&mut case))
            }
            ParameterKind::OptionalNumber { field, .. } => {
                field(&mut case).map_or(Scalar::Word(NOT_GIVEN), Scalar::Number)
            }
            ParameterKind::Count { field, .. } => Scalar::Count(*field(&mut case)),
            ParameterKind::Word { words, get, .. } => Scalar::Word(words[get(&case)]),
            ParameterKind::CountOrWord { get, word, .. } => {
                get(&case).map_or(Scalar::Word(word), Scalar::Count)
            }
            ParameterKind::Numbers { get, .. } => get(&case),
        }
    }

    /// Whether a case has a value for it: one that need not be given may have none.
    pub fn is_given(&self, case: &Case) -> bool {
        self.get(case) != Scalar::Word(NOT_GIVEN)
    }

    /// The value that it has unless a definition says otherwise.
    pub fn default(&self) -> Scalar {
        self.get(&Case::default())
    }

    /// Sets this parameter in `case` to a value that [`Self::read`] or [`Self::scalar`] gave, and what follows from it.
    pub(crate) fn set(&self, case: &mut Case, value: Scalar) {
        // Behind each parameter, because axes and sections set them in any order.
        self.assign(case, value);
        length::settle(case);
        modulus::settle(case);
    }

    /// Sets this parameter alone.
    fn assign(&self, case: &mut Case, value: Scalar) {
        match (&self.kind, value) {
            (
                ParameterKind::Number { field, .. } | ParameterKind::SignedNumber { field, .. },
                Scalar::Number(number),
            ) => *field(case) = number,
            // The word of a number that is not given takes away what the case had.
            (ParameterKind::OptionalNumber { field, .. }, value) => *field(case) = value.number(),
            (ParameterKind::Count { field, .. }, Scalar::Count(count)) => *field(case) = count,
            (ParameterKind::Word { words, set, .. }, Scalar::Word(word)) => {
                // `read` takes no other words.
                set(case, words.iter().position(|known| *known == word).unwrap_or(0));
            }
            (ParameterKind::CountOrWord { set, .. }, Scalar::Count(count)) => {
                set(case, Some(count));
            }
            (ParameterKind::CountOrWord { set, .. }, Scalar::Word(_)) => set(case, None),
            (ParameterKind::Numbers { set, .. }, value) => set(case, value),
            // Whoever reads a value checks its kind: any other is a mistake of the program.
            _ => debug_assert!(false, "{} cannot be {value}", self.key),
        }
    }

    /// The value `written`, if it is right for this parameter.
    ///
    /// # Errors
    /// If it is of another type or out of range.
    pub fn read(&self, written: &Value) -> Result<Scalar, WrongValue> {
        let value = match (&self.kind, written) {
            (
                ParameterKind::Number { .. }
                | ParameterKind::SignedNumber { .. }
                | ParameterKind::OptionalNumber { .. }
                | ParameterKind::Numbers { .. },
                Value::Number(text),
            ) => text.parse().ok().map(Scalar::Number),
            (ParameterKind::Numbers { .. }, Value::List(items)) => list(items).map(Scalar::List),
            (
                ParameterKind::Numbers { word: Some(word), .. }
                | ParameterKind::CountOrWord { word, .. },
                Value::Text(text),
            ) => (text == word).then_some(Scalar::Word(word)),
            (
                ParameterKind::Count { .. } | ParameterKind::CountOrWord { .. },
                Value::Number(text),
            ) => {
                let decimal = text.parse::<Decimal>().ok();
                decimal.and_then(Decimal::to_usize).map(Scalar::Count)
            }
            // A boolean is one of the two words of a parameter that says whether.
            (ParameterKind::Word { words, .. }, Value::Text(text) | Value::Other(text)) => {
                words.iter().find(|word| *word == text).map(|word| Scalar::Word(word))
            }
            _ => None,
        };
        match value {
            // TOML has `nan` and `inf`, too: no bounds contain them.
            Some(value) if self.contains(value) => Ok(tidy(value)),
            _ => Err(self.wrong(written)),
        }
    }

    /// The value that a number of a range stands for.
    pub(crate) fn scalar(&self, number: Decimal) -> Scalar {
        match self.kind {
            ParameterKind::Number { .. }
            | ParameterKind::SignedNumber { .. }
            | ParameterKind::OptionalNumber { .. }
            | ParameterKind::Numbers { .. }
            | ParameterKind::Word { .. } => Scalar::Number(number.to_f64()),
            ParameterKind::Count { .. } | ParameterKind::CountOrWord { .. } => {
                // Whole and in bounds: whoever reads a range has seen both ends and the step.
                Scalar::Count(number.to_usize().unwrap_or(usize::MAX))
            }
        }
    }

    /// The case in which this parameter has a value that [`Self::read`] gave, or the number that it takes.
    pub fn put(&self, case: &Case, value: Scalar) -> Case {
        let mut changed = *case;
        self.set(&mut changed, value);
        changed
    }

    /// The case in which this parameter alone has another value: lengths in mm say the same.
    pub fn replace(&self, case: &Case, value: Scalar) -> Case {
        let mut changed = *case;
        self.assign(&mut changed, value);
        length::keep_in_step(&mut changed, self);
        changed
    }

    /// Whether it is a length in mm that another parameter gives over the thickness.
    pub fn is_in_mm(&self) -> bool {
        self.over_t().is_some()
    }

    /// Whether it takes numbers, so that a range of it makes sense.
    pub(crate) fn takes_numbers(&self) -> bool {
        !matches!(self.kind, ParameterKind::Word { .. })
    }

    /// Whether a word may stand in the place of its numbers.
    pub(crate) fn takes_word(&self) -> bool {
        matches!(
            self.kind,
            ParameterKind::CountOrWord { .. } | ParameterKind::Numbers { word: Some(_), .. }
        )
    }

    /// Whether a case may do without a number of it.
    pub(crate) fn is_optional(&self) -> bool {
        self.takes_word() || matches!(self.kind, ParameterKind::OptionalNumber { .. })
    }

    /// Whether its numbers are whole.
    pub(crate) fn takes_counts(&self) -> bool {
        matches!(self.kind, ParameterKind::Count { .. } | ParameterKind::CountOrWord { .. })
    }

    /// The error of a value that [`Self::read`] refuses.
    fn wrong(&self, written: &Value) -> WrongValue {
        let found = written.to_string();
        let expected = self.expected();
        // Nobody can say of `nan` that it is out of range: it is not accepted.
        let is_finite = |text: &String| text.parse::<f64>().is_ok_and(f64::is_finite);
        let is_number = matches!(written, Value::Number(text) if is_finite(text));
        if is_number && self.takes_numbers() {
            WrongValue::OutOfRange { found, expected }
        } else {
            WrongValue::NotAccepted { found, expected }
        }
    }

    /// Whether a value is within the bounds.
    pub(crate) fn contains(&self, value: Scalar) -> bool {
        match (&self.kind, value) {
            (
                ParameterKind::Number { range, .. }
                | ParameterKind::OptionalNumber { range, .. }
                | ParameterKind::Numbers { range, .. },
                Scalar::Number(number),
            ) => range.contains(number),
            (ParameterKind::Numbers { range, .. }, Scalar::List(numbers)) => {
                numbers.as_slice().iter().all(|&number| range.contains(number))
            }
            (ParameterKind::SignedNumber { size, .. }, Scalar::Number(number)) => {
                size.contains(number.abs())
            }
            (
                ParameterKind::Count { range, .. } | ParameterKind::CountOrWord { range, .. },
                Scalar::Count(count),
            ) => (range.low..=range.high).contains(&count),
            _ => true,
        }
    }

    /// The values that the parameter takes, in words.
    pub fn expected(&self) -> String {
        match &self.kind {
            ParameterKind::Number { range, .. } | ParameterKind::OptionalNumber { range, .. } => {
                self.numbers(*range)
            }
            ParameterKind::SignedNumber { size, .. } => {
                format!("{}, or its negative", self.numbers(*size))
            }
            ParameterKind::Count { range, .. } => format!("a whole number {range}"),
            ParameterKind::Word { words, .. } => any_of(words),
            ParameterKind::CountOrWord { range, word, .. } => {
                format!("a whole number {range} or \"{word}\"")
            }
            ParameterKind::Numbers { range, word, .. } => {
                let word = word.map(|word| format!(", or \"{word}\"")).unwrap_or_default();
                let numbers = self.numbers(*range);
                format!("{numbers}, or a list of up to {MOST_NUMBERS} in ascending order{word}")
            }
        }
    }

    /// Its numbers within bounds, in words.
    fn numbers(&self, range: Range) -> String {
        let noun = match self.unit {
            "t" | "mm" => "a length",
            "deg" => "an angle",
            _ if range == list::FRACTION => "a fraction",
            _ => "a number",
        };
        format!("{noun} {range}")
    }
}

/// `words` in quotes, as alternatives.
pub(crate) fn any_of(words: &[&str]) -> String {
    words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(" or ")
}

/// The list of the numbers of `items`; `None` if one is no number, or they are too many or not ascending.
fn list(items: &[Value]) -> Option<NumberList> {
    let number = |item: &Value| match item {
        Value::Number(text) => text.parse().ok(),
        _ => None,
    };
    let numbers: Vec<f64> = items.iter().map(number).collect::<Option<_>>()?;
    // An empty list is how a case says that there is a single tilt.
    NumberList::new(&numbers).filter(|list| !list.is_empty())
}

/// Negative zero is zero.
fn tidy(value: Scalar) -> Scalar {
    match value {
        Scalar::Number(number) => Scalar::Number(number + 0.0),
        other => other,
    }
}

impl Range {
    /// Numbers from one to another, both included.
    pub const fn closed(low: f64, high: f64) -> Self {
        Self { low: Included(low), high: Included(high) }
    }

    fn contains(&self, number: f64) -> bool {
        let above = match self.low {
            Included(low) => number >= low,
            Excluded(low) => number > low,
        };
        let below = match self.high {
            Included(high) => number <= high,
            Excluded(high) => number < high,
        };
        above && below
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.low {
            Included(low) => write!(f, "of at least {}", number::text(low))?,
            Excluded(low) => write!(f, "above {}", number::text(low))?,
        }
        match self.high {
            Included(high) => write!(f, " and at most {}", number::text(high)),
            Excluded(high) => write!(f, " and below {}", number::text(high)),
        }
    }
}

impl fmt::Display for CountRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "from {} to {}", self.low, self.high)
    }
}
