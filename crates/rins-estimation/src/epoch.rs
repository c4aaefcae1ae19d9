//! An epoch: successive samples that are processed as one update.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};

use crate::gains::Gains;

/// The shortest epoch \[s\].
pub(crate) const SHORTEST_EPOCH: f64 = 0.1;

/// The longest epoch of a table that turns \[s\] ...
const LONGEST_EPOCH: f64 = 0.5;

/// ... in a run of at most this number of them: those of a run of a day last two seconds.
const MOST_EPOCHS: f64 = 40_000.0;

/// The duration of an epoch of a run of this duration \[s\]: a thousandth of it, within limits. Of a static run no signal changes faster.
pub(crate) fn epoch_of(run: f64, is_static: bool) -> f64 {
    let longest = if is_static { f64::INFINITY } else { LONGEST_EPOCH.max(run / MOST_EPOCHS) };
    (run / 1000.0).clamp(SHORTEST_EPOCH, longest)
}

/// Successive samples that are processed as one update.
///
/// `φ` is the attitude error of the reference trajectory, `C~ = (I - φ×) C`, and `v` the velocity error, both in the axis
/// frame. Over the epoch they change to `φ + gain_φ` and `v + (φ × F) Δ + gain_v`, apart from the rotation of `φ` by the
/// Earth's rate, which every gain includes. The measurements are the mean of `φ` over the readings of the epoch and the
/// velocity at its end. Every gain has a column for the residuals of the readings and a column for each parameter: the
/// derivative by that parameter.
#[derive(Clone, Debug)]
pub(crate) struct Epoch {
    /// The first sample, and the first of the next epoch.
    pub(crate) samples: (usize, usize),
    /// The duration \[s\].
    pub(crate) duration: f64,
    /// The rotation of the table \[rad\].
    pub(crate) rotation: f64,
    /// Whether samples are missing before the epoch, so that φ and v are unknown at its start.
    pub(crate) fresh: bool,
    /// Whether the epoch is excluded from the estimate: time passes without an update.
    pub(crate) left_out: bool,
    pub(crate) gains: Gains,
    pub(crate) turning: Turning,
    /// The uncertainty due to missing samples.
    pub(crate) held: Option<Held>,
    /// The variance of the mean angle that accounts for the encoder's quantization \[rad²\].
    pub(crate) rounding: f64,
}

impl Epoch {
    /// The number of readings in the mean.
    pub(crate) fn count(&self) -> f64 {
        (self.samples.1 - self.samples.0) as f64
    }
}

/// The samples of an epoch.
pub(crate) struct Span {
    pub(crate) samples: Range<usize>,
    /// Whether samples are missing before it.
    pub(crate) fresh: bool,
}

/// Integrals of the attitude of the body over an epoch, which propagate noise.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Turning {
    /// The integral of `C_b^s` \[s\].
    pub(crate) turned: Matrix3<f64>,
    /// The mean of this integral over the readings \[s\].
    pub(crate) mean: Matrix3<f64>,
    /// The integral of this integral \[s²\].
    pub(crate) twice: Matrix3<f64>,
}

/// The variances that missing samples add to an epoch, along x, y and z of the axis frame.
///
/// The rates of the sample after a gap are assumed over the whole gap; the actual motion differs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Held {
    /// The variance of the attitude at the end \[rad²\].
    pub(crate) angle: Vector3<f64>,
    /// Its covariance with the measured mean attitude.
    pub(crate) angle_with_mean: Vector3<f64>,
    /// The variance of that mean.
    pub(crate) mean_angle: Vector3<f64>,
    /// The variance of the velocity increment \[m²/s²\].
    pub(crate) velocity: Vector3<f64>,
}
