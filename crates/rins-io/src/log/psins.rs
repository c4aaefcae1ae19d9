//! PSINS text logs: three rows of header, then six integer increments per sample.

use std::io::BufRead;

use nalgebra::Vector3;
use rins_frames::units::{ARCSEC, DEG};
use rins_frames::{EulerAngles, InFrame, Increments, Site};
use rins_motion::Recording;

use super::clock::Stamps;
use super::damage::{Damage, is_of_a_row};
use super::fields::{Delimiter, Fields};
use super::files::BEYOND_REASON;
use super::lines::Lines;
use super::problem::LogProblem;
use super::summary::{LeftOut, LogPolicy, LogSummary, Omission};
use super::table::{Columns, MOST_ROWS};
use crate::error::{IoError, LogError};
use crate::quantity::kinds;
use crate::rig::{Rig, Stamp};

/// The header of a PSINS log, in SI units and radians.
///
/// Its frames are those of rins: body right, front, up; navigation east, north, up; and
/// `C_b^n = Rz(yaw) Rx(pitch) Ry(roll)`. The attitude has no stated uncertainty, and is
/// therefore never used as the attitude of the rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PsinsHeader {
    /// The initial attitude \[rad\].
    pub attitude: EulerAngles,
    /// The initial velocity, east, north, up \[m/s\].
    pub velocity: Vector3<f64>,
    /// The site.
    pub site: Site,
    /// The start time \[s\].
    pub start: f64,
    /// The sampling interval \[s\].
    pub interval: f64,
    /// The gravity in the definition of its unit ug \[m/s²\].
    pub gravity: f64,
    /// The scale of the gyros' counts \[rad\].
    pub angle_scale: Vector3<f64>,
    /// The scale of the accelerometers' counts \[m/s\].
    pub velocity_scale: Vector3<f64>,
}

const HEADER: [[&str; 6]; 3] = [
    ["pitch", "roll", "yaw", "east velocity", "north velocity", "up velocity"],
    ["latitude", "longitude", "height", "start time", "interval", "gravity"],
    [
        "gyro x scale",
        "gyro y scale",
        "gyro z scale",
        "accel x scale",
        "accel y scale",
        "accel z scale",
    ],
];

const NUMBERS: [&str; 6] = ["gyro x", "gyro y", "gyro z", "accel x", "accel y", "accel z"];

/// Reads the log of a rig whose format is `psins`. The ends of the samples are one interval apart.
pub(super) fn read(
    rig: &Rig,
    policy: LogPolicy,
) -> Result<(Recording, LogSummary, PsinsHeader), IoError> {
    read_from(&mut Lines::open(&rig.log.path)?, rig, policy)
}

pub(super) fn read_from<R: BufRead>(
    lines: &mut Lines<R>,
    rig: &Rig,
    policy: LogPolicy,
) -> Result<(Recording, LogSummary, PsinsHeader), IoError> {
    let path = lines.path().to_path_buf();
    let header = header(lines)?;
    if let Some(stated) = rig.log.rate
        && (header.interval * stated - 1.0).abs() > 0.01
    {
        let measured = 1.0 / header.interval;
        return Err(LogError::of(&path, LogProblem::WrongRate { measured, stated }));
    }
    let gyro_axes = rig.spin.after(&rig.log.gyro_axes);
    let accel_axes = rig.spin.after(&rig.log.accel_axes);
    let mut recording = Recording::default();
    let mut columns = Columns::default();
    let mut damage = Damage::default();
    let refused = |(line, problem)| LogError::at(&path, line, problem);
    let mut first = None;
    let mut moved = [false; 6];
    loop {
        let row = match row(lines, &NUMBERS) {
            Ok(Some(row)) => row,
            Ok(None) => break,
            Err(IoError::Log(error)) if is_of_a_row(&error.problem) => {
                damage.note(lines.number(), error.problem, MOST_ROWS).map_err(refused)?;
                continue;
            }
            Err(error) => return Err(error),
        };
        let first = first.get_or_insert(row);
        for (moved, (now, first)) in moved.iter_mut().zip(row.iter().zip(first.iter())) {
            *moved |= now - first != 0.0;
        }
        let [gx, gy, gz, ax, ay, az] = row;
        let angle = header.angle_scale.component_mul(&Vector3::new(gx, gy, gz));
        let velocity = header.velocity_scale.component_mul(&Vector3::new(ax, ay, az));
        for (unit, values, names) in
            [("rad", angle, &NUMBERS[..3]), ("m/s", velocity, &NUMBERS[3..])]
        {
            if let Some(axis) = values.iter().position(|value| value.abs() > BEYOND_REASON) {
                let (column, value) = (names[axis].into(), values[axis]);
                let problem = LogProblem::BeyondReason { column, value, unit };
                return Err(LogError::at(&path, lines.number(), problem));
            }
        }
        recording.increments.push(Increments {
            angle: InFrame::from_components(gyro_axes.apply(&angle)),
            velocity: InFrame::from_components(accel_axes.apply(&velocity)),
            interval: header.interval,
        });
        columns.lines.push(lines.number());
        if columns.lines.len() as u64 > MOST_ROWS {
            return Err(LogError::of(&path, LogProblem::ManyRows { most: MOST_ROWS }));
        }
    }
    let stuck = moved[..3].iter().position(|moved| !moved);
    if let (Some(axis), Some(first)) = (stuck.filter(|_| recording.increments.len() >= 10), first) {
        let problem = LogProblem::Stuck { channel: NUMBERS[axis].into(), value: first[axis] };
        return Err(LogError::of(&path, problem));
    }
    damage.settle(&mut columns).map_err(refused)?;
    let Columns { lines: of_rows, damaged, .. } = &columns;
    let stamps = Stamps { path: &path, lines: of_rows, damaged, stamp: Stamp::End, nominal: None };
    let mut clock = stamps.counted(header.interval, policy)?;
    for gap in &clock.summary.gaps {
        // The increment after a damaged row does not cover it.
        let sample = &mut recording.increments[gap.sample];
        *sample = sample.rates().over(gap.length);
    }
    let unfinished = lines.unfinished().map(|line| (line, Omission::Unfinished));
    let left_out = columns.left_out.iter().copied().chain(unfinished);
    clock.summary.left_out.extend(left_out.map(|(line, reason)| LeftOut {
        path: path.clone(),
        line,
        reason,
    }));
    recording.times = clock.ends.iter().map(|end| header.start + end).collect();
    Ok((recording, clock.summary, header))
}

