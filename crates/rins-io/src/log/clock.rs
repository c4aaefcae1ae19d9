//! The intervals of samples from their time stamps.

use std::ops::Range;
use std::path::Path;

use rins_motion::median;

use super::problem::LogProblem;
use super::summary::{Gap, LogPolicy, LogSummary};
use super::table::RowLines;
use crate::error::{IoError, LogError};
use crate::rig::Stamp;

/// The maximum relative difference of the measured sampling rate from the stated one.
const RATE_WITHIN: f64 = 0.01;

/// A step longer than this many nominal intervals is a gap.
pub(super) const GAP: f64 = 1.5;

/// Steps longer than this number of medians are excluded from the mean step.
const MEAN_OVER: f64 = 2.5;

/// The minimum and maximum sample interval that are plausible \[s\].
pub(super) const PACE: (f64, f64) = (1e-7, 1e4);

/// The intervals of a log's samples.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Clock {
    /// The end of each sample's interval \[s\].
    pub(super) ends: Vec<f64>,
    /// The length of each sample's interval \[s\].
    pub(super) intervals: Vec<f64>,
    pub(super) summary: LogSummary,
}

impl Clock {
    /// Keeps the samples of `range` only.
    pub(super) fn keep(&mut self, range: Range<usize>) {
        if range == (0..self.ends.len()) {
            return;
        }
        self.ends = self.ends[range.clone()].to_vec();
        // They may have been moved into a recording already.
        self.intervals = self.intervals.get(range.clone()).unwrap_or_default().to_vec();
        self.summary.samples = range.len();
        self.summary.gaps.retain(|gap| range.contains(&gap.sample));
        for gap in &mut self.summary.gaps {
            gap.sample -= range.start;
        }
    }
}

/// The time information in a log's rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stamps<'l> {
    pub(super) path: &'l Path,
    /// The line of each row.
    pub(super) lines: &'l RowLines,
    /// The lines of damaged rows, in order.
    pub(super) damaged: &'l [u64],
    pub(super) stamp: Stamp,
    /// The nominal interval, if the rig states it \[s\].
    pub(super) nominal: Option<f64>,
}

