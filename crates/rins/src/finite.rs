//! Numbers that JSON does not support.

/// The number, or `None` if it is infinite or NaN.
pub(crate) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
