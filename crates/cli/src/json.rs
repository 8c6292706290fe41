//! Output for programs.

use results::Cell;
use serde_json::Value;
use sweep::Scalar;

/// Prints `value` as JSON.
pub fn print(value: &Value) -> std::io::Result<()> {
    // What people would not see is a part of a text for programs.
    crate::print::print_raw(&format!("{value:#}\n"))
}

/// The value of a parameter.
pub fn scalar(scalar: Scalar) -> Value {
    match scalar {
        Scalar::Number(number) => number.into(),
        Scalar::Count(count) => count.into(),
        Scalar::Word(word) => word.into(),
        Scalar::List(list) => list.as_slice().into(),
    }
}

/// The value of a cell; `null` if there is none.
pub fn cell(cell: &Cell) -> Value {
    match cell {
        Cell::Empty => Value::Null,
        Cell::Number(number) => (*number).into(),
        Cell::Count(count) => (*count).into(),
        Cell::Text(text) => text.as_ref().into(),
    }
}
