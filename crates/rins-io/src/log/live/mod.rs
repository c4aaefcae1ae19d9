//! A log that is read while it is written.

mod rows;

use std::io::Cursor;
use std::mem;
use std::path::{Path, PathBuf};

use rins_motion::Recording;

use self::rows::{Row, Samples};
use super::instant::Instants;
use super::lines::Lines;
use super::problem::LogProblem;
use super::table::{Head, Wanted, WantedTime, read_rows};
use crate::error::{IoError, KeyError, KeyProblem, LogError};
use crate::rig::{ColumnSpec, LogFormat, Rig, Stamp, Table, TimeUnit};

/// The number of lines from which the columns are recognized, and the number after which a log whose columns are not recognized is
/// refused: that of the longest preamble with some rows.
const HEAD: (u64, u64) = (5, 210);

/// The maximum length of a line \[bytes\].
const LONGEST: usize = 1 << 20;

/// A log of text that is read while it is written: bytes in, samples out.
///
/// A row becomes a sample when its line ends. Columns, units, axes, and the treatment of gaps are those of
/// [`read_log`](crate::read_log()). What needs the finished log is not done: rounded stamps of an even clock stay rounded unless `[log] rate`
/// states the interval, and repeated samples stay. After a gap of more than a second the motion is unknown: the next sample has the
/// nominal interval.
///
/// A row that cannot be read is an error with its line; the samples before it are returned first.
#[derive(Debug)]
pub struct LiveLog {
    rig: Rig,
    columns: ColumnSpec,
    names: Vec<String>,
    /// The name of the source in messages.
    source: PathBuf,
    buffer: Vec<u8>,
    /// The number of lines read.
    line: u64,
    head: Option<Head>,
    /// The row before: some loggers write a sample twice.
    before: String,
    instants: Option<Instants>,
    samples: Samples,
    failed: Option<IoError>,
}

