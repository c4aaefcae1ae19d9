//! Logs: what a rig recorded, read into increments over intervals.

mod assemble;
mod clock;
mod even;
mod fields;
mod files;
mod instant;
mod lines;
mod problem;
mod psins;
mod redivide;
mod series;
mod summary;
mod table;

use std::path::Path;

use rins_motion::{Recording, Station, with_ramps};

pub use fields::Delimiter;
pub(crate) use fields::Fields;
pub(crate) use lines::Lines;
pub use problem::LogProblem;
pub use psins::PsinsHeader;
pub(crate) use psins::header as psins_header;
pub use summary::{Gap, LeftOut, LogPolicy, LogSummary, Omission, Redivided, Rounded};
pub(crate) use table::{Head, MOST_COLUMNS, most_rows};
pub use table::{LogHead, peek};

use crate::error::{IoError, LogError};
use crate::rig::{LogFormat, Rig};

/// A run: its rig and what was recorded, in SI units and radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// What the rig file says.
    pub rig: Rig,
    /// Where the table stands: by the rig file or, if that does not say, by the log's header.
    pub station: Station,
    /// What was recorded, along the body axes whose z is the spin axis.
    pub recording: Recording,
    /// What reading it has shown.
    pub summary: LogSummary,
    /// What a PSINS log says of itself.
    pub psins_header: Option<PsinsHeader>,
}

/// Reads a rig file and the log that it names.
///
/// # Errors
/// [`IoError`] if either cannot be read or says something wrong.
pub fn read(rig: &Path) -> Result<Loaded, IoError> {
    read_log(Rig::read(rig)?, LogPolicy::default())
}

/// Reads the log that `rig` names.
///
/// Mean rates are turned into increments over the time since the sample before; increments are
/// taken as they are. Where only the commanded [`TableSpec`](crate::TableSpec) is known, its mean
/// rate over each interval becomes the table rate; the profile begins with the first interval.
///
/// # Errors
/// [`IoError::File`] if the log cannot be read, [`IoError::Log`] if it holds anything but finite
/// numbers in the columns that are asked for, if its times do not increase, have longer gaps or
/// more of them than `policy` accepts or do not fit the stated rate, if a gyro never moves, or if the table angle
/// steps by about half a turn.
pub fn read_log(rig: Rig, policy: LogPolicy) -> Result<Loaded, IoError> {
    let (mut recording, mut summary, psins_header) = match &rig.log.format {
        LogFormat::Columns(columns) => {
            let (recording, summary) = assemble::read(&rig, columns, policy)?;
            (recording, summary, None)
        }
        LogFormat::Psins => {
            let (recording, summary, header) = psins::read(&rig)?;
            (recording, summary, Some(header))
        }
    };
    let from_header = psins_header.map(|header| Station::with_normal_gravity(header.site));
    let station = match rig.station.or(from_header) {
        Some(station) => station,
        None => *rig.require_station()?,
    };
    if recording.table_angle.is_none() && recording.table_rate.is_none() {
        let late = summary.redivided.map_or(0.0, |redivided| redivided.late);
        recording.table_rate = commanded(&rig, &recording, late)?;
        if let Some(rates) = &mut recording.table_rate {
            summary.ramps = with_ramps(rates, &recording.increments);
        }
    }
    Ok(Loaded { rig, station, recording, summary, psins_header })
}

/// The commanded table rate over each interval, if the rig tells the profile, which begins `late`
/// seconds before the recording.
fn commanded(rig: &Rig, recording: &Recording, late: f64) -> Result<Option<Vec<f64>>, IoError> {
    let Some(profile) = rig.table.as_ref().and_then(|table| table.profile.as_ref()) else {
        return Ok(None);
    };
    let (Some(first), Some(last)) = (recording.increments.first(), recording.times.last()) else {
        return Ok(None);
    };
    let start = recording.times[0] - first.interval - late;
    let (log, commanded) = (last - start, profile.duration());
    if log > commanded + 1.5 * first.interval {
        let problem = LogProblem::BeyondProfile { log, profile: commanded };
        return Err(LogError::of(&rig.log.path, problem));
    }
    let mut angle = profile.angle(0.0);
    let mut rates = Vec::with_capacity(recording.len());
    for (time, increments) in recording.times.iter().zip(&recording.increments) {
        let next = profile.angle(time - start);
        rates.push((next - angle) / increments.interval);
        angle = next;
    }
    Ok(Some(rates))
}
