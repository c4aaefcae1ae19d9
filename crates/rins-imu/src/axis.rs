//! The sensors of an IMU: two triads of three axes.

use core::fmt;

/// An axis of the body frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Axis {
    /// To the right.
    X,
    /// To the front.
    Y,
    /// Up, along the spin axis.
    Z,
}

impl Axis {
    /// The axes in order.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// The index of the axis in a vector: 0, 1 or 2.
    pub const fn index(self) -> usize {
        self as usize
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        })
    }
}

/// One of the two triads of an IMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Triad {
    /// The gyros: rates in rad/s, increments in rad.
    Gyro,
    /// The accelerometers: specific forces in m/s², increments in m/s.
    Accel,
}

impl fmt::Display for Triad {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Gyro => "gyro",
            Self::Accel => "accelerometer",
        })
    }
}
