//! Rows of a log that cannot be read: lost samples, within a limit.

use std::mem;

use super::problem::LogProblem;
use super::table::Columns;

/// The largest fraction of a log's rows that may be damaged. With more of them the rate of its rows differs from the sampling rate
/// by more than the hundredth within which both must agree, and a wrong column or format is more likely than a damaged row.
const LARGEST: f64 = 0.01;

/// The damaged rows of a file.
#[derive(Debug, Default)]
pub(crate) struct Damage {
    first: Option<LogProblem>,
    lines: Vec<u64>,
}

impl Damage {
    /// Notes a row.
    ///
    /// # Errors
    /// The line and the problem of the first one, if there are too many in a log of `most` rows.
    pub(crate) fn note(
        &mut self,
        line: u64,
        problem: LogProblem,
        most: u64,
    ) -> Result<(), (u64, LogProblem)> {
        self.first.get_or_insert(problem);
        self.lines.push(line);
        let count = self.lines.len();
        if is_too_much(count, most as f64) { Err(self.refused(count)) } else { Ok(()) }
    }

    fn refused(&mut self, rows: usize) -> (u64, LogProblem) {
        let (count, line) = (self.lines.len(), self.lines.first().copied().unwrap_or_default());
        let first = mem::take(&mut self.first).unwrap_or(LogProblem::Empty);
        if count == 1 {
            return (line, first);
        }
        (line, LogProblem::ManyDamaged { first: Box::new(first), count, rows })
    }

    /// Judges the damaged rows beside `good` other ones.
    ///
    /// # Errors
    /// The line and the problem of the first one, if there are too many: more than one, and more than one in a hundred; or if there
    /// are no other rows.
    pub(crate) fn judge(&mut self, good: usize) -> Result<(), (u64, LogProblem)> {
        let bad = self.lines.len();
        let is_hopeless = bad > 0 && good == 0 || is_too_much(bad, (good + bad) as f64);
        if is_hopeless { Err(self.refused(good + bad)) } else { Ok(()) }
    }

    /// Judges the damaged rows of `columns`, and adds them to those that are left out.
    ///
    /// # Errors
    /// As [`Damage::judge`].
    pub(super) fn settle(mut self, columns: &mut Columns) -> Result<(), (u64, LogProblem)> {
        self.judge(columns.lines.len())?;
        columns.add_damaged(self.lines);
        Ok(())
    }
}

/// Whether a problem is that of one row, which is then a lost sample.
pub(super) fn is_of_a_row(problem: &LogProblem) -> bool {
    matches!(
        problem,
        LogProblem::NotText
            | LogProblem::FieldCount { .. }
            | LogProblem::NotANumber { .. }
            | LogProblem::NotFinite { .. }
    )
}

fn is_too_much(damaged: usize, rows: f64) -> bool {
    damaged > 1 && damaged as f64 > LARGEST * rows
}

/// Leaves out of each of some files, which were sampled together, the rows that are damaged in another one.
pub(super) fn leave_out_of_all(files: &mut [&mut Columns]) {
    let rows = |columns: &Columns| columns.lines.len() + columns.damaged.len();
    let are_alike = files.windows(2).all(|pair| rows(pair[0]) == rows(pair[1]));
    // Files with other numbers of rows are refused where they are compared.
    if !are_alike || files.iter().all(|columns| columns.damaged.is_empty()) {
        return;
    }
    let count = files.first().map_or(0, |columns| rows(columns));
    let mut is_whole = vec![0; count];
    for columns in files.iter() {
        columns.places().for_each(|place| is_whole[place] += 1);
    }
    let all = files.len();
    for columns in files {
        let marked: Vec<bool> = columns.places().map(|place| is_whole[place] < all).collect();
        columns.leave_out_damaged(&marked);
    }
}
