//! A run for the estimation: a recording with the reference of its readings.

use std::ops::Range;
use std::sync::Arc;

use rins_frames::{Dcm, Nav, SignedAxes, Table};
use rins_motion::{Recording, Station};

use crate::epoch::SHORTEST_EPOCH;
use crate::rounding::AngleSteps;
use crate::sequence::InSequence;

/// The smallest tilt of the spin axis (its sine) for which gravity determines the table angle: below it, an angle of a milliradian
/// changes the specific force by less than 17 µg.
pub const LEAST_TILT: f64 = 0.017;

/// The source of the table angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reference {
    /// An encoder with white noise in its readings.
    Encoder {
        /// 1σ of a reading \[rad\].
        noise: f64,
    },
    /// The commanded rate, which the table follows with a random walk of its angle.
    Command {
        /// The density of the random walk of the servo's angle \[rad/√s\].
        noise: f64,
    },
    /// Gravity on a tilted axis, whose direction rotates in the body.
    Gravity,
    /// The table is static.
    Rest,
}

/// The site, the axis and the reference of a run, and the noise of a fixed base apart from that of the sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rig {
    /// The site of the table.
    pub station: Station,
    /// The surveyed attitude of the axis frame.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The source of the table angle.
    pub reference: Reference,
    /// Wobble: 1σ of the direction of the spin axis in one reading, for each of two components \[rad\].
    pub wobble: f64,
    /// 1σ of the velocity of the base; its mean is zero \[m/s\].
    pub velocity: f64,
}

impl Reference {
    /// Whether the angle about the axis is measured.
    pub(crate) fn shows_angle(self) -> bool {
        self != Self::Gravity
    }
}

/// A recording with its rig.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The rig.
    pub rig: Rig,
    /// The samples; copies of the run share them.
    pub recording: Arc<Recording>,
    /// The samples that are excluded from the estimate: disjoint spans in order.
    pub left_out: Vec<Range<usize>>,
    /// The power cycle that the run belongs to, or `None` if it has its own.
    pub turn_on: Option<usize>,
    /// The place of a static interval among those of its power cycle.
    pub in_sequence: Option<InSequence>,
    /// The axes of the run, whose z is the spin axis, relative to the sensors' own axes.
    pub axes: SignedAxes,
    /// The quantization of the encoder, if it is the reference and its LSB is large compared with its noise.
    pub angle_steps: Option<AngleSteps>,
    /// The number of samples in an epoch, if it does not follow from the duration of the run.
    pub epoch: Option<usize>,
}

/// The smallest number of epochs in a run: with fewer, six parameters and the noise are not distinguishable.
const FEWEST_EPOCHS: f64 = 10.0;

/// The reason why a run cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// Too few epochs.
    #[error(
        "{duration:.3} s of data are too short for an estimation: {needed:.3} s are needed at this sampling rate"
    )]
    TooShort {
        /// The duration \[s\].
        duration: f64,
        /// The required duration \[s\].
        needed: f64,
    },
    /// The reference is the table angle, which the log does not have.
    #[error("the reference is the table angle, but the recording has none")]
    NoAngle,
    /// The reference is the commanded rate, which the log does not have.
    #[error("the reference is the commanded rate, but the recording has none")]
    NoRate,
    /// Gravity has no component perpendicular to the axis.
    #[error(
        "the spin axis is tilted by {:.2} deg, too little to determine the table angle from gravity",
        tilt.to_degrees()
    )]
    NoTilt {
        /// The angle of the axis from the vertical \[rad\].
        tilt: f64,
    },
    /// A quantity of the rig is not finite and positive.
    #[error("{quantity} is {value}; it must be finite and more than zero")]
    Figure {
        /// The quantity.
        quantity: &'static str,
        /// Its value, in SI units.
        value: f64,
    },
}

