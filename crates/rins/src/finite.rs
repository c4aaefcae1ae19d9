//! Numbers that JSON has not.

/// A number, or nothing if it is infinite or none.
pub(crate) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
