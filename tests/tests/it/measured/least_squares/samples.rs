//! The samples of a measured log, and its static intervals.

use std::ops::Range;

use nalgebra::Vector3;

/// The rows of numbers in a text; blanks separate them, or `delimiter`. A header is skipped.
pub(super) fn rows(text: &str, delimiter: Option<char>) -> Vec<Vec<f64>> {
    let numbers = |line: &str| -> Option<Vec<f64>> {
        let parse = |word: &str| word.trim().parse().ok();
        match delimiter {
            Some(delimiter) => line.split(delimiter).map(parse).collect(),
            None => line.split_whitespace().map(parse).collect(),
        }
    };
    text.lines().filter_map(numbers).filter(|row: &Vec<f64>| row.len() > 3).collect()
}

/// A log at a constant rate, in \[s\], \[rad/s\] and \[m/s²\].
pub(super) struct Samples {
    pub(super) interval: f64,
    pub(super) gyro: Vec<Vector3<f64>>,
    pub(super) accel: Vec<Vector3<f64>>,
}

/// The samples of a cell: a quarter of a second.
const CELL: usize = 25;

/// The largest standard deviation in a static cell, relative to the quietest tenth of all cells.
const QUIET: f64 = 4.0;

/// The largest difference of the mean rates of cells, in quiet standard deviations, and of the mean forces \[m/s²\].
const SAME: [f64; 2] = [6.0, 0.15];

/// The shortest static interval without its ends \[s\].
const SHORTEST: f64 = 1.5;

/// Mean and standard deviation of each cell.
fn cells(of: &[Vector3<f64>]) -> Vec<(Vector3<f64>, f64)> {
    let statistics = |cell: &[Vector3<f64>]| {
        let count = cell.len() as f64;
        let mean = cell.iter().sum::<Vector3<f64>>() / count;
        let square: f64 = cell.iter().map(|one| (one - mean).norm_squared()).sum();
        (mean, (square / count).sqrt())
    };
    of.chunks_exact(CELL).map(statistics).collect()
}

/// The smallest deviation of nine tenths of the cells.
fn quiet(cells: &[(Vector3<f64>, f64)]) -> f64 {
    let mut deviations: Vec<f64> = cells.iter().map(|cell| cell.1).collect();
    deviations.sort_by(f64::total_cmp);
    deviations[deviations.len() / 10]
}

impl Samples {
    /// Spans of quiet cells with equal means, without the first and the last cell.
    pub(super) fn static_intervals(&self) -> Vec<Range<usize>> {
        let (gyro, accel) = (cells(&self.gyro), cells(&self.accel));
        let limits = [quiet(&gyro), quiet(&accel)];
        let is_quiet =
            |at: usize| gyro[at].1 < QUIET * limits[0] && accel[at].1 < QUIET * limits[1];
        let mean = |of: &[(Vector3<f64>, f64)], cells: Range<usize>| {
            let count = cells.len() as f64;
            of[cells].iter().map(|cell| cell.0).sum::<Vector3<f64>>() / count
        };
        let mut found = Vec::new();
        let mut start = 0;
        while start < gyro.len() {
            if !is_quiet(start) {
                start += 1;
                continue;
            }
            let mut end = start + 1;
            let goes_on = |end: usize| {
                end < gyro.len()
                    && is_quiet(end)
                    && (gyro[end].0 - mean(&gyro, start..end)).norm() < SAME[0] * limits[0]
                    && (accel[end].0 - mean(&accel, start..end)).norm() < SAME[1]
            };
            while goes_on(end) {
                end += 1;
            }
            let span = (start + 1) * CELL..(end - 1).max(start + 1) * CELL;
            if span.len() as f64 * self.interval >= SHORTEST {
                found.push(span);
            }
            start = end;
        }
        found
    }
}

/// The means over these intervals.
pub(super) fn means(of: &[Vector3<f64>], intervals: &[Range<usize>]) -> Vec<Vector3<f64>> {
    let mean =
        |span: &Range<usize>| of[span.clone()].iter().sum::<Vector3<f64>>() / span.len() as f64;
    intervals.iter().map(mean).collect()
}
