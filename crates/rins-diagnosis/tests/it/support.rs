//! Simulated runs that the tests share.

use rins_estimation::{Reference, Rig, Run};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{Axis, ImuError, ImuNoise, ImuSpec, NoiseModel, Seed, TriadError, TriadSpec};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Encoder, Scenario, TableRecord, Temperature, simulate};
use rins_terms::Model;

const ENCODER: f64 = 0.5 * ARCSEC;

/// The seed of every run but where a test says another: what is hidden is far from where it would be missed. How often
/// fainter effects are found, and how often one is named that is not there, are rates over many runs, which
/// `cargo xtask blind` counts.
pub(crate) const SEED: u64 = 1;

/// The gain of an effect of twenty sigmas, in nats.
pub(crate) const STRONG: f64 = 200.0;

/// The time between samples \[s\].
pub(crate) const INTERVAL: f64 = 0.04;

/// The data sheet of a navigation-grade fibre-optic unit.
pub(crate) fn fibre() -> ImuSpec {
    ImuSpec {
        gyro: TriadSpec::white(
            0.02 * DEG_PER_HOUR,
            0.1 * DEG_PER_HOUR,
            500.0 * PPM,
            120.0 * ARCSEC,
        ),
        accel: TriadSpec::white(30.0 * MICRO_G, 200.0 * MICRO_G, 300.0 * PPM, 60.0 * ARCSEC),
    }
}

/// A run over these rates \[deg/s\], 50 s each, with `effects` hidden in it; its gyros flicker by `flicker` \[rad/s\].
pub(crate) fn run(rates: &[f64], effects: Model, flicker: f64, seed: u64) -> Run {
    let attitude = EulerAngles { roll: 25.0 * DEG, pitch: 5.0 * DEG, yaw: 40.0 * DEG };
    run_at(attitude, rates, effects, flicker, seed)
}

/// A run over these rates \[deg/s\], so long each \[s\].
pub(crate) fn run_of(rates: &[f64], duration: f64, effects: Model, seed: u64) -> Run {
    let attitude = EulerAngles { roll: 25.0 * DEG, pitch: 5.0 * DEG, yaw: 40.0 * DEG };
    made((attitude, duration), rates, effects, 0.0, seed)
}

/// The same as [`run`] with the table in some attitude.
pub(crate) fn run_at(
    attitude: EulerAngles,
    rates: &[f64],
    effects: Model,
    flicker: f64,
    seed: u64,
) -> Run {
    made((attitude, 50.0), rates, effects, flicker, seed)
}

fn made(
    (attitude, duration): (EulerAngles, f64),
    rates: &[f64],
    effects: Model,
    flicker: f64,
    seed: u64,
) -> Run {
    let imu = fibre();
    let site = Site { latitude: 45.0 * DEG, longitude: 0.0, height: 0.0 };
    let station = Station::with_normal_gravity(site);
    let nav_from_table = attitude.dcm();
    let turns: Vec<Segment> =
        rates.iter().map(|rate| Segment { rate: rate * DEG_PER_SECOND, duration }).collect();
    let gyro = NoiseModel {
        flicker: (flicker > 0.0).then_some(flicker),
        ..NoiseModel::white(imu.gyro.noise_density)
    };
    // Errors of the baseline are always there.
    let gyro_error = TriadError::default()
        .with_scale(Axis::Z, 150.0 * PPM)
        .with_misalignment(Axis::X, Axis::Z, 40.0 * ARCSEC)
        .with_bias(Axis::Y, 0.05 * DEG_PER_HOUR);
    let accel_error = TriadError::default().with_bias(Axis::X, 120.0 * MICRO_G);
    let scenario = Scenario {
        imu_error: ImuError { gyro: gyro_error, accel: accel_error },
        noise: Some(ImuNoise { gyro, accel: NoiseModel::white(imu.accel.noise_density) }),
        table: TableRecord::Angle(Encoder { noise: ENCODER, resolution: None, zero: 0.0 }),
        effects,
        temperature: Some(Temperature::Sinus { start: 20.0, amplitude: 1.5, period: 170.0 }),
        seed: Seed::new(seed),
        ..Scenario::perfect(
            station,
            nav_from_table,
            Profile::new(&turns, Some(5.0 * DEG_PER_SECOND)).unwrap(),
            INTERVAL,
        )
    };
    let rig = Rig {
        station,
        nav_from_table,
        reference: Reference::Encoder { noise: ENCODER },
        wobble: 1e-3 * ARCSEC,
        velocity: 1e-6,
    };
    Run::new(rig, simulate(&scenario).unwrap().recording).unwrap()
}
