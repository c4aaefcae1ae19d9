//! The samples about an epoch, and the epoch linearized at the current estimate.

use std::sync::Arc;

use rins_frames::Increments;
use rins_motion::Recording;
use rins_terms::{Model, Surroundings, Track};

use super::setup::OnlineSetup;
use crate::build::{Build, Compared};
use crate::epoch::{Epoch, Span};
use crate::held::hold;
use crate::run::{Reference, Run};
use crate::smoothing::Differences;

/// The time constants of the smoother on either side of an epoch: beyond them a reading has a weight of less than 0.03 %.
const REACH: f64 = 8.0;

/// The smallest and the largest number of samples on either side of an epoch. The slope of the rate at the ends of an epoch
/// follows from the smallest.
const BESIDE: (f64, f64) = (8.0, 64.0);

/// A sample with the reading of the table at its end \[rad\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Held {
    pub(super) time: f64,
    pub(super) increments: Increments,
    pub(super) reading: f64,
}

/// The samples of an epoch and those beside it, as indices of the samples that are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct EpochSamples {
    /// The first sample after the last gap.
    pub(super) start: usize,
    /// The first sample of the epoch.
    pub(super) first: usize,
    /// The first sample after the epoch.
    pub(super) end: usize,
    /// The end of the samples after the epoch.
    pub(super) last: usize,
}

impl EpochSamples {
    /// Whether the epoch is the first after a gap, or of the run.
    pub(super) const fn is_fresh(self) -> bool {
        self.first == self.start
    }
}

/// The smoother of the table angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Smoother {
    /// Its time constant in samples: the ratio of the standard deviations of a reading and of the gyro's random walk over a
    /// sample. `None` if the readings are used as they are.
    constant: Option<f64>,
    /// The number of samples on either side of an epoch.
    pub(super) beside: usize,
}

impl Smoother {
    pub(super) fn of(setup: &OnlineSetup) -> Self {
        let constant = match setup.rig.reference {
            Reference::Encoder { noise } => {
                let rounding = setup.angle_steps.map_or(0.0, |steps| steps.step / 12_f64.sqrt());
                let walk = setup.noise.gyro.white * setup.interval.sqrt();
                Some((noise.hypot(rounding) / walk).min(BESIDE.1 / REACH))
            }
            _ => None,
        };
        let beside = (REACH * constant.unwrap_or(0.0)).clamp(BESIDE.0, BESIDE.1);
        Self { constant, beside: rins_motion::whole(beside) }
    }

    /// The table angle before the first and at the end of each sample \[rad\], with the errors of the z gyro in `model`.
    fn angles(self, samples: &[Held], model: &Model, earth_rate: f64) -> Vec<f64> {
        let error = model.split().0.gyro;
        let (bias, gain) = (error.bias.z, 1.0 + error.matrix[(2, 2)]);
        let mut angle = 0.0;
        let turns = samples.iter().map(|sample| {
            let Increments { angle: turn, interval, .. } = sample.increments;
            angle += (turn.components().z - bias * interval) / gain - earth_rate * interval;
            angle
        });
        let gyro: Vec<f64> = turns.collect();
        let values: Vec<f64> =
            samples.iter().zip(&gyro).map(|(sample, gyro)| sample.reading - gyro).collect();
        let correction = match self.constant {
            Some(constant) => {
                let linked = (0..values.len()).map(|sample| sample > 0).collect();
                Differences { times: &[], readings: &[], values, linked }.smoothed_over(constant)
            }
            None => values,
        };
        let start = correction.first().copied().unwrap_or_default();
        let ends = gyro.iter().zip(&correction).map(|(gyro, correction)| gyro + correction);
        std::iter::once(start).chain(ends).collect()
    }
}

/// The surroundings and the model at a point of linearization, and the free parameters.
pub(super) struct Point<'a> {
    pub(super) surroundings: Surroundings,
    pub(super) model: &'a Model,
    pub(super) free: &'a [(usize, usize)],
}

/// An epoch, linearized, and the table angle at its end \[rad\]. `before` is the angle at the end of the epoch before, if there is no
/// gap between them.
pub(super) fn epoch(
    (setup, smoother): (&OnlineSetup, Smoother),
    kept: &[Held],
    samples: EpochSamples,
    point: &Point<'_>,
    before: Option<f64>,
) -> (Epoch, f64) {
    let from = samples.start.max(samples.first.saturating_sub(smoother.beside));
    let window = &kept[from..samples.last];
    let (first, end) = (samples.first - from, samples.end - from);
    let recording = Recording {
        times: window.iter().map(|sample| sample.time).collect(),
        increments: window.iter().map(|sample| sample.increments).collect(),
        ..Recording::default()
    };
    let run = Run::unchecked(setup.rig, Arc::new(recording));
    let Point { surroundings, model, free } = *point;
    let mut angles = smoother.angles(window, model, surroundings.earth_rate.z);
    if let Some(before) = before.filter(|_| !samples.is_fresh()) {
        // The window of the epoch before ended earlier, with a slightly different angle.
        angles[first] = before;
    }
    let at_end = angles[end];
    let readings: Vec<f64> = window.iter().map(|sample| sample.reading).collect();
    let intervals = window.iter().map(|sample| sample.increments.interval).collect();
    let track = Track::new(surroundings, run.recording.times.clone(), intervals, angles, None);
    let compared = Compared::new(&run, model, free, Some(&readings), (&track, &track));
    let span = Span { samples: first..end, fresh: samples.is_fresh() };
    let mut starts = track.moments_from([first.saturating_sub(1), first]).into_iter();
    let (Some(piece_before), Some(fine)) = (starts.next(), starts.next()) else {
        unreachable!("a start for each of two samples")
    };
    let mut build = Build::new(&compared, fine, piece_before);
    if first > 0 {
        build.pass_piece();
    }
    let mut epochs = [build.epoch(&span, first + 1..=end)];
    hold(&mut epochs, &run.recording, setup.interval);
    let [mut epoch] = epochs;
    if let Some(steps) = &setup.angle_steps {
        let epochs = setup.duration / (setup.interval * setup.epoch as f64);
        epoch.rounding = steps.rounding(epochs, &track.angles()[first + 1..=end]);
    }
    (epoch, at_end)
}
