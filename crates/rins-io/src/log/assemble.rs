//! From columns of text logs to a recording.

use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use rins_frames::{InFrame, Increments};
use rins_motion::Recording;

use super::clock::{Clock, Stamps};
use super::columns::{self, Columns};
use super::instant::Instants;
use super::problem::LogProblem;
use super::series::{between, unwrap};
use super::summary::{LogPolicy, LogSummary};
use crate::error::{IoError, LogError};
use crate::rig::{
    Axes, ColumnSpec, Gaps, Reading, Rig, Stamp, TemperatureColumn, TimeUnit, TriadColumns,
};

/// How far the times of two files may be apart, in intervals.
const TOGETHER_WITHIN: f64 = 0.1;

/// How many of its own intervals a temperature may be held before its first and after its last.
const HELD_TEMPERATURES: f64 = 2.0;

/// How many samples it takes to call a channel stuck.
const ENOUGH_TO_BE_STUCK: usize = 10;

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
    clock.summary.repeated.clone_from(&main.columns.repeated);
    clock.summary.time_origin = files.instants.map_or(0.0, |instants| instants.origin());
    files.compare(clock.summary.nominal_interval)?;

    let times = if times.is_empty() { clock.ends.clone() } else { times.clone() };
    let gyro = files.triad(&spec.gyro, "gyro")?;
    let accel = files.triad(&spec.accel, "accel")?;
    let gyro = Channel { spec: &spec.gyro, values: gyro, axes: rig.spin.after(&rig.log.gyro_axes) };
    let accel =
        Channel { spec: &spec.accel, values: accel, axes: rig.spin.after(&rig.log.accel_axes) };
    let angles = gyro.increments(&clock, spec.gaps)?;
    let velocities = accel.increments(&clock, spec.gaps)?;
    let increments = angles.into_iter().zip(velocities).zip(&clock.intervals);
    let increments = increments.map(|((angle, velocity), &interval)| Increments {
        angle: InFrame::from_components(angle),
        velocity: InFrame::from_components(velocity),
        interval,
    });
    let increments = increments.collect();

    let table_angle = match &spec.table_angle {
        Some(column) => {
            let file = files.file(&rig.log.path);
            let mut angles = file.column(&column.column, column.factor);
            unwrap(&mut angles).map_err(|(row, turns)| {
                let problem = LogProblem::AmbiguousAngle { turns };
                LogError::at(&file.path, file.columns.lines[row], problem)
            })?;
            Some(at(&times, &angles, &clock.ends))
        }
        None => None,
    };
    let table_rate = spec.table_rate.as_ref().map(|column| {
        let mut rates = files.file(&rig.log.path).column(&column.column, column.factor);
        rates.truncate(clock.ends.len());
        rates
    });
    let temperature = match &spec.temperature {
        Some(TemperatureColumn { file: None, column, offset }) => {
            let mut values = files.file(&rig.log.path).column(column, 1.0);
            for value in &mut values {
                *value += offset;
            }
            Some(at(&times, &values, &clock.ends))
        }
        Some(column) => files.temperature(column, &clock.ends)?,
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
    values: Vec<Vector3<f64>>,
    axes: Axes,
}

impl Channel<'_> {
    fn increments(&self, clock: &Clock, gaps: Option<Gaps>) -> Result<Vec<Vector3<f64>>, IoError> {
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
        let turned = self.values.iter().map(|value| self.axes.apply(value));
        Ok(turned.zip(scale).map(|(value, scale)| value * scale).collect())
    }
}

/// The files of a run: that of the gyros, and perhaps others.
struct Files {
    files: Vec<OneFile>,
    instants: Option<Instants>,
}

struct OneFile {
    path: PathBuf,
    names: Vec<String>,
    columns: Columns,
}

impl OneFile {
    fn column(&self, name: &str, factor: f64) -> Vec<f64> {
        let place = self.names.iter().position(|known| known == name);
        let numbers = &self.columns.numbers[place.expect("every column in use was asked for")];
        numbers.iter().map(|number| number * factor).collect()
    }
}

