//! Keys for the interpretation of a log's numbers: units, factors, columns.

use crate::error::IoError;
use crate::quantity::{Dimension, QuantityError, Unit};
use crate::section::Section;

/// The two possible dimensions of a triad's numbers, with their names in an error message.
pub(super) struct Readings {
    pub(super) rate: Dimension,
    pub(super) increment: Dimension,
    pub(super) expected: &'static str,
    pub(super) example: &'static str,
}

pub(super) const GYRO: Readings = Readings {
    rate: Dimension::ANGULAR_RATE,
    increment: Dimension::ANGLE,
    expected: "an angular rate or an angle increment",
    example: "deg/s",
};

pub(super) const ACCEL: Readings = Readings {
    rate: Dimension::ACCELERATION,
    increment: Dimension::VELOCITY,
    expected: "a specific force or a velocity increment",
    example: "m/s^2",
};

/// The value of `[log] gyro` or `accel`, for an error message.
pub(crate) fn example(readings: &Readings) -> String {
    format!("{{ columns = [\"x\", \"y\", \"z\"], unit = {:?} }}", readings.example)
}

pub(super) const NUMBERS: &str = "a number, or one for each column";

pub(super) fn refuse_own(
    section: &Section<'_>,
    keys: &[&str],
    reason: &str,
) -> Result<(), IoError> {
    match keys.iter().find(|key| section.has(key)) {
        Some(key) => Err(section.conflict(key, reason)),
        None => Ok(()),
    }
}

pub(super) fn scale_of(triad: &Section<'_>) -> Result<[f64; 3], IoError> {
    let scale = triad.numbers("scale", NUMBERS)?.unwrap_or([1.0; 3]);
    if scale.contains(&0.0) {
        return Err(triad.not_allowed("scale", "factors other than zero"));
    }
    Ok(scale)
}

pub(super) fn unit(
    section: &Section<'_>,
    allowed: &[Dimension],
    Readings { expected, example, .. }: &Readings,
) -> Result<Unit, IoError> {
    let words = format!("{expected} such as {example:?}");
    let Some(text) = section.text("unit", &words)? else {
        return Err(section.missing("unit", words));
    };
    let unit = Unit::parse(text).map_err(|error| section.error("unit", error.into()))?;
    if allowed.contains(&unit.dimension) {
        return Ok(unit);
    }
    let problem =
        QuantityError::WrongDimension { text: text.into(), got: unit.dimension, expected, example };
    Err(section.error("unit", problem.into()))
}

pub(super) fn column(section: &Section<'_>, key: &str) -> Result<String, IoError> {
    let expected = r#"a column's name, or its number as in "1""#;
    section.text(key, expected)?.map(Into::into).ok_or_else(|| section.missing(key, expected))
}