pub(crate) fn header<R: BufRead>(lines: &mut Lines<R>) -> Result<PsinsHeader, IoError> {
    let mut rows = [[0.0; 6]; 3];
    for (index, names) in HEADER.iter().enumerate() {
        rows[index] = row(lines, names)?.ok_or_else(|| {
            let problem = match lines.emptiness() {
                LogProblem::Empty if lines.number() > 0 => LogProblem::ShortHeader { rows: index },
                problem if index == 0 => problem,
                _ => LogProblem::ShortHeader { rows: index },
            };
            LogError::of(lines.path(), problem)
        })?;
        let limits: &[(usize, f64, f64, &'static str)] = match index {
            0 => &[(0, -90.0, 90.0, "a pitch from -90 to 90 deg")],
            1 => &[
                (0, -kinds::MOST_LATITUDE, kinds::MOST_LATITUDE, kinds::LATITUDE_RANGE),
                (1, -360.0, 360.0, "a longitude from -360 to 360 deg"),
                (2, -1e3, 2e4, "a height from -1000 to 20000 m"),
                (3, -1e9, 1e9, "a start time from -1e9 to 1e9 s"),
                (4, 1e-3, 1e6, "an interval of more than 0.001 ms"),
                (5, 9.7, 9.9, "a gravity from 9.7 to 9.9 m/s^2"),
            ],
            _ => &[],
        };
        for &(column, low, high, expected) in limits {
            let value = rows[index][column];
            if !(low..=high).contains(&value) {
                let problem = LogProblem::Header { name: names[column], value, expected };
                return Err(LogError::at(lines.path(), lines.number(), problem));
            }
        }
        if let Some(column) = rows[2].iter().position(|scale| index == 2 && *scale == 0.0) {
            let (name, expected) = (names[column], "a scale other than zero");
            let problem = LogProblem::Header { name, value: 0.0, expected };
            return Err(LogError::at(lines.path(), lines.number(), problem));
        }
    }
    let [
        [pitch, roll, yaw, east, north, up],
        [latitude, longitude, height, start, step, gravity],
        scale,
    ] = rows;
    let scale_of = |first: usize| Vector3::new(scale[first], scale[first + 1], scale[first + 2]);
    Ok(PsinsHeader {
        attitude: EulerAngles { roll: roll * DEG, pitch: pitch * DEG, yaw: yaw * DEG },
        velocity: Vector3::new(east, north, up),
        site: Site { latitude: latitude * DEG, longitude: longitude * DEG, height },
        start,
        interval: step / 1e3,
        gravity,
        angle_scale: scale_of(0) * ARCSEC,
        velocity_scale: scale_of(3) * (1e-6 * gravity),
    })
}

/// The six numbers of the next row.
fn row<R: BufRead>(lines: &mut Lines<R>, names: &[&str; 6]) -> Result<Option<[f64; 6]>, IoError> {
    let path = lines.path().to_path_buf();
    let Some((line, text)) = lines.next()? else { return Ok(None) };
    let refuse = |problem| LogError::at(&path, line, problem);
    let mut numbers = [0.0; 6];
    let mut got = 0;
    for field in Fields::of(text, Delimiter::Blanks) {
        if let Some(number) = numbers.get_mut(got) {
            let column = || names[got].to_string();
            let text = || field.chars().take(40).collect();
            *number = match field.parse::<f64>() {
                Ok(value) if value.is_finite() => value,
                Ok(_) => {
                    return Err(refuse(LogProblem::NotFinite { column: column(), text: text() }));
                }
                Err(_) => {
                    return Err(refuse(LogProblem::NotANumber { column: column(), text: text() }));
                }
            };
        }
        got += 1;
    }
    if got != 6 {
        return Err(refuse(LogProblem::FieldCount { got, expected: 6 }));
    }
    Ok(Some(numbers))
}
