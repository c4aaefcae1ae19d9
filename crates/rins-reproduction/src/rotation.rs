//! "Rotation restrains the divergence of attitude": an IMU static and rotating, axis by axis.

use nalgebra::Vector3;
use rins_frames::InFrame;
use rins_imu::{ImuError, TriadError};
use rins_motion::mechanism::{NavErrors, SensorErrors};
use rins_motion::{NavState, Navigator, Profile, Segment, TrueMotion, VerticalChannel};
use rins_simulation::Scenario;

use crate::error::ReproductionError;
use crate::experiment::{Experiment, Sensors, spin_axis_error};

/// The motion of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    /// Static.
    Static,
    /// Rotation at the experiment's rate.
    Rotating,
}

/// The history of the attitude error, for one motion and one set of gyro errors.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AttitudeHistory {
    /// The motion.
    pub(crate) motion: Motion,
    /// The gyro errors in the data.
    pub(crate) errors: GyroErrors,
    /// Time \[s\], and the attitude error in the axis frame: x and y across the axis, z along it \[rad\].
    pub(crate) points: Vec<(f64, Vector3<f64>)>,
}

/// The subset of Table 2's gyro errors in the data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum GyroErrors {
    /// The biases.
    Biases,
    /// The biases and the matrix without its last column: the errors that remain after a perfect calibration of the spin-axis
    /// errors.
    AllButSpinAxis,
    /// All of them.
    All,
}

impl GyroErrors {
    /// This subset of the errors in `gyro`.
    fn of(self, gyro: &TriadError) -> TriadError {
        let spin_axis = spin_axis_error(&gyro.matrix.column(2).into_owned());
        match self {
            Self::Biases => TriadError { bias: gyro.bias, ..TriadError::default() },
            Self::AllButSpinAxis => {
                TriadError { bias: gyro.bias, matrix: gyro.matrix - spin_axis.matrix }
            }
            Self::All => *gyro,
        }
    }
}

impl AttitudeHistory {
    /// The final attitude error, axis by axis \[rad\].
    pub(crate) fn end(&self) -> Vector3<f64> {
        self.points.last().map_or_else(Vector3::zeros, |point| point.1)
    }

    /// The running maximum of the error about each axis, at each time \[rad\].
    pub(crate) fn largest_so_far(&self) -> Vec<(f64, Vector3<f64>)> {
        let mut largest = Vector3::<f64>::zeros();
        let so_far = self.points.iter().map(|&(time, error)| {
            largest = largest.zip_map(&error, |largest, error| largest.max(error.abs()));
            (time, largest)
        });
        so_far.collect()
    }

    /// The largest error about each axis \[rad\].
    pub(crate) fn largest(&self) -> Vector3<f64> {
        self.largest_so_far().last().map_or_else(Vector3::zeros, |point| point.1)
    }
}

/// The attitude errors of an experiment's IMU without noise, static and rotating, with three sets of gyro
/// errors; the accelerometers are perfect.
///
/// # Errors
/// [`ReproductionError::Profile`] if the experiment's profile is not valid for this.
pub(crate) fn histories(
    experiment: &Experiment,
) -> Result<Vec<AttitudeHistory>, ReproductionError> {
    let all = Sensors::Gyros.of(&experiment.scenario.imu_error).gyro;
    let mut histories = Vec::new();
    for motion in [Motion::Static, Motion::Rotating] {
        for errors in [GyroErrors::Biases, GyroErrors::AllButSpinAxis, GyroErrors::All] {
            let imu = ImuError { gyro: errors.of(&all), ..ImuError::default() };
            let points = attitude_errors(&experiment.scenario, motion, &imu)?;
            histories.push(AttitudeHistory { motion, errors, points });
        }
    }
    Ok(histories)
}

