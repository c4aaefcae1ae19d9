//! Resampling of increments from the intervals of one clock to those of another.

use std::ops::Range;

use nalgebra::Vector3;

use super::clock::Clock;
use super::files::TriadValues;

/// The maximum mismatch of two files at their beginning and end, as a fraction of an interval: the rounding
/// of their stamps.
const ROUNDING: f64 = 1e-6;

/// The increments over those intervals of `onto` that the intervals of `from` cover, with the range of these intervals.
///
/// The mean rate is held over each interval of `from`, so that the sum of the increments is preserved.
pub(super) fn redivide(
    from: &Clock,
    increments: &TriadValues,
    onto: &Clock,
) -> (Range<usize>, TriadValues) {
    let (Some(last), Some(first_end), Some(first_interval)) =
        (from.ends.last(), from.ends.first(), from.intervals.first())
    else {
        return (0..0, TriadValues::default());
    };
    let start = first_end - first_interval;
    let slack = ROUNDING * from.summary.nominal_interval;
    let begins = |index: usize| onto.ends[index] - onto.intervals[index];
    let first = (0..onto.ends.len()).find(|&index| begins(index) >= start - slack);
    let first = first.unwrap_or(onto.ends.len());
    let end = onto.ends.partition_point(|end| *end <= last + slack).max(first);
    let mut divided = TriadValues::default();
    let mut place = 0;
    for index in first..end {
        let (begin, end) = (begins(index).max(start), onto.ends[index].min(*last));
        while place + 1 < from.ends.len() && from.ends[place] <= begin {
            place += 1;
        }
        let mut sum = Vector3::zeros();
        let mut other = place;
        while other < from.ends.len() {
            let (from_end, interval) = (from.ends[other], from.intervals[other]);
            let overlap = end.min(from_end) - begin.max(from_end - interval);
            if overlap > 0.0 {
                let increment = Vector3::from_fn(|axis, _| increments[axis][other]);
                sum += increment * (overlap / interval);
            }
            if from_end >= end {
                break;
            }
            other += 1;
        }
        for (list, &component) in divided.iter_mut().zip(sum.iter()) {
            list.push(component);
        }
    }
    (first..end, divided)
}

#[cfg(test)]
mod tests {
    use super::redivide;
    use crate::log::clock::Clock;
    use crate::log::files::TriadValues;
    use crate::log::summary::LogSummary;
    use proptest::prelude::*;
    use rins_testing::assert_close;

    /// Consecutive intervals from `start`.
    fn clock(start: f64, intervals: Vec<f64>) -> Clock {
        let mut end = start;
        let ends = intervals.iter().map(|interval| {
            end += interval;
            end
        });
        let ends: Vec<f64> = ends.collect();
        let summary = LogSummary::even(ends.len(), intervals[0]);
        Clock { ends, intervals, summary }
    }

    proptest! {
        #[test]
        fn what_is_divided_is_not_lost(
            from in prop::collection::vec((0.5..1.5_f64, -1.0..1.0_f64), 1..40),
            onto in prop::collection::vec(0.2..3.0_f64, 1..40),
            start in -3.0..3.0_f64,
        ) {
            let increments: TriadValues = [1.0, -1.0, 0.0]
                .map(|part| from.iter().map(|(_, value)| part * value + 1.0).collect());
            let from = clock(0.0, from.iter().map(|(interval, _)| *interval).collect());
            let onto = clock(start, onto);
            let (range, divided) = redivide(&from, &increments, &onto);
            prop_assert!(divided.iter().all(|list| list.len() == range.len()));
            prop_assume!(!range.is_empty());
            // The sum over the common time is that of the whole minus the parts outside.
            let begin = onto.ends[range.start] - onto.intervals[range.start];
            let end = onto.ends[range.end - 1];
            let up_to = |list: &[f64], time: f64| {
                let mut sum = 0.0;
                for (index, increment) in list.iter().enumerate() {
                    let begin = from.ends[index] - from.intervals[index];
                    let part = ((time - begin) / from.intervals[index]).clamp(0.0, 1.0);
                    sum += increment * part;
                }
                sum
            };
            for (divided, list) in divided.iter().zip(&increments) {
                let sum: f64 = divided.iter().sum();
                prop_assert!((sum - (up_to(list, end) - up_to(list, begin))).abs() < 5e-6);
            }
        }
    }

    #[test]
    fn a_clock_that_ticks_at_the_same_time_changes_nothing() {
        let clock = clock(0.0, vec![0.25; 8]);
        let increments =
            [1.0, 2.0, 3.0].map(|axis| (0..8).map(|value| axis * f64::from(value)).collect());
        assert_eq!(redivide(&clock, &increments, &clock), (0..8, increments));
    }

    #[test]
    fn a_constant_rate_stays_one() {
        let (from, onto) = (clock(0.0, vec![0.3; 20]), clock(0.1, vec![0.25; 40]));
        let (range, divided) =
            redivide(&from, &[1.0, 2.0, 3.0].map(|axis| vec![0.6 * axis; 20]), &onto);
        // One ends at 6 s, and the other reaches 5.85 s with 23 intervals.
        assert_eq!(range, 0..23);
        for (axis, list) in (1..).zip(divided) {
            assert_eq!(list.len(), 23);
            for increment in list {
                assert_close!(increment, 0.5 * f64::from(axis), 1e-12);
            }
        }
    }
}
