//! What an online filter knows before the first sample, and what it refuses.

use rins_imu::ImuSpec;
use rins_motion::whole;
use rins_terms::{Model, Term, catalogue};

use crate::epoch::{SHORTEST_EPOCH, epoch_of};
use crate::evidence::Indefinite;
use crate::fit_error::FitError;
use crate::noise_parameters::NoiseParameters;
use crate::rounding::AngleSteps;
use crate::run::{Reference, Rig};

/// The duration of a run unless another is stated \[s\].
const DURATION: f64 = 3600.0;

/// The terms that depend only on the motion within an epoch.
static SUPPORTED: [&Term; 10] = [
    &catalogue::GYRO_BIAS,
    &catalogue::GYRO_SCALE,
    &catalogue::GYRO_MISALIGNMENT,
    &catalogue::ACCEL_BIAS,
    &catalogue::ACCEL_SCALE,
    &catalogue::ACCEL_MISALIGNMENT,
    &catalogue::AXIS_ATTITUDE,
    &catalogue::AXIS_AZIMUTH,
    &catalogue::GYRO_G_SENSITIVITY,
    &catalogue::ACCEL_LEVER_ARM,
];

/// The knowledge of an [`OnlineFilter`](crate::OnlineFilter) before the first sample.
#[derive(Clone, Debug, PartialEq)]
pub struct OnlineSetup {
    /// The site, the axis and the reference: an encoder or a commanded rate.
    pub rig: Rig,
    /// The model; its values are the means of the priors.
    pub model: Model,
    /// The data sheet, which gives the sigmas of the priors.
    pub imu: ImuSpec,
    /// The noise parameters, which are not estimated.
    pub noise: NoiseParameters,
    /// The quantization of the encoder, if its LSB is large compared with its noise.
    pub angle_steps: Option<AngleSteps>,
    /// The nominal interval of a sample \[s\].
    pub interval: f64,
    /// The number of samples in an epoch.
    pub epoch: usize,
    /// The expected duration of the run \[s\]. Bias instability slower than four times this duration is a constant bias.
    pub duration: f64,
}

impl OnlineSetup {
    /// A setup with the data sheet's noise, epochs of 0.1 s and an expected duration of an hour; `interval` is that of a
    /// sample \[s\].
    pub fn new(rig: Rig, model: Model, imu: ImuSpec, interval: f64) -> Self {
        let noise = NoiseParameters::of(&imu).with(&model);
        let epoch = if interval > 0.0 { whole(SHORTEST_EPOCH / interval) } else { 1 };
        let duration = DURATION;
        Self { rig, model, imu, noise, angle_steps: None, interval, epoch, duration }
    }

    /// The same for a run of this duration \[s\], with the epochs of a finished run of it.
    #[must_use]
    pub fn lasting(self, duration: f64) -> Self {
        Self { duration, epoch: whole(epoch_of(duration, false) / self.interval), ..self }
    }

    /// Refuses what the filter does not support.
    pub(super) fn refuse(&self) -> Result<(), OnlineError> {
        let positive = |quantity, value: f64| {
            let fine = value.is_finite() && value > 0.0;
            if fine { Ok(()) } else { Err(OnlineError::Figure { quantity, value }) }
        };
        positive("the interval of a sample", self.interval)?;
        positive("the number of samples in an epoch", self.epoch as f64)?;
        positive("the expected duration", self.duration)?;
        positive("the wobble of the spin axis", self.rig.wobble)?;
        positive("the velocity noise of the base", self.rig.velocity)?;
        positive("the noise density of the gyros", self.noise.gyro.white)?;
        positive("the noise density of the accelerometers", self.noise.accel.white)?;
        match self.rig.reference {
            Reference::Encoder { noise } => positive("the noise of the encoder", noise)?,
            Reference::Command { noise } if noise.is_finite() && noise >= 0.0 => {}
            Reference::Command { noise } => {
                return Err(OnlineError::Figure { quantity: "the servo's noise", value: noise });
            }
            Reference::Gravity | Reference::Rest => return Err(OnlineError::NoReference),
        }
        let is_supported = |term: &Term| SUPPORTED.iter().any(|supported| supported.is(term));
        let mut others = self.model.terms.iter().filter(|chosen| !is_supported(chosen.term));
        match others.next() {
            Some(other) => Err(OnlineError::Term { id: other.term.id }),
            None => Ok(()),
        }
    }
}

/// The reason why an online filter refuses its setup, a sample or a checkpoint.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OnlineError {
    /// The model cannot be estimated.
    #[error(transparent)]
    Model(#[from] FitError),
    /// The means of the priors cannot be compensated.
    #[error(transparent)]
    Compensation(#[from] rins_imu::ImuCompensationError),
    /// A quantity is not finite and positive.
    #[error("{quantity} is {value}; it must be finite and more than zero")]
    Figure {
        /// The quantity.
        quantity: &'static str,
        /// Its value, in SI units.
        value: f64,
    },
    /// There is neither a table angle nor a table rate.
    #[error("online estimation needs a table angle or a table rate in every sample")]
    NoReference,
    /// The effect of a term depends on the motion before the epoch.
    #[error(
        "online estimation does not support {id}, whose effect depends on the history of the run: remove it from the model, \
         or estimate it from the finished run"
    )]
    Term {
        /// The id of the term.
        id: &'static str,
    },
    /// A sample lacks the reading of the reference.
    #[error("the sample at {time} s has no reading of the table")]
    NoReading {
        /// The time \[s\].
        time: f64,
    },
    /// A number of a sample is not finite, or its interval is not positive.
    #[error(
        "the sample at {time} s has a number that is not finite, or an interval of {interval} s"
    )]
    NotFinite {
        /// The time \[s\].
        time: f64,
        /// Its interval \[s\].
        interval: f64,
    },
    /// The time does not increase.
    #[error("the time does not increase: {now} s after {before} s")]
    TimeNotIncreasing {
        /// The time of the sample before \[s\].
        before: f64,
        /// The time of the sample \[s\].
        now: f64,
    },
    /// The filter failed; it must not be used further.
    #[error(transparent)]
    Indefinite(#[from] Indefinite),
    /// A checkpoint is not one of this version of the filter, or is damaged.
    #[error("the checkpoint is not valid: {what}")]
    Checkpoint {
        /// What is wrong.
        what: String,
    },
}
