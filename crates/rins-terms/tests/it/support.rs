//! A run that shows most effects: both ways at three rates, with rests, while it warms up and cools.

use std::sync::LazyLock;

use rins_frames::units::{DEG, DEG_PER_HOUR, DEG_PER_HOUR_PER_ROOT_HZ, DEG_PER_SECOND, MICRO_G};
use rins_frames::{EulerAngles, Increments, Site};
use rins_imu::{ImuSpec, TriadSpec};
use rins_motion::{Profile, Recording, Segment, Station, TrueMotion};
use rins_terms::{Surroundings, Track};

pub(crate) const INTERVAL: f64 = 0.02;
pub(crate) const ACCELERATION: f64 = 5.0 * DEG_PER_SECOND;

/// A run and what a perfect IMU and encoder read over it.
pub(crate) struct Run {
    pub(crate) motion: TrueMotion,
    pub(crate) track: Track,
    pub(crate) recording: Recording,
}

pub(crate) fn run() -> &'static Run {
    static RUN: LazyLock<Run> = LazyLock::new(|| {
        let rates = [0.0, 10.0, -10.0, 20.0, -5.0, 0.0];
        turning(&rates.map(|rate| Segment { rate: rate * DEG_PER_SECOND, duration: 20.0 }))
    });
    &RUN
}

pub(crate) fn turning(segments: &[Segment]) -> Run {
    let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 400.0 };
    let attitude = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let motion = TrueMotion {
        station: Station::with_normal_gravity(site),
        nav_from_table: attitude.dcm(),
        profile: Profile::new(segments, Some(ACCELERATION)).unwrap(),
    };
    let samples: Vec<_> = motion.samples(INTERVAL).collect();
    let times: Vec<f64> = samples.iter().map(|sample| sample.time).collect();
    let temperature: Vec<f64> = times.iter().map(|time| 20.0 + 4.0 * (0.05 * time).sin()).collect();
    let mut angles = vec![motion.profile.angle(0.0)];
    angles.extend(samples.iter().map(|sample| sample.angle));
    let increments: Vec<Increments> = samples.iter().map(|sample| sample.increments).collect();
    let track = Track::new(
        Surroundings::new(motion.station, motion.nav_from_table),
        times.clone(),
        vec![INTERVAL; times.len()],
        angles.clone(),
        Some(temperature.clone()),
    );
    let recording = Recording {
        times,
        increments,
        table_angle: Some(angles[1..].to_vec()),
        table_rate: Some(samples.iter().map(|sample| sample.mean_rate).collect()),
        temperature: Some(temperature),
    };
    Run { motion, track, recording }
}

/// A navigation-grade data sheet.
pub(crate) fn sheet() -> ImuSpec {
    let none = TriadSpec::white(0.0, 0.0, 500e-6, 6e-4);
    ImuSpec {
        gyro: TriadSpec {
            noise_density: 0.02 * DEG_PER_HOUR_PER_ROOT_HZ,
            bias_sigma: 0.1 * DEG_PER_HOUR,
            ..none
        },
        accel: TriadSpec { noise_density: 30.0 * MICRO_G, bias_sigma: 200.0 * MICRO_G, ..none },
    }
}
