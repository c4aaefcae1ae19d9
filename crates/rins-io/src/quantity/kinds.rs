//! Kinds of quantities that keys of files expect: dimension, range, and example.

use core::f64::consts::{FRAC_PI_2, TAU};

use rins_frames::units::DEG;

use super::{Dimension, Quantity, QuantityError};

/// A kind of quantity that a key of a file expects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind {
    /// The name with its article: "a rate noise density".
    pub name: &'static str,
    /// Its dimension.
    pub dimension: Dimension,
    /// A valid example.
    pub example: &'static str,
    range: Range,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Range {
    Any,
    NotNegative,
    Positive,
    PositiveUpTo { high: f64, words: &'static str },
    Within { low: f64, high: f64, words: &'static str },
}

/// The largest number in SI units; the next constant is the smallest positive one. Their squares neither overflow nor underflow.
const LARGEST: f64 = 1e12;
const LEAST: f64 = 1e-30;

impl Kind {
    const fn new(
        name: &'static str,
        dimension: Dimension,
        example: &'static str,
        range: Range,
    ) -> Self {
        Self { name, dimension, example, range }
    }

    /// The value of `text` in SI units and radians.
    ///
    /// # Errors
    /// [`QuantityError`] if it is not a quantity, has another dimension, or is out of range.
    ///
    /// ```
    /// use rins_io::quantity::kinds;
    /// let error = kinds::GYRO_NOISE.parse("0.05 deg").unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "\"0.05 deg\" is an angle, expected a rate noise density such as \"0.02 deg/h/sqrt(Hz)\"",
    /// );
    /// ```
    pub fn parse(&self, text: &str) -> Result<f64, QuantityError> {
        let Quantity { value, dimension } = Quantity::parse(text)?;
        if dimension != self.dimension {
            return Err(QuantityError::WrongDimension {
                text: text.into(),
                got: dimension,
                expected: self.name,
                example: self.example,
            });
        }
        let out_of_range = match self.range {
            Range::Positive if value > 0.0 && value < LEAST => Some("1e-30 or more in SI units"),
            Range::Any => None,
            Range::NotNegative => (value < 0.0).then_some("zero or more"),
            Range::Positive => (value <= 0.0).then_some("more than zero"),
            Range::PositiveUpTo { high, words } => (value <= 0.0 || value > high).then_some(words),
            Range::Within { low, high, words } => (!(low..=high).contains(&value)).then_some(words),
        };
        let beyond = || (value.abs() > LARGEST).then_some("no more than 1e12 in SI units");
        match out_of_range.or_else(beyond) {
            Some(expected) => Err(QuantityError::OutOfRange { text: text.into(), expected }),
            None => Ok(value),
        }
    }
}

/// The maximum absolute latitude, up to which east and north are defined \[deg\].
pub(crate) const MOST_LATITUDE: f64 = 89.9;
/// The permitted latitudes.
pub(crate) const LATITUDE_RANGE: &str = "a latitude from -89.9 to 89.9 deg; the poles at -90 and \
                                         90 deg are excluded: east is not defined there";

/// A latitude, north positive.
pub const LATITUDE: Kind = Kind::new(
    "a latitude",
    Dimension::ANGLE,
    "34.25 deg",
    Range::Within { low: -MOST_LATITUDE * DEG, high: MOST_LATITUDE * DEG, words: LATITUDE_RANGE },
);
/// A longitude, east positive.
pub const LONGITUDE: Kind = Kind::new(
    "a longitude",
    Dimension::ANGLE,
    "108.9 deg",
    Range::Within { low: -TAU, high: TAU, words: "a longitude from -360 to 360 deg" },
);
/// A height above the ellipsoid.
pub const HEIGHT: Kind = Kind::new(
    "a height",
    Dimension::LENGTH,
    "400 m",
    Range::Within { low: -1e3, high: 2e4, words: "a height from -1 to 20 km" },
);
/// The magnitude of gravity on Earth.
pub const GRAVITY: Kind = Kind::new(
    "gravity",
    Dimension::ACCELERATION,
    "9.7966 m/s^2",
    Range::Within { low: 9.7, high: 9.9, words: "a gravity from 9.7 to 9.9 m/s^2" },
);
/// A roll or yaw angle.
pub const TURN: Kind = Kind::new(
    "an angle",
    Dimension::ANGLE,
    "30 deg",
    Range::Within { low: -TAU, high: TAU, words: "an angle from -360 to 360 deg" },
);
/// A pitch angle.
pub(crate) const PITCH: Kind = Kind::new(
    "an angle",
    Dimension::ANGLE,
    "20 deg",
    Range::Within { low: -FRAC_PI_2, high: FRAC_PI_2, words: "a pitch from -90 to 90 deg" },
);
/// The standard deviation of a given attitude, which replaces an alignment.
pub const ATTITUDE_SIGMA: Kind = Kind::new(
    "an angle",
    Dimension::ANGLE,
    "0.1 deg",
    Range::PositiveUpTo {
        high: 20.0 * DEG,
        words: "more than zero and at most 20 deg; leave [attitude] out if it is less accurate; it is \
                then found by alignment",
    },
);
/// The standard deviation of a small angle.
pub(crate) const ANGLE_SIGMA: Kind =
    Kind::new("an angle", Dimension::ANGLE, "60 arcsec", Range::Positive);
/// The total angle of a rotation, of any number of turns.
pub(crate) const TOTAL_ANGLE: Kind = Kind::new("an angle", Dimension::ANGLE, "720 deg", Range::Any);
/// The resolution of an angle; zero means none.
pub(crate) const ANGLE_RESOLUTION: Kind =
    Kind::new("an angle", Dimension::ANGLE, "0.1 arcsec", Range::NotNegative);
/// A small angle of either sign.
pub const SMALL_ANGLE: Kind = Kind::new("an angle", Dimension::ANGLE, "60 arcsec", Range::Any);
/// The least significant bit of an angle increment.
pub(crate) const ANGLE_BIT: Kind =
    Kind::new("an angle increment", Dimension::ANGLE, "0.1 arcsec", Range::Positive);
/// A speed over the ground.
pub(crate) const SPEED: Kind = Kind::new(
    "a speed",
    Dimension::VELOCITY,
    "10 kn",
    Range::Within { low: -1e3, high: 1e3, words: "a speed from -1 to 1 km/s" },
);
/// The acceleration of a carrier along its course.
pub(crate) const ACCELERATION: Kind =
    Kind::new("an acceleration", Dimension::ACCELERATION, "0.1 m/s^2", Range::Positive);
/// The rate of a turn.
pub(crate) const TURN_RATE: Kind =
    Kind::new("an angular rate", Dimension::ANGULAR_RATE, "1 deg/s", Range::Positive);
/// The amplitude of heave.
pub(crate) const HEAVE: Kind = Kind::new(
    "a length",
    Dimension::LENGTH,
    "1 m",
    Range::Within { low: -100.0, high: 100.0, words: "an amplitude up to 100 m" },
);
/// The amplitude of an angular oscillation.
pub(crate) const SWAY: Kind = Kind::new(
    "an angle",
    Dimension::ANGLE,
    "5 deg",
    Range::Within { low: -60.0 * DEG, high: 60.0 * DEG, words: "an amplitude up to 60 deg" },
);
/// The period of an oscillation.
pub(crate) const PERIOD: Kind = Kind::new(
    "a time",
    Dimension::TIME,
    "8 s",
    Range::Within { low: 0.1, high: 1e5, words: "a period of 0.1 s or more" },
);
/// A distance.
pub const DISTANCE: Kind = Kind::new("a distance", Dimension::LENGTH, "1 nmi", Range::Positive);
/// The least significant bit of a velocity increment.
pub(crate) const VELOCITY_BIT: Kind =
    Kind::new("a velocity increment", Dimension::VELOCITY, "1 ug*s", Range::Positive);
/// A sampling rate.
pub const SAMPLE_RATE: Kind = Kind::new(
    "a sampling rate",
    Dimension::FREQUENCY,
    "50 Hz",
    Range::Within { low: 1e-3, high: 1e6, words: "a sampling rate from 0.001 Hz to 1 MHz" },
);
/// The latency of a signal.
pub(crate) const LATENCY: Kind = Kind::new(
    "a time",
    Dimension::TIME,
    "1 ms",
    Range::Within { low: -10.0, high: 10.0, words: "a latency from -10 to 10 s" },
);
/// The offset of one clock from another.
pub(crate) const CLOCK_OFFSET: Kind = Kind::new("a time", Dimension::TIME, "12 ms", Range::Any);
/// A time in a log.
pub(crate) const LOG_TIME: Kind = Kind::new("a time", Dimension::TIME, "10 s", Range::Any);
/// A time since power-on.
pub(crate) const TIME_SINCE: Kind =
    Kind::new("a time", Dimension::TIME, "20 min", Range::NotNegative);
/// A time span.
pub const DURATION: Kind = Kind::new("a time", Dimension::TIME, "60 s", Range::Positive);
/// A table rate.
pub const TABLE_RATE: Kind =
    Kind::new("an angular rate", Dimension::ANGULAR_RATE, "10 deg/s", Range::Any);
/// The accuracy of an angular rate.
pub(crate) const RATE_ACCURACY: Kind =
    Kind::new("an angular rate", Dimension::ANGULAR_RATE, "0.0001 deg/s", Range::Positive);
/// The accuracy of gravity.
pub(crate) const GRAVITY_ACCURACY: Kind =
    Kind::new("an acceleration", Dimension::ACCELERATION, "20 ug", Range::Positive);
/// A table acceleration.
pub const TABLE_ACCELERATION: Kind = Kind::new(
    "an angular acceleration",
    Dimension::ANGULAR_ACCELERATION,
    "5 deg/s^2",
    Range::Positive,
);
/// The standard deviation of a ratio.
pub(crate) const RATIO_SIGMA: Kind =
    Kind::new("a ratio", Dimension::RATIO, "300 ppm", Range::Positive);
/// A ratio of either sign.
pub const RATIO: Kind = Kind::new("a ratio", Dimension::RATIO, "300 ppm", Range::Any);
/// The noise density of a gyro.
pub const GYRO_NOISE: Kind = Kind::new(
    "a rate noise density",
    Dimension::RATE_NOISE,
    "0.02 deg/h/sqrt(Hz)",
    Range::Positive,
);
/// A gyro bias.
pub const GYRO_BIAS: Kind =
    Kind::new("an angular rate", Dimension::ANGULAR_RATE, "0.05 deg/h", Range::Any);
/// The standard deviation of a gyro bias.
pub(crate) const GYRO_BIAS_SIGMA: Kind =
    Kind::new("an angular rate", Dimension::ANGULAR_RATE, "0.05 deg/h", Range::Positive);
/// The bias instability of a gyro.
pub const GYRO_BIAS_INSTABILITY: Kind =
    Kind::new("an angular rate", Dimension::ANGULAR_RATE, "0.005 deg/h", Range::NotNegative);
/// The range or resolution of a gyro.
pub(crate) const GYRO_READING: Kind =
    Kind::new("an angular rate", Dimension::ANGULAR_RATE, "300 deg/s", Range::Positive);
/// The rate random walk of a gyro.
pub(crate) const GYRO_RANDOM_WALK: Kind = Kind::new(
    "a rate random walk density",
    Dimension::RATE_RANDOM_WALK,
    "0.01 deg/h/sqrt(h)",
    Range::NotNegative,
);
/// The noise density of an accelerometer.
pub const ACCEL_NOISE: Kind = Kind::new(
    "an acceleration noise density",
    Dimension::ACCELERATION_NOISE,
    "30 ug/sqrt(Hz)",
    Range::Positive,
);
/// An accelerometer bias.
pub const ACCEL_BIAS: Kind =
    Kind::new("an acceleration", Dimension::ACCELERATION, "100 ug", Range::Any);
/// The standard deviation of an accelerometer bias.
pub(crate) const ACCEL_BIAS_SIGMA: Kind =
    Kind::new("an acceleration", Dimension::ACCELERATION, "100 ug", Range::Positive);
/// The bias instability of an accelerometer.
pub const ACCEL_BIAS_INSTABILITY: Kind =
    Kind::new("an acceleration", Dimension::ACCELERATION, "10 ug", Range::NotNegative);
/// The range or resolution of an accelerometer.
pub(crate) const ACCEL_READING: Kind =
    Kind::new("an acceleration", Dimension::ACCELERATION, "10 g", Range::Positive);
/// The acceleration random walk of an accelerometer.
pub(crate) const ACCEL_RANDOM_WALK: Kind = Kind::new(
    "an acceleration random walk density",
    Dimension::ACCELERATION_RANDOM_WALK,
    "10 ug/sqrt(h)",
    Range::NotNegative,
);
/// A rise of temperature, or its amplitude.
pub(crate) const TEMPERATURE_DIFFERENCE: Kind =
    Kind::new("a temperature difference", Dimension::TEMPERATURE, "5 K", Range::Any);
/// A rate of change of temperature.
pub(crate) const TEMPERATURE_RATE: Kind =
    Kind::new("a rate of temperature", Dimension::TEMPERATURE_RATE, "2 K/h", Range::Any);
