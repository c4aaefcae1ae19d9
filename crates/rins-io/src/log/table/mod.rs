//! Columns of numbers, selected by name or number from a log of any format.

mod columns;
mod doubles;
mod head;
mod mat;
mod memory;
mod novatel;
mod parquet;
mod rows;
mod text;
mod typed;

use std::io::Read as _;
use std::path::Path;

pub(crate) use self::columns::MOST_COLUMNS;
pub(super) use self::columns::{Columns, MOST_ROWS, Wanted, WantedTime};
use self::text::Header;
pub(super) use self::text::read_rows;
pub(crate) use head::Head;
pub use head::{LogHead, peek};
pub use memory::LogColumns;
pub(crate) use novatel::RawImu;
pub(super) use rows::RowLines;
pub use typed::Numbers;
pub(crate) use typed::most_rows;

use super::container::{MATLAB, PARQUET};
use super::problem::LogProblem;
use crate::error::{IoError, LogError};
use crate::rig::{Table, TextForm};
use crate::source;

/// All columns of numbers of a binary file.
pub(crate) struct BinaryColumns {
    /// The format, as a rig file names it.
    pub(crate) format: &'static str,
    pub(crate) names: Vec<String>,
    /// The numbers of each column.
    pub(crate) numbers: Vec<Vec<f64>>,
}

/// All columns of numbers of the Parquet or MATLAB file at `path`, with their names; none of a file of another format.
///
/// # Errors
/// As [`read`].
pub(crate) fn all(path: &Path) -> Result<Option<BinaryColumns>, IoError> {
    let mut beginning = [0; 20];
    let mut file = source::open(path).map_err(IoError::file("read", path))?;
    let length = file.read(&mut beginning).map_err(IoError::file("read", path))?;
    let (format, table, names) = match &beginning[..length] {
        bytes if bytes.starts_with(PARQUET) => ("parquet", Table::Parquet, parquet::names(path)?),
        bytes if bytes.starts_with(MATLAB) => ("mat", Table::Mat, mat::names(path)?),
        _ => return Ok(None),
    };
    let asked: Vec<&str> = names.iter().map(String::as_str).collect();
    let columns = read(
        path,
        table,
        Wanted { names: &asked, time: None, rows: None, sparse: None, text: TextForm::default() },
    )?;
    Ok(Some(BinaryColumns { format, names, numbers: columns.numbers }))
}

/// The maximum time of any clock \[s\]: 300 centuries.
const LATEST: f64 = 1e12;

/// Takes the `wanted` columns of a log in memory.
///
/// # Errors
/// As [`read`], except that no file is read.
pub(super) fn take(log: LogColumns, wanted: Wanted<'_>) -> Result<Columns, IoError> {
    let (path, time) = (log.path.clone(), wanted.time.as_ref().map(|time| time.column));
    let columns = memory::take(log, wanted)?;
    ensure_reasonable(&path, time, columns)
}

/// Reads the `wanted` columns from the log at `path`, whose format is `table`.
///
/// # Errors
/// [`IoError::File`] if it cannot be read, [`IoError::Log`] if it does not have this format, if
/// a column does not exist, or if one contains anything but finite numbers.
pub(super) fn read(path: &Path, table: Table, wanted: Wanted<'_>) -> Result<Columns, IoError> {
    let time = wanted.time.as_ref().map(|time| time.column);
    let columns = match table {
        Table::Text => text::read(path, Header::Allowed, wanted),
        Table::Numbers => text::read(path, Header::Refused, wanted),
        Table::Parquet => parquet::read(path, wanted),
        Table::Mat => mat::read(path, wanted),
        Table::Doubles(count) => doubles::read(path, count, wanted),
        Table::NovAtel => novatel::read(path, wanted),
    }?;
    ensure_reasonable(path, time, columns)
}

/// The columns, unless their time is later than any clock.
fn ensure_reasonable(
    path: &Path,
    time: Option<&str>,
    columns: Columns,
) -> Result<Columns, IoError> {
    if let Some(row) = columns.time.iter().position(|time| time.abs() > LATEST) {
        let (column, value) = (time.unwrap_or_default().into(), columns.time[row]);
        let problem = LogProblem::BeyondReason { column, value, unit: "s" };
        return Err(LogError::at(path, columns.lines.of(row), problem));
    }
    Ok(columns)
}
