//! Linearization of a run: the dependence of each epoch's measurements on attitude, velocity and the parameters.

use std::ops::Range;

use nalgebra::Vector3;
use rayon::prelude::*;
use rins_frames::{Dcm, InFrame, Nav, Table};
use rins_motion::whole;
use rins_terms::{Model, SettingKind, Surroundings, Track, catalogue};

use crate::build::{Build, Compared};
use crate::epoch::{Epoch, Span, epoch_of};
use crate::held::hold;
use crate::latency::without_latency;
use crate::path;
use crate::run::{Reference, Run};
use crate::step::SHOWN;

/// The largest rotation of the table in a piece of an epoch \[rad\].
const TURN_OF_PIECE: f64 = 0.04;

/// The rotation within a sample below which the table counts as static \[rad\].
const LEAST_TURN: f64 = 1e-6;

/// The smallest number of pieces of an epoch.
const FEWEST_PIECES: usize = 4;

/// The number of epochs that a thread constructs in one task.
const EPOCHS_AT_A_TIME: usize = 64;

/// A run, linearized with respect to the free parameters of a model.
#[derive(Clone, Debug)]
pub struct Linear {
    pub(crate) epochs: Vec<Epoch>,
    /// The specific force in the axis frame \[m/s²\].
    pub(crate) force: Vector3<f64>,
    /// The Earth's rate in the axis frame \[rad/s\].
    pub(crate) earth_rate: Vector3<f64>,
    /// The number of free parameters.
    pub(crate) parameters: usize,
    pub(crate) reference: Reference,
    /// The logarithm of the volume of an epoch's readings per volume of its residuals.
    pub(crate) ln_volume: f64,
    /// The power cycle that the run belongs to, or `None` if it has its own.
    pub(crate) turn_on: Option<usize>,
    /// Whether the rotation since another run is known.
    pub(crate) follows_turn: bool,
    /// The trajectory of the table at which the run is linearized.
    pub(crate) track: Track,
}

/// The surroundings corrected by the errors of axis attitude and azimuth in `model`, and the model without these errors.
///
/// These errors are not small enough to neglect their squares and are applied exactly: an attitude error affects the gyros
/// through the actual Earth's rate, not through the assumed one.
pub(crate) fn with_attitude(run: &Run, model: &Model) -> (Surroundings, Model) {
    let mut rest = model.clone();
    let mut nav_from_table = run.rig.nav_from_table;
    let mut horizontal = InFrame::<Nav>::new(0.0, 0.0, 0.0);
    for chosen in &mut rest.terms {
        if chosen.term.is(&catalogue::AXIS_ATTITUDE) {
            let tilt = InFrame::<Table>::new(chosen.values[0], chosen.values[1], chosen.values[2]);
            nav_from_table =
                nav_from_table * Dcm::<Table, Table>::from_rotation_vector(tilt.components());
            chosen.values.fill(0.0);
        }
        if chosen.term.is(&catalogue::AXIS_AZIMUTH) {
            horizontal = InFrame::new(chosen.values[1], chosen.values[0], 0.0);
            chosen.values.fill(0.0);
        }
    }
    let mut surroundings = Surroundings::new(run.rig.station, nav_from_table);
    surroundings.earth_rate += (nav_from_table.inverse() * horizontal).components();
    (surroundings, rest)
}

/// The resolution of the derivatives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pieces {
    /// One derivative for each sample.
    Samples,
    /// One derivative for several samples in which the table hardly rotates.
    Coarse,
}

/// Linearizes a run at the parameter values of `model`.
///
/// `free` lists the free parameters, each as term and place within it.
pub fn linearise(run: &Run, model: &Model, free: &[(usize, usize)]) -> Linear {
    linearised(run, model, free, Pieces::Samples)
}

/// The same with coarse derivatives, for the comparison of many parameters. The residuals are as exact; the derivatives are
/// calculated over pieces in which the table rotates by about 2 deg at most, which biases a harmonic order `n` of its angle
/// by less than `(0.02 n)²/6`.
pub fn linearise_coarsely(run: &Run, model: &Model, free: &[(usize, usize)]) -> Linear {
    linearised(run, model, free, Pieces::Coarse)
}