fn attitude_errors(
    scenario: &Scenario,
    motion: Motion,
    imu: &ImuError,
) -> Result<Vec<(f64, Vector3<f64>)>, ReproductionError> {
    let rate = match motion {
        Motion::Static => 0.0,
        Motion::Rotating => scenario.profile.rate(0.0),
    };
    let duration = scenario.profile.duration();
    let Scenario { station, nav_from_table, .. } = *scenario;
    let profile = Profile::new(&[Segment { rate, duration }], None)?;
    let sensors = SensorErrors {
        gyro_bias: InFrame::from_components(imu.gyro.bias),
        gyro_matrix: imu.gyro.matrix,
        ..SensorErrors::none()
    };
    let turned = |angle: f64| nav_from_table * rins_frames::Dcm::about_z(angle);
    let mut navigator = Navigator::at_rest(&station, turned(0.0), VerticalChannel::Held);
    let truth: NavState = *navigator.state();
    let motion = TrueMotion { station, nav_from_table, profile };
    let points = motion.samples(scenario.interval).map(|sample| {
        navigator.step(&sensors.measured(&sample.increments));
        let truth = NavState { nav_from_body: turned(sample.angle), ..truth };
        let error = NavErrors::between(navigator.state(), &truth).attitude;
        (sample.time, *(nav_from_table.inverse() * error).components())
    });
    Ok(points.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_testing::assert_close;

    fn history(
        histories: &[AttitudeHistory],
        motion: Motion,
        errors: GyroErrors,
    ) -> &AttitudeHistory {
        let found = histories.iter().find(|one| one.motion == motion && one.errors == errors);
        found.expect("each pair has a history")
    }

    #[test]
    fn rotation_bounds_what_biases_do_across_the_axis_and_nothing_along_it() {
        let experiment = Experiment::simulation().unwrap();
        let gyro = experiment.scenario.imu_error.gyro;
        let (rate, time) = (experiment.scenario.profile.rate(0.0), 360.0);
        let histories = histories(&experiment).unwrap();
        let fixed = history(&histories, Motion::Static, GyroErrors::Biases);
        let turning = history(&histories, Motion::Rotating, GyroErrors::Biases);
        // The Earth rate, the Schuler oscillation and products of errors change it by less than the fractions (t / τ)² and Ω t.
        let coupled = 0.2;
        for axis in 0..3 {
            let drift = -gyro.bias[axis] * time;
            assert_close!(fixed.end()[axis], drift, coupled * drift.abs());
        }
        // The drift about the axis is the same for static and rotating IMUs.
        assert_close!(turning.end().z, fixed.end().z, coupled * fixed.end().z.abs());
        // Two radians times the ratio of bias to rate, in the plane; the coupling from the z drift is added.
        let bound = 2.0 * gyro.bias.xy().norm() / rate;
        let across = turning.largest().xy().norm();
        assert!(across > 0.5 * bound, "{across} of {bound}");
        assert!(across < bound + coupled * fixed.largest().xy().norm(), "{across} of {bound}");
    }

    #[test]
    fn misalignments_swing_and_the_scale_error_diverges() {
        let experiment = Experiment::simulation().unwrap();
        let gyro = experiment.scenario.imu_error.gyro;
        let histories = histories(&experiment).unwrap();
        let all = history(&histories, Motion::Rotating, GyroErrors::All);
        let rest = history(&histories, Motion::Rotating, GyroErrors::AllButSpinAxis);
        // Eq. (6): S_z ω t along the axis. The horizontal part, sin² of the axis' tilt, is reduced by the Schuler oscillation by
        // the fraction (ω_s t)² / 6.
        let Scenario { station, nav_from_table, profile, .. } = &experiment.scenario;
        let scale = gyro.matrix[(2, 2)] * profile.angle(360.0);
        let horizontal = 1.0 - nav_from_table.matrix()[(2, 2)].powi(2);
        let schuler = station.gravity / station.site.meridian_radius() * 360.0 * 360.0 / 6.0;
        let drift = -scale * (1.0 - horizontal * schuler);
        assert_close!(all.end().z - rest.end().z, drift, 0.002 * scale);
        // Eq. (6) over one turn: up to twice the magnitude of the misalignments across the axis.
        let early: Vec<_> = all.points.iter().filter(|point| point.0 < 36.01).copied().collect();
        let one_turn = AttitudeHistory { points: early, ..all.clone() };
        let swing = 2.0 * gyro.matrix[(0, 2)].hypot(gyro.matrix[(1, 2)]);
        let largest = one_turn.points.iter().map(|point| point.1.xy().norm()).fold(0.0, f64::max);
        assert_close!(largest, swing, 0.05 * swing);
        assert!(one_turn.end().xy().norm() < 0.05 * swing, "a whole turn takes it back");
    }
}
