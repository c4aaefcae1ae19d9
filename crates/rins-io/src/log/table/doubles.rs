//! Consecutive rows of little-endian doubles without a header.

use std::io::{BufReader, Read};
use std::path::Path;

use super::columns::{Columns, MOST_ROWS, Repeated, Wanted, WantedTime};
use super::typed;
use crate::error::{IoError, LogError};
use crate::log::problem::LogProblem;
use crate::source;

/// Reads columns, named by their numbers from "1", of the file at `path` whose rows have `count`
/// doubles.
pub(super) fn read(path: &Path, count: usize, wanted: Wanted<'_>) -> Result<Columns, IoError> {
    let failed = || IoError::file("read", path);
    let mut reader = BufReader::with_capacity(1 << 16, source::open(path).map_err(failed())?);
    let Wanted { names, time, .. } = wanted;
    let present: Vec<String> = (1..=count).map(|place| place.to_string()).collect();
    let place = |name: &str| {
        super::columns::place(name, &present).map_err(|problem| LogError::of(path, problem))
    };
    let places = names.iter().map(|name| place(name)).collect::<Result<Vec<_>, _>>()?;
    // The format has one time column.
    let time_place = time.as_ref().map(|time| place(time.column)).transpose()?;
    let mut numbers = vec![Vec::new(); names.len()];
    let mut stamps = Vec::new();
    let mut row = vec![0; count * size_of::<f64>()];
    let mut before = Vec::new();
    let mut repeated = Repeated::default();
    let mut rows = 0_u64;
    while fill(&mut reader, &mut row)
        .map_err(failed())?
        .ok_or_else(|| LogError::at(path, rows + 1, LogProblem::PartOfARow { bytes: row.len() }))?
    {
        let number = |place: usize| {
            let bytes = row[place * 8..][..8].try_into().expect("a double has eight bytes");
            f64::from_le_bytes(bytes)
        };
        for (list, place) in numbers.iter_mut().zip(&places) {
            list.push(number(*place));
        }
        stamps.extend(time_place.map(number));
        rows += 1;
        repeated
            .count(rows, row == before)
            .map_err(|(row, problem)| LogError::at(path, row, problem))?;
        before.clone_from(&row);
        if rows > MOST_ROWS {
            return Err(LogError::of(path, LogProblem::ManyRows { most: MOST_ROWS }));
        }
    }
    if rows == 0 {
        return Err(LogError::of(path, LogProblem::Empty));
    }
    let time = time.map(|WantedTime { column, instants, .. }| {
        (column, stamps.into_iter().map(|stamp| instants.of_number(stamp)).collect())
    });
    typed::together(path, names, numbers, time)
}

/// Fills `row`: true on success, false at the end, `None` if only a part of a row is left.
fn fill(reader: &mut impl Read, row: &mut [u8]) -> std::io::Result<Option<bool>> {
    let mut filled = 0;
    while filled < row.len() {
        match reader.read(&mut row[filled..]) {
            Ok(0) if filled == 0 => return Ok(Some(false)),
            Ok(0) => return Ok(None),
            Ok(read) => filled += read,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(Some(true))
}
