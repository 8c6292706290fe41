//! Parameters of definitions. To add a parameter, follow the steps in `parameter/list.rs`.

mod continuous;
pub mod key;
pub(crate) mod length;
mod list;
mod modulus;
mod role;
mod schema;

use std::fmt;

use skin::puncture::{MOST_NUMBERS, NumberList};

use crate::case::Case;
use crate::decimal::Decimal;
use crate::scalar::Scalar;
use text::number;
use text::toml_source::Value;

pub use list::PARAMETERS;
pub use role::Role;

/// A scalar parameter of a sweep definition, set in its section or as an axis.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Key in the definition, and name of its axis and column.
    pub key: &'static str,
    /// Section of the definition that contains the parameter unless it is an axis.
    pub section: &'static str,
    /// Unit, or `-` for a parameter without a unit.
    pub unit: &'static str,
    /// Meaning, as a phrase without a full stop.
    pub meaning: &'static str,
    /// Roles in the model.
    pub(crate) roles: &'static [Role],
    /// Accepted values, and the field of [`Case`] that holds the value.
    pub(crate) kind: ParameterKind,
}

impl PartialEq for Parameter {
    fn eq(&self, other: &Self) -> bool {
        // Keys are unique over all sections, and function pointers cannot be compared.
        self.key == other.key
    }
}

/// Accepted values of a parameter, and access to its field of [`Case`].
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
    /// A number with either sign; the bounds apply to its magnitude.
    SignedNumber {
        size: Range,
        field: fn(&mut Case) -> &mut f64,
    },
    /// A number that may be missing.
    OptionalNumber {
        range: Range,
        field: fn(&mut Case) -> &mut Option<f64>,
    },
    /// A whole number, or a word instead of it, such as `auto`.
    CountOrWord {
        range: CountRange,
        word: &'static str,
        get: fn(&Case) -> Option<usize>,
        set: fn(&mut Case, Option<usize>),
    },
    /// A number, an ascending list of up to [`MOST_NUMBERS`] numbers, or the word `word`, if any.
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

/// Word that represents a missing number. A definition cannot contain this word.
const NOT_GIVEN: &str = "not given";

/// A value that a parameter does not accept.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WrongValue {
    /// The type is right, but the value is out of bounds.
    #[error("{found} is out of range, expected {expected}")]
    OutOfRange {
        /// The value.
        found: String,
        /// Accepted values.
        expected: String,
    },
    /// The key has no effect.
    #[error("has no effect: {0}")]
    NoEffect(String),
    /// The type or the word is wrong.
    #[error("{found} is not accepted, expected {expected}")]
    NotAccepted {
        /// The value.
        found: String,
        /// Accepted values.
        expected: String,
    },
}

impl WrongValue {
    /// Creates the error of the refused value `found`, with the accepted values `expected`.
    pub fn not_accepted(found: impl fmt::Display, expected: impl Into<String>) -> Self {
        Self::NotAccepted { found: found.to_string(), expected: expected.into() }
    }
}

