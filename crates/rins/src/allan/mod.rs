//! The noise that a static interval shows, sensor by sensor: Allan deviations with bounds, and the noise terms that make them.

mod filled;
mod noise;
mod outcome;
mod page;
mod result;

use self::noise::{Rest, rest};
pub use self::result::{AllanResult, ChannelResult, LineResult, NoiseTermResult};
use crate::check::refuse_mistaken;
use crate::error::Result;
use crate::log::Log;

/// The noise that a static interval of a log shows.
#[derive(Debug)]
pub struct Allan<'a> {
    log: &'a Log,
    rest: Rest,
}

/// The noise over the longest static interval of a log, lost samples filled in.
///
/// # Errors
/// If units, signs or axes are mistaken, or if there is no static interval of ten seconds.
///
/// ```
/// use rins::Outcome;
/// let folder = tempfile::tempdir()?;
/// let log = rins::demo::log(folder.path())?;
/// let noise = rins::allan(&log)?.result();
/// assert_eq!(noise.channels.len(), 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn allan(log: &Log) -> Result<Allan<'_>> {
    refuse_mistaken(&log.loaded)?;
    Ok(Allan { log, rest: rest(&log.loaded)? })
}
