//! Quantities with units as arguments.

use pyo3::prelude::*;
use rins::io::Kind;

use crate::error::argument;

/// An argument of this kind in SI units.
pub(crate) fn quantity(name: &str, kind: &Kind, text: &str) -> PyResult<f64> {
    kind.parse(text).map_err(|error| argument(name, error))
}

/// An argument that is more than zero.
pub(crate) fn positive(name: &str, value: f64) -> PyResult<f64> {
    if value > 0.0 { Ok(value) } else { Err(argument(name, "expected more than zero")) }
}
