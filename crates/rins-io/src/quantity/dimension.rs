//! Dimensions of quantities.

use core::fmt;

/// The largest exponent of a base, in halves; a larger one is a typing error.
const LARGEST_EXPONENT: i32 = 40;

/// A product of powers of the base quantities angle, time, length, temperature and magnetic flux density.
///
/// Exponents are counted in halves, because noise densities contain square roots. Angle is a base
/// dimension, so that an angle is not confused with a ratio nor `rad/s` with a frequency.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dimension {
    halves: [i32; 5],
}

/// Names of the dimensions in rig files; the first match is used.
const NAMES: &[(Dimension, &str)] = &[
    (Dimension::RATIO, "a ratio"),
    (Dimension::ANGLE, "an angle"),
    (Dimension::TIME, "a time"),
    (Dimension::LENGTH, "a length"),
    (Dimension::TEMPERATURE, "a temperature"),
    (Dimension::TEMPERATURE_RATE, "a rate of temperature"),
    (Dimension::MAGNETIC_FIELD, "a magnetic flux density"),
    (Dimension::FREQUENCY, "a frequency"),
    (Dimension::ANGULAR_RATE, "an angular rate"),
    (Dimension::ANGULAR_ACCELERATION, "an angular acceleration"),
    (Dimension::VELOCITY, "a velocity"),
    (Dimension::ACCELERATION, "an acceleration"),
    (Dimension::RATE_NOISE, "a rate noise density"),
    (Dimension::ACCELERATION_NOISE, "an acceleration noise density"),
    (Dimension::RATE_RANDOM_WALK, "a rate random walk density"),
    (Dimension::ACCELERATION_RANDOM_WALK, "an acceleration random walk density"),
];

impl Dimension {
    /// The dimension of a pure number.
    pub const RATIO: Self = Self::halves(0, 0, 0, 0);
    /// The dimension of an angle.
    pub const ANGLE: Self = Self::halves(2, 0, 0, 0);
    /// The dimension of a time.
    pub const TIME: Self = Self::halves(0, 2, 0, 0);
    /// The dimension of a length.
    pub(crate) const LENGTH: Self = Self::halves(0, 0, 2, 0);
    /// The dimension of a temperature.
    pub const TEMPERATURE: Self = Self::halves(0, 0, 0, 2);
    /// The dimension of a rate of change of temperature.
    pub(crate) const TEMPERATURE_RATE: Self = Self::halves(0, -2, 0, 2);
    /// The dimension of a magnetic flux density.
    pub(crate) const MAGNETIC_FIELD: Self = Self { halves: [0, 0, 0, 0, 2] };
    /// The dimension of a frequency, which contains no angle and thus differs from a rate.
    pub const FREQUENCY: Self = Self::halves(0, -2, 0, 0);
    /// The dimension of an angular rate.
    pub const ANGULAR_RATE: Self = Self::halves(2, -2, 0, 0);
    /// The dimension of an angular acceleration.
    pub(crate) const ANGULAR_ACCELERATION: Self = Self::halves(2, -4, 0, 0);
    /// The dimension of a velocity or velocity increment.
    pub const VELOCITY: Self = Self::halves(0, -2, 2, 0);
    /// The dimension of an acceleration or specific force.
    pub const ACCELERATION: Self = Self::halves(0, -4, 2, 0);
    /// The dimension of the noise density of a rate, which is also that of an angle random walk.
    pub(crate) const RATE_NOISE: Self = Self::halves(2, -1, 0, 0);
    /// The dimension of the noise density of an acceleration, which is also that of a velocity random walk.
    pub(crate) const ACCELERATION_NOISE: Self = Self::halves(0, -3, 2, 0);
    /// The dimension of a rate random walk.
    pub(crate) const RATE_RANDOM_WALK: Self = Self::halves(2, -3, 0, 0);
    /// The dimension of an acceleration random walk.
    pub(crate) const ACCELERATION_RANDOM_WALK: Self = Self::halves(0, -5, 2, 0);

    const fn halves(angle: i32, time: i32, length: i32, temperature: i32) -> Self {
        Self { halves: [angle, time, length, temperature, 0] }
    }

    /// The dimension of a product; `None` if an exponent exceeds its limit.
    pub(super) fn times(self, other: Self) -> Option<Self> {
        let mut halves = self.halves;
        for (sum, exponent) in halves.iter_mut().zip(other.halves) {
            *sum += exponent;
        }
        Self::checked(halves)
    }

    /// The dimension of a power whose exponent is `halves`/2; `None` if the result is not an integer number
    /// of halves or exceeds the limit.
    pub(super) fn power(self, halves: i32) -> Option<Self> {
        let mut powered = self.halves;
        for exponent in &mut powered {
            let doubled = exponent.checked_mul(halves)?;
            if doubled % 2 != 0 {
                return None;
            }
            *exponent = doubled / 2;
        }
        Self::checked(powered)
    }

    fn checked(halves: [i32; 5]) -> Option<Self> {
        halves.iter().all(|exponent| exponent.abs() <= LARGEST_EXPONENT).then_some(Self { halves })
    }
}

/// Prints a name such as "an angular rate" or, if there is none, the SI units.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((_, name)) = NAMES.iter().find(|(dimension, _)| dimension == self) {
            return f.write_str(name);
        }
        f.write_str("a quantity in")?;
        for (base, &halves) in ["rad", "s", "m", "K", "T"].iter().zip(&self.halves) {
            match halves {
                0 => {}
                2 => write!(f, " {base}")?,
                even if even % 2 == 0 => write!(f, " {base}^{}", even / 2)?,
                odd => write!(f, " {base}^({odd}/2)")?,
            }
        }
        Ok(())
    }
}
