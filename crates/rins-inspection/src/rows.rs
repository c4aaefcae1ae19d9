//! Spans of equal readings.

use std::ops::Range;

/// Readings are equal if they differ by no more than rounding, relative to the larger.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A longer span of equal samples is not a delay of a driver, but a recording without noise, a static one, or a stuck sensor.
pub(crate) const LONGEST: usize = 50;

/// The largest fraction of repeated samples that is attributed to delays of a driver.
pub(crate) const MOST: f64 = 0.2;

/// The ratio to the number expected by chance, for quantized sensors, from which repeats are significant.
pub(crate) const BEYOND_CHANCE: f64 = 10.0;

/// Whether a reading equals the previous one.
pub(crate) fn alike(before: f64, now: f64) -> bool {
    (now - before).abs() <= ROUNDING * before.abs().max(now.abs())
}

/// The spans of the samples that are marked.
pub(crate) fn rows_of(marked: &[bool]) -> Vec<Range<usize>> {
    let mut end = 0;
    let rows = marked.chunk_by(|a, b| a == b).map(|row| {
        end += row.len();
        (row[0], end - row.len()..end)
    });
    rows.filter(|(is_marked, _)| *is_marked).map(|(_, row)| row).collect()
}
