//! Between Python and the values of definitions and tables.

use pyo3::prelude::*;
use pyo3::types::{PyBool, PyByteArray, PyDict, PyFloat, PyInt, PyList, PyString};
use results::{Cell, Column};
use sweep::number;
use sweep::toml_source::{KeyValue, Place, Value};

/// A column for Python: name, unit, meaning, and its cells, the bytes of numbers or a list of texts.
pub type Array<'py> = (String, &'static str, &'static str, Bound<'py, PyAny>);

/// The place of everything that comes from Python, for messages.
pub fn place() -> Place {
    Place::Argument("squama".into())
}

/// A thing as text. Not by `to_string`, which would take an interrupt for a text that cannot be made, and swallow it.
pub fn text(of: &Bound<'_, PyAny>) -> PyResult<String> {
    of.str()?.extract()
}

/// A value as a definition would write it. What no definition can hold is kept as text, to be refused by name.
pub fn value(of: &Bound<'_, PyAny>) -> PyResult<Value> {
    if of.is_instance_of::<PyBool>() {
        return Ok(Value::Other(text(of)?.to_lowercase()));
    }
    if of.is_instance_of::<PyString>() {
        return Ok(Value::Text(text(of)?));
    }
    if of.is_instance_of::<PyInt>() {
        return Ok(Value::Number(text(of)?));
    }
    if of.is_instance_of::<PyFloat>() {
        return Ok(Value::Number(number::text(of.extract()?)));
    }
    if let Ok(entries) = of.cast::<PyDict>() {
        let entry = |(key, of): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            Ok(KeyValue { key: text(&key)?, value: value(&of)?, place: place() })
        };
        return entries.iter().map(entry).collect::<PyResult<_>>().map(Value::Table);
    }
    // Scalars and arrays of numpy become plain numbers and lists.
    if of.hasattr("tolist")? {
        return value(&of.call_method0("tolist")?);
    }
    match of.try_iter() {
        Ok(items) => items.map(|item| value(&item?)).collect::<PyResult<_>>().map(Value::List),
        Err(_) => Ok(Value::Other(of.repr()?.extract()?)),
    }
}

/// The cell of a table: a number, a text, or `None`.
pub fn cell(py: Python<'_>, cell: Cell) -> PyResult<Bound<'_, PyAny>> {
    Ok(match cell {
        Cell::Empty => py.None().into_bound(py),
        Cell::Text(text) if text.is_empty() => py.None().into_bound(py),
        Cell::Number(number) => number.into_pyobject(py)?.into_any(),
        Cell::Count(count) => count.into_pyobject(py)?.into_any(),
        Cell::Text(text) => text.into_pyobject(py)?.into_any(),
    })
}

/// The cells of every column in some rows.
pub fn arrays<'py, R>(
    py: Python<'py>,
    columns: &[Column<R>],
    rows: &[R],
) -> PyResult<Vec<Array<'py>>> {
    let array = |column: &Column<R>| {
        let cells = array(py, rows.iter().map(|row| column.cell(row)))?;
        Ok((column.name.to_string(), column.unit, column.meaning, cells))
    };
    columns.iter().map(array).collect()
}

/// The cells of a column: the bytes of numbers, of which one that does not exist is NaN, or, if one is a text, a list.
pub fn array(
    py: Python<'_>,
    cells: impl Iterator<Item = Cell> + Clone,
) -> PyResult<Bound<'_, PyAny>> {
    if cells.clone().any(|cell| matches!(cell, Cell::Text(text) if !text.is_empty())) {
        let list = PyList::empty(py);
        for of in cells {
            list.append(cell(py, of)?)?;
        }
        return Ok(list.into_any());
    }
    let bytes: Vec<u8> =
        cells.flat_map(|cell| cell.number().unwrap_or(f64::NAN).to_ne_bytes()).collect();
    Ok(PyByteArray::new(py, &bytes).into_any())
}
