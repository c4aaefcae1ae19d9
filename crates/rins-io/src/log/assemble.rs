//! Conversion of a log's columns to a recording.

use std::mem;
use std::ops::Range;
use std::slice;

use nalgebra::Vector3;
use rins_frames::{InFrame, Increments};
use rins_motion::Recording;

use super::angle_file::{OwnAngles, angles_of_own_clock};
use super::clock::Clock;
use super::files::{Files, OneFile, TriadValues, own_file};
use super::instant::Instants;
use super::problem::LogProblem;
use super::redivide::redivide;
use super::series::{between, smoothly_between, unwrap};
use super::sparse_angle::SparseAngle;
use super::summary::{Gap, LogPolicy, LogSummary, Redivided, TableClock};
use super::table::{self, LogColumns, Wanted, WantedTime};
use crate::error::{IoError, LogError};
use crate::rig::{
    AngleColumn, Axes, ColumnSpec, Gaps, Reading, Rig, Stamp, StatedRotation, Table,
    TemperatureColumn, TextForm, TriadColumns,
};
use crate::shown::shown;

/// The time, in temperature intervals, over which a temperature is held before its first and after its last reading.
const HELD_TEMPERATURES: f64 = 2.0;

/// Reads the recording that a rig's columns describe, from files or with the log in memory.
pub(super) fn read(
    rig: &Rig,
    spec: &ColumnSpec,
    memory: Option<LogColumns>,
    policy: LogPolicy,
) -> Result<(Recording, LogSummary), IoError> {
    let mut files = Files::read(rig, spec, memory)?;
    let main = files.main();
    let stamp = spec.time.as_ref().map_or(Stamp::End, |time| time.stamp);
    let nominal = rig.log.rate.map(|rate| 1.0 / rate);
    let stamps = main.stamps(stamp, nominal);
    let mut clock = match nominal {
        Some(interval) if spec.time.is_none() => stamps.counted(interval, policy)?,
        _ => stamps.timed(&main.columns.time, policy)?,
    };
    clock.summary.left_out = files.left_out();
    clock.summary.rounded = files.rounded;
    clock.summary.overflows = mem::take(&mut files.overflows);
    clock.summary.time_origin = files.instants.map_or(0.0, |instants| instants.origin());
    files.compare(clock.summary.nominal_interval)?;

    let gyro = files.gyro(spec)?;
    let accel = files.accel(spec)?;
    let gyro = Channel { spec: &spec.gyro, values: gyro, axes: rig.spin.after(&rig.log.gyro_axes) };
    let accel =
        Channel { spec: &spec.accel, values: accel, axes: rig.spin.after(&rig.log.accel_axes) };
    let mut angles = gyro.increments(&clock, spec.gaps)?;
    let (mut kept, velocities) = match files.accel_clock(spec, &clock, policy)? {
        None => (0..clock.ends.len(), accel.increments(&clock, spec.gaps)?),
        Some(own) => {
            let (kept, velocities) = redivide(&own, &accel.increments(&own, spec.gaps)?, &clock);
            if kept.len() < 2 {
                let other = shown(&spec.accel.path);
                return Err(LogError::of(&files.main().path, LogProblem::NoOverlap { other }));
            }
            let left_out = clock.ends.len() - kept.len();
            let late = clock.intervals[..kept.start].iter().sum();
            let samples = own.ends.len();
            clock.summary.redivided = Some(Redivided { samples, left_out, late });
            (kept, velocities)
        }
    };
    for list in &mut angles {
        cut(list, &kept);
    }
    let times = Some(files.take_times());
    let times = times.filter(|times| !times.is_empty() && *times != clock.ends);
    clock.keep(kept.clone());
    let mut increments = joined([angles, velocities], mem::take(&mut clock.intervals));

    let mut own_angles = None;
    if let Some(column @ AngleColumn { file: Some((path, own)), .. }) = &spec.table_angle {
        let file = (path.as_path(), Table::of(path), spec.text.of_another_file());
        let file = own_file(file, (slice::from_ref(&column.column), None), own, files.instants)?;
        clock.summary.left_out.extend(file.left_out());
        let log = &files.main().path;
        let OwnAngles { angles, covered, rate } =
            angles_of_own_clock(file, column, &increments, &clock.ends, log)?;
        let left_out = increments.len() - covered.len();
        clock.summary.table_clock = Some(TableClock { rate, left_out });
        kept = kept.start + covered.start..kept.start + covered.end;
        cut(&mut increments, &covered);
        clock.keep(covered);
        own_angles = Some(angles);
    }

    // Interpolates a signal to the ends of the samples' intervals.
    let at_ends = |mut values: Vec<f64>, between: Between| match &times {
        // Without a time column, the rows' times are those ends.
        None => {
            cut(&mut values, &kept);
            values
        }
        Some(times) => at(between, times, &values, &clock.ends),
    };
    let table_angle = match &spec.table_angle {
        Some(AngleColumn { file: Some(_), .. }) => own_angles,
        Some(column) => {
            let moments = times.as_ref().unwrap_or(&clock.ends);
            let (angles, rotations) = angle_in_log(files.file(&rig.log.path), column, moments)?;
            clock.summary.rotations = rotations;
            angles.map(|angles| at_ends(angles, smoothly_between))
        }
        None => None,
    };
    let table_rate = spec.table_rate.as_ref().map(|column| {
        let log = files.file(&rig.log.path);
        let mut rates = log.column(&column.column, column.factor, "rad/s")?;
        cut(&mut rates, &kept);
        Ok::<_, IoError>(rates)
    });
    let table_rate = table_rate.transpose()?;
    let temperature = match &spec.temperature {
        Some(TemperatureColumn { file: None, column, offset }) => {
            Some(at_ends(files.file(&rig.log.path).temperatures(column, *offset)?, between))
        }
        Some(column) => {
            let own =
                temperature((column, spec.text.of_another_file()), files.instants, &clock.ends)?;
            own.map(|(file, temperatures)| {
                clock.summary.left_out.extend(file.left_out());
                temperatures
            })
        }
        None => None,
    };
    let Clock { ends: times, summary, .. } = clock;
    Ok((Recording { times, increments, table_angle, table_rate, temperature }, summary))
}

