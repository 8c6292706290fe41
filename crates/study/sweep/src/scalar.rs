//! The value of one parameter.

use std::fmt;

use serde::Serialize;
use skin::puncture::NumberList;

use text::number;

/// The value of one parameter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Scalar {
    /// A real number.
    Number(f64),
    /// A count.
    Count(usize),
    /// One of a few words.
    Word(&'static str),
    /// A short list of real numbers.
    List(NumberList),
}

impl fmt::Display for Scalar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => f.write_str(&number::text(*number)),
            Self::Count(count) => write!(f, "{count}"),
            Self::Word(word) => f.write_str(word),
            Self::List(list) => {
                let numbers = list.as_slice().iter().map(|&number| number::text(number));
                write!(f, "[{}]", numbers.collect::<Vec<_>>().join(", "))
            }
        }
    }
}

impl Scalar {
    /// Returns the value if it is a real number.
    pub fn number(self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(number),
            Self::Count(_) | Self::Word(_) | Self::List(_) => None,
        }
    }

    /// Returns true if `self` and `other` are equal up to round-off.
    pub fn same(self, other: Self) -> bool {
        match (self, other) {
            (Self::Number(one), Self::Number(other)) => number::same(one, other),
            (Self::List(one), Self::List(other)) => {
                let (one, other) = (one.as_slice(), other.as_slice());
                one.len() == other.len() && one.iter().zip(other).all(|(a, b)| number::same(*a, *b))
            }
            _ => self == other,
        }
    }

    /// Returns the value as written in a definition: words in quotes, except booleans.
    pub fn to_toml(self) -> String {
        match self {
            Self::Word(word) if word.parse::<bool>().is_err() => format!("\"{word}\""),
            value => value.to_string(),
        }
    }
}
