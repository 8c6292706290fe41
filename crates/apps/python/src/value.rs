//! Conversion between Python and the values of definitions and tables.

use std::borrow::Cow;
use std::sync::Arc;

use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    ArrayRef, Float64Array, RecordBatch, RecordBatchIterator, StringArray, StructArray,
};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyBool, PyCapsule, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use ranking::Requirement;
use results::{Cell, Column};
use text::number;
use text::toml_source::{KeyValue, Location, Value};

use crate::error::OrFailed as _;

/// A column for Python: name, unit, meaning, and its cells.
pub type NamedCells = (String, &'static str, &'static str, Cells);

/// Returns the location that messages state for values from Python.
pub fn location() -> Location {
    Location::Argument("squama".into())
}

/// Converts an object to text. Unlike `to_string`, this function propagates interrupts.
pub fn text(of: &Bound<'_, PyAny>) -> PyResult<String> {
    of.str()?.extract()
}

/// Parses requirements, such as `coverage >= 0.6`.
pub fn requirements(texts: &[String]) -> PyResult<Vec<Requirement>> {
    texts.iter().map(|text| text.parse().or_failed(text)).collect()
}

/// Maximum depth of nested lists and tables; definitions need at most three levels.
///
/// Without a limit, a list that contains itself would overflow the stack.
const MAX_DEPTH: usize = 8;

/// Converts a value to its form in a definition.
///
/// Unsupported values become text, so that the parser rejects them with their key.
pub fn value(object: &Bound<'_, PyAny>) -> PyResult<Value> {
    nested_value(object, MAX_DEPTH)
}

fn nested_value(object: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    if depth == 0 {
        return Ok(Value::Other(format!("a value of more than {MAX_DEPTH} levels")));
    }
    // Check booleans first, because they are integers in Python.
    if object.is_instance_of::<PyBool>() {
        return Ok(Value::Other(text(object)?.to_lowercase()));
    }
    if object.is_instance_of::<PyString>() {
        return Ok(Value::Text(text(object)?));
    }
    if object.is_instance_of::<PyInt>() {
        // Pass integers as text, because Python integers are unbounded.
        return Ok(Value::Number(text(object)?));
    }
    if object.is_instance_of::<PyFloat>() {
        return Ok(Value::Number(number::text(object.extract()?)));
    }
    if let Ok(entries) = object.cast::<PyDict>() {
        let mut table = Vec::with_capacity(entries.len());
        for (key, entry) in entries.iter() {
            let value = nested_value(&entry, depth - 1)?;
            table.push(KeyValue { key: text(&key)?, value, location: location() });
        }
        return Ok(Value::Table(table));
    }
    // Scalars and arrays of numpy become numbers and lists.
    if object.hasattr("tolist")? {
        return nested_value(&object.call_method0("tolist")?, depth - 1);
    }
    // Reject other iterables: sets have no order, and generators may be endless.
    if object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>() {
        let items = object.try_iter()?.map(|item| nested_value(&item?, depth - 1));
        return items.collect::<PyResult<_>>().map(Value::List);
    }
    Ok(Value::Other(format!("a value of type {}", object.get_type().name()?)))
}

/// A table cell: a number, a text, or `None`.
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

/// The cells of a column: numbers as bytes (NaN if missing), or texts.
///
/// If any cell is text, the whole column is text.
#[derive(IntoPyObject)]
pub enum Cells {
    Numbers(Vec<u8>),
    Texts(Vec<PythonCell>),
}

impl Extend<Cell> for Cells {
    /// Appends cells; the first text converts the whole column to text.
    fn extend<T: IntoIterator<Item = Cell>>(&mut self, cells: T) {
        let cells: Vec<Cell> = cells.into_iter().collect();
        if let Self::Numbers(known) = self
            && cells.iter().any(|cell| matches!(cell, Cell::Text(text) if !text.is_empty()))
        {
            let (known, _) = known.as_chunks();
            // `Cell::from` converts NaN to an empty cell.
            let known = known.iter().map(|of| Cell::from(f64::from_ne_bytes(*of)).number());
            *self = Self::Texts(known.map(|number| Cell::from(number).into()).collect());
        }
        match self {
            Self::Texts(texts) => texts.extend(cells.into_iter().map(PythonCell::from)),
            Self::Numbers(bytes) => {
                bytes.extend(
                    cells.iter().flat_map(|cell| cell.number().unwrap_or(f64::NAN).to_ne_bytes()),
                );
            }
        }
    }
}

impl Cells {
    /// Creates the cells of a column; the column is numeric if every cell is a number or empty.
    pub fn of_texts(cells: Vec<String>) -> Self {
        let number =
            |cell: &String| if cell.is_empty() { Some(f64::NAN) } else { cell.parse::<f64>().ok() };
        match cells.iter().map(number).collect::<Option<Vec<_>>>() {
            Some(numbers) => {
                Self::Numbers(numbers.into_iter().flat_map(f64::to_ne_bytes).collect())
            }
            None => Self::text_column(cells),
        }
    }

    /// Creates the cells of a text column, such as design numbers with leading zeros.
    pub fn text_column(cells: Vec<String>) -> Self {
        Self::Texts(
            cells.into_iter().map(|text| PythonCell::from(Cell::Text(text.into()))).collect(),
        )
    }
}

/// Returns the cells of every column for the given rows.
pub fn table<R>(columns: &[Column<R>], rows: impl IntoIterator<Item = R>) -> Vec<NamedCells> {
    let rows: Vec<R> = rows.into_iter().collect();
    columns
        .iter()
        .map(|column| {
            let mut cells = Cells::Numbers(Vec::new());
            cells.extend(rows.iter().map(|row| column.cell(row)));
            (column.name.to_string(), column.unit, column.meaning, cells)
        })
        .collect()
}

/// Returns a table as an Arrow stream of one batch, in a `PyCapsule`.
#[pyfunction]
pub fn arrow(py: Python<'_>, columns: Vec<(String, ArrowCells)>) -> PyResult<Bound<'_, PyCapsule>> {
    // A table without columns is an empty batch, because `try_from_iter` rejects it.
    let mut batch = RecordBatch::from(StructArray::new_empty_fields(0, None));
    if !columns.is_empty() {
        let arrays = columns.into_iter().map(|(name, cells)| (name, cells.array(), true));
        batch = RecordBatch::try_from_iter_with_nullable(arrays).or_failed("arrow")?;
    }
    let schema = batch.schema();
    let stream = FFI_ArrowArrayStream::new(Box::new(RecordBatchIterator::new([Ok(batch)], schema)));
    PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
}

/// The cells of a column in a Python table.
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