impl Files {
    fn read(rig: &Rig, spec: &ColumnSpec) -> Result<Self, IoError> {
        let mut wanted: Vec<(&Path, Vec<String>)> = vec![(&spec.gyro.path, Vec::new())];
        let mut want = |path, name: &String| {
            let known = wanted.iter().position(|(known, _)| *known == path);
            let place = known.unwrap_or_else(|| {
                wanted.push((path, Vec::new()));
                wanted.len() - 1
            });
            let names = &mut wanted[place].1;
            if !names.contains(name) {
                names.push(name.clone());
            }
        };
        for triad in [&spec.gyro, &spec.accel] {
            triad.columns.iter().for_each(|name| want(&triad.path, name));
        }
        let log = rig.log.path.as_path();
        spec.table_angle.iter().for_each(|angle| want(log, &angle.column));
        spec.table_rate.iter().for_each(|rate| want(log, &rate.column));
        for temperature in spec.temperature.iter().filter(|column| column.file.is_none()) {
            want(log, &temperature.column);
        }

        let unit = spec.time.as_ref().map(|time| match time.unit {
            TimeUnit::Seconds(unit) => unit,
            TimeUnit::Samples => 1.0,
        });
        let mut instants = unit.map(Instants::new);
        let mut files = Vec::with_capacity(wanted.len());
        for (path, names) in wanted {
            let asked: Vec<&str> = names.iter().map(String::as_str).collect();
            let time = spec.time.as_ref().map(|time| time.column.as_str());
            let mut columns = columns::read(path, &asked, time.zip(instants.as_mut()))?;
            if let Some(time) = spec.time.as_ref().filter(|time| time.unit == TimeUnit::Samples) {
                let interval = rig.log.rate.map_or(1.0, |rate| 1.0 / rate);
                count(path, &time.column, &mut columns, interval)?;
            }
            files.push(OneFile { path: path.into(), names, columns });
        }
        Ok(Self { files, instants })
    }

    fn main(&self) -> &OneFile {
        &self.files[0]
    }

    fn file(&self, path: &Path) -> &OneFile {
        let found = self.files.iter().find(|file| file.path == path);
        found.expect("every file in use was read")
    }

    /// Refuses files that were not sampled together with the gyros'.
    fn compare(&self, interval: f64) -> Result<(), IoError> {
        let (main, others) = (self.main(), &self.files[1..]);
        for file in others {
            let other = || main.path.display().to_string();
            let (samples, expected) = (file.columns.lines.len(), main.columns.lines.len());
            if samples != expected {
                let problem = LogProblem::UnequalLength { samples, other: other(), expected };
                return Err(LogError::of(&file.path, problem));
            }
            let pairs = file.columns.time.iter().zip(&main.columns.time);
            for ((&time, &expected), &line) in pairs.zip(&file.columns.lines) {
                if (time - expected).abs() > TOGETHER_WITHIN * interval {
                    let problem = LogProblem::UnequalTimes { time, other: other(), expected };
                    return Err(LogError::at(&file.path, line, problem));
                }
            }
        }
        Ok(())
    }

    /// A triad's values in SI units along the sensors' axes, none of them stuck.
    fn triad(&self, spec: &TriadColumns, sensor: &str) -> Result<Vec<Vector3<f64>>, IoError> {
        let file = self.file(&spec.path);
        let (Reading::Rate(factor) | Reading::Increment(factor)) = spec.reading;
        let mut values = vec![Vector3::zeros(); file.columns.lines.len()];
        let mut stuck = Vec::new();
        for (axis, name) in spec.columns.iter().enumerate() {
            let numbers = file.column(name, 1.0);
            let first = numbers[0];
            let moves = numbers.iter().any(|n| n - first != 0.0);
            if numbers.len() >= ENOUGH_TO_BE_STUCK && !moves {
                let channel = format!("{sensor} {} ({name:?})", ["x", "y", "z"][axis]);
                stuck.push((channel, first));
            }
            for (value, number) in values.iter_mut().zip(numbers) {
                value[axis] = (number - spec.offset[axis]) * spec.scale[axis] * factor;
            }
        }
        // At rest a coarse accelerometer may well say the same all along, but not all three zero.
        let dead = sensor == "gyro" || stuck.len() == 3 && stuck.iter().all(|(_, n)| *n == 0.0);
        match stuck.into_iter().next().filter(|_| dead) {
            Some((channel, value)) => {
                Err(LogError::of(&file.path, LogProblem::Stuck { channel, value }))
            }
            None => Ok(values),
        }
    }

    /// The temperature at the ends of the intervals, from a file of its own.
    fn temperature(
        &self,
        TemperatureColumn { file, column, offset }: &TemperatureColumn,
        ends: &[f64],
    ) -> Result<Option<Vec<f64>>, IoError> {
        let (Some((path, time)), Some(mut instants)) = (file, self.instants) else {
            return Ok(None);
        };
        let read = columns::read(path, &[column], Some((&time.column, &mut instants)))?;
        let (times, values) = (&read.time, &read.numbers[0]);
        for (pair, &line) in times.windows(2).zip(&read.lines[1..]) {
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
            temperatures.push(between(times, values, end).unwrap_or(held) + offset);
        }
        Ok(Some(temperatures))
    }
}

/// Turns a counter of samples into seconds.
fn count(path: &Path, name: &str, columns: &mut Columns, interval: f64) -> Result<(), IoError> {
    for (time, &line) in columns.time.iter_mut().zip(&columns.lines) {
        if time.fract() != 0.0 {
            let problem = LogProblem::PartOfASample { column: name.into(), count: *time };
            return Err(LogError::at(path, line, problem));
        }
        *time *= interval;
    }
    Ok(())
}
