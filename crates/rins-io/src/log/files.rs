//! The files of a run, with the requested columns of each.

use std::mem;
use std::path::{Path, PathBuf};

use super::clock::{Clock, Stamps};
use super::damage::leave_out_of_all;
use super::even::undo_rounding;
use super::instant::Instants;
use super::overflow::{Overflow, continued};
use super::problem::LogProblem;
use super::summary::{LeftOut, LogPolicy, Rounded};
use super::table::{self, Columns, LogColumns, Wanted, WantedTime};
use crate::error::{IoError, LogError};
use crate::rig::{
    ColumnSpec, OwnClock, Reading, Rig, RowFilter, Stamp, Table, TextForm, TimeUnit, TriadColumns,
};
use crate::shown::shown;

/// The maximum difference between the times of two files, in intervals.
const TOGETHER_WITHIN: f64 = 0.1;

/// The minimum number of samples from which a constant channel counts as stuck.
const ENOUGH_TO_BE_STUCK: usize = 10;

/// The maximum plausible reading of any sensor, in SI units or radians: squares and sums of smaller numbers are
/// finite, and an angle is still resolved to a tenth of an arcsecond.
pub(super) const BEYOND_REASON: f64 = 1e9;

/// The plausible temperatures \[°C\].
const TEMPERATURES: std::ops::RangeInclusive<f64> = -273.15..=2000.0;

/// The files of a run.
pub(super) struct Files {
    /// Files that were sampled together, the gyros' first.
    together: Vec<OneFile>,
    /// The file of accelerometers with a clock of their own.
    accel: Option<OneFile>,
    pub(super) instants: Option<Instants>,
    /// The rounding that was removed from the stamps of the gyros' file.
    pub(super) rounded: Option<Rounded>,
    /// The overflows of the time column of the gyros' file.
    pub(super) overflows: Vec<Overflow>,
}

/// One file with its requested columns.
pub(super) struct OneFile {
    pub(super) path: PathBuf,
    asked: Asked,
    pub(super) columns: Columns,
}

/// The requested columns of a file, with the number of requests of each.
#[derive(Default)]
struct Asked {
    names: Vec<String>,
    times: Vec<usize>,
}

impl Asked {
    fn add(&mut self, name: &str) {
        match self.names.iter().position(|known| known == name) {
            Some(place) => self.times[place] += 1,
            None => {
                self.names.push(name.into());
                self.times.push(1);
            }
        }
    }

    fn of<'n>(names: impl IntoIterator<Item = &'n String>) -> Self {
        let mut asked = Self::default();
        names.into_iter().for_each(|name| asked.add(name));
        asked
    }

    fn place(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    fn names(&self) -> Vec<&str> {
        self.names.iter().map(String::as_str).collect()
    }
}

/// A triad's values along its three axes, one list for each axis.
pub(super) type TriadValues = [Vec<f64>; 3];

impl OneFile {
    /// The lines that are not samples.
    pub(super) fn left_out(&self) -> impl Iterator<Item = LeftOut> {
        let named = |&(line, reason): &_| LeftOut { path: self.path.clone(), line, reason };
        self.columns.left_out.iter().map(named)
    }

