//! The true motion: attitudes on a grid of short steps, with rates and forces from differences.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::drive::Way;
use crate::effect::{Effect, Law};
use crate::experiment::Experiment;
use crate::laws::Pose;

/// An attitude.
type Attitude = UnitQuaternion<f64>;

/// The attitude and motion of a table.
pub(crate) struct Motion<'a> {
    experiment: &'a Experiment,
    tilts: Vec<&'a Effect>,
    nav_from_axis: Attitude,
    mounting: Attitude,
    places: [Vector3<f64>; 3],
    step: f64,
}

/// Attitudes at every point of the grid.
pub(crate) struct Attitudes {
    /// Relative to inertial space.
    inertial: Vec<Attitude>,
    /// Relative to the local navigation frame.
    local: Vec<Attitude>,
}

impl<'a> Motion<'a> {
    pub(crate) fn new(experiment: &'a Experiment, step: f64) -> Self {
        let [roll, pitch, yaw] = experiment.attitude;
        let about = |axis: Vector3<f64>, angle: f64| Attitude::from_scaled_axis(axis * angle);
        let nav_from_axis =
            about(Vector3::z(), yaw) * about(Vector3::x(), pitch) * about(Vector3::y(), roll);
        let [x, y] = experiment.mounting;
        let mut places = [Vector3::zeros(); 3];
        let mut tilts = Vec::new();
        for effect in &experiment.effects {
            match effect.law() {
                Law::Tilt(_) => tilts.push(effect),
                Law::Places(of) => {
                    for (place, more) in places.iter_mut().zip(of(&effect.parameters)) {
                        *place += more;
                    }
                }
                _ => {}
            }
        }
        let mounting = Attitude::from_scaled_axis(Vector3::new(x, y, 0.0));
        Self { experiment, tilts, nav_from_axis, mounting, places, step }
    }

    /// The attitudes along the trajectory, `lead` steps of which are before the run.
    pub(crate) fn attitudes(&self, way: &Way, lead: usize) -> Attitudes {
        let earth = self.experiment.place.earth_rate();
        let mut attitudes = Attitudes { inertial: Vec::new(), local: Vec::new() };
        for (place, (&angle, &sense)) in way.angles.iter().zip(&way.senses).enumerate() {
            let time = (place as f64 - lead as f64) * self.step;
            let local = self.nav_from_body(&Pose { time, angle, sense });
            attitudes.inertial.push(Attitude::from_scaled_axis(earth * time) * local);
            attitudes.local.push(local);
        }
        attitudes
    }

    fn nav_from_body(&self, pose: &Pose) -> Attitude {
        let mut tilt = Vector3::zeros();
        for effect in &self.tilts {
            if let Law::Tilt(of) = effect.law() {
                tilt += of(&effect.parameters, &effect.settings, pose);
            }
        }
        let base = Attitude::from_scaled_axis(Vector3::z() * self.experiment.base_rate * pose.time);
        let (sin, cos) = (0.5 * pose.angle).sin_cos();
        let turned = Attitude::new_unchecked(Quaternion::new(cos, 0.0, 0.0, sin));
        base * self.nav_from_axis * Attitude::from_scaled_axis(tilt) * turned * self.mounting
    }

    /// The mean rate over the step after point `place` \[rad/s\].
    pub(crate) fn turning(&self, attitudes: &Attitudes, place: usize) -> Vector3<f64> {
        let [before, after] = [place, place + 1].map(|place| attitudes.inertial[place]);
        (before.inverse() * after).scaled_axis() / self.step
    }

    /// The specific force at point `place`, which must not be an end point \[m/s²\].
    pub(crate) fn force(&self, attitudes: &Attitudes, place: usize) -> Vector3<f64> {
        let up = Vector3::z() * self.experiment.place.gravity;
        let mut force = attitudes.in_body(place, &up);
        if self.places.iter().any(|place| place.norm_squared() > 0.0) {
            let [before, now, after] =
                [place - 1, place, place + 1].map(|place| attitudes.inertial[place]);
            for (axis, at) in self.places.iter().enumerate() {
                let acceleration =
                    (before * at - (now * at) * 2.0 + after * at) / self.step.powi(2);
                force[axis] += (now.inverse() * acceleration)[axis];
            }
        }
        force
    }
}

impl Attitudes {
    /// A vector of the local navigation frame in body axes at point `place`.
    pub(crate) fn in_body(&self, place: usize, vector: &Vector3<f64>) -> Vector3<f64> {
        self.local[place].inverse() * vector
    }
}
