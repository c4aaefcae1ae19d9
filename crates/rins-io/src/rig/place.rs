//! The site of a table and the attitude of its axis: `[site]` and `[attitude]`.

use rins_frames::{EulerAngles, Site};
use rins_motion::Station;

use crate::error::IoError;
use crate::quantity::kinds;
use crate::section::Section;

/// The attitude of the table axis frame s at table angle zero, `C_s^n`, with its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialAttitude {
    /// `C_s^n = Rz(yaw) Rx(pitch) Ry(roll)` \[rad\].
    pub angles: EulerAngles,
    /// The standard deviation of its error about each axis \[rad\].
    pub sigma: f64,
}

/// The keys of `[site]`.
pub(super) const SITE: [&str; 6] =
    ["latitude", "longitude", "height", "gravity", "latitude_accuracy", "gravity_accuracy"];

/// The station of `[site]`. No result depends on its longitude, which may be left out, and without a height it is at sea level.
pub(crate) fn station(root: &Section<'_>) -> Result<Option<Station>, IoError> {
    let Some(section) = root.section("site", &SITE)? else { return Ok(None) };
    let site = Site {
        latitude: section.require_quantity("latitude", &kinds::LATITUDE)?,
        longitude: section.quantity("longitude", &kinds::LONGITUDE)?.unwrap_or(0.0),
        height: section.quantity("height", &kinds::HEIGHT)?.unwrap_or(0.0),
    };
    let station = Station::with_normal_gravity(site);
    let gravity = section.quantity("gravity", &kinds::GRAVITY)?.unwrap_or(station.gravity);
    Ok(Some(Station { gravity, ..station }))
}

/// Whether gravity is that of sea level because `[site]` states neither a height nor gravity.
pub(super) fn is_at_sea_level(root: &Section<'_>) -> Result<bool, IoError> {
    let site = root.section("site", &SITE)?;
    Ok(site.is_some_and(|site| !site.has("height") && !site.has("gravity")))
}

pub(super) fn attitude(root: &Section<'_>) -> Result<Option<InitialAttitude>, IoError> {
    let known = ["roll", "pitch", "yaw", "sigma"];
    let Some(section) = root.section("attitude", &known)? else { return Ok(None) };
    let angles = angles(&section)?;
    let sigma = section.require_quantity("sigma", &kinds::ATTITUDE_SIGMA)?;
    Ok(Some(InitialAttitude { angles, sigma }))
}

/// The keys `roll`, `pitch` and `yaw` of a section.
pub(crate) fn angles(section: &Section<'_>) -> Result<EulerAngles, IoError> {
    Ok(EulerAngles {
        roll: section.require_quantity("roll", &kinds::TURN)?,
        pitch: section.require_quantity("pitch", &kinds::PITCH)?,
        yaw: section.require_quantity("yaw", &kinds::TURN)?,
    })
}