    /// The time information in its rows.
    pub(super) fn stamps(&self, stamp: Stamp, nominal: Option<f64>) -> Stamps<'_> {
        let Columns { lines, damaged, .. } = &self.columns;
        Stamps { path: &self.path, lines, damaged, stamp, nominal }
    }

    /// The file at `path`, of which one column was requested.
    pub(super) fn of_column(path: &Path, name: &String, columns: Columns) -> Self {
        Self { path: path.into(), asked: Asked::of([name]), columns }
    }

    /// Refuses times that do not increase.
    pub(super) fn ensure_increasing(&self) -> Result<(), IoError> {
        let times = &self.columns.time;
        let Some(row) = times.windows(2).position(|pair| pair[1] <= pair[0]) else { return Ok(()) };
        let problem = LogProblem::TimeNotIncreasing { before: times[row], now: times[row + 1] };
        Err(LogError::at(&self.path, self.columns.lines.of(row + 1), problem))
    }

    fn place(&self, name: &str) -> usize {
        let place = self.asked.place(name);
        place.expect("every column in use was asked for")
    }

    fn numbers(&self, name: &str) -> &[f64] {
        &self.columns.numbers[self.place(name)]
    }

    /// The numbers of a column, converted by `read`, without a copy at the last request.
    fn take(&mut self, name: &str, read: impl Fn(f64) -> f64) -> Vec<f64> {
        let place = self.place(name);
        let (left, numbers) = (&mut self.asked.times[place], &mut self.columns.numbers[place]);
        *left = left.saturating_sub(1);
        let mut taken = if *left == 0 { mem::take(numbers) } else { numbers.clone() };
        for number in &mut taken {
            *number = read(*number);
        }
        taken
    }

    /// The numbers of a column whose unit is `factor` times an SI `unit`; not a number without a reading, if that is allowed.
    pub(super) fn column(
        &mut self,
        name: &str,
        factor: f64,
        unit: &'static str,
    ) -> Result<Vec<f64>, IoError> {
        let read = |number| number * factor;
        let plausible = |value: f64| value.is_nan() || value.abs() <= BEYOND_REASON;
        self.refuse_unless(name, unit, read, plausible)?;
        Ok(self.take(name, read))
    }

    /// The temperatures \[°C\] of a column with numbers that are lower by `offset`.
    pub(super) fn temperatures(&mut self, name: &str, offset: f64) -> Result<Vec<f64>, IoError> {
        let read = |number| number + offset;
        self.refuse_unless(name, "degC", read, |value| TEMPERATURES.contains(&value))?;
        Ok(self.take(name, read))
    }

    fn refuse_unless(
        &self,
        name: &str,
        unit: &'static str,
        read: impl Fn(f64) -> f64,
        reasonable: impl Fn(f64) -> bool,
    ) -> Result<(), IoError> {
        let mut values = self.numbers(name).iter().map(|number| read(*number)).enumerate();
        match values.find(|(_, value)| !reasonable(*value)) {
            None => Ok(()),
            Some((row, value)) => {
                let problem = LogProblem::BeyondReason { column: name.into(), value, unit };
                Err(LogError::at(&self.path, self.columns.lines.of(row), problem))
            }
        }
    }
}

impl Files {
    pub(super) fn read(
        rig: &Rig,
        spec: &ColumnSpec,
        mut memory: Option<LogColumns>,
    ) -> Result<Self, IoError> {
        let mut wanted: Vec<(&Path, Asked)> = vec![(&spec.gyro.path, Asked::default())];
        let mut want = |path, name: &String| {
            let known = wanted.iter().position(|(known, _)| *known == path);
            let place = known.unwrap_or_else(|| {
                wanted.push((path, Asked::default()));
                wanted.len() - 1
            });
            wanted[place].1.add(name);
        };
        let together = spec.accel_clock.is_none();
        for triad in std::iter::once(&spec.gyro).chain(Some(&spec.accel).filter(|_| together)) {
            triad.names().for_each(|name| want(&triad.path, name));
        }
        let log = rig.log.path.as_path();
        let in_log = spec.table_angle.iter().filter(|angle| angle.file.is_none());
        in_log.for_each(|angle| want(log, &angle.column));
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
        let mut rounded = None;
        let mut overflows = Vec::new();
        for (path, asked) in wanted {
            let rows = spec.gyro.rows.as_ref().filter(|_| path == spec.gyro.path);
            let time = spec.time.as_ref().zip(instants.as_mut());
            let time = time.map(|(time, instants)| WantedTime::of(time, instants));
            let angle =
                spec.table_angle.as_ref().filter(|angle| angle.file.is_none() && path == log);
            let sparse = angle.map(|angle| angle.column.as_str());
            let wanted = Wanted { names: &asked.names(), time, rows, sparse, text: spec.text };
            let mut columns = match memory.take_if(|memory| memory.path == path) {
                Some(memory) => table::take(memory, wanted)?,
                None => table::read(path, spec.table, wanted)?,
            };
            let all_six = together && spec.gyro.path == spec.accel.path && rig.log.is_complete();
            if all_six && path == spec.gyro.path {
                let names = spec.gyro.names().chain(spec.accel.names());
                let places = names.filter_map(|name| asked.place(name));
                columns.leave_out_zeros(&places.collect::<Vec<_>>());
            }
            // The sum of two columns does not overflow.
            if let Some(time) = spec.time.as_ref().filter(|time| time.split.is_none()) {
                let continued = continued(&mut columns.time, time.unit.seconds());
                if files.is_empty() {
                    overflows = continued;
                }
            }
            if let Some(time) = spec.time.as_ref().filter(|time| time.unit == TimeUnit::Samples) {
                let interval = rig.log.rate.map_or(1.0, |rate| 1.0 / rate);
                count(path, &time.column, &mut columns, interval)?;
            }
            if spec.time.as_ref().is_some_and(|time| time.unit != TimeUnit::Samples) {
                let undone = undo_rounding(&mut columns.time, rig.log.rate.map(f64::recip));
                if files.is_empty() {
                    rounded = undone;
                }
            }
            files.push(OneFile { path: path.into(), asked, columns });
        }
        leave_out_of_all(&mut files.iter_mut().map(|file| &mut file.columns).collect::<Vec<_>>());
        let accel = spec.accel_clock.as_ref().map(|clock| {
            let file = (spec.accel.path.as_path(), spec.table, spec.text);
            let names: Vec<String> = spec.accel.names().cloned().collect();
            let rows = spec.accel.rows.as_ref();
            own_file(file, (&names, rows), clock, instants)
        });
        Ok(Self { together: files, instants, accel: accel.transpose()?, rounded, overflows })
    }

