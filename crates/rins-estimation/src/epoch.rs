//! A stretch of samples that is taken as one, and what is known of it.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};

use crate::gains::Gains;

/// The shortest epoch \[s\].
pub(crate) const SHORTEST_EPOCH: f64 = 0.1;

/// A stretch of samples, taken as one.
///
/// Over it `φ`, the attitude error of the reference path, `C~ = (I - φ×) C`, and `v`, the velocity, both in the
/// axis frame, go from `φ`, `v` to `φ + gain_φ`, `v + (φ × F) Δ + gain_v`, but for the Earth's turning of `φ`,
/// which every gain holds too; what is observed are
/// the mean of `φ` over the readings within and the velocity at the end. Every gain has one
/// column of what was read beyond the model, and one a parameter: the derivative by it.
#[derive(Clone, Debug)]
pub(crate) struct Epoch {
    /// The first sample, and the first of the next epoch.
    pub(crate) samples: (usize, usize),
    /// How long \[s\].
    pub(crate) duration: f64,
    /// Whether samples are missing before it, so that nothing is known of φ and v.
    pub(crate) fresh: bool,
    /// Whether it plays no part: time goes by, and nothing is shown.
    pub(crate) left_out: bool,
    pub(crate) gains: Gains,
    pub(crate) turning: Turning,
    /// What is not known of it where samples are missing.
    pub(crate) held: Option<Held>,
    /// The variance of its mean angle for which the encoder's steps are taken \[rad²\].
    pub(crate) rounding: f64,
}

impl Epoch {
    /// How many readings the mean is of.
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

/// What the body does over an epoch, as far as noise is carried by it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Turning {
    /// The integral of `C_b^s` \[s\].
    pub(crate) turned: Matrix3<f64>,
    /// The mean of that over the readings \[s\].
    pub(crate) mean: Matrix3<f64>,
    /// Its integral \[s²\].
    pub(crate) twice: Matrix3<f64>,
}

/// The variances that missing samples add to an epoch, along x, y and z of the axis frame.
///
/// The rates of the sample after a gap are held over it, and the motion went its own way.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Held {
    /// Of attitude at the end \[rad²\].
    pub(crate) angle: Vector3<f64>,
    /// Its covariance with the mean attitude that is shown.
    pub(crate) angle_with_mean: Vector3<f64>,
    /// Of that mean.
    pub(crate) mean_angle: Vector3<f64>,
    /// Of the velocity gained \[m²/s²\].
    pub(crate) velocity: Vector3<f64>,
}
