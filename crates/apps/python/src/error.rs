//! Errors as exceptions of the package, which are written in Python so that they pickle.

use std::fmt::Display;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use sweep::{InvalidDefinition, Problem, WrongValue};

/// The exception `name` with such arguments.
fn exception<'py>(
    py: Python<'py>,
    name: &str,
    arguments: impl pyo3::call::PyCallArgs<'py>,
) -> PyErr {
    // Where the class cannot be had, the reason for that is the exception.
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

/// Creates the exception for a definition that cannot be used, for the reason in `message`.
pub fn refused_definition(py: Python<'_>, message: &str) -> PyErr {
    exception(py, "InvalidDefinition", (message,))
}

/// Creates the exception for failed work.
pub fn failed(what: &str, reason: &str) -> PyErr {
    Python::attach(|py| exception(py, "Failed", (what, reason)))
}

/// Errors of the crates as exceptions.
pub trait OrFailed<T> {
    /// Returns the value, or an exception that names the failed operation.
    fn or_failed(self, what: &str) -> PyResult<T>;
}

impl<T, E: Display> OrFailed<T> for Result<T, E> {
    fn or_failed(self, what: &str) -> PyResult<T> {
        // Messages name flags of commands; functions have keywords instead.
        let spoken = |text: String| {
            let text = text.replace("squama run --resume", "squama.run(..., resume=True)");
            text.replace("--resume", "resume=True").replace("--fresh", "fresh=True")
        };
        self.map_err(|error| failed(what, &spoken(error.to_string())))
    }
}

/// Creates the exception for an invalid definition; `given` are the values from Python.
pub fn invalid_definition(
    py: Python<'_>,
    error: &InvalidDefinition,
    given: Option<&Bound<'_, PyDict>>,
) -> PyErr {
    match error {
        InvalidDefinition::Several(errors) if !errors.is_empty() => {
            let error_of = invalid_definition(py, &errors[0], given);
            // The first problem is the exception; the others are attached to it.
            for other in &errors[1..] {
                let _ = error_of.value(py).call_method1("add", (other.to_string(),));
            }
            error_of
        }
        InvalidDefinition::Refused { key, problem, .. } => {
            // Keywords of Python have no sections.
            let key = key.rsplit('.').next().unwrap_or(key);
            let value = given.and_then(|given| given.get_item(key).ok().flatten());
            let (found, expected) = explained(problem);
            let found = || found.map(|found| pyo3::types::PyString::new(py, &found).into_any());
            let value = value.or_else(found);
            // Without a value it is missing, or something else than a value is wrong.
            if value.is_none() && !matches!(**problem, Problem::Missing(_)) {
                return exception(py, "InvalidDefinition", (error.to_string(),));
            }
            invalid_parameter(py, key, value, &expected)
        }
        other => exception(py, "InvalidDefinition", (other.to_string(),)),
    }
}

/// Returns the value in question, and a description of valid values.
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
