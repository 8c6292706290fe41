//! Conversion between Python and the values of definitions and tables.

use std::borrow::Cow;
use std::sync::Arc;

use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    ArrayRef, Float64Array, RecordBatch, RecordBatchIterator, StringArray, StructArray,
};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyBool, PyCapsule, PyDict, PyFloat, PyInt, PyString};
use results::{Cell, Column};
use sweep::number;
use sweep::toml_source::{KeyValue, Place, Value};

use crate::error::OrFailed as _;

/// A column for Python: name, unit, meaning, and its cells.
pub type NamedCells = (String, &'static str, &'static str, Cells);

/// The place of everything that comes from Python, for messages.
pub fn place() -> Place {
    Place::Argument("squama".into())
}

/// Converts an object to text; unlike `to_string`, propagates interrupts.
pub fn text(of: &Bound<'_, PyAny>) -> PyResult<String> {
    of.str()?.extract()
}

/// Converts a value for a definition; unsupported types become text, which is rejected with its name.
pub fn value(of: &Bound<'_, PyAny>) -> PyResult<Value> {
    // Asked first, since in Python a boolean is a whole number, too.
    if of.is_instance_of::<PyBool>() {
        return Ok(Value::Other(text(of)?.to_lowercase()));
    }
    if of.is_instance_of::<PyString>() {
        return Ok(Value::Text(text(of)?));
    }
    if of.is_instance_of::<PyInt>() {
        // As text: whole numbers of Python have no bounds.
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
#[derive(IntoPyObject)]
pub enum PythonCell {
    Empty(Option<()>),
    Number(f64),
    Count(i64),
    Text(Cow<'static, str>),
}

impl From<Cell> for PythonCell {
    fn from(cell: Cell) -> Self {
        match cell {
            Cell::Text(text) if !text.is_empty() => Self::Text(text),
            Cell::Empty | Cell::Text(_) => Self::Empty(None),
            Cell::Number(number) => Self::Number(number),
            Cell::Count(count) => Self::Count(count),
        }
    }
}

/// The cells of a column: the bytes of numbers, of which one that does not exist is NaN, unless one of them is a text.
#[derive(IntoPyObject)]
pub enum Cells {
    Numbers(Vec<u8>),
    Texts(Vec<PythonCell>),
}

impl Extend<Cell> for Cells {
    /// Adds cells. The first text makes all of them texts.
    fn extend<T: IntoIterator<Item = Cell>>(&mut self, cells: T) {
        let cells: Vec<Cell> = cells.into_iter().collect();
        let is_text = |cell: &Cell| matches!(cell, Cell::Text(text) if !text.is_empty());
        if let Self::Numbers(known) = self
            && cells.iter().any(is_text)
        {
            let (known, _) = known.as_chunks();
            // NaN stood for a cell that does not exist, and becomes one again.
            let known = known.iter().map(|of| Cell::from(f64::from_ne_bytes(*of)).number());
            *self = Self::Texts(known.map(|number| Cell::from(number).into()).collect());
        }
        match self {
            Self::Texts(texts) => texts.extend(cells.into_iter().map(PythonCell::from)),
            Self::Numbers(bytes) => {
                let number = |cell: &Cell| cell.number().unwrap_or(f64::NAN).to_ne_bytes();
                bytes.extend(cells.iter().flat_map(number));
            }
        }
    }
}

/// The cells of every column in some rows.
pub fn table<R>(columns: &[Column<R>], rows: impl IntoIterator<Item = R>) -> Vec<NamedCells> {
    let rows: Vec<R> = rows.into_iter().collect();
    let named = |column: &Column<R>| {
        let mut cells = Cells::Numbers(Vec::new());
        cells.extend(rows.iter().map(|row| column.cell(row)));
        (column.name.to_string(), column.unit, column.meaning, cells)
    };
    columns.iter().map(named).collect()
}

/// The columns of a table as a stream of Arrow, of one batch, in the capsule by which libraries hand over such streams.
#[pyfunction]
pub fn arrow(py: Python<'_>, columns: Vec<(String, ArrowCells)>) -> PyResult<Bound<'_, PyCapsule>> {
    // A batch of no columns, which `try_from_iter` does not make.
    let mut batch = RecordBatch::from(StructArray::new_empty_fields(0, None));
    if !columns.is_empty() {
        let arrays = columns.into_iter().map(|(name, cells)| (name, cells.array(), true));
        batch = RecordBatch::try_from_iter_with_nullable(arrays).or_failed("arrow")?;
    }
    let schema = batch.schema();
    let stream = FFI_ArrowArrayStream::new(Box::new(RecordBatchIterator::new([Ok(batch)], schema)));
    PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
}

/// The cells of a column as a table in Python has them.
#[derive(FromPyObject)]
pub enum ArrowCells {
    Numbers(PyBackedBytes),
    Texts(Vec<Option<String>>),
}

impl ArrowCells {
    fn array(self) -> ArrayRef {
        match self {
            Self::Texts(texts) => Arc::new(StringArray::from(texts)),
            Self::Numbers(bytes) => {
                let (numbers, _) = bytes.as_chunks();
                let numbers = numbers.iter().map(|of| f64::from_ne_bytes(*of));
                // NaN means a missing value, which Arrow represents as null.
                let numbers = numbers.map(|of| (!of.is_nan()).then_some(of));
                Arc::new(numbers.collect::<Float64Array>())
            }
        }
    }
}
