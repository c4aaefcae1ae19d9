//! Logs: the recorded data of a rig, converted to increments over intervals.

mod angle_file;
mod assemble;
mod clock;
mod container;
mod damage;
mod date_time;
mod even;
mod fields;
mod files;
mod instant;
mod lines;
mod live;
mod overflow;
mod problem;
mod psins;
mod redivide;
mod series;
mod sparse_angle;
mod split_time;
mod summary;
mod table;

use std::path::Path;

use rins_motion::{Recording, Station, with_ramps};

pub(crate) use damage::Damage;
pub use date_time::{date_seconds, date_text};
pub(crate) use date_time::{day, nanoseconds, time_of_day};
pub use fields::Delimiter;
pub(crate) use fields::Fields;
pub(crate) use lines::Lines;
pub use live::LiveLog;
pub use overflow::Overflow;
pub(crate) use overflow::continued;
pub use problem::LogProblem;
pub use psins::PsinsHeader;
pub(crate) use psins::header as psins_header;
pub use summary::{Gap, LeftOut, LogPolicy, LogSummary, Omission, Redivided, Rounded, TableClock};
pub(crate) use table::{BinaryColumns, Head, MOST_COLUMNS, RawImu, all as all_columns, most_rows};
pub use table::{LogColumns, LogHead, Numbers as ColumnNumbers, peek};

use crate::error::{IoError, KeyError, KeyProblem, LogError};
use crate::rig::{ColumnSpec, LogFormat, Rig, StatedRotation, Table};

/// A run: its rig and its recording, in SI units and radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The content of the rig file.
    pub rig: Rig,
    /// The site of the table, from the rig file or otherwise from the header of the log.
    pub station: Station,
    /// The recording, along the body axes whose z is the spin axis.
    pub recording: Recording,
    /// The findings while reading it.
    pub summary: LogSummary,
    /// The rotations of known angle, in the time of the recording.
    pub rotations: Vec<StatedRotation>,
    /// The header of a PSINS log.
    pub psins_header: Option<PsinsHeader>,
}

impl Loaded {
    /// Samples of a log that is read while it is written.
    ///
    /// # Errors
    /// [`IoError::Key`] if the rig file states no site.
    pub fn of_live(log: &LiveLog, recording: Recording) -> Result<Self, IoError> {
        let interval = log.nominal_interval().unwrap_or_else(|| recording.mean_interval());
        Self::even(log.rig(), recording, interval)
    }

    /// A recording in memory, such as a simulated one, without jitter or gaps.
    ///
    /// # Errors
    /// [`IoError::Key`] if the rig file states no site.
    pub fn of_recording(rig: &Rig, recording: Recording) -> Result<Self, IoError> {
        let interval = recording.mean_interval();
        Self::even(rig, recording, interval)
    }

    fn even(rig: &Rig, recording: Recording, interval: f64) -> Result<Self, IoError> {
        Ok(Self {
            station: *rig.require_station()?,
            rig: rig.clone(),
            summary: LogSummary::even(recording.len(), interval),
            recording,
            rotations: Vec::new(),
            psins_header: None,
        })
    }
}

/// Reads a rig file and its log.
///
/// # Errors
/// [`IoError`] if either cannot be read or is invalid.
pub fn read(rig: &Path) -> Result<Loaded, IoError> {
    read_log(Rig::read(rig)?, LogPolicy::default())
}

/// Reads the log of `rig`.
///
/// Mean rates are multiplied by the time since the previous sample; increments are unchanged. If only the commanded
/// [`TableSpec`](crate::TableSpec) is known, its mean rate over each interval becomes the table rate; the profile begins with the
/// first interval.
///
/// # Errors
/// [`IoError::Key`] if the log lacks sensors and `policy` does not accept that, [`IoError::File`] if the log cannot be read,
/// [`IoError::Log`] if more than one row and more than one in a hundred cannot be read,
/// if its times do not increase, have longer or more gaps than `policy` accepts or do not agree with the stated rate, if a gyro is
/// stuck, or if a step of the table angle is about half a turn.
pub fn read_log(rig: Rig, policy: LogPolicy) -> Result<Loaded, IoError> {
    loaded(rig, None, policy)
}