/// Linearizes a run with this resolution of the derivatives.
pub(crate) fn linearised(
    run: &Run,
    model: &Model,
    free: &[(usize, usize)],
    pieces: Pieces,
) -> Linear {
    let (surroundings, model) = with_attitude(run, model);
    let moved = without_latency(run, &model);
    let (run, model) = moved.as_ref().map_or((run, &model), |(run, model)| (run, model));
    let recording = &run.recording;
    let duration = recording.times[recording.len() - 1] - recording.times[0];
    let is_static = matches!(run.rig.reference, Reference::Rest);
    let interval = duration / (recording.len() - 1) as f64;
    let block = run.epoch.unwrap_or_else(|| whole(epoch_of(duration, is_static) / interval));
    let track = path::track(run, surroundings, model, block);
    let readings = path::readings(run);
    let spans = spans(run, block);
    let piece = match pieces {
        Pieces::Samples => 1,
        Pieces::Coarse => {
            let turned = track.angles().windows(2).map(|pair| (pair[1] - pair[0]).abs());
            let most = turned.fold(LEAST_TURN, f64::max);
            whole(TURN_OF_PIECE / most).min(block.div_ceil(FEWEST_PIECES))
        }
    };
    let events = if piece > 1 { events(model, &track) } else { Vec::new() };
    let cut = |span: &Span| cut(&span.samples, piece, &events);
    let ends: Vec<usize> = spans.iter().flat_map(cut).collect();
    let coarse = (piece > 1).then(|| track.thinned(&ends));
    let pieces = coarse.as_ref().unwrap_or(&track);
    let compared = Compared::new(run, model, free, readings.as_deref(), (&track, pieces));
    let stretches: Vec<&[Span]> = spans.chunks(EPOCHS_AT_A_TIME).collect();
    let firsts: Vec<usize> = stretches.iter().map(|spans| spans[0].samples.start).collect();
    // A group of epochs begins with the piece before it, which determines the previous error of the readings.
    let before =
        firsts.iter().map(|first| ends.partition_point(|end| end <= first).saturating_sub(1));
    let starts = track.moments_from(firsts.iter().copied()).into_iter();
    let starts: Vec<_> = starts.zip(pieces.moments_from(before)).collect();
    let made = stretches.into_par_iter().zip(starts).enumerate().map(
        |(index, (spans, (fine, pieces)))| {
            let mut build = Build::new(&compared, fine, pieces);
            if index > 0 {
                build.pass_piece();
            }
            spans.iter().map(|span| build.epoch(span, cut(span).into_iter())).collect()
        },
    );
    let mut epochs = made.collect::<Vec<Vec<Epoch>>>().into_iter().flatten().collect::<Vec<_>>();
    hold(&mut epochs, recording, recording.mean_interval());
    if let Some(steps) = &run.angle_steps {
        steps.tell(&mut epochs, &track);
    }
    leave_out(&mut epochs, &run.left_out);
    Linear {
        epochs,
        force: surroundings.specific_force,
        earth_rate: surroundings.earth_rate,
        parameters: free.len(),
        reference: run.rig.reference,
        ln_volume: compared.ln_volume(),
        turn_on: run.turn_on,
        follows_turn: run.in_sequence.as_ref().is_some_and(|place| place.turn.is_some()),
        track,
    }
}

/// The samples of all epochs: `block` samples each, with a new epoch after every gap.
fn spans(run: &Run, block: usize) -> Vec<Span> {
    let epochs = |whole: Range<usize>| {
        whole.clone().step_by(block).map(move |first| Span {
            samples: first..whole.end.min(first + block),
            fresh: first == whole.start,
        })
    };
    run.recording.between_gaps().flat_map(epochs).collect()
}

/// The ends of pieces of `piece` samples, with a piece of one sample at every event.
fn cut(samples: &Range<usize>, piece: usize, events: &[usize]) -> Vec<usize> {
    let end = samples.end;
    let mut ends: Vec<usize> =
        samples.clone().step_by(piece).map(|first| end.min(first + piece)).collect();
    let first = events.partition_point(|event| *event < samples.start);
    let within = events[first..].iter().take_while(|event| **event < end);
    ends.extend(within.flat_map(|&event| [event, event + 1]));
    ends.retain(|one| *one > samples.start);
    ends.sort_unstable();
    ends.dedup();
    ends
}

