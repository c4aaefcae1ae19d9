//! The linear system of an epoch: its transition of attitude, velocity and colored noise, and its measurement.
#![expect(
    clippy::inline_always,
    reason = "what is not inlined is compiled without the vector instructions"
)]

use nalgebra::{DMatrix, Matrix3, SMatrix};
use rins_lanes::{Matrix, Real, Vector};

use crate::epoch::Turning;

/// The number of navigation states: attitude and velocity.
pub(crate) const NAVIGATION: usize = 6;

/// The number of measurements in an epoch: mean attitude, and velocity at its end.
pub(crate) const SHOWN: usize = 6;

/// The number of linear functions of the states in an epoch: mean attitude, then attitude and velocity at its end.
pub(crate) const FOLLOWING: usize = 9;

/// The functions that are measured, and those that are propagated.
pub(crate) const SHOWN_OF: [usize; SHOWN] = [0, 1, 2, 6, 7, 8];
pub(crate) const CARRIED_OF: [usize; NAVIGATION] = [3, 4, 5, 6, 7, 8];

/// A colored-noise process: the place of its three states, its mean over the epoch per unit of state, and the normalized mean
/// of its integral.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weight {
    pub(crate) place: usize,
    pub(crate) mean: f64,
    pub(crate) half_mean: f64,
}

/// The linear system of an epoch: `x⁺ = Φ x + w`, `y = H x + e`.
///
/// `Φ` has full rows for navigation and a diagonal for the other states; `w` and `e` are correlated. Rows of states have the
/// length of those of the covariance, with zeros as padding.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    /// Factors of φ, the attitude error at the start: at the end, in the mean over the readings, and in v.
    pub(crate) turned: Matrix3<f64>,
    pub(crate) mean_turned: Matrix3<f64>,
    pub(crate) pulled: Matrix3<f64>,
    /// The integrals of the body's attitude, and the factor of the twice integrated noise of a gyro in v.
    pub(crate) body: Turning,
    pub(crate) body_pulled: Matrix3<f64>,
    /// The axes of the states after navigation that are random-walk angles of the base.
    pub(crate) astray: Vec<usize>,
    pub(crate) gyros: Vec<Weight>,
    pub(crate) accels: Vec<Weight>,
    /// Whether the angle about the axis is measured.
    pub(crate) shows_angle: bool,
    /// The diagonal of Φ after navigation, and the variances of that part of `w`; unused for navigation.
    pub(crate) decay: Vec<f64>,
    pub(crate) colour_noise: Vec<f64>,
    /// The covariance of `e`.
    pub(crate) shown: SMatrix<f64, SHOWN, SHOWN>,
    /// The covariances of `w` with its navigation part, and of `w` with `e`: a row of all states for each.
    pub(crate) noise: DMatrix<f64>,
    pub(crate) cross: DMatrix<f64>,
}

/// The three states from this place on. It is no closure, which the compiler would not inline where it is called several times.
#[inline(always)]
fn three<T: Real>(state: &impl Fn(usize) -> T, place: usize) -> Vector<T> {
    Vector([state(place), state(place + 1), state(place + 2)])
}

/// The product of a matrix that is common to all lanes and a vector.
#[inline(always)]
fn times<T: Real>(matrix: &Matrix3<f64>, vector: Vector<T>) -> Vector<T> {
    Matrix::constant(vector[0], matrix) * vector
}

impl Step {
    /// The linear functions of the states: the measured mean attitude, and attitude and velocity at the end.
    #[inline(always)]
    pub(crate) fn follow<T: Real>(&self, state: impl Fn(usize) -> T) -> [Vector<T>; 3] {
        let (attitude, velocity) = (three(&state, 0), three(&state, 3));
        let like = attitude[0];
        let (mut gyro, mut gyro_mean, mut accel) =
            (Vector::zeros(like), Vector::zeros(like), Vector::zeros(like));
        for weight in &self.gyros {
            let noise = three(&state, weight.place);
            gyro = gyro + noise.scaled(weight.mean);
            gyro_mean = gyro_mean + noise.scaled(weight.half_mean);
        }
        for weight in &self.accels {
            accel = accel + three(&state, weight.place).scaled(weight.mean);
        }
        let mut mean = times(&self.mean_turned, attitude) - times(&self.body.mean, gyro_mean);
        for (index, &axis) in self.astray.iter().enumerate() {
            mean[axis] = mean[axis] - state(NAVIGATION + index);
        }
        if !self.shows_angle {
            mean[2] = like.constant(0.0);
        }
        let end = times(&self.turned, attitude) - times(&self.body.turned, gyro);
        let gained = times(&self.pulled, attitude) + times(&self.body_pulled, gyro_mean)
            - times(&self.body.turned, accel);
        [mean, end, velocity + gained]
    }

