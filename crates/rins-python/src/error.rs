//! Errors of the library as Python exceptions.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The exception for an error: `rins.ModelError` if a model file is wrong or cannot be estimated, `rins.DataError` otherwise.
pub(crate) fn exception(py: Python<'_>, error: &rins::Error, model: Option<&str>) -> PyErr {
    let is_in_model = model.is_some_and(|model| error.file().is_some_and(|file| file == model));
    let class = if is_in_model || error.is_of_model() { "ModelError" } else { "DataError" };
    let file = error.file().map(|file| file.to_string_lossy().into_owned());
    placed(py, class, (error.to_string(), file, error.line(), error.key()))
}

/// `rins.DataError` about data in memory.
pub(crate) fn data_error(py: Python<'_>, message: String, file: &str, key: &str) -> PyErr {
    placed(py, "DataError", (message, Some(file.to_owned()), None, Some(key)))
}

type Place<'a> = (String, Option<String>, Option<u64>, Option<&'a str>);

fn placed(py: Python<'_>, class: &str, place: Place<'_>) -> PyErr {
    let made = py.import("rins._errors").and_then(|module| module.getattr(class)?.call1(place));
    match made {
        Ok(value) => PyErr::from_value(value),
        Err(error) => error,
    }
}

/// `ValueError` for an argument.
pub(crate) fn argument(name: &str, expected: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(format!("{name}: {expected}"))
}
