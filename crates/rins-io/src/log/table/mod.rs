//! Columns of numbers, picked by name or number from a log of any format.

mod doubles;
mod mat;
mod novatel;
mod parquet;
mod rows;
mod text;
mod typed;

use std::path::Path;

use self::text::Header;
pub(super) use rows::RowLines;
pub(crate) use text::Head;
pub use text::{LogHead, peek};
pub(crate) use typed::most_rows;

use super::instant::Instants;
use super::problem::LogProblem;
use super::summary::Omission;
use crate::error::{IoError, LogError};
use crate::rig::Table;
use crate::section::quoted;
use crate::suggestion::nearest;

/// The most columns that are read.
pub(crate) const MOST_COLUMNS: usize = 4096;

/// The most rows that are read: 93 hours at 200 Hz, which fill some ten gigabytes of memory.
pub(super) const MOST_ROWS: u64 = 1 << 26;

/// A row that is repeated so often in a row is no sample that a logger wrote twice.
const MOST_REPEATED: u64 = 1 << 20;

/// No clock shows more seconds than this: 300 centuries.
const LATEST: f64 = 1e12;

/// The most columns that an error lists.
const MOST_LISTED: usize = 30;

/// How much of a column's name an error shows.
const LONGEST_LISTED: usize = 60;

/// The numbers of some columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Columns {
    /// The time stamps \[s\], if time was asked for.
    pub(super) time: Vec<f64>,
    /// The numbers of each column that was asked for.
    pub(super) numbers: Vec<Vec<f64>>,
    /// The line of each row; its number from 1 where a log has no lines.
    pub(super) lines: RowLines,
    /// The lines that are left out.
    pub(super) left_out: Vec<(u64, Omission)>,
}

/// What of a log is asked for: columns by name, and perhaps one of time stamps.
pub(super) struct Wanted<'w> {
    pub(super) names: &'w [&'w str],
    pub(super) time: Option<(&'w str, &'w mut Instants)>,
}

/// Reads the columns that are `wanted` from the log at `path`, which is written as `table`.
///
/// # Errors
/// [`IoError::File`] if it cannot be read, [`IoError::Log`] if it is not what it is said to be, if
/// a column is not there, or if one holds anything but finite numbers.
pub(super) fn read(path: &Path, table: Table, wanted: Wanted<'_>) -> Result<Columns, IoError> {
    let time = wanted.time.as_ref().map(|(name, _)| *name);
    let columns = match table {
        Table::Text => text::read(path, Header::Allowed, wanted),
        Table::Numbers => text::read(path, Header::Refused, wanted),
        Table::Parquet => parquet::read(path, wanted),
        Table::Mat => mat::read(path, wanted),
        Table::Doubles(count) => doubles::read(path, count, wanted),
        Table::NovAtel => novatel::read(path, wanted),
    }?;
    if let Some(row) = columns.time.iter().position(|time| time.abs() > LATEST) {
        let (column, value) = (time.unwrap_or_default().into(), columns.time[row]);
        let problem = LogProblem::BeyondReason { column, value, unit: "s" };
        return Err(LogError::at(path, columns.lines.of(row), problem));
    }
    Ok(columns)
}

/// Rows that are the same as the one before.
#[derive(Clone, Copy, Debug, Default)]
struct Repeated {
    times: u64,
    /// The line of the first of them.
    from: u64,
}

impl Repeated {
    /// Counts a row.
    ///
    /// # Errors
    /// The line of the first of them, once there are more than any logger repeats.
    fn count(&mut self, line: u64, is_same: bool) -> Result<(), (u64, LogProblem)> {
        match (is_same, self.times) {
            (false, _) => self.times = 0,
            (true, 0) => (self.times, self.from) = (1, line),
            (true, times) if times > MOST_REPEATED => {
                return Err((self.from, LogProblem::SameRow { times }));
            }
            (true, times) => self.times = times + 1,
        }
        Ok(())
    }
}

/// The place of the only one of `names` that is `wanted`.
fn place(wanted: &str, names: &[String]) -> Result<usize, LogProblem> {
    let mut found = names.iter().enumerate().filter(|(_, present)| *present == wanted);
    match (found.next(), found.next()) {
        (Some((place, _)), None) => Ok(place),
        (Some(_), Some(_)) => Err(LogProblem::TwoColumns { column: wanted.into() }),
        (None, _) => Err(LogProblem::NoColumn {
            column: wanted.into(),
            suggestion: nearest(wanted, names.iter().map(String::as_str)).map(Into::into),
            present: listed(names),
        }),
    }
}

/// The columns that there are, in words.
fn listed(names: &[String]) -> String {
    let short: Vec<String> = names
        .iter()
        .take(MOST_LISTED)
        .map(|name| name.chars().take(LONGEST_LISTED).collect())
        .collect();
    let words = quoted(short.iter().map(String::as_str));
    match names.len().checked_sub(MOST_LISTED) {
        None | Some(0) => words,
        Some(more) => format!("{words} and {more} more"),
    }
}
