//! The noise of each sensor over a static interval: Allan deviations with bounds, and the noise parameters fitted to them.

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

/// The noise of the sensors over a static interval of a log.
#[derive(Debug)]
pub struct Allan<'a> {
    log: &'a Log,
    rest: Rest,
}

/// Estimates the noise over the longest static interval of a log, with lost samples filled in. The log may have fewer than three
/// gyros and three accelerometers ([`Log::open_partial`]).
///
/// # Errors
/// If units, signs or axes are wrong, or if there is no static interval of ten seconds.
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
    if log.loaded.rig.log.is_complete() {
        refuse_mistaken(&log.loaded)?;
    }
    Ok(Allan { log, rest: rest(&log.loaded)? })
}
