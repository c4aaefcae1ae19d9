//! Rows of equal readings.

use std::ops::Range;

/// Readings are the same if they differ by no more than rounding, relative to the larger.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A longer row of equal samples is no hiccup of a driver: a recording without noise, one that stands still, or a sensor that
/// sticks.
pub(crate) const LONGEST: usize = 50;

/// Nor is it one if more than this share of all samples repeats.
pub(crate) const MOST: f64 = 0.2;

/// So many times what chance would make of sensors that read in steps.
pub(crate) const BEYOND_CHANCE: f64 = 10.0;

/// Whether a reading is that before it.
pub(crate) fn alike(before: f64, now: f64) -> bool {
    (now - before).abs() <= ROUNDING * before.abs().max(now.abs())
}

/// The rows of samples that are marked.
pub(crate) fn rows_of(marked: &[bool]) -> Vec<Range<usize>> {
    let mut end = 0;
    let rows = marked.chunk_by(|a, b| a == b).map(|row| {
        end += row.len();
        (row[0], end - row.len()..end)
    });
    rows.filter(|(is_marked, _)| *is_marked).map(|(_, row)| row).collect()
}
