//! A run to be explained: a recording, and what its readings are compared with.

use std::ops::Range;
use std::sync::Arc;

use rins_frames::{Dcm, Nav, SignedAxes, Table};
use rins_motion::{Recording, Station};

use crate::epoch::SHORTEST_EPOCH;
use crate::rounding::AngleSteps;

/// What tells where the table is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reference {
    /// An encoder: its readings, white noise in each of this 1σ \[rad\].
    Encoder {
        /// 1σ of a reading \[rad\].
        noise: f64,
    },
    /// The commanded rate, which the table follows but for a random walk of its angle.
    Command {
        /// The root density of the servo's rate error \[rad/√s\].
        noise: f64,
    },
    /// Nothing but gravity, on an axis that is tilted: it turns in the plane of rotation.
    Gravity,
    /// The table does not turn.
    Rest,
}

/// How the readings of a fixed base scatter, apart from the sensors' own noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rig {
    /// Where the table stands.
    pub station: Station,
    /// The surveyed attitude of the axis frame.
    pub nav_from_table: Dcm<Nav, Table>,
    /// What tells where the table is.
    pub reference: Reference,
    /// 1σ of the axis' direction at a reading, each of two components \[rad\].
    pub wobble: f64,
    /// How far the velocity of the base may be from zero, 1σ \[m/s\].
    pub velocity: f64,
}

/// A recording on a rig.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The rig.
    pub rig: Rig,
    /// The samples; a copy of the run shares them.
    pub recording: Arc<Recording>,
    /// The samples that play no part in an estimate, apart and in order.
    pub left_out: Vec<Range<usize>>,
    /// Which of several switchings-on it belongs to, if not to one of its own.
    pub turn_on: Option<usize>,
    /// Its axes, of which z is the axis of rotation, as they are picked from the sensors' own.
    pub axes: SignedAxes,
    /// The steps of the encoder, if it is the reference and they are coarse beside its noise.
    pub angle_steps: Option<AngleSteps>,
}

/// A run has so many epochs at least: with fewer, six parameters and the noise cannot be told from each other.
const FEWEST_EPOCHS: f64 = 10.0;

/// Why a run cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// Too few epochs.
    #[error(
        "{duration:.3} s of data are too short for an estimation: {needed:.3} s are needed at this sampling rate"
    )]
    TooShort {
        /// How long it lasts \[s\].
        duration: f64,
        /// How long it must last \[s\].
        needed: f64,
    },
    /// The log has no encoder, which is to be the reference.
    #[error("the reference is the table angle, but the recording has none")]
    NoAngle,
    /// The log has no commanded rate, which is to be the reference.
    #[error("the reference is the commanded rate, but the recording has none")]
    NoRate,
    /// Gravity has no component across the axis.
    #[error(
        "the spin axis is tilted by {tilt} rad, too little to determine the table angle from gravity"
    )]
    NoTilt {
        /// The axis' angle from the vertical \[rad\].
        tilt: f64,
    },
    /// A figure of the rig is not what it must be.
    #[error("{quantity} is {value}; it must be finite and more than zero")]
    Figure {
        /// Which.
        quantity: &'static str,
        /// Its value, in SI units.
        value: f64,
    },
}

impl Run {
    /// A run, if the recording has what the rig refers to.
    ///
    /// # Errors
    /// [`RunError`] if it is too short, lacks the reference, or a figure of the rig is impossible.
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
                /// Below it a milliradian of the angle is less than 17 µg.
                const LEAST_TILT: f64 = 0.017;
                let up = rig.nav_from_table.matrix()[(2, 2)];
                let tilt = up.clamp(-1.0, 1.0).acos();
                if tilt.sin() < LEAST_TILT {
                    return Err(RunError::NoTilt { tilt });
                }
            }
            Reference::Rest => {}
        }
        Ok(Self {
            rig,
            recording,
            left_out: Vec::new(),
            turn_on: None,
            axes: SignedAxes::IDENTITY,
            angle_steps,
        })
    }

    /// The same with these samples left out of what is estimated from: apart and in order.
    ///
    /// The recording keeps them, so that time goes on: an effect that depends on it is the same. An epoch with any
    /// sample left out is left out, and nothing is known of attitude and velocity where the next begins.
    #[must_use]
    pub fn leaving_out(mut self, spans: Vec<Range<usize>>) -> Self {
        self.left_out = spans;
        self
    }

    /// The same as a part of what was recorded without switching off: all runs of the same `turn_on` have their turn-on
    /// biases in common, and the noise of their rig.
    #[must_use]
    pub fn since(mut self, turn_on: usize) -> Self {
        self.turn_on = Some(turn_on);
        self
    }

    /// The same about another of the sensors' axes: axis `i` of the run is `sign[i]` times the sensors' own axis `source[i]`.
    #[must_use]
    pub fn with_axes(mut self, axes: SignedAxes) -> Self {
        self.axes = axes;
        self
    }

    /// Whether the IMU was neither switched off nor mounted about another of its axes between this run and another.
    pub(crate) fn shares_turn_on(&self, other: &Self) -> bool {
        self.turn_on.is_some() && self.turn_on == other.turn_on && self.axes == other.axes
    }
}
