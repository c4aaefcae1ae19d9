//! Estimated parameters: their names, units and what they stand for under the schedule flown.

use rins_frames::units::{ARCSEC, DEG_PER_HOUR, MICRO_G, PPM};

/// The kind of a sensor parameter, which decides the unit it is shown in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// A gyro bias, in rad/s; shown in deg/h.
    GyroBias,
    /// An accelerometer bias, in m/s²; shown in µg.
    AccelBias,
    /// A scale error, a ratio; shown in ppm.
    Scale,
    /// A misalignment \[rad\]; shown in seconds of arc.
    Misalignment,
}

impl ParameterKind {
    /// The unit's symbol in files and on screen.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::GyroBias => "deg/h",
            Self::AccelBias => "ug",
            Self::Scale => "ppm",
            Self::Misalignment => "arcsec",
        }
    }

    /// One of the unit in SI units.
    pub const fn factor(self) -> f64 {
        match self {
            Self::GyroBias => DEG_PER_HOUR,
            Self::AccelBias => MICRO_G,
            Self::Scale => PPM,
            Self::Misalignment => ARCSEC,
        }
    }
}

/// A parameter that the data only show together with others.
#[derive(Clone, Debug, PartialEq)]
pub struct Partner {
    /// The other parameter's id.
    pub id: String,
    /// How much of it is in the value: value = parameter + `share` × partner, SI units.
    pub share: f64,
    /// The other parameter's kind.
    pub kind: ParameterKind,
}

/// An estimated parameter, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its id, such as `gyro.misalignment.xz` (row, column of eq. (1)).
    pub id: String,
    /// Its kind.
    pub kind: ParameterKind,
    /// The estimate: of the parameter, or of the combination with `partners`.
    pub value: f64,
    /// Its 1σ.
    pub sigma: f64,
    /// What it cannot be told from under this schedule; empty if it stands alone.
    pub partners: Vec<Partner>,
}

impl Parameter {
    /// Whether the schedule shows this parameter alone.
    pub const fn identifiable(&self) -> bool {
        self.partners.is_empty()
    }
}
