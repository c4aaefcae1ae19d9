//! The requested columns of a log, with their rows.

use super::rows::RowLines;
use crate::log::instant::Instants;
use crate::log::problem::LogProblem;
use crate::log::summary::Omission;
use crate::rig::{RowFilter, SplitTime, TextForm, TimeColumn};
use crate::section::quoted;
use crate::suggestion::nearest;

/// The maximum number of columns.
pub(crate) const MOST_COLUMNS: usize = 4096;

/// The maximum number of rows: 93 hours at 200 Hz, which occupy about ten gigabytes of memory.
pub(in crate::log) const MOST_ROWS: u64 = 1 << 26;

/// The number of consecutive repetitions above which a row is not a sample that a logger wrote twice.
const MOST_REPEATED: u64 = 1 << 20;

/// The maximum number of columns that an error lists.
const MOST_LISTED: usize = 30;

/// The maximum length of a column's name in an error.
const LONGEST_LISTED: usize = 60;

/// The numbers of some columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::log) struct Columns {
    /// The time stamps \[s\], if time was requested.
    pub(in crate::log) time: Vec<f64>,
    /// The numbers of each requested column.
    pub(in crate::log) numbers: Vec<Vec<f64>>,
    /// The line of each row; its number from 1 if a log has no lines.
    pub(in crate::log) lines: RowLines,
    /// The omitted lines.
    pub(in crate::log) left_out: Vec<(u64, Omission)>,
    /// The lines of damaged rows, which are among the omitted ones.
    pub(in crate::log) damaged: Vec<u64>,
}

impl Columns {
    /// Removes the rows in which the numbers of all columns at `places` are zero, unless all rows are such or rows have no time.
    pub(in crate::log) fn leave_out_zeros(&mut self, places: &[usize]) {
        let is_empty = |row: usize| places.iter().all(|&place| self.numbers[place][row] == 0.0);
        let empty: Vec<bool> = (0..self.time.len()).map(is_empty).collect();
        if !empty.contains(&false) {
            return;
        }
        self.leave_out(&empty, Omission::Empty);
    }

    /// Adds damaged rows, which are not among the numbers.
    pub(in crate::log) fn add_damaged(&mut self, lines: Vec<u64>) {
        self.left_out.extend(lines.iter().map(|&line| (line, Omission::Damaged)));
        self.damaged.extend(lines);
        self.damaged.sort_unstable();
    }

    /// Removes the rows that are marked, because the same samples are damaged elsewhere.
    pub(in crate::log) fn leave_out_damaged(&mut self, marked: &[bool]) {
        let rows = marked.iter().enumerate().filter(|(_, marked)| **marked);
        let lines = rows.map(|(row, _)| self.lines.of(row)).collect();
        self.remove(marked);
        self.add_damaged(lines);
    }

    /// The place of each row among all rows, with the damaged ones.
    pub(in crate::log) fn places(&self) -> impl Iterator<Item = usize> {
        self.lines.places(&self.damaged)
    }

    /// Removes the rows that are marked, for this reason.
    pub(super) fn leave_out(&mut self, marked: &[bool], reason: Omission) {
        let rows = marked.iter().enumerate().filter(|(_, marked)| **marked);
        let lines: Vec<_> = rows.map(|(row, _)| (self.lines.of(row), reason)).collect();
        self.left_out.extend(lines);
        self.remove(marked);
    }

    /// Removes the rows that are marked.
    pub(super) fn remove(&mut self, marked: &[bool]) {
        if !marked.contains(&true) {
            return;
        }
        let mut lines = RowLines::default();
        let kept = marked.iter().enumerate().filter(|(_, marked)| !**marked);
        kept.for_each(|(row, _)| lines.push(self.lines.of(row)));
        self.lines = lines;
        for list in self.numbers.iter_mut().chain([&mut self.time]) {
            let mut marked = marked.iter();
            list.retain(|_| !marked.next().copied().unwrap_or_default());
        }
    }
}

/// The request: columns by name, and optionally a column of time stamps.
pub(in crate::log) struct Wanted<'w> {
    pub(in crate::log) names: &'w [&'w str],
    pub(in crate::log) time: Option<WantedTime<'w>>,
    /// The rows that are read, if not all are.
    pub(in crate::log) rows: Option<&'w RowFilter>,
    /// The column of text that may be empty in a row, where its number is then not a number.
    pub(in crate::log) sparse: Option<&'w str>,
    /// The form of text.
    pub(in crate::log) text: TextForm,
}

/// The requested column of time stamps, or the two columns whose sum they are.
pub(in crate::log) struct WantedTime<'w> {
    pub(in crate::log) column: &'w str,
    pub(in crate::log) split: Option<&'w SplitTime>,
    pub(in crate::log) instants: &'w mut Instants,
}

impl<'w> WantedTime<'w> {
    pub(in crate::log) fn of(time: &'w TimeColumn, instants: &'w mut Instants) -> Self {
        Self { column: &time.column, split: time.split.as_ref(), instants }
    }

    /// The names of its columns.
    pub(super) fn names(&self) -> impl Iterator<Item = &'w str> + use<'w> {
        [self.column].into_iter().chain(self.split.map(|split| split.column.as_str()))
    }
}

/// A counter of rows that equal the previous row.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Repeated {
    times: u64,
    /// The line of the first of them.
    from: u64,
}

impl Repeated {
    /// Counts a row.
    ///
    /// # Errors
    /// The line of the first of them, if there are more than any logger repeats.
    pub(super) fn count(&mut self, line: u64, is_same: bool) -> Result<(), (u64, LogProblem)> {
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

/// The index of the only one of `names` that is `wanted`.
pub(super) fn place(wanted: &str, names: &[String]) -> Result<usize, LogProblem> {
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

/// A list of the existing columns, for an error message.
pub(super) fn listed(names: &[String]) -> String {
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
