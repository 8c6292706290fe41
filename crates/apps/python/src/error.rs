//! Conversion of errors to the exceptions of the package.
//!
//! The exceptions are defined in Python, so that they can be pickled.

use std::fmt::Display;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use sweep::{InvalidDefinition, Problem, WrongValue};

use crate::names::NAMES;

/// Creates the exception `name` with the given arguments.
fn exception<'py>(
    py: Python<'py>,
    name: &str,
    arguments: impl pyo3::call::PyCallArgs<'py>,
) -> PyErr {
    // If the class cannot be imported, return the import error.
    let class = py.import("squama._errors").and_then(|module| module.getattr(name));
    class.and_then(|class| class.call1(arguments)).map_or_else(|error| error, PyErr::from_value)
}

/// Creates the exception for an invalid value of a parameter.
pub fn invalid_parameter(
    py: Python<'_>,
    key: &str,
    value: Option<Bound<'_, PyAny>>,
    expected: &str,
) -> PyErr {
    exception(py, "InvalidParameter", (key, value, expected))
}

/// Creates the exception for an unusable definition; `message` is the reason.
pub fn refused_definition(py: Python<'_>, message: &str) -> PyErr {
    exception(py, "InvalidDefinition", (message,))
}

/// Creates the exception for a failed operation.
pub fn failed(what: &str, reason: &str) -> PyErr {
    Python::attach(|py| exception(py, "Failed", (what, reason)))
}

/// Conversion of errors of the crates to exceptions.
pub trait OrFailed<T> {
    /// Returns the value, or an exception that names the failed operation.
    fn or_failed(self, what: &str) -> PyResult<T>;
}

impl<T, E: Display> OrFailed<T> for Result<T, E> {
    fn or_failed(self, what: &str) -> PyResult<T> {
        // Messages name options of commands; functions have keywords instead.
        let in_python = |text: String| {
            let text = text.replace("squama run --resume", "squama.run(..., resume=True)");
            text.replace("--resume", "resume=True").replace("--fresh", "fresh=True")
        };
        self.map_err(|error| failed(what, &in_python(error.to_string())))
    }
}

/// Creates the exception for an invalid definition; `given` holds the keywords from Python.
pub fn invalid_definition(
    py: Python<'_>,
    error: &InvalidDefinition,
    given: Option<&Bound<'_, PyDict>>,
) -> PyErr {
    match error {
        InvalidDefinition::Several(errors) if !errors.is_empty() => {
            let error_of = invalid_definition(py, &errors[0], given);
            // The first problem becomes the exception; the others are attached to it.
            for other in &errors[1..] {
                let _ = error_of.value(py).call_method1("add", (other.to_string(),));
            }
            error_of
        }
        InvalidDefinition::Refused { key, problem, .. } => {
            // Keys of definitions have a section, but Python keywords have none.
            let of_name =
                NAMES.iter().find(|name| *key == format!("{}.{}", name.section, name.key));
            let last = key.rsplit('.').next().unwrap_or(key);
            let key = of_name.filter(|_| given.is_some()).map_or(last, |name| name.keyword);
            let value = given.and_then(|given| given.get_item(key).ok().flatten());
            let (found, expected) = explained(problem);
            let value = value
                .or_else(|| found.map(|found| pyo3::types::PyString::new(py, &found).into_any()));
            // Without a value, the key is missing or the problem does not concern a value.
            if value.is_none() && !matches!(**problem, Problem::Missing(_)) {
                return exception(py, "InvalidDefinition", (error.to_string(),));
            }
            invalid_parameter(py, key, value, &expected)
        }
        other => exception(py, "InvalidDefinition", (other.to_string(),)),
    }
}

/// Returns the invalid value, if the problem states one, and a description of valid values.
fn explained(problem: &Problem) -> (Option<String>, String) {
    match problem {
        Problem::Value(
            WrongValue::OutOfRange { found, expected }
            | WrongValue::NotAccepted { found, expected },
        ) => (Some(found.clone()), expected.clone()),
        Problem::Missing(expected) => (None, (*expected).to_owned()),
        Problem::Value(WrongValue::NoEffect(reason)) => (None, reason.clone()),
        Problem::Unknown { value, hint } => (Some(value.clone()), hint.clone()),
        other => (None, other.to_string()),
    }
}
