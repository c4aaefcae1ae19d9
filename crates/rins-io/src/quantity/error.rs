//! What can be wrong with a quantity.

use super::dimension::Dimension;

/// Why a text is not the quantity that is wanted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QuantityError {
    /// It does not begin with a number.
    #[error("{text:?} does not begin with a number")]
    NotANumber {
        /// The text.
        text: String,
    },
    /// The number, or its value in SI units, is infinite or not a number.
    #[error("{text:?} is not finite")]
    NotFinite {
        /// The text.
        text: String,
    },
    /// Nothing follows the number.
    #[error("{text:?} has no unit")]
    NoUnit {
        /// The text.
        text: String,
    },
    /// A unit is not known.
    #[error("{text:?}: unknown unit {unit:?}{}", did_you_mean(*.suggestion))]
    UnknownUnit {
        /// The text.
        text: String,
        /// The unit in it that is not known.
        unit: String,
        /// What may have been meant.
        suggestion: Option<&'static str>,
    },
    /// The unit is not a product of units.
    #[error("{text:?} is not a product of units such as \"deg/h/sqrt(Hz)\"")]
    Malformed {
        /// The text.
        text: String,
    },
    /// It measures something else.
    #[error("{text:?} is {got}, expected {expected} such as {example:?}")]
    WrongDimension {
        /// The text.
        text: String,
        /// What it measures.
        got: Dimension,
        /// What it should measure.
        expected: &'static str,
        /// A text that would do.
        example: &'static str,
    },
    /// It lies outside the range in which it makes sense.
    #[error("{text:?} is out of range, expected {expected}")]
    OutOfRange {
        /// The text.
        text: String,
        /// The range, in words.
        expected: &'static str,
    },
    /// It is too long to be a quantity.
    #[error("a text of {length} characters is too long for a quantity")]
    TooLong {
        /// Its length.
        length: usize,
    },
}

pub(crate) fn did_you_mean(suggestion: Option<&str>) -> String {
    suggestion.map_or_else(String::new, |word| format!("; did you mean {word:?}?"))
}
