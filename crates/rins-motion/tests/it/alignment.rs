//! Static alignment: exact for perfect means, and with a consistent covariance for noisy ones.

use nalgebra::Vector3;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G};
use rins_frames::{Body, Dcm, InFrame, Nav, Rates};
use rins_motion::{AlignmentError, MeanUncertainty, Station, align, level, place_seen, residual};
use rins_testing::{any_euler_angles, any_latitude, assert_close};

use crate::support::{any_attitude, at_angle_zero, attitude_apart, station};

/// Rounding, which increases near a pole with the small horizontal component of the Earth's rate.
const ROUNDING: f64 = 1e-12;

/// The means of a navigation-grade IMU over some minutes.
const SIGMA: MeanUncertainty =
    MeanUncertainty { angular_rate: 0.005 * DEG_PER_HOUR, specific_force: 20.0 * MICRO_G };

const DRAWS: u32 = 4000;

fn rates_at_rest(station: &Station, attitude: Dcm<Nav, Body>) -> Rates {
    let body_from_nav = attitude.inverse();
    Rates {
        angular_rate: body_from_nav * station.site.earth_rate(),
        specific_force: body_from_nav * -station.gravity_vector(),
    }
}

fn with_noise(rates: &Rates, sigma: &MeanUncertainty, rng: &mut Pcg64) -> Rates {
    let mut noise = |sigma: f64| {
        let normal = Normal::new(0.0, sigma).unwrap();
        InFrame::new(normal.sample(rng), normal.sample(rng), normal.sample(rng))
    };
    Rates {
        angular_rate: rates.angular_rate + noise(sigma.angular_rate),
        specific_force: rates.specific_force + noise(sigma.specific_force),
    }
}

/// Whether a mean of χ² values is within four sigma of its expectation.
fn is_chi_squared(mean: f64, dof: f64, draws: u32) -> bool {
    (mean - dof).abs() < 4.0 * (2.0 * dof / f64::from(draws)).sqrt()
}

proptest! {
    #[test]
    fn perfect_means_give_the_attitude(latitude in any_latitude(), attitude in any_attitude()) {
        let station = station(latitude);
        let attitude = at_angle_zero(attitude);
        let perfect = MeanUncertainty { angular_rate: 1e-12, specific_force: 1e-9 };
        let found = align(&rates_at_rest(&station, attitude), &perfect, &station).unwrap();
        let apart = attitude_apart(found.nav_from_body, attitude).norm();
        prop_assert!(apart < ROUNDING / latitude.cos(), "{apart:e} rad");
    }

    #[test]
    fn leveling_keeps_up_and_takes_the_yaw(angles in any_euler_angles()) {
        let [roll, pitch, yaw] = angles;
        let attitude: Dcm<Nav, Body> = rins_frames::EulerAngles { roll, pitch, yaw }.dcm();
        let station = station(0.5);
        let found = level(&rates_at_rest(&station, attitude), yaw).unwrap();
        let apart = attitude_apart(found, attitude).norm();
        prop_assert!(apart < ROUNDING / pitch.cos(), "{apart:e} rad");
    }

    #[test]
    fn place_is_seen_without_being_told(latitude in any_latitude(), attitude in any_attitude()) {
        let station = station(latitude);
        let seen = place_seen(&rates_at_rest(&station, at_angle_zero(attitude)), &SIGMA);
        prop_assert!((seen.latitude - latitude).abs() < ROUNDING);
        prop_assert!((seen.gravity - station.gravity).abs() < ROUNDING * 10.0);
        prop_assert!((seen.earth_rate / rins_frames::EARTH_RATE - 1.0).abs() < ROUNDING);
    }

    #[test]
    fn right_attitude_leaves_only_the_biases(
        latitude in any_latitude(),
        attitude in any_attitude(),
    ) {
        let station = station(latitude);
        let attitude = at_angle_zero(attitude);
        let mut rates = rates_at_rest(&station, attitude);
        let biases = Rates {
            angular_rate: InFrame::new(1e-7, -2e-7, 3e-7),
            specific_force: InFrame::new(1e-3, 2e-3, -3e-3),
        };
        rates.angular_rate += biases.angular_rate;
        rates.specific_force += biases.specific_force;
        let left = residual(&rates, attitude, &station);
        prop_assert!((left.angular_rate - biases.angular_rate).norm() < 1e-18);
        prop_assert!((left.specific_force - biases.specific_force).norm() < 1e-14);
    }
}

