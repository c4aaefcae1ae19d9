//! Errors of quantities.

use super::dimension::Dimension;

/// The reason why a text is not the expected quantity.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QuantityError {
    /// The text does not begin with a number.
    #[error("{text:?} does not begin with a number")]
    NotANumber {
        /// The text.
        text: String,
    },
    /// The number, or its value in SI units, is infinite or NaN.
    #[error("{text:?} is not finite")]
    NotFinite {
        /// The text.
        text: String,
    },
    /// The number has no unit.
    #[error("{text:?} has no unit")]
    NoUnit {
        /// The text.
        text: String,
    },
    /// A unit is unknown.
    #[error("{text:?}: unknown unit {unit:?}{}", did_you_mean(*.suggestion))]
    UnknownUnit {
        /// The text.
        text: String,
        /// The unknown unit.
        unit: String,
        /// The most similar unit.
        suggestion: Option<&'static str>,
    },
    /// The unit is not a valid product of units.
    #[error("{text:?} is not a product of units such as \"deg/h/sqrt(Hz)\"")]
    Malformed {
        /// The text.
        text: String,
    },
    /// The dimension is wrong.
    #[error("{text:?} is {got}, expected {expected} such as {example:?}")]
    WrongDimension {
        /// The text.
        text: String,
        /// Its dimension.
        got: Dimension,
        /// The expected dimension.
        expected: &'static str,
        /// A valid example.
        example: &'static str,
    },
    /// The value is out of range.
    #[error("{text:?} is out of range, expected {expected}")]
    OutOfRange {
        /// The text.
        text: String,
        /// The permitted range.
        expected: &'static str,
    },
    /// The text is too long.
    #[error("a text of {length} characters is too long for a quantity")]
    TooLong {
        /// Its length.
        length: usize,
    },
}

pub(crate) fn did_you_mean(suggestion: Option<&str>) -> String {
    suggestion.map_or_else(String::new, |word| format!("; did you mean {word:?}?"))
}
