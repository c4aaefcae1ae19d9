//! What each parameter adds to the readings, as an affine function of rate and specific force.

use nalgebra::{Matrix3, Vector3};
use rins_terms::{Instant, KinematicState, Model, Surroundings, derivatives};

use super::GrowthError;

/// The relative difference from an affine function that is rounding.
const ROUNDING: f64 = 1e-9;

/// A rate \[rad/s\] and a specific force \[m/s²\] at which the function is compared.
const ELSEWHERE: [[f64; 3]; 2] = [[0.013, -0.007, 0.11], [1.7, -0.6, 9.4]];

/// A reading's derivative by a parameter: `constant + by_rate ω + by_force f`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Affine {
    constant: Vector3<f64>,
    by_rate: Matrix3<f64>,
    by_force: Matrix3<f64>,
}

/// The derivatives of gyros and accelerometers by a parameter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sensitivity {
    pub(super) gyro: Affine,
    pub(super) accel: Affine,
}

impl Affine {
    #[inline]
    pub(super) fn at(&self, rate: &Vector3<f64>, force: &Vector3<f64>) -> Vector3<f64> {
        self.constant + self.by_rate * rate + self.by_force * force
    }

    /// Constant and matrices times a factor, added.
    fn add(&mut self, other: &Self, factor: f64) {
        self.constant += other.constant * factor;
        self.by_rate += other.by_rate * factor;
        self.by_force += other.by_force * factor;
    }

    /// The constant, and the matrices that multiply rate and force.
    pub(super) fn parts(&self) -> (&Vector3<f64>, [&Matrix3<f64>; 2]) {
        (&self.constant, [&self.by_rate, &self.by_force])
    }
}

impl Sensitivity {
    /// That of each parameter, given by term and place within it.
    ///
    /// # Errors
    /// [`GrowthError::NotAffine`] if a term depends on anything but rate and specific force, or is not affine in them.
    pub(super) fn of_each(
        model: &Model,
        parameters: &[(usize, usize)],
        surroundings: &Surroundings,
    ) -> Result<Vec<Self>, GrowthError> {
        parameters.iter().map(|place| Self::of(model, *place, surroundings)).collect()
    }

    fn of(
        model: &Model,
        (term, parameter): (usize, usize),
        surroundings: &Surroundings,
    ) -> Result<Self, GrowthError> {
        let at = |rate: Vector3<f64>, force: Vector3<f64>, angle: f64| {
            let now = Instant { angle, rate: rate.z, time: 10.0 * angle, ..Instant::default() };
            let moment = KinematicState {
                sample: 0,
                interval: 1e-3,
                duration: 1.0,
                mean: now,
                end: now,
                rate,
                force,
                surroundings: *surroundings,
                track: None,
            };
            let signals = model.terms[term].signals(&moment, Some(parameter));
            [derivatives(&signals.gyro), derivatives(&signals.accel)]
        };
        let none = Vector3::zeros();
        let constant = at(none, none, 0.0);
        let mut all = constant.map(|constant| Affine { constant, ..Affine::default() });
        for axis in 0..3 {
            let unit = Vector3::ith(axis, 1.0);
            let [by_rate, by_force] = [at(unit, none, 0.0), at(none, unit, 0.0)];
            for (sensor, affine) in all.iter_mut().enumerate() {
                affine.by_rate.set_column(axis, &(by_rate[sensor] - constant[sensor]));
                affine.by_force.set_column(axis, &(by_force[sensor] - constant[sensor]));
            }
        }
        let [rate, force] = ELSEWHERE.map(Vector3::from);
        for (affine, seen) in all.iter().zip(at(rate, force, 0.7)) {
            let off = (affine.at(&rate, &force) - seen).norm();
            let is_affine = off <= ROUNDING * (seen.norm() + affine.constant.norm());
            if !is_affine {
                return Err(GrowthError::NotAffine { term: model.terms[term].term.id });
            }
        }
        let [gyro, accel] = all;
        Ok(Self { gyro, accel })
    }

    /// What errors of the parameters add together.
    pub(super) fn sum(each: &[Self], errors: &[f64]) -> Self {
        let mut sum = Self::default();
        for (one, error) in each.iter().zip(errors) {
            sum.gyro.add(&one.gyro, *error);
            sum.accel.add(&one.accel, *error);
        }
        sum
    }
}