/// The mean of `φᵀ P⁻¹ φ`, with P for sensors whose stated sigma is `claimed` times the true one.
fn mean_chi_square(claimed: f64) -> f64 {
    let mut rng = Pcg64::seed_from_u64(9);
    let station = station(48.0 * DEG);
    let attitude =
        at_angle_zero(rins_frames::EulerAngles { roll: 0.4, pitch: -0.3, yaw: 2.0 }.dcm());
    let truth = rates_at_rest(&station, attitude);
    let claim = MeanUncertainty {
        angular_rate: SIGMA.angular_rate * claimed,
        specific_force: SIGMA.specific_force * claimed,
    };
    let sum: f64 = (0..DRAWS)
        .map(|_| {
            let found = align(&with_noise(&truth, &SIGMA, &mut rng), &claim, &station).unwrap();
            let error = attitude_apart(found.nav_from_body, attitude);
            let information = found.covariance.try_inverse().unwrap();
            error.dot(&(information * error))
        })
        .sum();
    sum / f64::from(DRAWS)
}

#[test]
fn covariance_is_that_of_many_alignments() {
    let mean = mean_chi_square(1.0);
    assert!(is_chi_squared(mean, 3.0, DRAWS), "mean χ² {mean}, not 3");
}

#[test]
fn covariance_of_a_wrong_sigma_is_found_out() {
    for claimed in [0.95, 1.05] {
        let mean = mean_chi_square(claimed);
        assert!(!is_chi_squared(mean, 3.0, DRAWS), "mean χ² {mean} passes at {claimed} sigma");
    }
}

/// The apparent tilt due to a horizontal accelerometer error, and the apparent azimuth due to an error of an east gyro.
#[test]
fn single_errors_do_what_the_covariance_says() {
    let station = station(45.0 * DEG);
    let level = at_angle_zero(Dcm::identity());
    let cos = 45.0_f64.to_radians().cos();
    let apart = |gyro: Vector3<f64>, accel: Vector3<f64>| {
        let mut rates = rates_at_rest(&station, level);
        rates.angular_rate += InFrame::from_components(gyro);
        rates.specific_force += InFrame::from_components(accel);
        // φ is minus the rotation vector from true to computed.
        -attitude_apart(align(&rates, &SIGMA, &station).unwrap().nav_from_body, level)
    };
    let gyro = 0.01 * DEG_PER_HOUR;
    let by_east_gyro = apart(Vector3::x() * gyro, Vector3::zeros());
    let azimuth = -gyro / (rins_frames::EARTH_RATE * cos);
    assert_close!(by_east_gyro.z, azimuth, 1e-6 * azimuth.abs());
    assert!(by_east_gyro.xy().norm() < 1e-12);
    let by_north_accel = apart(Vector3::zeros(), Vector3::y() * 1e-4);
    assert_close!(by_north_accel.x, -1e-4 / station.gravity, 1e-9);
    let by_east_accel = apart(Vector3::zeros(), Vector3::x() * 1e-4);
    assert_close!(by_east_accel.y, 1e-4 / station.gravity, 1e-9);
    // φ_U = φ_N tan L.
    assert_close!(by_east_accel.z, by_east_accel.y, 1e-9);
}

/// The covariance is the sum of the effects of single errors of each sensor: their squares and their products.
#[test]
fn covariance_is_made_of_what_single_errors_do() {
    // For an error of a hundredth of a degree, whose square is negligible.
    const WITHIN: f64 = 1e-3;
    let level = at_angle_zero(Dcm::identity());
    for latitude in [-50.0, 20.0, 60.0] {
        let station = station(latitude * DEG);
        let mut sum = nalgebra::Matrix3::zeros();
        for axis in 0..6 {
            let mut rates = rates_at_rest(&station, level);
            let mut error = Vector3::zeros();
            if axis < 3 {
                error[axis] = SIGMA.angular_rate;
                rates.angular_rate += InFrame::from_components(error);
            } else {
                // So large that its effect on the azimuth equals that of a gyro.
                error[axis - 3] = 20.0 * SIGMA.specific_force;
                rates.specific_force += InFrame::from_components(error);
            }
            let found = align(&rates, &SIGMA, &station).unwrap().nav_from_body;
            let phi = -attitude_apart(found, level);
            sum += phi * phi.transpose();
        }
        let sigma = MeanUncertainty { specific_force: 20.0 * SIGMA.specific_force, ..SIGMA };
        let covariance = align(&rates_at_rest(&station, level), &sigma, &station);
        let covariance = covariance.unwrap().covariance;
        for (found, want) in covariance.iter().zip(&sum) {
            let off = (found - want).abs();
            assert!(off < WITHIN * sum.trace(), "at {latitude} deg:{covariance}{sum}");
        }
        // The azimuth is correlated with the tilt about north: a product with the wrong sign would be detected.
        assert!(sum[(1, 2)].abs() > 10.0 * WITHIN * sum.trace(), "{sum}");
    }
}

