//! A parameter of a sweep: which values are right, and where they go.

mod list;
mod scalar;

use std::fmt;

use crate::case::Case;
use crate::decimal::{Decimal, DecimalRange};
use crate::number;
use crate::toml_source::Value;

pub use list::PARAMETERS;
pub use scalar::Scalar;

/// A scalar that a sweep definition may set, in its section or as an axis of the grid.
#[derive(Debug)]
pub struct Parameter {
    /// Key in the definition, the name of its axis and of its column.
    pub key: &'static str,
    /// Section in which it is set when it is no axis.
    pub section: &'static str,
    /// Unit, `-` if it has none.
    pub unit: &'static str,
    /// What it is, in half a sentence.
    pub meaning: &'static str,
    /// Which values are right, and where they go.
    pub(crate) kind: Kind,
}

impl PartialEq for Parameter {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

/// Which values are right, and where they go.
#[derive(Debug)]
pub(crate) enum Kind {
    Number {
        noun: &'static str,
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
    /// A count, or the word `auto`.
    CountOrAuto {
        range: CountRange,
        get: fn(&Case) -> Option<usize>,
        set: fn(&mut Case, Option<usize>),
    },
}

/// Bounds of a number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Range {
    pub low: Bound,
    pub high: Bound,
}

#[derive(Clone, Copy, Debug)]
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

/// The word of a count that is to be found.
const AUTO: &str = "auto";

/// The two ways to say how long a strip is.
const ALTERNATIVES: [&str; 2] = ["gaps", "membrane_length_over_t"];

/// What is wrong with a value.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WrongValue {
    /// The right type, but outside of the bounds.
    #[error("{found} is out of range, expected {expected}")]
    OutOfRange {
        /// The value.
        found: String,
        /// What would be right.
        expected: String,
    },
    /// Not what this key takes.
    #[error("{found} is not accepted, expected {expected}")]
    NotAccepted {
        /// The value.
        found: String,
        /// What would be right.
        expected: String,
    },
}

