//! The pace of a log: which column tells the time, in which unit, and how steadily it goes.

use super::label::{Label, Role};
use super::page::short;
use super::sample::Sample;
use crate::log::continued;
use crate::quantity::Dimension;

/// A step longer than this many median steps is a gap.
const GAP: f64 = 1.5;

/// How many steps it takes to call a column without a name a time.
const ENOUGH: usize = 9;

/// The time column and what its steps show.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pace {
    /// The column.
    pub(super) column: usize,
    /// Why it should be the time, where its name does not say so.
    pub(super) column_guess: Option<String>,
    /// What it counts.
    pub(super) unit: PaceUnit,
    /// How many steps were looked at.
    pub(super) steps: usize,
    /// The median step, in the column's unit.
    pub(super) step: f64,
    /// How much the steps that are not gaps differ from it, rms, relative to it.
    pub(super) jitter: f64,
    /// How many of the steps that were looked at are gaps.
    pub(super) gaps: usize,
    /// How many of them do not go on.
    pub(super) halts: usize,
}

/// What a time column counts.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum PaceUnit {
    /// Its name says so in brackets.
    Stated(&'static str),
    /// A guess, and why.
    Guess(&'static str, String),
    /// Nothing tells.
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

/// The units of time, the seconds in each, and the steps in them between 10 Hz and 5 kHz.
const UNITS: [(&str, f64); 4] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)];
const SLOWEST: f64 = 0.1;
const FASTEST: f64 = 2e-4;

impl Pace {
    /// Finds the time column: by its name, or as the first that rises steadily.
    pub(super) fn find(sample: &Sample, labels: &[Label]) -> Option<Self> {
        let named = |role| {
            let named = (0..sample.count).filter(move |&column| labels[column].role == Some(role));
            named.filter_map(|column| Self::of(sample, column)).find(|pace| pace.jitter.is_finite())
        };
        if let Some(pace) = named(Role::Time).or_else(|| named(Role::Counter)) {
            let label = &labels[pace.column];
            return Some(pace.with_unit(label));
        }
        let nameless = (0..sample.count).filter(|&column| labels[column].role.is_none());
        let mut rising = nameless.filter_map(|column| Self::of(sample, column));
        let steadily = |pace: &Self| pace.steps >= ENOUGH && pace.halts == 0 && pace.jitter < 0.3;
        let pace = rising.find(steadily)?;
        let why = "it increases steadily from row to row".to_string();
        let label = &labels[pace.column];
        Some(Self { column_guess: Some(why), ..pace }.with_unit(label))
    }

    /// The interval from row to row \[s\], where the unit is known and not samples.
    pub(super) fn interval(&self) -> Option<f64> {
        let name = self.unit.name()?;
        let (_, seconds) = UNITS.iter().find(|(unit, _)| *unit == name)?;
        Some(self.step * seconds)
    }

    pub(super) fn counts_samples(&self) -> bool {
        self.unit.name() == Some("sample")
    }

    /// What the steps of a column show; `None` if it does not go on.
    fn of(sample: &Sample, column: usize) -> Option<Self> {
        let steps = |run: &Vec<Vec<f64>>| -> Vec<f64> {
            let mut times = run[column].clone();
            continued(&mut times, None);
            times.windows(2).map(|pair| pair[1] - pair[0]).collect()
        };
        let all: Vec<f64> = sample.runs.iter().flat_map(steps).collect();
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
            column_guess: None,
            unit: PaceUnit::Unknown,
            steps: all.len(),
            step,
            jitter: (sum / even.len() as f64).sqrt(),
            gaps: sorted.iter().filter(|s| **s > GAP * step).count(),
            halts: all.iter().filter(|s| s.is_nan() || **s <= 0.0).count(),
        })
    }

    fn with_unit(self, label: &Label) -> Self {
        let unit = self.judged_unit(label);
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
            // A time in ms at 1 kHz, or in s at 1 Hz, steps by one too.
            return if label.role == Some(Role::Counter) {
                PaceUnit::Guess(
                    "sample",
                    "it increases by one, and its name is that of a counter".into(),
                )
            } else {
                PaceUnit::Unknown
            };
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
