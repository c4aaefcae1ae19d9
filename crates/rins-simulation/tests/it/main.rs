//! Simulated runs compared with their scenarios.
mod bounds;
mod effects;
mod statistics;
mod truth;

use rins_frames::units::{ARCSEC, PPM};
use rins_frames::units::{DEG, DEG_PER_HOUR, DEG_PER_HOUR_PER_ROOT_HZ, DEG_PER_SECOND, MICRO_G};
use rins_frames::{EulerAngles, Site};
use rins_imu::{Axis, ImuError, ImuNoise, NoiseModel, Seed, TriadError};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Encoder, Scenario, TableRecord, Temperature};

const INTERVAL: f64 = 0.02;

/// A tilted table that stands still and rotates in both directions, without any errors.
fn perfect() -> Scenario {
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    let attitude = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let segments =
        [0.0, 10.0, -10.0].map(|rate| Segment { rate: rate * DEG_PER_SECOND, duration: 60.0 });
    let profile = Profile::new(&segments, Some(5.0 * DEG_PER_SECOND)).expect("the ramps fit");
    Scenario::perfect(Station::with_normal_gravity(site), attitude.dcm(), profile, INTERVAL)
}

/// The same with all errors.
fn realistic() -> Scenario {
    let gyro = TriadError::default()
        .with_bias(Axis::X, 0.05 * DEG_PER_HOUR)
        .with_scale(Axis::Z, 300.0 * PPM)
        .with_misalignment(Axis::X, Axis::Z, 60.0 * ARCSEC);
    let accel = TriadError::default().with_bias(Axis::Y, 50.0 * MICRO_G);
    Scenario {
        imu_error: ImuError { gyro, accel },
        noise: Some(ImuNoise {
            gyro: NoiseModel {
                flicker: Some(0.005 * DEG_PER_HOUR),
                ..NoiseModel::white(0.02 * DEG_PER_HOUR_PER_ROOT_HZ)
            },
            accel: NoiseModel::white(30.0 * MICRO_G),
        }),
        table: TableRecord::Angle(Encoder {
            noise: 0.5 * ARCSEC,
            resolution: Some(0.36 * ARCSEC),
            zero: 3.0 * DEG,
        }),
        temperature: Some(Temperature::Constant(25.0)),
        seed: Seed { seed: 2019, run: 0 },
        ..perfect()
    }
}
