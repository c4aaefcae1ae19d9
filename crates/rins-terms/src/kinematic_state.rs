//! The table and the true motion over one sample.

use nalgebra::{Complex, Vector3};
use num_dual::Dual64;
use rins_frames::Increments;

use crate::surroundings::Surroundings;
use crate::track::Track;
use crate::waves::sin_cos;

/// The table at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Instant {
    /// Since the run's first sample began \[s\].
    pub time: f64,
    /// The table angle, unwrapped \[rad\].
    pub angle: f64,
    /// Its rate \[rad/s\].
    pub rate: f64,
    /// Its acceleration, over the sample \[rad/s²\].
    pub acceleration: f64,
    /// The way the table turned last: 1, -1, or 0 before it ever turned; the mean of both while it turns round.
    pub sense: f64,
    /// The way its rate changed last: 1, -1, or 0 before it ever changed.
    pub rate_change: f64,
    /// Its temperature \[°C\], if it is known.
    pub temperature: Option<f64>,
    /// How fast that changes, over five seconds on either side \[K/s\].
    pub warming_rate: f64,
}

impl Instant {
    /// How far the temperature is above `reference`, both in °C \[K\]; zero where it is not known.
    pub fn above(&self, reference: f64) -> f64 {
        self.temperature.map_or(0.0, |temperature| temperature - reference)
    }
}

/// What is going on over one sample.
///
/// Gyros and accelerometers are described by means over the sample, `mean`; what is read at an instant, an
/// encoder and the direction of the axis, is read at its `end`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KinematicState<'a> {
    /// Which of its track's samples this is.
    pub sample: usize,
    /// The length of the sample's interval \[s\].
    pub interval: f64,
    /// How long the run is \[s\].
    pub duration: f64,
    /// The table in the middle of the interval; its angle, its rate and its acceleration are the means over it.
    pub mean: Instant,
    /// The table at the end of the interval.
    pub end: Instant,
    /// The mean of the true angular rate `ω_ib^b` \[rad/s\].
    pub rate: Vector3<f64>,
    /// The mean of the true specific force `f^b` \[m/s²\].
    pub force: Vector3<f64>,
    /// What surrounds the table.
    pub surroundings: Surroundings,
    /// The whole motion, if it is known: [`sample`](Self::sample) is one of its samples.
    pub track: Option<&'a Track>,
}

impl KinematicState<'_> {
    /// The same with the rate and force that a perfect IMU measures as `felt`.
    #[must_use]
    pub fn feeling(&self, felt: &Increments) -> Self {
        let rates = felt.rates();
        Self {
            rate: *rates.angular_rate.components(),
            force: *rates.specific_force.components(),
            ..*self
        }
    }

    /// Rotation of the table during `time` before an instant of the sample \[rad\], or after it if the time is negative.
    ///
    /// If the track is not known, with the acceleration of the sample.
    pub(crate) fn turned_before(&self, instant: &Instant, time: Dual64) -> Dual64 {
        let Some(track) = self.track else {
            return time * instant.rate - time * time * (0.5 * instant.acceleration);
        };
        let (angle, _) = track.at(instant.time, self.sample);
        let (earlier, rate) = track.at(instant.time - time.re, self.sample);
        Dual64::new(angle - earlier, rate * time.eps)
    }

    /// The table angle in the middle of the way \[rad\]: about it the table turns as much before as after.
    pub fn middle_angle(&self) -> f64 {
        self.end.angle - 0.5 * self.mean.rate * self.interval
    }

    /// A vector of the axis frame in body axes, at the mean angle of the interval.
    pub fn in_body(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        turned_back(vector, sin_cos(self.mean.angle))
    }

    /// `exp(iζ)` of the mean angle of the interval.
    pub(crate) fn exp_angle(&self) -> Complex<f64> {
        let (sin, cos) = sin_cos(self.mean.angle);
        Complex::new(cos, sin)
    }

    /// The share of the interval that lies after `time` \[s\], between 0 and 1.
    pub fn share_after(&self, time: f64) -> f64 {
        ((self.mean.time - time) / self.interval + 0.5).clamp(0.0, 1.0)
    }

    /// How fast the true angular rate changes in body axes \[rad/s²\].
    pub fn rate_derivative(&self) -> Vector3<f64> {
        let w = self.mean.rate;
        Vector3::new(self.rate.y * w, -self.rate.x * w, self.mean.acceleration)
    }

    /// How fast the true specific force changes in body axes \[m/s³\].
    pub fn force_derivative(&self) -> Vector3<f64> {
        let w = self.mean.rate;
        Vector3::new(self.force.y * w, -self.force.x * w, 0.0)
    }

    /// The magnetic flux density in body axes \[T\].
    pub fn magnetic_field(&self) -> Vector3<f64> {
        self.in_body(&self.surroundings.magnetic_field)
    }
}

/// A vector of the axis frame in axes that are turned about z, by the angle whose sine and cosine are given.
pub(crate) fn turned_back(vector: &Vector3<f64>, (sin, cos): (f64, f64)) -> Vector3<f64> {
    Vector3::new(vector.x * cos + vector.y * sin, vector.y * cos - vector.x * sin, vector.z)
}
