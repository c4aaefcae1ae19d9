//! Motion on the rotating Earth: an attitude as a quaternion, and the true means of rate and specific force over samples.

use nalgebra::{UnitQuaternion, Vector3};

/// The largest step of the integration \[s\].
const STEP: f64 = 1e-3;

/// The Earth's rate \[rad/s\].
const EARTH_RATE: f64 = 7.292115e-5;

/// The site: latitude \[rad\] and height \[m\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    pub(crate) latitude: f64,
    pub(crate) height: f64,
}

impl Site {
    /// The rate of the Earth, east, north and up.
    pub(crate) fn earth_rate(&self) -> Vector3<f64> {
        Vector3::new(0.0, self.latitude.cos(), self.latitude.sin()) * EARTH_RATE
    }

    /// Normal gravity of WGS84: Somigliana's formula and its series in height.
    pub(crate) fn gravity(&self) -> f64 {
        let square = self.latitude.sin().powi(2);
        let surface = 9.7803253359 * (1.0 + 0.00193185265241 * square)
            / (1.0 - 0.00669437999013 * square).sqrt();
        let (a, flattening, m) = (6378137.0, 1.0 / 298.257223563, 0.00344978650684);
        let ratio = self.height / a;
        let slope = 2.0 * (1.0 + flattening + m - 2.0 * flattening * square);
        surface * (1.0 - slope * ratio + 3.0 * ratio * ratio)
    }
}

/// A rotation about an axis fixed in the body, relative to the Earth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    pub(crate) duration: f64,
    pub(crate) axis: Vector3<f64>,
    pub(crate) rate: Rate,
    /// An acceleration in the navigation frame that begins and ends at standstill, its amplitude \[m/s²\].
    pub(crate) shake: Vector3<f64>,
}

/// The rate about the axis of a segment \[rad/s\].
#[derive(Clone, Copy, Debug)]
pub(crate) enum Rate {
    Zero,
    /// One cosine bump with this angle \[rad\].
    Turn(f64),
    /// Linear from one rate to another.
    Ramp(f64, f64),
}

impl Segment {
    pub(crate) fn still(duration: f64) -> Self {
        Self { duration, axis: Vector3::z(), rate: Rate::Zero, shake: Vector3::zeros() }
    }

    /// About z.
    pub(crate) fn ramp(duration: f64, from: f64, to: f64) -> Self {
        Self { rate: Rate::Ramp(from, to), ..Self::still(duration) }
    }

    /// The angle and the rate at a time since its start.
    fn at(&self, time: f64) -> (f64, f64) {
        let part = time / self.duration;
        match self.rate {
            Rate::Zero => (0.0, 0.0),
            Rate::Turn(angle) => {
                let phase = std::f64::consts::TAU * part;
                let bump = angle / self.duration * (1.0 - phase.cos());
                (angle * (part - phase.sin() / std::f64::consts::TAU), bump)
            }
            Rate::Ramp(from, to) => {
                let rate = from + (to - from) * part;
                (0.5 * (from + rate) * time, rate)
            }
        }
    }

    fn end(&self) -> UnitQuaternion<f64> {
        UnitQuaternion::new(self.axis * self.at(self.duration).0)
    }
}

/// The true means over the samples of a run, in the body frame, and the angle about z at their ends.
#[derive(Debug)]
pub(crate) struct Truth {
    pub(crate) rate: Vec<Vector3<f64>>,
    pub(crate) force: Vec<Vector3<f64>>,
    pub(crate) angle: Vec<f64>,
}

/// A motion from a first attitude.
#[derive(Debug)]
pub(crate) struct Motion {
    pub(crate) site: Site,
    /// Navigation frame from body.
    pub(crate) start: UnitQuaternion<f64>,
    pub(crate) segments: Vec<Segment>,
}

impl Motion {
    pub(crate) fn duration(&self) -> f64 {
        self.segments.iter().map(|segment| segment.duration).sum()
    }

    /// The means over samples of `interval` \[s\], by the midpoint rule on short steps.
    pub(crate) fn sampled(&self, interval: f64) -> Truth {
        let (earth, gravity) = (self.site.earth_rate(), Vector3::z() * self.site.gravity());
        let count = std::iter::successors(Some(interval), |time| Some(time + interval))
            .take_while(|time| *time <= self.duration() + 1e-6)
            .count();
        let steps = std::iter::successors(Some(1.0), |steps| Some(steps + 1.0))
            .find(|steps| interval / steps <= STEP)
            .expect("a step is short enough");
        let (mut at, mut from, mut attitude, mut turned) = (0, 0.0, self.start, 0.0);
        let mut truth = Truth { rate: Vec::new(), force: Vec::new(), angle: Vec::new() };
        for sample in 0..count {
            let start = sample as f64 * interval;
            let segment = &self.segments[at];
            let still =
                matches!(segment.rate, Rate::Zero) && start + interval <= from + segment.duration;
            let steps = if still { 1.0 } else { steps };
            let (mut rate, mut force) = (Vector3::zeros(), Vector3::zeros());
            let mut angle = turned;
            let mut middle = 0.5;
            while middle < steps {
                let time = start + middle / steps * interval;
                while time > from + self.segments[at].duration && at + 1 < self.segments.len() {
                    let segment = &self.segments[at];
                    (from, attitude) = (from + segment.duration, attitude * segment.end());
                    turned += segment.at(segment.duration).0;
                    at += 1;
                }
                let segment = &self.segments[at];
                let (about, speed) = segment.at(time - from);
                let body = attitude * UnitQuaternion::new(segment.axis * about);
                let phase = std::f64::consts::TAU * (time - from) / segment.duration;
                rate += segment.axis * speed + body.inverse_transform_vector(&earth);
                force += body.inverse_transform_vector(&(gravity + segment.shake * phase.sin()));
                angle = turned + segment.at(start + interval - from).0;
                middle += 1.0;
            }
            truth.rate.push(rate / steps);
            truth.force.push(force / steps);
            truth.angle.push(angle);
        }
        truth
    }
}
