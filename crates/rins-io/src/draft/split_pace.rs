//! The time in two columns: seconds and their parts, a GNSS week and its seconds, a date and a time of day.

use super::label::{Label, Role};
use super::pace::{Pace, PaceUnit, SplitPace};
use super::sample::{ClockText, Run, Sample};
use crate::quantity::Dimension;

/// The units of the second column, and their values in seconds.
const UNITS: [(&str, f64); 4] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)];

/// The units of the first column, and the longest of them in seconds: a day may have a leap second.
const COARSE: [(&str, f64); 3] = [("s", 1.0), ("week", 604_800.0), ("date", 86_401.0)];

/// The shortest and the longest plausible step of a sum \[s\].
const STEPS: std::ops::RangeInclusive<f64> = 1e-4..=1.0;

/// Finds two adjacent columns whose sum is the time; `None` if there are none.
pub(super) fn find(sample: &Sample, labels: &[Label]) -> Option<Pace> {
    let mut pairs =
        (1..sample.count).flat_map(|second| [(second - 1, second), (second, second - 1)]);
    pairs.find_map(|(first, second)| {
        let pair = Pair { sample, labels, first, second };
        pair.by_date().or_else(|| pair.by_week()).or_else(|| pair.by_seconds())
    })
}

/// Two columns that may be a time.
#[derive(Clone, Copy)]
struct Pair<'s> {
    sample: &'s Sample,
    labels: &'s [Label],
    first: usize,
    second: usize,
}

impl Pair<'_> {
    /// A date and a time of day.
    fn by_date(self) -> Option<Pace> {
        let texts = [self.first, self.second].map(|column| self.sample.clocks[column]);
        if texts != [Some(ClockText::Date), Some(ClockText::TimeOfDay)] {
            return None;
        }
        self.with(["date", "s"], "a date and a time of day, whose sum increases from row to row")
    }

    /// A GNSS week and a time within it, known by the name of the week.
    fn by_week(self) -> Option<Pace> {
        let roles = [self.first, self.second].map(|column| self.labels[column].role);
        if roles != [Some(Role::Week), Some(Role::Time)] || !self.sample.is_numeric(self.second) {
            return None;
        }
        self.only("week", "a GNSS week and the time within it, whose sum increases steadily")
    }

    /// Whole seconds that never decrease, and a whole number of parts that starts again with each of them.
    fn by_seconds(self) -> Option<Pace> {
        let Self { sample, labels, first, second } = self;
        let is_time = |column: usize| labels[column].role == Some(Role::Time);
        let may_be = |column: usize| {
            sample.is_numeric(column) && (is_time(column) || labels[column].role.is_none())
        };
        if !may_be(first) || !may_be(second) {
            return None;
        }
        let is_whole = |number: &f64| number.fract() == 0.0 && *number >= 0.0;
        let mut starts_again = false;
        for run in &sample.runs {
            let (seconds, parts) = (&run[first], &run[second]);
            let rises = seconds.windows(2).all(|pair| pair[1] >= pair[0]);
            if !(rises && seconds.iter().chain(parts).all(is_whole)) {
                return None;
            }
            starts_again |= parts.windows(2).any(|pair| pair[1] < pair[0]);
        }
        let is_named = is_time(first) && is_time(second) && self.stated().is_some();
        if !starts_again && !is_named {
            return None;
        }
        self.only("s", "whole seconds and the parts of a second, whose sum increases steadily")
    }

    /// The unit of time that the name of the second column states.
    fn stated(self) -> Option<&'static str> {
        let stated = self.labels[self.second].unit.as_ref();
        let stated = stated.filter(|unit| unit.unit.dimension == Dimension::TIME)?;
        UNITS.iter().map(|(name, _)| *name).find(|name| *name == stated.text)
    }

    /// The time with the only unit of the second column that makes the sum increase steadily: the stated one, if there is one.
    fn only(self, coarse: &'static str, why: &'static str) -> Option<Pace> {
        let stated = self.stated();
        let units = UNITS.iter().map(|(unit, _)| *unit).filter(|unit| *unit != coarse);
        let units = units.filter(|unit| stated.is_none_or(|stated| stated == *unit));
        let mut paces = units.filter_map(|unit| self.with([coarse, unit], why));
        paces.next().filter(|_| paces.next().is_none())
    }

    /// The time with these units, if their sum increases.
    fn with(self, units: [&'static str; 2], why: &'static str) -> Option<Pace> {
        let Self { sample, labels, first, second } = self;
        let (_, longest) = COARSE.iter().find(|(unit, _)| *unit == units[0])?;
        let (_, fine) = UNITS.iter().find(|(unit, _)| *unit == units[1])?;
        // The first column of a date has seconds already.
        let coarse = if units[0] == "date" { 1.0 } else { *longest };
        // Differences of both columns, so that the sum loses no digits.
        let steps = |run: &Run| -> Vec<f64> {
            let pairs = run[first].windows(2).zip(run[second].windows(2));
            pairs.map(|(a, b)| (a[1] - a[0]) * coarse + (b[1] - b[0]) * fine).collect()
        };
        let all: Vec<f64> = sample.runs.iter().flat_map(steps).collect();
        let parts = sample.runs.iter().flat_map(|run| run[second].iter());
        let is_inside = parts.into_iter().all(|part| (0.0..*longest).contains(&(part * fine)));
        let pace = Pace::of_steps(first, &all).filter(|_| is_inside)?;
        // Without names only even steps show a time.
        let is_named = labels[first].role.is_some() || sample.clocks[first].is_some();
        let increases = pace.halts == 0 && STEPS.contains(&pace.step) && pace.jitter.is_finite();
        let split = Some(SplitPace { column: second, units, why });
        let is_time = increases && (is_named || pace.is_steady());
        is_time.then_some(Pace { split, unit: PaceUnit::Stated("s"), ..pace })
    }
}
