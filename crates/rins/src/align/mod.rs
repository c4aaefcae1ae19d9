//! Attitude from a static interval: level from gravity, north from the Earth's rotation.

mod found;
mod outcome;
mod result;
mod text;

use anyhow::Context;
use rins_inspection::StaticIntervals;
use rins_io::shown;

pub(crate) use self::found::{ANY_AZIMUTH, AlignmentSolution, found, found_over};
pub use self::result::{AboutAxes, AlignResult, ApparentSite, ExpectedSite, LeveledDegrees};
use crate::check::refuse_mistaken;
use crate::error::Result;
use crate::log::{Log, static_intervals};

/// The attitude of an IMU over the longest static interval of a log, and the latitude and gravity that the sensors indicate.
#[derive(Debug)]
pub struct Alignment<'a> {
    log: &'a Log,
    found: AlignmentSolution,
    statics: StaticIntervals,
}

/// Aligns on the longest static interval of a log.
///
/// # Errors
/// If units, signs or axes are wrong, if there is no static interval of five seconds, or if the readings determine no attitude.
///
/// ```
/// use rins::Outcome;
/// let folder = tempfile::tempdir()?;
/// let log = rins::demo::log(folder.path())?;
/// let alignment = rins::align(&log)?;
/// assert!(alignment.result().attitude_deg.yaw.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn align(log: &Log) -> Result<Alignment<'_>> {
    let loaded = &log.loaded;
    refuse_mistaken(loaded)?;
    let found = found(loaded).with_context(|| shown(&loaded.rig.log.path))?;
    Ok(Alignment { log, found, statics: static_intervals(loaded) })
}
