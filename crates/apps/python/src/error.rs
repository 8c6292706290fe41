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

/// A parameter with a value that it does not take.
pub fn invalid_parameter(
    py: Python<'_>,
    key: &str,
    value: Option<Bound<'_, PyAny>>,
    expected: &str,
) -> PyErr {
    exception(py, "InvalidParameter", (key, value, expected))
}

/// Work that could not be done, for a reason.
pub fn failed(what: &str, reason: &str) -> PyErr {
    Python::attach(|py| exception(py, "Failed", (what, reason)))
}

/// Errors of the crates as exceptions.
pub trait OrFailed<T> {
    /// The value, or the exception that `what` failed.
    fn or_failed(self, what: &str) -> PyResult<T>;
}

impl<T, E: Display> OrFailed<T> for Result<T, E> {
    fn or_failed(self, what: &str) -> PyResult<T> {
        // What a command is told by flags, a function is told by keywords.
        let spoken = |text: String| {
            let text = text.replace("squama run --resume", "squama.run(..., resume=True)");
            text.replace("--resume", "resume=True").replace("--fresh", "fresh=True")
        };
        self.map_err(|error| failed(what, &spoken(error.to_string())))
    }
}

/// What is wrong with a definition, where `given` are the values that came from Python.
pub fn invalid_definition(
    py: Python<'_>,
    error: &InvalidDefinition,
    given: Option<&Bound<'_, PyDict>>,
) -> PyErr {
    match error {
        InvalidDefinition::Several(errors) if !errors.is_empty() => {
            let error_of = invalid_definition(py, &errors[0], given);
            // The first is the exception, and the others are told with it.
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

/// The value that a problem is about, and what would be right.
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