    /// The same as a matrix with a row for each function.
    pub(crate) fn following(&self, states: usize) -> DMatrix<f64> {
        let mut rows = DMatrix::zeros(FOLLOWING, states);
        for of in 0..states {
            let unit = |place| if place == of { 1.0 } else { 0.0 };
            for (row, value) in self.follow(unit).iter().flat_map(|vector| vector.0).enumerate() {
                rows[(row, of)] = value;
            }
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::SVector;
    use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G};
    use rins_frames::{EulerAngles, Site};
    use rins_motion::{Profile, Segment, Station};
    use rins_simulation::{Scenario, simulate};
    use rins_terms::{Model, catalogue};

    use crate::linear::linearise;
    use crate::noise_parameters::{Noise, NoiseParameters, TriadStrengths};
    use crate::run::{Reference, Rig, Run};
    use crate::space::Space;

    use super::*;

    /// The Earth rotates by 7e-6 in an epoch of 0.1 s; the effect of a gyro on the velocity is of second order.
    const RELATIVE: f64 = 1e-4;

    /// A run of twenty seconds on a tilted axis.
    fn run() -> Run {
        let site = Site { latitude: 45.0 * DEG, longitude: 0.0, height: 0.0 };
        let station = Station::with_normal_gravity(site);
        let nav_from_table = EulerAngles { roll: 50.0 * DEG, pitch: 10.0 * DEG, yaw: 0.0 }.dcm();
        let turn = Segment { rate: 40.0 * DEG_PER_SECOND, duration: 20.0 };
        let scenario =
            Scenario::perfect(station, nav_from_table, Profile::new(&[turn], None).unwrap(), 0.005);
        let reference = Reference::Encoder { noise: ARCSEC };
        let rig = Rig { station, nav_from_table, reference, wobble: ARCSEC, velocity: 1e-6 };
        Run::new(rig, simulate(&scenario).unwrap().recording).unwrap()
    }

    /// A random walk is constant over an epoch in the mean: its effect is that of a bias, which is a parameter and acts
    /// through the derivatives of the run, sample by sample.
    #[test]
    fn a_walk_does_within_an_epoch_what_a_bias_does() {
        let run = run();
        let biases = [catalogue::GYRO_BIAS.id, catalogue::ACCEL_BIAS.id];
        let model = Model::full();
        let place = |id: &str| model.terms.iter().position(|chosen| chosen.term.id == id).unwrap();
        let free: Vec<(usize, usize)> =
            biases.iter().flat_map(|id| [0, 1, 2].map(|axis| (place(id), axis))).collect();
        let linear = linearise(&run, &model, &free);
        let triad = |white| TriadStrengths { white, flicker: 0.0, walk: 0.1 * white };
        let imu = NoiseParameters {
            gyro: triad(1e-3 * DEG_PER_HOUR),
            accel: triad(10.0 * MICRO_G),
            jitter: 0.0,
        };
        let space = Space::new(&linear, &Noise::on(&run.rig, &imu));
        for epoch in &linear.epochs[3..] {
            let following = space.step(epoch).following(space.states());
            for column in 0..6 {
                let by_walk: SVector<f64, FOLLOWING> =
                    following.column(NAVIGATION + column).fixed_rows::<FOLLOWING>(0).into_owned();
                let gains = epoch.gains.column(column + 1);
                for (what, walk, bias) in [
                    ("the mean attitude", by_walk.fixed_rows::<3>(0), gains.fixed_rows::<3>(6)),
                    ("the attitude", by_walk.fixed_rows::<3>(3), gains.fixed_rows::<3>(0)),
                    ("the velocity", by_walk.fixed_rows::<3>(6), gains.fixed_rows::<3>(3)),
                ] {
                    let off = (walk - bias).norm();
                    let is_there = column < 3 || what == "the velocity";
                    assert_eq!(bias.norm() > 0.0, is_there, "{what}, column {column}: {bias}");
                    assert!(off <= RELATIVE * bias.norm(), "{what}, column {column}: {walk}{bias}");
                }
            }
        }
    }
}
