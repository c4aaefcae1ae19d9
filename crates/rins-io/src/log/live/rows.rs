//! Rows of a live log as samples.

use std::mem;
use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use rins_frames::{InFrame, Increments};
use rins_motion::{Recording, median};

use crate::error::{IoError, LogError};
use crate::log::clock::{GAP, PACE};
use crate::log::files::BEYOND_REASON;
use crate::log::problem::LogProblem;
use crate::log::series::Unwrapping;
use crate::log::summary::LogPolicy;
use crate::rig::{Axes, ColumnSpec, Gaps, Reading, Rig, Stamp, TriadColumns};

/// The number of rows whose median step is the nominal interval, if the rig file states no rate.
const PACED: usize = 10;

/// A row with the numbers of its columns.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) line: u64,
    /// In seconds, or in samples; `None` without a time column.
    pub(super) time: Option<f64>,
    pub(super) numbers: Vec<f64>,
}

/// A row in SI units.
#[derive(Clone, Copy, Debug)]
struct Reads {
    line: u64,
    time: f64,
    /// Along the body's axes: rates or increments.
    gyro: Vector3<f64>,
    accel: Vector3<f64>,
    /// The unwrapped angle \[rad\], or the rate \[rad/s\].
    table: f64,
}

/// The conversion of a triad.
#[derive(Clone, Debug)]
struct Triad {
    places: [usize; 3],
    spec: TriadColumns,
    axes: Axes,
    unit: &'static str,
}

/// The conversion of rows to samples.
#[derive(Debug)]
pub(super) struct Samples {
    source: PathBuf,
    gyro: Triad,
    accel: Triad,
    /// The place and the factor of the table's column, and its name.
    table: (usize, f64, String),
    is_angle: bool,
    stamp: Stamp,
    gaps: Option<Gaps>,
    pub(super) nominal: Option<f64>,
    is_stated: bool,
    /// The rows before the nominal interval is known.
    waiting: Vec<Reads>,
    before: Option<Reads>,
    /// The number of rows.
    count: u64,
    unwrapping: Unwrapping,
    ready: Recording,
}

impl Samples {
    pub(super) fn of(rig: &Rig, columns: &ColumnSpec, names: &[String], source: &Path) -> Self {
        let place = |name: &String| names.iter().position(|known| known == name);
        let place = |name: &String| place(name).expect("every column in use was asked for");
        let triad = |spec: &TriadColumns, axes: Axes, units: [&'static str; 2]| {
            let mut places = [0; 3];
            for (to, name) in places.iter_mut().zip(spec.names()) {
                *to = place(name);
            }
            let unit = units[usize::from(matches!(spec.reading, Reading::Increment(_)))];
            Triad { places, spec: spec.clone(), axes: rig.spin.after(&axes), unit }
        };
        let angle = columns.table_angle.as_ref().map(|angle| (&angle.column, angle.factor));
        let rate = columns.table_rate.as_ref().map(|rate| (&rate.column, rate.factor));
        let (name, factor) = angle.or(rate).expect("a live log has a reading of the table");
        Self {
            source: source.into(),
            gyro: triad(&columns.gyro, rig.log.gyro_axes, ["rad/s", "rad"]),
            accel: triad(&columns.accel, rig.log.accel_axes, ["m/s^2", "m/s"]),
            table: (place(name), factor, name.clone()),
            is_angle: angle.is_some(),
            stamp: columns.time.as_ref().map_or(Stamp::End, |time| time.stamp),
            gaps: columns.gaps,
            nominal: rig.log.rate.map(f64::recip),
            is_stated: rig.log.rate.is_some(),
            waiting: Vec::new(),
            before: None,
            count: 0,
            unwrapping: Unwrapping::default(),
            ready: Recording::default(),
        }
    }

    /// Takes a row; its time is a number of samples if the column `is_counter`.
    pub(super) fn push(&mut self, row: &Row, is_counter: bool) -> Result<(), IoError> {
        let reads = self.reads(row, is_counter)?;
        let Some(reads) = reads else { return Ok(()) };
        self.count += 1;
        if self.nominal.is_some() {
            return self.advance(reads);
        }
        self.waiting.push(reads);
        if self.waiting.len() < PACED { Ok(()) } else { self.pace() }
    }

    /// Takes the rows that wait for the nominal interval, at the end of the log.
    pub(super) fn end(&mut self) -> Result<(), IoError> {
        if self.count == 0 {
            return Err(LogError::of(&self.source, LogProblem::OnlyHeader));
        }
        if self.nominal.is_none() { self.pace() } else { Ok(()) }
    }

    /// The samples since the last call.
    pub(super) fn take(&mut self) -> Recording {
        mem::take(&mut self.ready)
    }

    fn refused(&self, line: u64, problem: LogProblem) -> IoError {
        LogError::at(&self.source, line, problem)
    }

