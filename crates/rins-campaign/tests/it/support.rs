//! The paper's simulation, shortened.

use rins_calibration::{AxisAttitude, Setup, TableSpec};
use rins_campaign::Cell;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{Axis, ImuError, ImuNoise, ImuSpec, NoiseModel, Seed, TriadError, TriadSpec};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Encoder, Scenario, TableRecord};

/// The noise of the encoder, if there is one \[rad\].
pub(crate) const ENCODER_NOISE: f64 = 1.0 * ARCSEC;

/// The three gyro errors along the spin axis and white noise, over `duration` seconds at 10 °/s.
pub(crate) fn cell(duration: f64, table: TableRecord) -> Cell {
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    let station = Station::with_normal_gravity(site);
    let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let turn = Segment { rate: 10.0 * DEG_PER_SECOND, duration };
    let triad = |noise_density| TriadSpec::white(noise_density, 0.0, 500.0 * PPM, 120.0 * ARCSEC);
    let imu = ImuSpec { gyro: triad(0.02 * DEG_PER_HOUR), accel: triad(30.0 * MICRO_G) };
    let noise = ImuNoise { gyro: NoiseModel::from(&imu.gyro), accel: NoiseModel::from(&imu.accel) };
    let gyro = TriadError::default()
        .with_scale(Axis::Z, 300.0 * PPM)
        .with_misalignment(Axis::X, Axis::Z, 60.0 * ARCSEC)
        .with_misalignment(Axis::Y, Axis::Z, 60.0 * ARCSEC);
    let profile = Profile::new(&[turn], None).expect("a segment that lasts is a profile");
    let scenario = Scenario {
        imu_error: ImuError { gyro, ..ImuError::default() },
        noise: Some(noise),
        table,
        seed: Seed::new(17),
        ..Scenario::perfect(station, angles.dcm(), profile, 0.02)
    };
    let setup = Setup {
        station,
        axis: Some(AxisAttitude { angles, sigma: 0.01 * DEG }),
        table: TableSpec {
            angle_noise: ENCODER_NOISE,
            wobble: 1e-4 * ENCODER_NOISE,
            rate_noise: 0.0,
            latency: 0.0,
        },
        imu,
        velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
    };
    Cell { scenario, setup }
}

pub(crate) fn encoder() -> TableRecord {
    TableRecord::Angle(Encoder { noise: ENCODER_NOISE, ..Encoder::default() })
}