impl Parameter {
    /// Returns the parameter with this key.
    pub fn named(key: &str) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.key == key)
    }

    /// Returns `section.key`.
    pub fn path(&self) -> String {
        format!("{}.{}", self.section, self.key)
    }

    /// Returns the value of this parameter in `case`.
    pub fn get(&self, case: &Case) -> Scalar {
        // The accessor `field` needs a mutable case, also for reading, so copy the case.
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

    /// Returns true if a case has a value for this parameter.
    pub fn is_given(&self, case: &Case) -> bool {
        self.get(case) != Scalar::Word(NOT_GIVEN)
    }

    /// Returns the default value.
    pub fn default(&self) -> Scalar {
        self.get(&Case::default())
    }

    /// Sets this parameter in `case`, and updates the parameters that follow from it.
    ///
    /// The value must come from [`Self::read`] or [`Self::scalar`].
    pub(crate) fn set(&self, case: &mut Case, value: Scalar) {
        // Update the dependent parameters after each change, because axes and sections set
        // parameters in any order.
        self.assign(case, value);
        length::settle(case);
        modulus::settle(case);
    }

    /// Sets this parameter without updating the parameters that follow from it.
    fn assign(&self, case: &mut Case, value: Scalar) {
        match (&self.kind, value) {
            (
                ParameterKind::Number { field, .. } | ParameterKind::SignedNumber { field, .. },
                Scalar::Number(number),
            ) => *field(case) = number,
            // The word for a missing number removes the value.
            (ParameterKind::OptionalNumber { field, .. }, value) => *field(case) = value.number(),
            (ParameterKind::Count { field, .. }, Scalar::Count(count)) => *field(case) = count,
            (ParameterKind::Word { words, set, .. }, Scalar::Word(word)) => {
                // `read` accepts only these words, so the position always exists.
                set(case, words.iter().position(|known| *known == word).unwrap_or(0));
            }
            (ParameterKind::CountOrWord { set, .. }, Scalar::Count(count)) => {
                set(case, Some(count));
            }
            (ParameterKind::CountOrWord { set, .. }, Scalar::Word(_)) => set(case, None),
            (ParameterKind::Numbers { set, .. }, value) => set(case, value),
            // `read` returns values of the right kind, so any other value is an internal error.
            _ => debug_assert!(false, "{} cannot be {value}", self.key),
        }
    }

    /// Converts the value `written` in a definition to a value of this parameter.
    ///
    /// # Errors
    ///
    /// If `written` has another type or is out of range.
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
            // A boolean of TOML is one of the words `true` and `false`.
            (ParameterKind::Word { words, .. }, Value::Text(text) | Value::Other(text)) => {
                words.iter().find(|word| *word == text).map(|word| Scalar::Word(word))
            }
            _ => None,
        };
        match value {
            // TOML also has the numbers `nan` and `inf`; no range contains them.
            Some(value) if self.contains(value) => Ok(tidy(value)),
            _ => Err(self.wrong(written)),
        }
    }

    /// Converts `number`, a number of a range, to a value of this parameter.
    pub(crate) fn scalar(&self, number: Decimal) -> Scalar {
        match self.kind {
            ParameterKind::Number { .. }
            | ParameterKind::SignedNumber { .. }
            | ParameterKind::OptionalNumber { .. }
            | ParameterKind::Numbers { .. }
            | ParameterKind::Word { .. } => Scalar::Number(number.to_f64()),
            ParameterKind::Count { .. } | ParameterKind::CountOrWord { .. } => {
                // The number is whole and within bounds, because both ends and the step of the
                // range were checked.
                Scalar::Count(number.to_usize().unwrap_or(usize::MAX))
            }
        }
    }

    /// Returns `case` with this parameter set to `value`, and the dependent parameters updated.
    ///
    /// `value` comes from [`Self::read`] or is a number.
    pub fn put(&self, case: &Case, value: Scalar) -> Case {
        let mut changed = *case;
        self.set(&mut changed, value);
        changed
    }

    /// Returns `case` with this parameter set to `value`, even if another key defines it.
    ///
    /// The same length in mm is updated to agree with `value`. A number given for an alternative of
    /// this parameter, such as the radius for the curvature, is removed.
    pub fn replace(&self, case: &Case, value: Scalar) -> Case {
        let mut changed = *case;
        for instead in self.others_in(case).filter(|other| other.replaces(self)) {
            instead.assign(&mut changed, Scalar::Word(NOT_GIVEN));
        }
        self.assign(&mut changed, value);
        length::keep_in_step(&mut changed, self);
        changed
    }

    /// Returns true if the parameter is a length in mm.
    pub fn is_in_mm(&self) -> bool {
        self.over_t().is_some()
    }

    /// Returns true if the parameter takes numbers, and may therefore have a range.
    pub(crate) fn takes_numbers(&self) -> bool {
        !matches!(self.kind, ParameterKind::Word { .. })
    }

    /// Returns true if the parameter accepts a word instead of a number.
    pub(crate) fn takes_word(&self) -> bool {
        matches!(
            self.kind,
            ParameterKind::CountOrWord { .. } | ParameterKind::Numbers { word: Some(_), .. }
        )
    }

    /// Returns true if a case may have no number for the parameter.
    pub(crate) fn is_optional(&self) -> bool {
        self.takes_word() || matches!(self.kind, ParameterKind::OptionalNumber { .. })
    }

    /// Returns true if the numbers of the parameter are whole.
    pub(crate) fn takes_counts(&self) -> bool {
        matches!(self.kind, ParameterKind::Count { .. } | ParameterKind::CountOrWord { .. })
    }

    /// Returns the error of a value that [`Self::read`] refuses.
    fn wrong(&self, written: &Value) -> WrongValue {
        let found = written.to_string();
        let expected = self.expected();
        // `nan` is not out of range, so report it as not accepted.
        let is_number =
            matches!(written, Value::Number(text) if text.parse::<f64>().is_ok_and(f64::is_finite));
        if is_number && self.takes_numbers() {
            WrongValue::OutOfRange { found, expected }
        } else {
            WrongValue::NotAccepted { found, expected }
        }
    }

    /// Returns true if `value` is within the bounds of the parameter. Words have no bounds.
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

    /// Returns a phrase for messages that describes the accepted values.
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

    /// Returns a phrase that describes the numbers in `range`, such as "a length above 0".
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

/// Returns `words` in quotes, as alternatives.
pub(crate) fn any_of(words: &[&str]) -> String {
    words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(" or ")
}

/// Returns the numbers of `items` as a list.
///
/// `None` if an item is not a number, the list is empty or too long, or the numbers do not ascend.
fn list(items: &[Value]) -> Option<NumberList> {
    let numbers: Vec<f64> = items
        .iter()
        .map(|item| match item {
            Value::Number(text) => text.parse().ok(),
            _ => None,
        })
        .collect::<Option<_>>()?;
    // Refuse an empty list, which is the internal form of a single tilt.
    NumberList::new(&numbers).filter(|list| !list.is_empty())
}

/// Replaces negative zero by zero.
fn tidy(value: Scalar) -> Scalar {
    match value {
        Scalar::Number(number) => Scalar::Number(number + 0.0),
        other => other,
    }
}

impl Range {
    /// Returns the bounds from `low` to `high`, both included.
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