impl Run {
    /// A run with this recording and this rig, if the recording has the reference of the rig.
    ///
    /// # Errors
    /// [`RunError`] if the recording is too short or lacks the reference, or a value of the rig is invalid.
    pub fn new(rig: Rig, recording: impl Into<Arc<Recording>>) -> Result<Self, RunError> {
        let recording = recording.into();
        let duration: f64 = recording.increments.iter().map(|sample| sample.interval).sum();
        let interval = duration / recording.len().max(1) as f64;
        let needed = FEWEST_EPOCHS * SHORTEST_EPOCH.max(interval);
        if recording.len() < 2 || duration < needed * (1.0 - 1e-9) {
            return Err(RunError::TooShort { duration, needed });
        }
        let positive = |quantity, value: f64| {
            let fine = value.is_finite() && value > 0.0;
            if fine { Ok(()) } else { Err(RunError::Figure { quantity, value }) }
        };
        positive("the wobble of the spin axis", rig.wobble)?;
        positive("the velocity noise of the base", rig.velocity)?;
        let mut angle_steps = None;
        match rig.reference {
            Reference::Encoder { noise } => {
                positive("the noise of the encoder", noise)?;
                if recording.table_angle.is_none() {
                    return Err(RunError::NoAngle);
                }
                angle_steps = AngleSteps::of(&recording, noise, None);
            }
            Reference::Command { noise } => {
                if !(noise.is_finite() && noise >= 0.0) {
                    return Err(RunError::Figure { quantity: "the servo's noise", value: noise });
                }
                if recording.table_rate.is_none() {
                    return Err(RunError::NoRate);
                }
            }
            Reference::Gravity => {
                let up = rig.nav_from_table.matrix()[(2, 2)];
                let tilt = up.clamp(-1.0, 1.0).acos();
                if tilt.sin() < LEAST_TILT {
                    return Err(RunError::NoTilt { tilt });
                }
            }
            Reference::Rest => {}
        }
        Ok(Self { angle_steps, ..Self::unchecked(rig, recording) })
    }

    /// A run, or a part of one around an epoch, without any check.
    pub(crate) fn unchecked(rig: Rig, recording: Arc<Recording>) -> Self {
        Self {
            rig,
            recording,
            left_out: Vec::new(),
            turn_on: None,
            in_sequence: None,
            axes: SignedAxes::IDENTITY,
            angle_steps: None,
            epoch: None,
        }
    }

    /// The same run with these samples excluded from the estimate: disjoint spans in order.
    ///
    /// The recording keeps them, so that effects which depend on time do not change. An epoch that contains an excluded
    /// sample is excluded, and attitude and velocity are unknown at the start of the next.
    #[must_use]
    pub fn leaving_out(mut self, spans: Vec<Range<usize>>) -> Self {
        self.left_out = spans;
        self
    }

    /// The same run in epochs of this number of samples: successive samples that are processed as one update. By default
    /// the duration of an epoch follows from that of the run.
    #[must_use]
    pub fn in_epochs_of(mut self, samples: usize) -> Self {
        self.epoch = Some(samples.max(1));
        self
    }

    /// The same run as part of one power cycle: all runs of the same `turn_on` share their turn-on biases and the noise of
    /// their rig.
    #[must_use]
    pub fn since(mut self, turn_on: usize) -> Self {
        self.turn_on = Some(turn_on);
        self
    }

    /// The same run with its place among the static intervals of its power cycle, and the rotation since the one before.
    #[must_use]
    pub fn in_sequence(mut self, place: InSequence) -> Self {
        self.in_sequence = Some(place);
        self
    }

    /// The same run about another of the sensors' axes: axis `i` of the run is `sign[i]` times the sensors' own axis
    /// `source[i]`.
    #[must_use]
    pub fn with_axes(mut self, axes: SignedAxes) -> Self {
        self.axes = axes;
        self
    }

    /// Whether there was no power cycle between this run and another.
    pub(crate) fn shares_power(&self, other: &Self) -> bool {
        self.turn_on.is_some() && self.turn_on == other.turn_on
    }

    /// Whether there was neither a power cycle nor a change of mounting of the IMU between this run and another.
    pub(crate) fn shares_turn_on(&self, other: &Self) -> bool {
        self.shares_power(other) && self.axes == other.axes
    }
}
