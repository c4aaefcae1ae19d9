//! The sampling of a log: the time column, its unit, and its jitter.

use super::label::{Label, Role};
use super::page::short;
use super::sample::Sample;
use crate::log::continued;
use crate::quantity::Dimension;

/// A step longer than this many median steps is a gap.
const GAP: f64 = 1.5;

/// The minimum number of steps from which a column without a name can be recognized as time.
const ENOUGH: usize = 9;

/// The time column and the properties of its steps.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pace {
    /// The column; the first of two whose sum is the time.
    pub(super) column: usize,
    /// The second of two columns.
    pub(super) split: Option<SplitPace>,
    /// The reason for the selection, if the column's name does not state it.
    pub(super) column_guess: Option<String>,
    /// The unit of the column.
    pub(super) unit: PaceUnit,
    /// The number of steps that were examined.
    pub(super) steps: usize,
    /// The median step, in the column's unit.
    pub(super) step: f64,
    /// The rms difference from the median of the steps that are not gaps, relative to the median.
    pub(super) jitter: f64,
    /// The number of examined steps that are gaps.
    pub(super) gaps: usize,
    /// The number of examined steps in which time does not increase.
    pub(super) halts: usize,
}

/// The second of two columns whose sum is the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SplitPace {
    pub(super) column: usize,
    /// The units of both columns.
    pub(super) units: [&'static str; 2],
    /// What they are.
    pub(super) why: &'static str,
}

/// The unit of a time column.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum PaceUnit {
    /// The name states it in brackets.
    Stated(&'static str),
    /// A guess, with its reason.
    Guess(&'static str, String),
    /// Unknown.
    Unknown,
}

impl PaceUnit {
    fn name(&self) -> Option<&'static str> {
        match self {
            Self::Stated(name) | Self::Guess(name, _) => Some(name),
            Self::Unknown => None,
        }
    }
}

/// The units of time, their values in seconds, and the step sizes in them between 10 Hz and 5 kHz.
const UNITS: [(&str, f64); 4] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)];
/// Words of clocks that count in units of their own.
const TICKS: [&str; 3] = ["fine", "tick", "ticks"];
const SLOWEST: f64 = 0.1;
const FASTEST: f64 = 2e-4;

impl Pace {
    /// Finds the time column: by its name, or as the first column that increases in even steps.
    pub(super) fn find(sample: &Sample, labels: &[Label]) -> Option<Self> {
        let named = |role| {
            let named = (0..sample.count).filter(move |&column| labels[column].role == Some(role));
            named.filter_map(|column| Self::of(sample, column)).find(|pace| pace.jitter.is_finite())
        };
        let time = named(Role::Time).map(|pace| pace.with_unit(labels));
        // Rows of several kinds have a counter each.
        let counter = || named(Role::Counter).filter(|_| sample.kinds.is_empty());
        let counter = || counter().map(|pace| pace.with_unit(labels));
        let has_unit = |pace: &&Self| pace.unit != PaceUnit::Unknown;
        let known = time.as_ref().filter(has_unit).cloned();
        if let Some(pace) = known.or_else(|| counter().filter(|pace| has_unit(&pace))).or(time) {
            return Some(pace);
        }
        if let Some(pace) = counter() {
            return Some(pace);
        }
        let nameless = (0..sample.count).filter(|&column| labels[column].role.is_none());
        let mut rising = nameless.filter_map(|column| Self::of(sample, column));
        let pace = rising.find(Self::is_steady)?;
        let why = "it increases steadily from row to row".to_string();
        Some(Self { column_guess: Some(why), ..pace }.with_unit(labels))
    }

    /// The interval between rows \[s\], if the unit is known and is not samples.
    pub(super) fn interval(&self) -> Option<f64> {
        let name = self.unit.name()?;
        let (_, seconds) = UNITS.iter().find(|(unit, _)| *unit == name)?;
        Some(self.step * seconds)
    }

    /// Whether time increases in even steps, of which there are enough.
    pub(super) fn is_steady(&self) -> bool {
        self.steps >= ENOUGH && self.halts == 0 && self.jitter < 0.3
    }

    /// Whether the column is the time or a part of it.
    pub(super) fn has(&self, column: usize) -> bool {
        column == self.column || self.split.is_some_and(|split| split.column == column)
    }

    pub(super) fn counts_samples(&self) -> bool {
        self.unit.name() == Some("sample")
    }

    /// The properties of a column's steps; `None` if it does not increase.
    fn of(sample: &Sample, column: usize) -> Option<Self> {
        let steps = |run: &Vec<Vec<f64>>| -> Vec<f64> {
            let mut times = run[column].clone();
            continued(&mut times, None);
            times.windows(2).map(|pair| pair[1] - pair[0]).collect()
        };
        let all: Vec<f64> = sample.runs.iter().flat_map(steps).collect();
        Self::of_steps(column, &all)
    }

    /// The properties of these steps of a column; `None` if it does not increase.
    pub(super) fn of_steps(column: usize, all: &[f64]) -> Option<Self> {
        let mut sorted: Vec<f64> = all.iter().copied().filter(|step| step.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let step = *sorted.get(sorted.len() / 2)?;
        if step <= 0.0 || !step.is_finite() {
            return None;
        }
        let even: Vec<f64> =
            sorted.iter().copied().filter(|s| *s > 0.0 && *s <= GAP * step).collect();
        let sum: f64 = even.iter().map(|s| (s / step - 1.0) * (s / step - 1.0)).sum();
        Some(Self {
            column,
            split: None,
            column_guess: None,
            unit: PaceUnit::Unknown,
            steps: all.len(),
            step,
            jitter: (sum / even.len() as f64).sqrt(),
            gaps: sorted.iter().filter(|s| **s > GAP * step).count(),
            halts: all.iter().filter(|s| s.is_nan() || **s <= 0.0).count(),
        })
    }

    fn with_unit(self, labels: &[Label]) -> Self {
        let unit = self.judged_unit(&labels[self.column]);
        Self { unit, ..self }
    }

    fn judged_unit(&self, label: &Label) -> PaceUnit {
        let stated = label.unit.as_ref().filter(|unit| unit.unit.dimension == Dimension::TIME);
        if let Some(stated) = stated
            && let Some((name, _)) = UNITS.iter().find(|(name, _)| *name == stated.text)
        {
            return if stated.by_ending {
                PaceUnit::Guess(name, "by the ending of the column's name".into())
            } else {
                PaceUnit::Stated(name)
            };
        }
        let step = self.step;
        if (step - 1.0).abs() < f64::EPSILON && self.jitter < f64::EPSILON {
            // A time in ms at 1 kHz, or in s at 1 Hz, has steps of one too.
            return if label.role == Some(Role::Counter) {
                PaceUnit::Guess(
                    "sample",
                    "it increases by one, and its name is that of a counter".into(),
                )
            } else {
                PaceUnit::Unknown
            };
        }
        if label.stem.split(' ').any(|word| TICKS.contains(&word)) {
            return PaceUnit::Unknown;
        }
        let sensible = |seconds: f64| (FASTEST..=SLOWEST).contains(&(step * seconds));
        match UNITS.iter().find(|(_, seconds)| sensible(*seconds)) {
            Some((name, seconds)) => {
                let (step, rate) = (short(step), short(1.0 / (self.step * seconds)));
                PaceUnit::Guess(name, format!("its median step of {step} is then {rate} Hz"))
            }
            None => PaceUnit::Unknown,
        }
    }
}