/// The table angle in the rows of a log, or the rotations between its readings if these are rare.
fn angle_in_log(
    file: &mut OneFile,
    column: &AngleColumn,
    times: &[f64],
) -> Result<(Option<Vec<f64>>, Vec<StatedRotation>), IoError> {
    let mut angles = file.column(&column.column, column.factor, "rad")?;
    let ambiguous = |(row, turns)| {
        let problem = LogProblem::AmbiguousAngle { turns };
        LogError::at(&file.path, file.columns.lines.of(row), problem)
    };
    if !angles.iter().any(|angle| angle.is_nan()) {
        unwrap(&mut angles).map_err(ambiguous)?;
        return Ok((Some(angles), Vec::new()));
    }
    Ok(match SparseAngle::of(&angles, times).map_err(ambiguous)? {
        SparseAngle::Filled(angles) => (Some(angles), Vec::new()),
        SparseAngle::Rotations(rotations) => (None, rotations),
    })
}

/// Keeps a range of a list.
fn cut<T>(list: &mut Vec<T>, range: &Range<usize>) {
    list.truncate(range.end);
    list.drain(..range.start);
}

/// An interpolation of a signal at a time between its readings.
type Between = fn(&[f64], &[f64], f64) -> Option<f64>;

/// A signal's values at the ends of the samples' intervals, which must be within its own times.
fn at(between: Between, times: &[f64], values: &[f64], ends: &[f64]) -> Vec<f64> {
    // Rounding can put an end after the last time: the last value is then used.
    let last = values.last().copied().unwrap_or_default();
    ends.iter().map(|&end| between(times, values, end).unwrap_or(last)).collect()
}