/// The mean of `(δL / σ)²`, with `claimed` times the true sigma.
fn mean_square_of_latitude(sigma: &MeanUncertainty, claimed: f64) -> f64 {
    let mut rng = Pcg64::seed_from_u64(4);
    let station = station(-30.0 * DEG);
    let attitude = at_angle_zero(Dcm::about_x(0.7));
    let truth = rates_at_rest(&station, attitude);
    let sum: f64 = (0..DRAWS)
        .map(|_| {
            let seen = place_seen(&with_noise(&truth, sigma, &mut rng), sigma);
            let error = seen.latitude - station.site.latitude;
            (error / (claimed * seen.latitude_sigma)).powi(2)
        })
        .sum();
    sum / f64::from(DRAWS)
}

/// If gyros or accelerometers are less accurate, or both equally accurate.
#[test]
fn latitude_seen_has_its_sigma() {
    // So that the gyros of SIGMA are as accurate as the accelerometers.
    let poor = MeanUncertainty { specific_force: 17.0 * SIGMA.specific_force, ..SIGMA };
    let poorer = MeanUncertainty { specific_force: 100.0 * SIGMA.specific_force, ..SIGMA };
    for sigma in [SIGMA, poor, poorer] {
        let right = mean_square_of_latitude(&sigma, 1.0);
        assert!(is_chi_squared(right, 1.0, DRAWS), "{sigma:?}: {right}");
        for claimed in [0.9, 1.1] {
            let wrong = mean_square_of_latitude(&sigma, claimed);
            assert!(!is_chi_squared(wrong, 1.0, DRAWS), "{sigma:?}: {wrong} at {claimed} sigma");
        }
    }
}

#[test]
fn north_is_not_found_near_a_pole_or_by_poor_gyros() {
    let near_pole = station(90.0 * DEG - 60.0 * ARCSEC);
    let level = at_angle_zero(Dcm::identity());
    let found = align(&rates_at_rest(&near_pole, level), &SIGMA, &near_pole);
    let Err(AlignmentError::NorthNotFound { azimuth_sigma }) = found else {
        panic!("north found a mile from the pole: {found:?}");
    };
    assert!(azimuth_sigma > 0.5);

    let poor = MeanUncertainty { angular_rate: 10.0 * DEG_PER_HOUR, ..SIGMA };
    let here = station(34.0 * DEG);
    let found = align(&rates_at_rest(&here, level), &poor, &here);
    let message = found.unwrap_err().to_string();
    // 10 °/h compared with the horizontal component of the Earth's rate, 12.5 °/h.
    assert!(message.contains("sigma of 0.80 rad"), "{message}");

    let unknown = MeanUncertainty { angular_rate: f64::NAN, ..SIGMA };
    let found = align(&rates_at_rest(&here, level), &unknown, &here);
    assert!(matches!(found, Err(AlignmentError::NorthNotFound { .. })));
}

#[test]
fn nothing_is_leveled_without_gravity() {
    let here = station(34.0 * DEG);
    for specific_force in
        [InFrame::zeros(), InFrame::new(0.0, 0.0, 0.9), InFrame::new(f64::NAN, 0.0, 9.8)]
    {
        let mean = Rates { angular_rate: InFrame::new(0.0, 5e-5, 5e-5), specific_force };
        let refused = |error| matches!(error, Err(AlignmentError::NoGravity { .. }));
        assert!(refused(align(&mean, &SIGMA, &here).map(|_| ())));
        assert!(refused(level(&mean, 0.0).map(|_| ())));
    }
}