impl Parameter {
    /// The parameter of that name.
    pub fn named(key: &str) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.key == key)
    }

    /// The parameter that says the same in another way: a definition has one of the two.
    pub(crate) fn alternative(&self) -> Option<&'static Self> {
        let [first, second] = ALTERNATIVES;
        match self.key {
            key if key == first => Self::named(second),
            key if key == second => Self::named(first),
            _ => None,
        }
    }

    /// `section.key`.
    pub fn path(&self) -> String {
        format!("{}.{}", self.section, self.key)
    }

    /// The value of this parameter in `case`.
    pub fn get(&self, case: &Case) -> Scalar {
        let mut case = *case;
        match &self.kind {
            Kind::Number { field, .. } => Scalar::Number(*field(&mut case)),
            Kind::Count { field, .. } => Scalar::Count(*field(&mut case)),
            Kind::Word { words, get, .. } => Scalar::Word(words[get(&case)]),
            Kind::CountOrAuto { get, .. } => get(&case).map_or(Scalar::Word(AUTO), Scalar::Count),
        }
    }

    /// The value that it has unless a definition says otherwise.
    pub fn default(&self) -> Scalar {
        self.get(&Case::default())
    }

    /// Sets this parameter in `case` to a value that [`Self::read`] or [`Self::pick`] gave.
    pub(crate) fn set(&self, case: &mut Case, value: Scalar) {
        match (&self.kind, value) {
            (Kind::Number { field, .. }, Scalar::Number(number)) => *field(case) = number,
            (Kind::Count { field, .. }, Scalar::Count(count)) => *field(case) = count,
            (Kind::Word { words, set, .. }, Scalar::Word(word)) => {
                // `read` takes no other words.
                set(case, words.iter().position(|known| *known == word).unwrap_or(0));
            }
            (Kind::CountOrAuto { set, .. }, Scalar::Count(count)) => set(case, Some(count)),
            (Kind::CountOrAuto { set, .. }, Scalar::Word(_)) => set(case, None),
            _ => debug_assert!(false, "{} cannot be {value}", self.key),
        }
        case.share();
    }

    /// The value `written`, if it is right for this parameter.
    ///
    /// # Errors
    /// If it is of another type or out of range.
    pub fn read(&self, written: &Value) -> Result<Scalar, WrongValue> {
        let value = match (&self.kind, written) {
            (Kind::Number { .. }, Value::Number(text)) => text.parse().ok().map(Scalar::Number),
            (Kind::Count { .. } | Kind::CountOrAuto { .. }, Value::Number(text)) => {
                let decimal = text.parse::<Decimal>().ok();
                decimal.and_then(Decimal::to_usize).map(Scalar::Count)
            }
            (Kind::Word { words, .. }, Value::Text(text)) => {
                words.iter().find(|word| *word == text).map(|word| Scalar::Word(word))
            }
            (Kind::CountOrAuto { .. }, Value::Text(text)) => {
                (text == AUTO).then_some(Scalar::Word(AUTO))
            }
            _ => None,
        };
        match value {
            Some(value) if self.contains(value) => Ok(tidy(value)),
            _ => Err(self.wrong(written)),
        }
    }

    /// Value `index` of `range`.
    pub(crate) fn pick(&self, range: &DecimalRange, index: u64) -> Scalar {
        let decimal = range.value(index);
        match self.kind {
            Kind::Number { .. } | Kind::Word { .. } => Scalar::Number(decimal.to_f64()),
            Kind::Count { .. } | Kind::CountOrAuto { .. } => {
                // Whole and in bounds: `read` has seen both ends and the step.
                Scalar::Count(decimal.to_usize().unwrap_or(usize::MAX))
            }
        }
    }

    /// Whether it takes numbers, so that a range of it makes sense.
    pub(crate) fn takes_numbers(&self) -> bool {
        !matches!(self.kind, Kind::Word { .. })
    }

    /// Whether its numbers are whole.
    pub(crate) fn takes_counts(&self) -> bool {
        matches!(self.kind, Kind::Count { .. } | Kind::CountOrAuto { .. })
    }

    /// What is wrong with a value that [`Self::read`] refuses.
    fn wrong(&self, written: &Value) -> WrongValue {
        let found = written.to_string();
        let expected = self.expected();
        let is_finite = |text: &String| text.parse::<f64>().is_ok_and(f64::is_finite);
        let is_number = matches!(written, Value::Number(text) if is_finite(text));
        if is_number && self.takes_numbers() {
            WrongValue::OutOfRange { found, expected }
        } else {
            WrongValue::NotAccepted { found, expected }
        }
    }

    fn contains(&self, value: Scalar) -> bool {
        match (&self.kind, value) {
            (Kind::Number { range, .. }, Scalar::Number(number)) => range.contains(number),
            (Kind::Count { range, .. } | Kind::CountOrAuto { range, .. }, Scalar::Count(count)) => {
                (range.low..=range.high).contains(&count)
            }
            _ => true,
        }
    }

    /// Which values are right, in words.
    pub fn expected(&self) -> String {
        match &self.kind {
            Kind::Number { noun, range, .. } => format!("{noun} {range}"),
            Kind::Count { range, .. } => format!("a whole number {range}"),
            Kind::Word { words, .. } => any_of(words),
            Kind::CountOrAuto { range, .. } => format!("a whole number {range} or \"{AUTO}\""),
        }
    }
}

/// `words` in quotes, as alternatives.
pub(crate) fn any_of(words: &[&str]) -> String {
    words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(" or ")
}

/// Negative zero is zero.
fn tidy(value: Scalar) -> Scalar {
    match value {
        Scalar::Number(number) => Scalar::Number(number + 0.0),
        other => other,
    }
}

impl Range {
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