/// Increments from the components of their angles and velocities, and from their intervals.
///
/// For a day at 100 Hz each of these is half a gigabyte, so the inputs are released during the conversion: from the
/// end, where lists can be truncated.
fn joined(mut parts: [TriadValues; 2], mut intervals: Vec<f64>) -> Vec<Increments> {
    const SHARES: usize = 32;
    let mut increments = Vec::with_capacity(intervals.len());
    let share = intervals.len().div_ceil(SHARES).max(1);
    while !intervals.is_empty() {
        let first = (intervals.len() - 1) / share * share;
        for sample in (first..intervals.len()).rev() {
            let vector = |part: &TriadValues| {
                Vector3::new(part[0][sample], part[1][sample], part[2][sample])
            };
            increments.push(Increments {
                angle: InFrame::from_components(vector(&parts[0])),
                velocity: InFrame::from_components(vector(&parts[1])),
                interval: intervals[sample],
            });
        }
        for list in parts.iter_mut().flatten().chain([&mut intervals]) {
            list.truncate(first);
            list.shrink_to_fit();
        }
    }
    increments.reverse();
    increments
}

/// The numbers of a triad along the sensors' axes in SI units, with their kind.
struct Channel<'s> {
    spec: &'s TriadColumns,
    values: TriadValues,
    axes: Axes,
}

impl Channel<'_> {
    /// The increments over the intervals along the body's axes.
    fn increments(self, clock: &Clock, gaps: Option<Gaps>) -> Result<TriadValues, IoError> {
        let increments = matches!(self.spec.reading, Reading::Increment(_));
        let mut unexplained = clock.summary.gaps.iter().filter(|gap| !gap.damaged);
        if let (true, None, Some(gap)) = (increments, gaps, unexplained.next()) {
            let problem = LogProblem::LostIncrements { length: gap.length, after: gap.after };
            return Err(LogError::at(&self.spec.path, gap.line, problem));
        }
        let [mut x, mut y, mut z] = self.values;
        for list in [&mut x, &mut y, &mut z] {
            list.truncate(clock.intervals.len());
        }
        let is_held = |gap: &&Gap| gap.damaged || gaps == Some(Gaps::Held);
        let mut held = clock.summary.gaps.iter().filter(is_held).peekable();
        for (sample, &interval) in clock.intervals.iter().enumerate() {
            let in_gap = held.next_if(|gap| gap.sample == sample).is_some();
            let scale = match (increments, in_gap) {
                (false, _) => interval,
                (true, false) => 1.0,
                (true, true) => interval / clock.summary.nominal_interval,
            };
            let value = self.axes.apply(&Vector3::new(x[sample], y[sample], z[sample])) * scale;
            (x[sample], y[sample], z[sample]) = (value.x, value.y, value.z);
        }
        Ok([x, y, z])
    }
}

/// The file of the temperature, if it is not the log, and the temperatures at the ends of the
/// intervals.
fn temperature(
    (TemperatureColumn { file, column, offset }, text): (&TemperatureColumn, TextForm),
    instants: Option<Instants>,
    ends: &[f64],
) -> Result<Option<(OneFile, Vec<f64>)>, IoError> {
    let (Some((path, time)), Some(instants)) = (file, instants) else {
        return Ok(None);
    };
    let mut instants = instants.of_another_file();
    let time = Some(WantedTime::of(time, &mut instants));
    let wanted = Wanted { names: &[column], time, rows: None, sparse: None, text };
    let columns = table::read(path, Table::of(path), wanted)?;
    let mut file = OneFile::of_column(path, column, columns);
    let values = file.temperatures(column, *offset)?;
    file.ensure_increasing()?;
    let times = &file.columns.time;
    let (first, last) = (times[0], times[times.len() - 1]);
    let own = (last - first) / (times.len().max(2) - 1) as f64;
    let reach = HELD_TEMPERATURES * own;
    let mut temperatures = Vec::with_capacity(ends.len());
    for &end in ends {
        if end < first - reach || end > last + reach {
            let problem = LogProblem::NoTemperature { first, last, time: end };
            return Err(LogError::of(path, problem));
        }
        let held = if end < first { values[0] } else { values[values.len() - 1] };
        temperatures.push(between(times, &values, end).unwrap_or(held));
    }
    Ok(Some((file, temperatures)))
}
