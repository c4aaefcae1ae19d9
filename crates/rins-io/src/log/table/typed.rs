//! Common functions for columns of logs with binary numbers.

use std::path::Path;

use super::columns::{Columns, MOST_ROWS, WantedTime};
use crate::error::{IoError, LogError};
use crate::log::damage::Damage;
use crate::log::instant::Instants;
use crate::log::problem::LogProblem;
use crate::log::split_time;
use crate::log::summary::Omission;

/// The number of rows that any file may have, however small it is.
const ALWAYS_ROWS: u64 = 1 << 20;

/// The maximum number of rows of a file of this length \[bytes\].
///
/// In a compressed format, a few bytes can stand for billions of rows; the seven numbers of a sample of a working
/// sensor occupy at least one byte.
pub(crate) fn most_rows(length: u64) -> u64 {
    length.clamp(ALWAYS_ROWS, MOST_ROWS)
}

/// The numbers of a column in their own representation.
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// Floating-point numbers.
    Real(Vec<f64>),
    /// Integers, such as nanoseconds since 1970, which have no exact `f64`.
    Whole(Vec<i64>),
}

impl Numbers {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Real(numbers) => numbers.len(),
            Self::Whole(numbers) => numbers.len(),
        }
    }

    /// The numbers as doubles.
    pub(super) fn plain(self) -> Vec<f64> {
        match self {
            Self::Real(numbers) => numbers,
            Self::Whole(numbers) => numbers.into_iter().map(|number| number as f64).collect(),
        }
    }

    fn text(&self, row: usize) -> String {
        match self {
            Self::Real(numbers) => numbers[row].to_string(),
            Self::Whole(numbers) => numbers[row].to_string(),
        }
    }

    /// The numbers as time stamps \[s\].
    fn stamps(self, instants: &mut Instants) -> Vec<f64> {
        match self {
            Self::Real(numbers) => {
                numbers.into_iter().map(|number| instants.of_number(number)).collect()
            }
            Self::Whole(numbers) => {
                numbers.into_iter().map(|number| instants.of_integer(number)).collect()
            }
        }
    }
}

/// The name and the time stamps \[s\] of a time, whose column or columns are the last of `lists`.
///
/// # Errors
/// [`IoError::Log`] if the two columns of a time do not fit.
pub(super) fn stamps<'w>(
    path: &Path,
    time: WantedTime<'w>,
    lists: &mut Vec<Numbers>,
) -> Result<(&'w str, Vec<f64>), IoError> {
    let mut last = || lists.pop().unwrap_or(Numbers::Real(Vec::new()));
    let WantedTime { column, split, instants } = time;
    let Some(split) = split else { return Ok((column, last().stamps(instants))) };
    let (second, first) = (last(), last());
    let stamp = |row: usize| {
        let (first, second) = (first.text(row), second.text(row));
        split_time::seconds(instants, split, (column, &first), &second)
            .map_err(|problem| LogError::at(path, row as u64 + 1, problem))
    };
    let stamps = (0..first.len().min(second.len())).map(stamp).collect::<Result<_, _>>()?;
    Ok((column, stamps))
}

/// Combines columns, without rows that repeat the previous row.
///
/// # Errors
/// [`IoError::Log`] if there are no rows, or a number is not finite.
pub(super) fn together(
    path: &Path,
    names: &[&str],
    numbers: Vec<Vec<f64>>,
    time: Option<(&str, Vec<f64>)>,
) -> Result<Columns, IoError> {
    let rows = numbers.first().map_or(0, Vec::len);
    if rows == 0 {
        return Err(LogError::of(path, LogProblem::OnlyHeader));
    }
    let timed = time.is_some();
    let (time_name, time) = time.unwrap_or_default();
    let mut columns = Columns { time, numbers, ..Columns::default() };
    (1..=rows as u64).for_each(|row| columns.lines.push(row));
    leave_out_damaged(&mut columns, names, time_name)
        .map_err(|(row, problem)| LogError::at(path, row, problem))?;
    let rows = columns.lines.len();
    // Without a time stamp, a repeated row could be two samples.
    if timed {
        let is_same = |row: usize| {
            let mut lists = columns.numbers.iter().chain([&columns.time]);
            row > 0 && lists.all(|list| list[row].to_bits() == list[row - 1].to_bits())
        };
        let repeated: Vec<bool> = (0..rows).map(is_same).collect();
        columns.leave_out(&repeated, Omission::Repeated);
    }
    Ok(columns)
}

/// Leaves out the rows with a number that is not finite.
fn leave_out_damaged(
    columns: &mut Columns,
    names: &[&str],
    time_name: &str,
) -> Result<(), (u64, LogProblem)> {
    let mut is_damaged = vec![false; columns.lines.len()];
    for list in columns.numbers.iter().chain([&columns.time]) {
        for (mark, number) in is_damaged.iter_mut().zip(list) {
            *mark |= !number.is_finite();
        }
    }
    let mut damage = Damage::default();
    let damaged = is_damaged.iter().enumerate().filter(|(_, damaged)| **damaged);
    for (row, _) in damaged {
        let lists = names.iter().copied().zip(&columns.numbers);
        let mut lists = lists.chain([(time_name, &columns.time)]);
        let (column, number) = lists
            .find_map(|(name, list)| list.get(row).filter(|n| !n.is_finite()).map(|n| (name, n)))
            .unwrap_or((time_name, &f64::NAN));
        let problem = LogProblem::NotFinite { column: column.into(), text: number.to_string() };
        damage.note(row as u64 + 1, problem, MOST_ROWS)?;
    }
    columns.remove(&is_damaged);
    damage.settle(columns)
}
