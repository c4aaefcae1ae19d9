//! The line numbers of a log's rows.

/// The line of each row; for consecutive lines only the first is stored.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::log) struct RowLines {
    /// The row and the line at the start of each sequence of consecutive lines.
    series: Vec<(usize, u64)>,
    rows: usize,
}

impl RowLines {
    /// Appends a row at `line`.
    pub(in crate::log) fn push(&mut self, line: u64) {
        let next = self.series.last().map(|(row, first)| first + (self.rows - row) as u64);
        if next != Some(line) {
            self.series.push((self.rows, line));
        }
        self.rows += 1;
    }

    /// The number of rows.
    pub(in crate::log) const fn len(&self) -> usize {
        self.rows
    }

    /// Whether there are no rows.
    pub(in crate::log) const fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// The place of each row among all rows and these other lines, which are in order.
    pub(in crate::log) fn places(&self, others: &[u64]) -> impl Iterator<Item = usize> {
        let mut before = 0;
        (0..self.rows).map(move |row| {
            let line = self.of(row);
            while others.get(before).is_some_and(|other| *other < line) {
                before += 1;
            }
            row + before
        })
    }

    /// The line of a row; zero, which is not a line number, if the row does not exist.
    pub(in crate::log) fn of(&self, row: usize) -> u64 {
        let after = self.series.partition_point(|(first, _)| *first <= row);
        let series = after.checked_sub(1).filter(|_| row < self.rows);
        series.map_or(0, |index| {
            let (first, line) = self.series[index];
            line + (row - first) as u64
        })
    }
}

#[cfg(test)]
mod tests {
    use super::RowLines;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_row_keeps_its_line(steps in prop::collection::vec(1..4_u64, 0..60)) {
            let mut line = 0;
            let lines: Vec<u64> = steps.iter().map(|step| { line += step; line }).collect();
            let mut rows = RowLines::default();
            for &line in &lines {
                rows.push(line);
            }
            prop_assert_eq!((rows.len(), rows.is_empty()), (lines.len(), lines.is_empty()));
            for (row, &line) in lines.iter().enumerate() {
                prop_assert_eq!(rows.of(row), line);
            }
            prop_assert_eq!(rows.of(lines.len()), 0);
        }
    }

    #[test]
    fn a_log_without_holes_is_one_series() {
        let mut rows = RowLines::default();
        (3..100_003).for_each(|line| rows.push(line));
        assert_eq!(rows.series, [(0, 3)]);
    }
}
