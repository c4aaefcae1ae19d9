//! A realistic run: the paper's table, with noise, biases and an encoder.

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G};
use rins_frames::{Dcm, EulerAngles, InFrame, Increments, Nav, Site, Table};
use rins_inspection::{Expected, ExpectedAxis, ExpectedTriad, Inspection, inspect};
use rins_motion::{Profile, Recording, Segment, Station, TrueMotion};

/// The latitude of Xi'an, the site of the paper's table.
pub(crate) const PAPER_LATITUDE: f64 = 34.25 * DEG;

pub(crate) fn station(latitude: f64) -> Station {
    Station::with_normal_gravity(Site { latitude, longitude: 0.0, height: 0.0 })
}

pub(crate) const INTERVAL: f64 = 0.02;

/// The attitude in Table 4.
pub(crate) const ANGLES: EulerAngles =
    EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };

/// White noise \[rad/s/√Hz\] and \[m/s²/√Hz\], and constant biases.
#[derive(Clone, Copy)]
pub(crate) struct Grade {
    pub(crate) gyro_noise: f64,
    pub(crate) accel_noise: f64,
    pub(crate) gyro_bias: f64,
    pub(crate) accel_bias: f64,
}

pub(crate) const NAVIGATION: Grade = Grade {
    gyro_noise: 0.02 * DEG_PER_HOUR,
    accel_noise: 30.0 * MICRO_G,
    gyro_bias: 0.05 * DEG_PER_HOUR,
    accel_bias: 100.0 * MICRO_G,
};

/// A MEMS gyro that cannot measure the Earth's rate.
pub(crate) const CHIP: Grade = Grade {
    gyro_noise: 0.005 * DEG_PER_SECOND,
    accel_noise: 100.0 * MICRO_G,
    gyro_bias: 0.3 * DEG_PER_SECOND,
    accel_bias: 3000.0 * MICRO_G,
};

/// The table's motion by `segments` of rate \[deg/s\] and duration \[s\], with ramps of 5 deg/s².
pub(crate) fn profile(segments: &[(f64, f64)]) -> Profile {
    let segments: Vec<Segment> = segments
        .iter()
        .map(|&(rate, duration)| Segment { rate: rate * DEG_PER_SECOND, duration })
        .collect();
    Profile::new(&segments, Some(5.0 * DEG_PER_SECOND)).unwrap()
}

/// A static minute, then forward and backward.
pub(crate) fn usual() -> Profile {
    profile(&[(0.0, 60.0), (10.0, 80.0), (-20.0, 60.0), (0.0, 20.0)])
}

/// The recording of an IMU, with the table angle.
pub(crate) fn record(profile: Profile, grade: Grade, seed: u64) -> Recording {
    record_tilted(ANGLES.dcm(), profile, grade, seed)
}

/// The same for any axis.
pub(crate) fn record_tilted(
    nav_from_table: Dcm<Nav, Table>,
    profile: Profile,
    grade: Grade,
    seed: u64,
) -> Recording {
    let motion = TrueMotion { station: station(PAPER_LATITUDE), nav_from_table, profile };
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut one = || -> f64 { StandardNormal.sample(&mut rng) };
    let (gyro_bias, accel_bias) = (
        Vector3::new(1.0, -0.7, 0.8) * grade.gyro_bias,
        Vector3::new(-1.0, 0.6, 0.9) * grade.accel_bias,
    );
    let mut recording = Recording { table_angle: Some(Vec::new()), ..Recording::default() };
    for sample in motion.samples(INTERVAL) {
        let truth = sample.increments;
        let mut noisy = |bias: Vector3<f64>, density: f64| {
            let white = Vector3::new(one(), one(), one()) * (density * INTERVAL.sqrt());
            InFrame::from_components(bias * INTERVAL + white)
        };
        recording.increments.push(Increments {
            angle: truth.angle + noisy(gyro_bias, grade.gyro_noise),
            velocity: truth.velocity + noisy(accel_bias, grade.accel_noise),
            ..truth
        });
        recording.times.push(sample.time);
        if let Some(angles) = &mut recording.table_angle {
            angles.push(sample.angle + one() * 0.3 * ARCSEC);
        }
    }
    recording
}

/// The prior knowledge of such a run.
pub(crate) fn expected(grade: Grade) -> Expected {
    let triad = |bias: f64| ExpectedTriad { bias_sigma: Some(2.0 * bias), range: None, unit: None };
    Expected {
        station: Some(station(PAPER_LATITUDE)),
        axis: Some(ExpectedAxis { angles: ANGLES, sigma: 0.1 * DEG }),
        table_latency: 0.0,
        table_unit: None,
        gyro: triad(grade.gyro_bias),
        accel: triad(grade.accel_bias),
    }
}

/// Fails if there is any suspicion.
pub(crate) fn assert_unsuspected(recording: &Recording, expected: &Expected) -> Inspection {
    let inspection = inspect(recording, expected);
    assert!(inspection.suspicions.is_empty(), "{:?}", inspection.suspicions);
    inspection
}
