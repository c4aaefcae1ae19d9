//! From a log's columns to a recording.

use nalgebra::Vector3;
use rins_frames::{InFrame, Increments};
use rins_motion::Recording;

use super::clock::{Clock, Stamps};
use super::files::{Files, OneFile, TriadValues};
use super::instant::Instants;
use super::problem::LogProblem;
use super::redivide::redivide;
use super::series::{between, unwrap};
use super::summary::{LogPolicy, LogSummary, Redivided};
use super::table::{self, Wanted};
use crate::error::{IoError, LogError};
use crate::rig::{
    Axes, ColumnSpec, Gaps, Reading, Rig, Stamp, Table, TemperatureColumn, TriadColumns,
};

/// How many of its own intervals a temperature may be held before its first and after its last.
const HELD_TEMPERATURES: f64 = 2.0;

/// Reads the recording that a rig's columns describe.
pub(super) fn read(
    rig: &Rig,
    spec: &ColumnSpec,
    policy: LogPolicy,
) -> Result<(Recording, LogSummary), IoError> {
    let files = Files::read(rig, spec)?;
    let main = files.main();
    let stamp = spec.time.as_ref().map_or(Stamp::End, |time| time.stamp);
    let nominal = rig.log.rate.map(|rate| 1.0 / rate);
    let stamps = Stamps { path: &main.path, lines: &main.columns.lines, stamp, nominal };
    let times = &main.columns.time;
    let mut clock = match nominal {
        Some(interval) if spec.time.is_none() => stamps.counted(interval)?,
        _ => stamps.timed(times, policy)?,
    };
    clock.summary.left_out = files.left_out();
    clock.summary.time_origin = files.instants.map_or(0.0, |instants| instants.origin());
    files.compare(clock.summary.nominal_interval)?;

    let gyro = files.gyro(spec)?;
    let accel = files.accel(spec)?;
    let gyro = Channel { spec: &spec.gyro, values: gyro, axes: rig.spin.after(&rig.log.gyro_axes) };
    let accel =
        Channel { spec: &spec.accel, values: accel, axes: rig.spin.after(&rig.log.accel_axes) };
    let angles = gyro.increments(&clock, spec.gaps)?;
    let (kept, velocities) = match files.accel_clock(spec, &clock, policy)? {
        None => (0..clock.ends.len(), accel.increments(&clock, spec.gaps)?),
        Some(own) => {
            let (kept, velocities) = redivide(&own, &accel.increments(&own, spec.gaps)?, &clock);
            if kept.len() < 2 {
                let other = spec.accel.path.display().to_string();
                return Err(LogError::of(&main.path, LogProblem::NoOverlap { other }));
            }
            let left_out = clock.ends.len() - kept.len();
            let late = clock.intervals[..kept.start].iter().sum();
            let samples = own.ends.len();
            clock.summary.redivided = Some(Redivided { samples, left_out, late });
            (kept, velocities)
        }
    };
    let angles = angles.into_iter().skip(kept.start);
    let intervals = &clock.intervals[kept.clone()];
    let increments = angles.zip(velocities).zip(intervals);
    let increments = increments.map(|((angle, velocity), &interval)| Increments {
        angle: InFrame::from_components(angle),
        velocity: InFrame::from_components(velocity),
        interval,
    });
    let increments = increments.collect();
    let uncut = if times.is_empty() { clock.ends.clone() } else { Vec::new() };
    let times = if times.is_empty() { &uncut } else { times };
    clock.keep(kept.clone());

    let table_angle = match &spec.table_angle {
        Some(column) => {
            let file = files.file(&rig.log.path);
            let mut angles = file.column(&column.column, column.factor, "rad")?;
            unwrap(&mut angles).map_err(|(row, turns)| {
                let problem = LogProblem::AmbiguousAngle { turns };
                LogError::at(&file.path, file.columns.lines[row], problem)
            })?;
            Some(at(times, &angles, &clock.ends))
        }
        None => None,
    };
    let table_rate = match &spec.table_rate {
        Some(column) => {
            let log = files.file(&rig.log.path);
            let mut rates = log.column(&column.column, column.factor, "rad/s")?;
            rates.truncate(kept.end);
            rates.drain(..kept.start);
            Some(rates)
        }
        None => None,
    };
    let temperature = match &spec.temperature {
        Some(TemperatureColumn { file: None, column, offset }) => {
            let values = files.file(&rig.log.path).temperatures(column, *offset)?;
            Some(at(times, &values, &clock.ends))
        }
        Some(column) => {
            let own = temperature(column, files.instants, &clock.ends)?;
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

/// A signal's values at the ends of the samples' intervals, which lie among its own times.
fn at(times: &[f64], values: &[f64], ends: &[f64]) -> Vec<f64> {
    // The last values for a time that rounding has put beyond the last.
    let last = values.last().copied().unwrap_or_default();
    ends.iter().map(|&end| between(times, values, end).unwrap_or(last)).collect()
}

/// The numbers of a triad, row by row, and what they are.
struct Channel<'s> {
    spec: &'s TriadColumns,
    values: TriadValues,
    axes: Axes,
}

impl Channel<'_> {
    fn increments(self, clock: &Clock, gaps: Option<Gaps>) -> Result<Vec<Vector3<f64>>, IoError> {
        let mut scale = clock.intervals.clone();
        if let Reading::Increment(_) = self.spec.reading {
            scale.fill(1.0);
            for gap in &clock.summary.gaps {
                match gaps {
                    Some(Gaps::Accumulated) => {}
                    Some(Gaps::Held) => {
                        let interval = clock.intervals[gap.sample];
                        scale[gap.sample] = interval / clock.summary.nominal_interval;
                    }
                    None => {
                        let (length, after) = (gap.length, gap.after);
                        let problem = LogProblem::LostIncrements { length, after };
                        return Err(LogError::at(&self.spec.path, gap.line, problem));
                    }
                }
            }
        }
        let mut values = self.values;
        for (value, scale) in values.iter_mut().zip(scale) {
            *value = self.axes.apply(value) * scale;
        }
        Ok(values)
    }
}

/// The file that holds the temperature, where it is not the log, and what it says at the ends of the
/// intervals.
fn temperature(
    TemperatureColumn { file, column, offset }: &TemperatureColumn,
    instants: Option<Instants>,
    ends: &[f64],
) -> Result<Option<(OneFile, Vec<f64>)>, IoError> {
    let (Some((path, time)), Some(mut instants)) = (file, instants) else {
        return Ok(None);
    };
    let wanted = Wanted { names: &[column], time: Some((&time.column, &mut instants)) };
    let columns = table::read(path, Table::of(path), wanted)?;
    let file = OneFile { path: path.clone(), names: vec![column.clone()], columns };
    let (times, values) = (&file.columns.time, file.temperatures(column, *offset)?);
    for (pair, &line) in times.windows(2).zip(&file.columns.lines[1..]) {
        if pair[1] <= pair[0] {
            let problem = LogProblem::TimeNotIncreasing { before: pair[0], now: pair[1] };
            return Err(LogError::at(path, line, problem));
        }
    }
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