    /// The readings of a row in SI units; `None` for an empty message of a driver, in which all are zero.
    fn reads(&mut self, row: &Row, is_counter: bool) -> Result<Option<Reads>, IoError> {
        let line = row.line;
        let sensors = self.gyro.places.iter().chain(&self.accel.places);
        if sensors.clone().all(|&place| row.numbers[place] == 0.0) && row.time.is_some() {
            return Ok(None);
        }
        let time = match (row.time, is_counter) {
            (Some(count), true) if count.fract() != 0.0 => {
                let problem = LogProblem::PartOfASample { column: "time".into(), count };
                return Err(self.refused(line, problem));
            }
            (Some(count), true) => count * self.nominal.unwrap_or(1.0),
            (Some(time), false) => time,
            (None, _) => (self.count + 1) as f64 * self.nominal.unwrap_or(1.0),
        };
        let [gyro, accel] = [&self.gyro, &self.accel].map(|triad| triad.read(&row.numbers));
        let beyond = |triad: &Triad, values: &Vector3<f64>| {
            let axis = (0..3).find(|&axis| values[axis].abs() > BEYOND_REASON)?;
            let column = triad.spec.columns[axis].clone().unwrap_or_default();
            Some(LogProblem::BeyondReason { column, value: values[axis], unit: triad.unit })
        };
        let found = beyond(&self.gyro, &gyro).or_else(|| beyond(&self.accel, &accel));
        if let Some(problem) = found {
            return Err(self.refused(line, problem));
        }
        let (place, factor, name) = &self.table;
        let table = row.numbers[*place] * factor;
        if table.abs() > BEYOND_REASON {
            let unit = if self.is_angle { "rad" } else { "rad/s" };
            let problem = LogProblem::BeyondReason { column: name.clone(), value: table, unit };
            return Err(self.refused(line, problem));
        }
        let ambiguous = |turns| self.refused(line, LogProblem::AmbiguousAngle { turns });
        let mut unwrapping = self.unwrapping;
        let table = if self.is_angle { unwrapping.next(table).map_err(ambiguous)? } else { table };
        self.unwrapping = unwrapping;
        let (gyro, accel) = (self.gyro.axes.apply(&gyro), self.accel.axes.apply(&accel));
        Ok(Some(Reads { line, time, gyro, accel, table }))
    }

    /// Sets the nominal interval to the median step of the rows that wait, and takes them.
    fn pace(&mut self) -> Result<(), IoError> {
        let steps = self.waiting.windows(2).map(|pair| pair[1].time - pair[0].time);
        let samples = self.waiting.len();
        let short = || LogError::of(&self.source, LogProblem::TooShort { samples });
        let interval = median(steps).ok_or_else(short)?;
        let (least, most) = PACE;
        if !(least..=most).contains(&interval) {
            let problem = LogProblem::Pace { interval, least, most };
            return Err(LogError::of(&self.source, problem));
        }
        self.nominal = Some(interval);
        mem::take(&mut self.waiting).into_iter().try_for_each(|reads| self.advance(reads))
    }

    /// Takes a row, which is a sample, or determines the end of the sample before it.
    fn advance(&mut self, reads: Reads) -> Result<(), IoError> {
        let nominal = self.nominal.expect("the nominal interval is known by now");
        let before = self.before.replace(reads);
        let Some(before) = before else {
            return match self.stamp {
                Stamp::Start => Ok(()),
                Stamp::End | Stamp::Middle => {
                    self.sample(reads, (reads.time, nominal, reads.table))
                }
            };
        };
        let mut step = reads.time - before.time;
        if step <= 0.0 {
            let problem = LogProblem::TimeNotIncreasing { before: before.time, now: reads.time };
            return Err(self.refused(reads.line, problem));
        }
        let rounding = 4.0 * f64::EPSILON * before.time.abs().max(reads.time.abs());
        if self.is_stated && (step - nominal).abs() <= rounding {
            step = nominal;
        }
        let of = match self.stamp {
            Stamp::Start => Reads { line: reads.line, time: before.time, ..before },
            Stamp::End | Stamp::Middle => reads,
        };
        let table = if self.is_angle { reads.table } else { of.table };
        self.sample(of, (reads.time, step, table))
    }

    /// Appends a sample with these readings, whose interval ends at a time after this step from the row before.
    fn sample(&mut self, of: Reads, (end, step, table): (f64, f64, f64)) -> Result<(), IoError> {
        let nominal = self.nominal.expect("the nominal interval is known by now");
        let is_gap = step > GAP * nominal;
        let is_long = step > LogPolicy::default().largest_gap.max(GAP * nominal);
        let is_increment = |triad: &Triad| matches!(triad.spec.reading, Reading::Increment(_));
        let increments = [&self.gyro, &self.accel].map(is_increment);
        if is_gap && self.gaps.is_none() && increments.contains(&true) {
            let problem = LogProblem::LostIncrements { length: step, after: end - step };
            return Err(self.refused(of.line, problem));
        }
        let accumulates = is_gap && self.gaps == Some(Gaps::Accumulated);
        let interval = if is_long && !accumulates { nominal } else { step };
        let [angle, velocity] = [(of.gyro, increments[0]), (of.accel, increments[1])].map(
            |(value, is_increment)| match (is_increment, accumulates) {
                (false, _) => value * interval,
                (true, false) if is_gap => value * (interval / nominal),
                (true, _) => value,
            },
        );
        self.ready.times.push(end);
        self.ready.increments.push(Increments {
            angle: InFrame::from_components(angle),
            velocity: InFrame::from_components(velocity),
            interval,
        });
        let list =
            if self.is_angle { &mut self.ready.table_angle } else { &mut self.ready.table_rate };
        list.get_or_insert_default().push(table);
        Ok(())
    }
}

impl Triad {
    /// The readings along the sensors' axes in SI units.
    fn read(&self, numbers: &[f64]) -> Vector3<f64> {
        let (Reading::Rate(factor) | Reading::Increment(factor)) = self.spec.reading;
        Vector3::from_fn(|axis, _| {
            let number = numbers[self.places[axis]];
            (number - self.spec.offset[axis]) * self.spec.scale[axis] * factor
        })
    }
}