/// Reads columns in memory as the log of `rig`, whose `[log]` states their names, units and axes.
///
/// They are checked as the columns of a file are. The name of `columns` replaces the path of the log.
///
/// # Errors
/// As [`read_log`]; [`IoError::Key`] if the format of the rig's log has no named columns, or if the rig file has a row filter or
/// accelerometers with a clock of their own, which only files have.
pub fn read_columns(
    mut rig: Rig,
    columns: LogColumns,
    policy: LogPolicy,
) -> Result<Loaded, IoError> {
    let (file, name) = (rig.path.clone(), columns.path.clone());
    let refuse = |key: &str, reason: &str| {
        let problem = KeyProblem::Conflict { reason: reason.into() };
        Box::new(KeyError { path: file, line: None, key: key.into(), problem })
    };
    let format = match &mut rig.log.format {
        LogFormat::Columns(columns) if columns.table != Table::NovAtel => columns,
        _ => {
            let reason =
                "this format defines its own columns, and columns in memory are named in [log]";
            return Err(refuse("[log] format", reason).into());
        }
    };
    let ColumnSpec { gyro, accel, accel_clock, .. } = format.as_mut();
    if accel_clock.is_some() {
        let reason = "accelerometers with a clock of their own are read from a file only";
        return Err(refuse("[log] accel.time", reason).into());
    }
    if gyro.rows.is_some() || accel.rows.is_some() {
        return Err(refuse("[log] where", "columns in memory have one sample in each row").into());
    }
    gyro.path.clone_from(&name);
    accel.path.clone_from(&name);
    rig.log.path = name;
    loaded(rig, Some(columns), policy)
}

/// The recording of a log, of a file or in memory.
fn loaded(mut rig: Rig, memory: Option<LogColumns>, policy: LogPolicy) -> Result<Loaded, IoError> {
    if !policy.incomplete && !rig.log.is_complete() {
        return Err(rig.lacks_sensors());
    }
    let (mut recording, mut summary, psins_header) = match &rig.log.format {
        LogFormat::Columns(columns) => {
            let (recording, summary) = assemble::read(&rig, columns, memory, policy)?;
            (recording, summary, None)
        }
        LogFormat::Psins => {
            let (recording, summary, header) = psins::read(&rig, policy)?;
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
    let rotations = rotations(&rig, &recording, &mut summary);
    window(&mut rig, &mut recording, &mut summary)?;
    Ok(Loaded { rig, station, recording, summary, rotations, psins_header })
}

/// Keeps the part of a recording in the rig's window, and refuses static intervals without any sample in it.
///
/// If the times of a log are counted from an origin, both may be stated in the time of the log or from the origin.
fn window(
    rig: &mut Rig,
    recording: &mut Recording,
    summary: &mut LogSummary,
) -> Result<(), IoError> {
    let origin = summary.time_origin;
    let from_origin =
        |time: &mut f64| *time -= if origin > 0.0 && *time >= origin { origin } else { 0.0 };
    rig.log.window.iter_mut().chain(&mut rig.log.static_spans).flatten().for_each(from_origin);
    let outside = |key, [from, to]: [f64; 2], recording: &Recording| {
        let start = recording.times.first().zip(recording.increments.first());
        let first = start.map_or(0.0, |(time, sample)| time - sample.interval);
        let last = recording.times.last().copied().unwrap_or_default();
        LogError::of(&rig.log.path, LogProblem::OutsideLog { key, from, to, first, last })
    };
    // A sample's interval may begin before the window by a rounding error.
    let slack = 0.01 * summary.nominal_interval;
    let samples = |[from, to]: [f64; 2], recording: &Recording| {
        let mut samples = recording.times.iter().zip(&recording.increments);
        let inside = |(time, sample): (&f64, &rins_frames::Increments)| {
            time - sample.interval >= from - slack
        };
        let first = samples.position(inside).unwrap_or(recording.len());
        let end = recording.times.partition_point(|time| *time <= to + slack);
        (end > first + 1).then_some(first..end)
    };
    if let Some(window) = rig.log.window {
        let Some(kept) = samples(window, recording) else {
            return Err(outside("window", window, recording));
        };
        *recording = recording.slice(kept.start, kept.end);
        summary.samples = kept.len();
        summary.gaps.retain(|gap| kept.contains(&gap.sample));
        for gap in &mut summary.gaps {
            gap.sample -= kept.start;
        }
    }
    match rig.log.static_spans.iter().find(|span| samples(**span, recording).is_none()) {
        Some(span) => Err(outside("static", *span, recording)),
        None => Ok(()),
    }
}

/// The rotations of known angle in the time of the recording: between readings, or of a profile, which begins with the log.
fn rotations(rig: &Rig, recording: &Recording, summary: &mut LogSummary) -> Vec<StatedRotation> {
    if !summary.rotations.is_empty() {
        return std::mem::take(&mut summary.rotations);
    }
    let (Some(table), Some(first)) = (&rig.table, recording.increments.first()) else {
        return Vec::new();
    };
    let late = summary.redivided.map_or(0.0, |redivided| redivided.late);
    let start = recording.times[0] - first.interval - late;
    let moved = |turn: &StatedRotation| StatedRotation {
        start: turn.start + start,
        end: turn.end + start,
        ..*turn
    };
    table.turns.iter().map(moved).collect()
}

/// The commanded table rate over each interval, if the rig has a profile, which begins `late`
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
