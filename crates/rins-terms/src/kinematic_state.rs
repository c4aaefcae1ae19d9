//! What is going on over one sample: the table, the true motion, the surroundings.

use nalgebra::{Complex, Vector3};
use num_dual::Dual64;
use rins_frames::{Dcm, InFrame, Increments, Nav, Table};
use rins_motion::Station;

use crate::track::Track;
use crate::waves::sin_cos;

/// What surrounds a table: the directions in which the Earth turns, pulls and is magnetic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// Where the table stands.
    pub station: Station,
    /// The attitude of the axis frame.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The Earth's rate in the axis frame \[rad/s\].
    pub earth_rate: Vector3<f64>,
    /// The specific force at rest in the axis frame, `-g` \[m/s²\].
    pub specific_force: Vector3<f64>,
    /// The magnetic flux density in the axis frame \[T\].
    pub magnetic_field: Vector3<f64>,
}

impl Surroundings {
    /// The surroundings of a table whose axis frame has this attitude, in the Earth's dipole field.
    pub fn new(station: Station, nav_from_table: Dcm<Nav, Table>) -> Self {
        let table_from_nav = nav_from_table.inverse();
        let in_table = |vector: InFrame<Nav>| *(table_from_nav * vector).components();
        Self {
            station,
            nav_from_table,
            earth_rate: in_table(station.site.earth_rate()),
            specific_force: in_table(-station.gravity_vector()),
            magnetic_field: in_table(dipole_field(station.site.latitude)),
        }
    }

    /// The same with another magnetic field, given in n \[T\].
    #[must_use]
    pub fn with_magnetic_field(mut self, field: &InFrame<Nav>) -> Self {
        self.magnetic_field = *(self.nav_from_table.inverse() * *field).components();
        self
    }
}

/// The field of a dipole along the Earth's axis, strong as the Earth's at the equator \[T\]: within
/// some 20 deg of direction and 30 % of size of what a compass would show.
fn dipole_field(latitude: f64) -> InFrame<Nav> {
    const EQUATORIAL_FIELD: f64 = 3.0e-5;
    let (sin, cos) = latitude.sin_cos();
    InFrame::new(0.0, EQUATORIAL_FIELD * cos, -2.0 * EQUATORIAL_FIELD * sin)
}

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
