//! Estimated parameters: names, units, and the combinations that are observable under the schedule.

use rins_frames::units::{ARCSEC, DEG_PER_HOUR, MICRO_G, PPM};

/// The kind of a sensor parameter, which determines its display unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// A gyro bias, in rad/s; displayed in deg/h.
    GyroBias,
    /// An accelerometer bias, in m/s²; displayed in µg.
    AccelBias,
    /// A scale error, a ratio; displayed in ppm.
    Scale,
    /// A misalignment \[rad\]; displayed in arcsec.
    Misalignment,
}

impl ParameterKind {
    /// The symbol of the display unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::GyroBias => "deg/h",
            Self::AccelBias => "ug",
            Self::Scale => "ppm",
            Self::Misalignment => "arcsec",
        }
    }

    /// The display unit in SI units.
    pub const fn factor(self) -> f64 {
        match self {
            Self::GyroBias => DEG_PER_HOUR,
            Self::AccelBias => MICRO_G,
            Self::Scale => PPM,
            Self::Misalignment => ARCSEC,
        }
    }
}

/// A parameter that is observable only in combination with another one.
#[derive(Clone, Debug, PartialEq)]
pub struct Partner {
    /// The other parameter's id.
    pub id: String,
    /// Its coefficient in the estimate: value = parameter + `share` × partner, SI units.
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
    /// The parameters that are indistinguishable from it under this schedule; empty if it is observable alone.
    pub partners: Vec<Partner>,
}

impl Parameter {
    /// Whether the parameter is observable alone under the schedule.
    pub const fn identifiable(&self) -> bool {
        self.partners.is_empty()
    }
}
