//! An alignment, for a machine.

use nalgebra::Vector3;
use rins_frames::units::{DEG, DEG_PER_HOUR, MICRO_G};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Alignment;
use super::text::own_axes;
use crate::basis::BasisResult;
use crate::log::{StaticIntervalResult, only, statics_result};
use crate::outcome::Outcome as _;
use crate::values::EulerDegrees;

/// The result of `rins align`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AlignResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `align`.
    pub command: String,
    /// The rig file.
    pub rig: String,
    /// Start and end of the static interval that was used \[s\].
    pub static_interval_s: [f64; 2],
    /// The static intervals of the log.
    pub static_intervals: Vec<StaticIntervalResult>,
    /// The attitude of the body frame \[deg\].
    pub attitude_deg: LeveledDegrees,
    /// The 1σ of the attitude error \[deg\].
    pub sigma_deg: AboutAxes,
    /// What the sensors show of the site.
    pub apparent: ApparentSite,
    /// What the rig file says of it.
    pub site: ExpectedSite,
    /// The gyro biases along the sensor's own axes \[deg/h\]; null if north was not found.
    pub gyro_bias_deg_h: Option<[f64; 3]>,
    /// The 1σ of these \[deg/h\].
    pub gyro_bias_sigma_deg_h: Option<[f64; 3]>,
    /// Whether the static interval shows each, or it is what was assumed.
    pub gyro_bias_observable: Option<[bool; 3]>,
    /// The accelerometer biases along the sensor's own axes, as far as gravity shows them \[µg\].
    pub accel_bias_ug: [f64; 3],
    /// The attitude that the header of a PSINS log has \[deg\].
    pub header_attitude_deg: Option<EulerDegrees>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// An attitude of which the yaw may not be known \[deg\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LeveledDegrees {
    /// Roll.
    pub roll: f64,
    /// Pitch.
    pub pitch: f64,
    /// Yaw; null if north was not found.
    pub yaw: Option<f64>,
}

/// The 1σ about the axes of the navigation frame \[deg\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AboutAxes {
    /// About east.
    pub east: f64,
    /// About north.
    pub north: f64,
    /// About up; null if north was not found.
    pub up: Option<f64>,
}

/// What the sensors show of the site.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ApparentSite {
    /// The magnitude of the mean specific force \[m/s²\].
    pub gravity_m_s2: f64,
    /// The magnitude of the mean angular rate \[deg/h\].
    pub earth_rate_deg_h: f64,
    /// The 1σ of that \[deg/h\].
    pub earth_rate_sigma_deg_h: f64,
    /// The latitude at which the rate makes this angle with gravity \[deg\]; null if north was not found.
    pub latitude_deg: Option<f64>,
    /// The 1σ of that \[deg\].
    pub latitude_sigma_deg: Option<f64>,
}

/// What the rig file says of the site.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ExpectedSite {
    /// Gravity \[m/s²\].
    pub gravity_m_s2: f64,
    /// The Earth's rate \[deg/h\].
    pub earth_rate_deg_h: f64,
    /// The latitude \[deg\].
    pub latitude_deg: f64,
}

impl AlignResult {
    pub(super) fn of(alignment: &Alignment<'_>) -> Self {
        let Alignment { log, found, statics } = alignment;
        let loaded = &log.loaded;
        let angles = found.nav_from_body.euler_angles();
        let (east, north, up) = found.sigma;
        let place = &found.place;
        let (rate_sigma, latitude_sigma) = found.seen_sigma();
        let own_axes = own_axes(loaded);
        let bias = own_axes.undo(found.residual.angular_rate.components()) / DEG_PER_HOUR;
        let bias_sigma =
            found.fine.map(|fine| own_axes.undo(&fine.gyro_bias_sigma).abs() / DEG_PER_HOUR);
        let accel = own_axes.undo(found.residual.specific_force.components()) / MICRO_G;
        let site = &loaded.station.site;
        Self {
            schema: crate::SCHEMA,
            command: "align".into(),
            rig: log.name.clone(),
            static_interval_s: [found.start, loaded.recording.times[found.span.end - 1]],
            static_intervals: statics_result(statics, only(&found.span)),
            attitude_deg: LeveledDegrees {
                roll: angles.roll / DEG,
                pitch: angles.pitch / DEG,
                yaw: up.map(|_| angles.yaw / DEG),
            },
            sigma_deg: AboutAxes {
                east: east / DEG,
                north: north / DEG,
                up: up.map(|up| up / DEG),
            },
            apparent: ApparentSite {
                gravity_m_s2: place.gravity,
                earth_rate_deg_h: place.earth_rate / DEG_PER_HOUR,
                earth_rate_sigma_deg_h: rate_sigma / DEG_PER_HOUR,
                latitude_deg: up.map(|_| place.latitude / DEG),
                latitude_sigma_deg: up.map(|_| latitude_sigma / DEG),
            },
            site: ExpectedSite {
                gravity_m_s2: loaded.station.gravity,
                earth_rate_deg_h: site.earth_rate().norm() / DEG_PER_HOUR,
                latitude_deg: site.latitude / DEG,
            },
            gyro_bias_deg_h: up.map(|_| bias.into()),
            gyro_bias_sigma_deg_h: bias_sigma.map(Vector3::into),
            gyro_bias_observable: bias_sigma.map(|_| found.bias_shown(&own_axes)),
            accel_bias_ug: accel.into(),
            header_attitude_deg: loaded.psins_header.map(|header| header.attitude.into()),
            basis: alignment.basis(),
        }
    }
}