impl LiveLog {
    /// The log of a rig file, before its first line; `source` names it in messages.
    ///
    /// # Errors
    /// [`IoError::Key`] if the log is not one file of text in which every row has the readings of six sensors and of the table, or
    /// if a latency or a stamp in the middle of the interval is stated.
    pub fn new(rig: Rig, source: &Path) -> Result<Self, IoError> {
        let refuse = |key: &str, reason: &str| {
            let problem = KeyProblem::Conflict { reason: format!("a live log {reason}") };
            let key = format!("[log] {key}");
            Err(Box::new(KeyError { path: rig.path.clone(), line: None, key, problem }).into())
        };
        if !rig.log.is_complete() {
            return Err(rig.lacks_sensors());
        }
        let LogFormat::Columns(columns) = &rig.log.format else {
            return refuse("format", "has columns of text, not PSINS text");
        };
        if !matches!(columns.table, Table::Text | Table::Numbers) {
            return refuse("format", "has columns of text");
        }
        if columns.accel.path != columns.gyro.path || columns.accel_clock.is_some() {
            return refuse("accel", "has gyros and accelerometers in one file");
        }
        match (&columns.table_angle, &columns.table_rate) {
            (Some(angle), _) if angle.file.is_some() => {
                return refuse(
                    "table_angle",
                    "has the table angle in every row, not in another file",
                );
            }
            (Some(angle), _) if angle.latency.is_some_and(|latency| latency != 0.0) => {
                return refuse("table_angle", "has a table angle without latency");
            }
            (None, None) => return refuse("table_angle", "has a column table_angle or table_rate"),
            _ => {}
        }
        match &columns.time {
            Some(time) if time.stamp == Stamp::Middle => {
                return refuse("time", "has stamps of the start or the end of an interval");
            }
            None if rig.log.rate.is_none() => return refuse("time", "has a time column or a rate"),
            _ => {}
        }
        if rig.log.window.is_some() {
            return refuse("window", "is read as a whole");
        }
        let columns = (**columns).clone();
        let mut names: Vec<String> = Vec::new();
        let angle = columns.table_angle.as_ref().map(|angle| &angle.column);
        let rate = columns.table_rate.as_ref().map(|rate| &rate.column);
        let table = angle.or(rate);
        for name in columns.gyro.names().chain(columns.accel.names()).chain(table) {
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
        let unit = columns.time.as_ref().map(|time| time.unit.seconds().unwrap_or(1.0));
        Ok(Self {
            samples: Samples::of(&rig, &columns, &names, source),
            instants: unit.map(Instants::new),
            source: source.into(),
            buffer: Vec::new(),
            line: 0,
            head: None,
            before: String::new(),
            failed: None,
            rig,
            columns,
            names,
        })
    }

    /// Takes the next bytes, and returns the samples that they complete.
    ///
    /// # Errors
    /// [`IoError::Log`] if a row cannot be read.
    pub fn feed(&mut self, bytes: &[u8]) -> Result<Recording, IoError> {
        self.buffer.extend_from_slice(bytes);
        self.take(false)
    }

    /// The samples of the last rows, at the end of the log. A last line without a line end is left out: it may be cut.
    ///
    /// # Errors
    /// [`IoError::Log`] if a row cannot be read, or if there is no row.
    pub fn end(&mut self) -> Result<Recording, IoError> {
        self.take(true)
    }

    fn take(&mut self, is_end: bool) -> Result<Recording, IoError> {
        if let Some(failed) = self.failed.take() {
            return Err(failed);
        }
        let complete = self.buffer.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        if self.buffer.len() - complete > LONGEST {
            let most = LONGEST as u64;
            return Err(LogError::at(&self.source, self.line + 1, LogProblem::LongLine { most }));
        }
        if self.head.is_none() {
            self.begin(complete, is_end)?;
        } else {
            let rest = self.buffer.split_off(complete);
            let bytes = mem::replace(&mut self.buffer, rest);
            let mut lines = Lines::after(Cursor::new(&bytes[..]), &self.source, self.line);
            let (rows, failed) = remaining(&mut lines);
            self.line = lines.number();
            self.process(rows);
            self.failed = self.failed.take().or(failed);
        }
        if is_end && self.failed.is_none() {
            self.failed = self.samples.end().err();
        }
        let samples = self.samples.take();
        match self.failed.take() {
            Some(failed) if samples.is_empty() => Err(failed),
            failed => {
                self.failed = failed;
                Ok(samples)
            }
        }
    }

    /// Recognizes the columns in the first lines, and processes the rows in them.
    fn begin(&mut self, complete: usize, is_end: bool) -> Result<(), IoError> {
        let bytes = self.buffer[..complete].to_vec();
        let count = bytes.split(|byte| *byte == b'\n').count() as u64 - 1;
        let skip = self.columns.text.skip.unwrap_or_default();
        if count < HEAD.0 + skip && !is_end {
            return Ok(());
        }
        let mut lines = Lines::new(Cursor::new(&bytes[..]), &self.source);
        let head = Head::read(&mut lines, self.columns.text).and_then(|head| {
            // Lines above the header may look like a header until the rows are there.
            let mut instants = self.instants;
            let first: Vec<(u64, String)> = head.rows.iter().take(1).cloned().collect();
            let (_, failed) = self.read(&head, &mut instants, &first)?;
            failed.map_or(Ok(head), Err)
        });
        let head = match head {
            Ok(head) => head,
            Err(_) if !is_end && count < HEAD.1 + skip => return Ok(()),
            Err(error) => return Err(error),
        };
        let (rest, failed) = remaining(&mut lines);
        self.line = lines.number();
        let rows = head.rows.iter().cloned().chain(rest).collect();
        self.head = Some(head);
        self.buffer.drain(..complete);
        self.process(rows);
        self.failed = self.failed.take().or(failed);
        Ok(())
    }

    /// The numbers of some rows, and the error of the first that cannot be read.
    fn read(
        &self,
        head: &Head,
        instants: &mut Option<Instants>,
        lines: &[(u64, String)],
    ) -> Result<(super::table::Columns, Option<IoError>), IoError> {
        let names: Vec<&str> = self.names.iter().map(String::as_str).collect();
        let time = self.columns.time.as_ref().zip(instants.as_mut());
        let time = time.map(|(time, instants)| WantedTime::of(time, instants));
        let rows = self.columns.gyro.rows.as_ref();
        let wanted = Wanted { names: &names, time, rows, sparse: None, text: self.columns.text };
        read_rows(head, &self.source, wanted, lines)
    }

    /// Converts rows to samples, up to the first that cannot be read.
    fn process(&mut self, mut lines: Vec<(u64, String)>) {
        if self.columns.time.is_some() {
            lines.retain(|(_, line)| {
                let is_new = *line != self.before;
                self.before.clone_from(line);
                is_new
            });
        }
        let Some(head) = self.head.take() else { return };
        let mut instants = self.instants;
        let read = self.read(&head, &mut instants, &lines);
        (self.head, self.instants) = (Some(head), instants);
        match read {
            Err(error) => self.failed = Some(error),
            Ok((columns, failed)) => {
                let is_counter =
                    self.columns.time.as_ref().is_some_and(|time| time.unit == TimeUnit::Samples);
                let rows = (0..columns.lines.len()).map(|row| Row {
                    line: columns.lines.of(row),
                    time: columns.time.get(row).copied(),
                    numbers: columns.numbers.iter().map(|list| list[row]).collect(),
                });
                for row in rows {
                    if let Err(error) = self.samples.push(&row, is_counter) {
                        self.failed = Some(error);
                        return;
                    }
                }
                self.failed = failed;
            }
        }
    }

    /// The nominal interval of a sample \[s\], if it is known yet.
    pub fn nominal_interval(&self) -> Option<f64> {
        self.samples.nominal
    }

    /// The number of lines read.
    pub const fn line(&self) -> u64 {
        self.line
    }

    /// The rig.
    pub const fn rig(&self) -> &Rig {
        &self.rig
    }
}

/// The remaining complete lines, up to the first that is not text.
fn remaining(lines: &mut Lines<Cursor<&[u8]>>) -> (Vec<(u64, String)>, Option<IoError>) {
    let mut all = Vec::new();
    loop {
        match lines.next() {
            Ok(Some((number, line))) => all.push((number, line.to_string())),
            Ok(None) => return (all, None),
            Err(error) => return (all, Some(error)),
        }
    }
}