    /// The lines of all files that are not samples.
    pub(super) fn left_out(&self) -> Vec<LeftOut> {
        self.together.iter().chain(&self.accel).flat_map(OneFile::left_out).collect()
    }

    pub(super) fn main(&self) -> &OneFile {
        &self.together[0]
    }

    /// The times of the rows \[s\], which can be taken once; `None` for a log without a time column.
    pub(super) fn take_times(&mut self) -> Vec<f64> {
        mem::take(&mut self.together[0].columns.time)
    }

    pub(super) fn file(&mut self, path: &Path) -> &mut OneFile {
        let found = self.together.iter_mut().find(|file| file.path == path);
        found.expect("every file in use was read")
    }

    /// Refuses files that were not sampled together with the gyros' file.
    pub(super) fn compare(&self, interval: f64) -> Result<(), IoError> {
        let (main, others) = (self.main(), &self.together[1..]);
        for file in others {
            let other = || shown(&main.path);
            let (samples, expected) = (file.columns.lines.len(), main.columns.lines.len());
            if samples != expected {
                let problem = LogProblem::UnequalLength { samples, other: other(), expected };
                return Err(LogError::of(&file.path, problem));
            }
            let pairs = file.columns.time.iter().zip(&main.columns.time);
            for (row, (&time, &expected)) in pairs.enumerate() {
                if (time - expected).abs() > TOGETHER_WITHIN * interval {
                    let problem = LogProblem::UnequalTimes { time, other: other(), expected };
                    return Err(LogError::at(&file.path, file.columns.lines.of(row), problem));
                }
            }
        }
        Ok(())
    }

    /// The gyros' values, after a check for stuck channels.
    pub(super) fn gyro(&mut self, spec: &ColumnSpec) -> Result<TriadValues, IoError> {
        self.file(&spec.gyro.path).triad(&spec.gyro, "gyro")
    }

    /// The accelerometers' values.
    pub(super) fn accel(&mut self, spec: &ColumnSpec) -> Result<TriadValues, IoError> {
        let file = match &mut self.accel {
            Some(own) => own,
            None => self.file(&spec.accel.path),
        };
        file.triad(&spec.accel, "accel")
    }