/// The samples in which the events of a model occur.
fn events(model: &Model, track: &Track) -> Vec<usize> {
    let times = model.terms.iter().filter_map(|chosen| chosen.setting(SettingKind::Time));
    let sample = |time: f64| track.times().partition_point(|end| end - track.start() < time);
    let mut events: Vec<usize> = times.map(sample).collect();
    events.sort_unstable();
    events.dedup();
    events
}

/// Marks the epochs that contain any of these samples as excluded.
fn leave_out(epochs: &mut [Epoch], spans: &[Range<usize>]) {
    for epoch in epochs {
        let (first, end) = epoch.samples;
        epoch.left_out = spans.iter().any(|span| span.start < end && first < span.end);
    }
}

impl Linear {
    /// The same with no epochs excluded.
    #[must_use]
    pub fn with_all(mut self) -> Self {
        leave_out(&mut self.epochs, &[]);
        self
    }

    /// The number of epochs.
    pub fn epochs(&self) -> usize {
        self.epochs.len()
    }

    /// The trajectory of the table at which the run is linearized.
    pub fn track(&self) -> &Track {
        &self.track
    }

    /// The samples of each epoch.
    pub fn samples(&self) -> impl Iterator<Item = Range<usize>> {
        self.epochs.iter().map(|epoch| epoch.samples.0..epoch.samples.1)
    }

    /// The end of each epoch \[s\].
    pub fn ends(&self) -> Vec<f64> {
        let times = self.track.times();
        self.epochs.iter().map(|epoch| times[epoch.samples.1 - 1]).collect()
    }

    /// Whether navigation is initialized at an epoch: at the start of a run, after a gap, or after an excluded epoch.
    pub(crate) fn starts_anew(&self, epoch: usize) -> bool {
        self.epochs[epoch].fresh || (epoch > 0 && self.epochs[epoch - 1].left_out)
    }

    /// Whether the angle about the axis is measured.
    pub(crate) fn shows_angle(&self) -> bool {
        self.reference.shows_angle()
    }

    /// The number of measurements in an epoch.
    pub fn shown(&self) -> usize {
        if self.shows_angle() { SHOWN } else { SHOWN - 1 }
    }

    /// The rotation of the table in an epoch \[rad\].
    pub(crate) fn turned(&self, epoch: &Epoch) -> f64 {
        let angles = self.track.angles();
        angles[epoch.samples.1] - angles[epoch.samples.0]
    }

    /// The table angle in the middle of each epoch \[rad\], and its mean rate over it \[rad/s\].
    pub fn motion(&self) -> Vec<(f64, f64)> {
        let angles = self.track.angles();
        let of = |epoch: &Epoch| {
            let middle = 0.5 * (angles[epoch.samples.0] + angles[epoch.samples.1]);
            (middle, self.turned(epoch) / epoch.duration)
        };
        self.epochs.iter().map(of).collect()
    }

    /// The same with additional parameters: for each of `parameters` one that acts only in the epochs of group 1, and so on
    /// up to group `last`.
    ///
    /// # Panics
    /// If there is not one group for every epoch.
    #[must_use]
    pub fn in_groups(&self, parameters: &[usize], groups: &[usize], last: usize) -> Self {
        assert_eq!(groups.len(), self.epochs.len(), "a group for every epoch");
        let mut apart = self.clone();
        for (epoch, &group) in apart.epochs.iter_mut().zip(groups) {
            let of = |group_of: usize| {
                parameters.iter().map(move |&one| (group_of == group).then_some(one + 1))
            };
            let more: Vec<Option<usize>> = (1..=last).flat_map(of).collect();
            epoch.gains = epoch.gains.with(&more);
        }
        apart.parameters += parameters.len() * last;
        apart
    }

    /// The mean duration of an epoch \[s\].
    pub fn mean_epoch(&self) -> f64 {
        let total: f64 = self.epochs.iter().map(|epoch| epoch.duration).sum();
        total / self.epochs.len() as f64
    }

    /// The total duration of the samples \[s\].
    pub(crate) fn duration(&self) -> f64 {
        self.epochs.iter().map(|epoch| epoch.duration).sum()
    }
}
