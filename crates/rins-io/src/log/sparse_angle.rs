//! A table angle that is not read in every row: that of marks, or of a table that is read at rest.

use std::iter;
use std::ops::Range;

use super::angle_file::LONGEST_INTERVAL;
use super::series::{smoothly_between, unwrap};
use crate::rig::StatedRotation;

/// A table angle of which some rows have no reading.
#[derive(Debug, PartialEq)]
pub(super) enum SparseAngle {
    /// The angle of every row: readings are frequent enough for an interpolation.
    Filled(Vec<f64>),
    /// The rotations from the last reading before to the first after each time without readings.
    Rotations(Vec<StatedRotation>),
}

/// A step between two readings of successive rows that is about half a turn: the row, and the step in turns.
type Ambiguous = (usize, f64);

impl SparseAngle {
    /// From the angle in each row, which is not a number without a reading, and from the times of the rows.
    ///
    /// # Errors
    /// If a step between two readings of successive rows is about half a turn: the row, and the step in turns.
    pub(super) fn of(angles: &[f64], times: &[f64]) -> Result<Self, Ambiguous> {
        let stretches = stretches(angles);
        let mut read = angles.to_vec();
        for stretch in &stretches {
            unwrap(&mut read[stretch.clone()])
                .map_err(|(row, turns)| (stretch.start + row, turns))?;
        }
        let covers_ends = stretches
            .first()
            .is_some_and(|first| times[first.start] - times[0] <= LONGEST_INTERVAL)
            && stretches.last().is_some_and(|last| {
                times[times.len() - 1] - times[last.end - 1] <= LONGEST_INTERVAL
            });
        let pairs = || stretches.windows(2);
        let apart = |pair: &[Range<usize>]| times[pair[1].start] - times[pair[0].end - 1];
        if covers_ends && pairs().all(|pair| apart(pair) <= LONGEST_INTERVAL) {
            return Self::filled(angles, times);
        }
        let rotation = |pair: &[Range<usize>]| {
            let (from, to) = (pair[0].end - 1, pair[1].start);
            StatedRotation {
                start: times[from],
                end: times[to],
                angle: angles[to] - read[from],
                sigma: 0.0,
                read: true,
            }
        };
        Ok(Self::Rotations(pairs().map(rotation).collect()))
    }

    fn filled(angles: &[f64], times: &[f64]) -> Result<Self, Ambiguous> {
        let (rows, mut known): (Vec<usize>, Vec<f64>) =
            angles.iter().enumerate().filter(|(_, angle)| !angle.is_nan()).unzip();
        unwrap(&mut known).map_err(|(place, turns)| (rows[place], turns))?;
        let moments: Vec<f64> = rows.iter().map(|&row| times[row]).collect();
        let (first, last) = (known[0], known[known.len() - 1]);
        let at = |time: &f64| {
            smoothly_between(&moments, &known, *time).unwrap_or(if *time < moments[0] {
                first
            } else {
                last
            })
        };
        Ok(Self::Filled(times.iter().map(at).collect()))
    }
}

/// The spans of successive rows with a reading.
fn stretches(angles: &[f64]) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut start = None;
    for (row, is_read) in
        angles.iter().map(|angle| !angle.is_nan()).chain(iter::once(false)).enumerate()
    {
        match (start, is_read) {
            (None, true) => start = Some(row),
            (Some(first), false) => {
                found.push(first..row);
                start = None;
            }
            _ => {}
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::SparseAngle;
    use rins_testing::assert_close;

    const NONE: f64 = f64::NAN;

    fn times(rows: u32, interval: f64) -> Vec<f64> {
        (0..rows).map(|row| interval * f64::from(row)).collect()
    }

    #[test]
    fn readings_at_rest_are_rotations_between() {
        let angles = [[0.1; 3], [NONE; 3], [2.0 * TAU; 3]].concat();
        let Ok(SparseAngle::Rotations(found)) = SparseAngle::of(&angles, &times(9, 1.0)) else {
            panic!("rare readings")
        };
        let [turn] = found[..] else { panic!("{found:?}") };
        assert_eq!((turn.start, turn.end, turn.read), (2.0, 6.0, true));
        assert_close!(turn.angle, 2.0 * TAU - 0.1, 1e-12);
    }

    #[test]
    fn frequent_readings_are_interpolated() {
        let angle = |row: u32| 0.3 * f64::from(row);
        let angles: Vec<f64> =
            (0..60).map(|row| if row % 3 == 1 { NONE } else { angle(row) % TAU }).collect();
        let Ok(SparseAngle::Filled(found)) = SparseAngle::of(&angles, &times(60, 0.02)) else {
            panic!("frequent readings")
        };
        for (row, found) in (0..60).zip(&found) {
            assert_close!(*found, angle(row), 1e-9);
        }
    }

    #[test]
    fn half_turn_between_rows_is_ambiguous() {
        let angles = [0.0, 0.5 * TAU, NONE, NONE, NONE, NONE];
        assert_eq!(SparseAngle::of(&angles, &times(6, 1.0)), Err((1, 0.5)));
    }
}