    /// The intervals of accelerometers with a clock of their own, in the gyros' time.
    pub(super) fn accel_clock(
        &self,
        spec: &ColumnSpec,
        gyro: &Clock,
        policy: LogPolicy,
    ) -> Result<Option<Clock>, IoError> {
        let (Some(own), Some(file)) = (&spec.accel_clock, &self.accel) else { return Ok(None) };
        let stamps = file.stamps(own.time.stamp, None);
        // A gap is equally long in both, whatever their sampling rates.
        let largest_gap = policy.largest_gap.max(gyro.summary.nominal_interval);
        stamps.timed(&file.columns.time, LogPolicy { largest_gap, ..policy }).map(Some)
    }
}

/// Reads columns of a file with its own clock, with its time stamps in the time of the gyros.
pub(super) fn own_file(
    (path, table, text): (&Path, Table, TextForm),
    (columns, rows): (&[String], Option<&RowFilter>),
    clock: &OwnClock,
    gyro: Option<Instants>,
) -> Result<OneFile, IoError> {
    let mut instants = Instants::new(clock.time.unit.seconds().unwrap_or(1.0));
    let asked = Asked::of(columns);
    let time = Some(WantedTime::of(&clock.time, &mut instants));
    let wanted = Wanted { names: &asked.names(), time, rows, sparse: None, text };
    let mut columns = table::read(path, table, wanted)?;
    if clock.time.split.is_none() {
        let _overflows = continued(&mut columns.time, clock.time.unit.seconds());
    }
    let _rounded = undo_rounding(&mut columns.time, None);
    let shift = instants.origin() - gyro.map_or(0.0, |gyro| gyro.origin()) - clock.offset;
    if shift != 0.0 {
        for time in &mut columns.time {
            *time += shift;
        }
    }
    Ok(OneFile { path: path.into(), asked, columns })
}

impl OneFile {
    /// A triad's values in SI units along the sensors' axes, after a check for stuck channels.
    fn triad(&mut self, spec: &TriadColumns, sensor: &str) -> Result<TriadValues, IoError> {
        let (Reading::Rate(factor) | Reading::Increment(factor)) = spec.reading;
        let unit = match (sensor, spec.reading) {
            ("gyro", Reading::Rate(_)) => "rad/s",
            ("gyro", Reading::Increment(_)) => "rad",
            (_, Reading::Rate(_)) => "m/s^2",
            (_, Reading::Increment(_)) => "m/s",
        };
        let read = |axis: usize| {
            let (offset, scale) = (spec.offset[axis], spec.scale[axis]);
            move |number: f64| (number - offset) * scale * factor
        };
        let mut stuck = Vec::new();
        for (axis, name) in spec.columns.iter().enumerate() {
            let Some(name) = name else { continue };
            let numbers = self.numbers(name);
            let first = numbers[0];
            let moves = numbers.iter().any(|n| n - first != 0.0);
            if numbers.len() >= ENOUGH_TO_BE_STUCK && !moves {
                let channel = format!("{sensor} {} ({name:?})", ["x", "y", "z"][axis]);
                stuck.push((channel, first));
            }
            self.refuse_unless(name, unit, read(axis), |value| value.abs() <= BEYOND_REASON)?;
        }
        // At rest a coarse accelerometer may give a constant number, but not all three zero.
        let dead = sensor == "gyro" || stuck.len() == 3 && stuck.iter().all(|(_, n)| *n == 0.0);
        match stuck.into_iter().next().filter(|_| dead) {
            Some((channel, value)) => {
                Err(LogError::of(&self.path, LogProblem::Stuck { channel, value }))
            }
            None => Ok([0, 1, 2].map(|axis| match &spec.columns[axis] {
                Some(name) => self.take(name, read(axis)),
                None => vec![0.0; self.columns.lines.len()],
            })),
        }
    }
}

/// Converts a sample counter to seconds.
fn count(path: &Path, name: &str, columns: &mut Columns, interval: f64) -> Result<(), IoError> {
    for (row, time) in columns.time.iter_mut().enumerate() {
        if time.fract() != 0.0 {
            let problem = LogProblem::PartOfASample { column: name.into(), count: *time };
            return Err(LogError::at(path, columns.lines.of(row), problem));
        }
        *time *= interval;
    }
    Ok(())
}
