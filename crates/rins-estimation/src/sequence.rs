//! Static intervals of one power cycle in the order of time, and the rotations between them.

use std::sync::Arc;

use nalgebra::Vector3;
use rins_frames::{Body, Dcm};
use rins_motion::Recording;

/// The rotation of an IMU since the static interval before this one.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// The samples from the end of the interval before to the start of this one.
    pub recording: Arc<Recording>,
    /// The angle of the rotation about the body's z axis, if it is known otherwise than from the gyros.
    pub stated: Option<StatedTurn>,
}

/// A known angle of rotation about the body's z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StatedTurn {
    /// The angle \[rad\]. Whole turns count through the gyros.
    pub angle: f64,
    /// 1σ of the angle \[rad\]; zero if it is exact.
    pub sigma: f64,
    /// 1σ of the angle that is read in each of the two static intervals \[rad\]. The reading between two rotations is an error
    /// of both.
    pub mark: f64,
}

/// The place of a static interval among those of its power cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct InSequence {
    /// Its number in the order of time.
    pub number: usize,
    /// The rotation since the one before, if it is known.
    pub turn: Option<Turn>,
}

/// The rotation by the gyros' readings over a recording, minus a constant rate \[rad/s\].
///
/// ```
/// use nalgebra::Vector3;
/// use rins_frames::{Increments, InFrame};
/// use rins_motion::Recording;
/// let sample = Increments { angle: InFrame::new(0.0, 0.0, 0.1), velocity: InFrame::new(0.0, 0.0, 0.098), interval: 0.01 };
/// let times = (1..=10).map(|count| 0.01 * f64::from(count)).collect();
/// let recording = Recording { times, increments: vec![sample; 10], ..Recording::default() };
/// let turned = rins_estimation::rotation(&recording, &Vector3::new(0.0, 0.0, 1.0));
/// assert!((turned.rotation_vector().z - 0.9).abs() < 1e-12);
/// ```
pub fn rotation(recording: &Recording, bias: &Vector3<f64>) -> Dcm<Body, Body> {
    let start = Dcm::<Body, Body>::identity();
    recording.increments.iter().fold(start, |turned, sample| {
        turned * Dcm::from_rotation_vector(&(sample.angle.components() - bias * sample.interval))
    })
}