impl Stamps<'_> {
    /// Intervals of rows without a time column: consecutive nominal intervals from zero. A damaged row is a gap.
    pub(super) fn counted(&self, interval: f64, policy: LogPolicy) -> Result<Clock, IoError> {
        if !self.damaged.is_empty() {
            let places = self.lines.places(self.damaged);
            let times: Vec<f64> = places.map(|place| (place + 1) as f64 * interval).collect();
            let stamps = Self { nominal: Some(interval), ..*self };
            return stamps.timed(&times, policy);
        }
        self.need_two()?;
        let count = self.lines.len();
        Ok(Clock {
            ends: (1..=count).map(|sample| sample as f64 * interval).collect(),
            intervals: vec![interval; count],
            summary: LogSummary::even(count, interval),
        })
    }

    /// Intervals of rows with these times \[s\].
    ///
    /// A sample stamped at its end covers the time since the previous stamp, and the first sample one nominal interval. Stamps of
    /// the start or the middle define the end of the interval only together with the next stamp, so that the last row is not a
    /// sample.
    pub(super) fn timed(&self, times: &[f64], policy: LogPolicy) -> Result<Clock, IoError> {
        self.need_two()?;
        let steps = self.steps(times)?;
        let median = median(steps.iter().copied()).expect("two rows have a step between them");
        let (least, most) = PACE;
        if !(least..=most).contains(&median) {
            let problem = LogProblem::Pace { interval: median, least, most };
            return Err(LogError::of(self.path, problem));
        }
        if let Some(nominal) = self.nominal {
            // Missing samples distort the mean, and coarse time stamps the median.
            let fits = |interval: f64| (interval / nominal - 1.0).abs() <= RATE_WITHIN;
            if !(fits(median) || fits(mean_below(&steps, MEAN_OVER * median))) {
                let (measured, stated) = (1.0 / median, 1.0 / nominal);
                return Err(LogError::of(self.path, LogProblem::WrongRate { measured, stated }));
            }
        }
        let nominal = self.nominal.unwrap_or(median);
        self.refuse_long_gaps(times, &steps, policy.largest_gap.max(GAP * nominal))?;
        let intervals: Vec<f64> = match self.stamp {
            Stamp::Start => steps.clone(),
            Stamp::End => std::iter::once(nominal).chain(steps.iter().copied()).collect(),
            Stamp::Middle => {
                let halves = steps.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
                std::iter::once(0.5 * (nominal + steps[0])).chain(halves).collect()
            }
        };
        let ends = match self.stamp {
            Stamp::Start => times[1..].to_vec(),
            Stamp::End => times.to_vec(),
            Stamp::Middle => times.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect(),
        };
        let gaps = self.gaps(times, &steps, nominal);
        let lost = gaps.iter().map(|gap| gap.length).sum();
        let lasting = times[times.len() - 1] - times[0];
        if lost > policy.largest_loss * lasting {
            let (count, most) = (gaps.len(), policy.largest_loss);
            let problem = LogProblem::ManyGaps { count, lost, lasting, most };
            return Err(LogError::of(self.path, problem));
        }
        let even = steps.iter().filter(|step| **step <= GAP * nominal);
        let (count, sum) = even.fold((0.0, 0.0), |(count, sum), step| {
            (count + 1.0, sum + (step - nominal) * (step - nominal))
        });
        let jitter_rms = if count > 0.0 { f64::sqrt(sum / count) } else { 0.0 };
        let even = LogSummary::even(ends.len(), nominal);
        Ok(Clock { summary: LogSummary { jitter_rms, gaps, ..even }, ends, intervals })
    }

    fn need_two(&self) -> Result<(), IoError> {
        match self.lines.len() {
            samples @ (0 | 1) => Err(LogError::of(self.path, LogProblem::TooShort { samples })),
            _ => Ok(()),
        }
    }

    /// The steps between consecutive times; steps that equal the nominal interval within the rounding
    /// of the times are set to it exactly.
    fn steps(&self, times: &[f64]) -> Result<Vec<f64>, IoError> {
        let mut steps = Vec::with_capacity(times.len() - 1);
        for (row, pair) in times.windows(2).enumerate() {
            let (before, now) = (pair[0], pair[1]);
            let step = now - before;
            if step <= 0.0 {
                let problem = LogProblem::TimeNotIncreasing { before, now };
                return Err(LogError::at(self.path, self.lines.of(row + 1), problem));
            }
            let rounding = 4.0 * f64::EPSILON * before.abs().max(now.abs());
            let nominal = self.nominal.filter(|nominal| (step - nominal).abs() <= rounding);
            steps.push(nominal.unwrap_or(step));
        }
        Ok(steps)
    }

    fn refuse_long_gaps(&self, times: &[f64], steps: &[f64], largest: f64) -> Result<(), IoError> {
        match steps.iter().position(|step| *step > largest) {
            Some(row) => {
                let problem =
                    LogProblem::LongGap { length: steps[row], after: times[row], largest };
                Err(LogError::at(self.path, self.lines.of(row + 1), problem))
            }
            None => Ok(()),
        }
    }

    /// The number of damaged rows between a row and the next one.
    fn damaged_in(&self, row: usize) -> f64 {
        let before = |line: u64| self.damaged.partition_point(|damaged| *damaged < line);
        (before(self.lines.of(row + 1)) - before(self.lines.of(row))) as f64
    }

    fn gaps(&self, times: &[f64], steps: &[f64], nominal: f64) -> Vec<Gap> {
        let gap = |(row, &length): (usize, &f64)| {
            (length > GAP * nominal).then(|| Gap {
                sample: if self.stamp == Stamp::End { row + 1 } else { row },
                line: self.lines.of(row + 1),
                after: times[row],
                length,
                damaged: self.damaged_in(row) >= length / nominal - GAP,
            })
        };
        steps.iter().enumerate().filter_map(gap).collect()
    }
}

fn mean_below(steps: &[f64], most: f64) -> f64 {
    let below = steps.iter().filter(|step| **step <= most);
    let (count, sum) = below.fold((0.0, 0.0), |(count, sum), step| (count + 1.0, sum + step));
    sum / count
}
