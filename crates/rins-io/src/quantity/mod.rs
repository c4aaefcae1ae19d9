//! Quantities: a number with its unit, parsed from text to SI units and radians.

mod dimension;
mod error;
pub mod kinds;
mod unit;

pub use dimension::Dimension;
pub use error::QuantityError;
pub(crate) use error::did_you_mean;
pub use kinds::Kind;
pub use unit::Unit;

/// The maximum length of a quantity's text \[bytes\], which also limits the nesting of its parentheses.
const LONGEST: usize = 120;

/// A number with its dimension, in SI units and radians.
///
/// ```
/// use rins_io::{Dimension, Quantity};
/// let bias = Quantity::parse("15 deg/h")?;
/// assert_eq!(bias.dimension, Dimension::ANGULAR_RATE);
/// assert!((bias.value - 15.0_f64.to_radians() / 3600.0).abs() < 1e-20);
///
/// // An angle random walk and a rate noise density are one thing.
/// let walk = Quantity::parse("0.02 deg/sqrt(h)")?;
/// let noise = Quantity::parse("1.2 deg/h/sqrt(Hz)")?;
/// assert_eq!(walk.dimension, noise.dimension);
/// assert!((walk.value / noise.value - 1.0).abs() < 1e-15);
/// # Ok::<(), rins_io::QuantityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// The value in SI units and radians.
    pub value: f64,
    /// Its dimension.
    pub dimension: Dimension,
}

impl Quantity {
    /// The quantity in `text`: a number, then a unit ([`Unit::parse`]).
    ///
    /// # Errors
    /// [`QuantityError`] if there is no finite number or no known unit.
    pub fn parse(text: &str) -> Result<Self, QuantityError> {
        if text.len() > LONGEST {
            return Err(QuantityError::TooLong { length: text.chars().count() });
        }
        let trimmed = text.trim();
        let (number, unit) = trimmed.split_at(number_length(trimmed));
        let Ok(number) = number.parse::<f64>() else {
            let word = trimmed.split_whitespace().next().unwrap_or_default();
            return Err(match word.parse::<f64>() {
                Ok(_) => QuantityError::NotFinite { text: text.into() },
                Err(_) => QuantityError::NotANumber { text: text.into() },
            });
        };
        if !number.is_finite() {
            return Err(QuantityError::NotFinite { text: text.into() });
        }
        if unit.trim().is_empty() {
            return Err(QuantityError::NoUnit { text: text.into() });
        }
        let Unit { factor, dimension } = Unit::parse(unit).map_err(|error| error.within(text))?;
        let value = number * factor;
        if !value.is_finite() {
            return Err(QuantityError::NotFinite { text: text.into() });
        }
        Ok(Self { value, dimension })
    }
}

impl QuantityError {
    /// The same error of a unit, with the text of the whole quantity.
    fn within(self, whole: &str) -> Self {
        match self {
            Self::UnknownUnit { unit, suggestion, .. } => {
                Self::UnknownUnit { text: whole.into(), unit, suggestion }
            }
            Self::Malformed { .. } => Self::Malformed { text: whole.into() },
            other => other,
        }
    }
}

/// The length of the decimal number at the beginning of `text`.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut end = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    end += digits(end);
    if bytes.get(end) == Some(&b'.') {
        end += 1 + digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = if end + 1 + sign <= bytes.len() { digits(end + 1 + sign) } else { 0 };
        if exponent > 0 {
            end += 1 + sign + exponent;
        }
    }
    end
}

#[cfg(test)]
mod tests;
