//! Cells of tables.

use std::borrow::Cow;
use std::fmt;

use serde::Serialize;
use sweep::Scalar;
use text::number;

use crate::design::failure::finite;

/// The value of one cell of a table, before it is formatted for a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// A value that does not exist.
    Empty,
    /// A real number. A number that is not finite is written as an empty cell.
    Number(f64),
    /// A whole number.
    Count(i64),
    /// A text.
    Text(Cow<'static, str>),
}

impl Cell {
    /// Returns the number in the cell, if it is finite.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => finite(*number),
            // Counts in a table are far below 2^53, so the conversion is exact.
            Self::Count(count) => Some(*count as f64),
            Self::Empty | Self::Text(_) => None,
        }
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) if number.is_finite() => number::write(f, *number),
            Self::Empty | Self::Number(_) => Ok(()),
            Self::Count(count) => write!(f, "{count}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<i64> for Cell {
    fn from(count: i64) -> Self {
        Self::Count(count)
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        // Counts of objects in memory are far below 2^63.
        Self::Count(i64::try_from(count).unwrap_or(i64::MAX))
    }
}

impl From<&'static str> for Cell {
    fn from(text: &'static str) -> Self {
        Self::Text(text.into())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text.into())
    }
}

impl From<Scalar> for Cell {
    fn from(scalar: Scalar) -> Self {
        match scalar {
            Scalar::Number(number) => number.into(),
            Scalar::Count(count) => count.into(),
            Scalar::Word(word) => word.into(),
            Scalar::List(_) => scalar.to_string().into(),
        }
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Empty, Into::into)
    }
}
