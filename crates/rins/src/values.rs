//! Values that are common to several results, for the JSON output.

use rins_frames::EulerAngles;
use rins_frames::units::DEG;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Roll, pitch and yaw of `C = Rz(yaw) Rx(pitch) Ry(roll)` \[deg\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EulerDegrees {
    /// About the forward axis.
    pub roll: f64,
    /// About the axis to the right.
    pub pitch: f64,
    /// About the vertical, counted from north.
    pub yaw: f64,
}

impl From<EulerAngles> for EulerDegrees {
    fn from(angles: EulerAngles) -> Self {
        Self { roll: angles.roll / DEG, pitch: angles.pitch / DEG, yaw: angles.yaw / DEG }
    }
}

/// An estimate, in the unit of its parameter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EstimateResult {
    /// The value.
    pub value: f64,
    /// Its 1σ.
    pub sigma: f64,
}
