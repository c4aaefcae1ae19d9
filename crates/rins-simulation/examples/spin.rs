//! Simulates ten minutes of rotation, and computes the scale error and the z bias from the recording by hand.
//!
//! `cargo run --release -p rins-simulation --example spin`
#![expect(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;

use rins_frames::units::{
    ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_HOUR_PER_ROOT_HZ, DEG_PER_SECOND, PPM,
};
use rins_frames::{Dcm, Site};
use rins_imu::{Axis, ImuError, ImuNoise, NoiseModel, Seed, TriadError};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Encoder, Scenario, TableRecord, simulate};

fn main() -> Result<(), Box<dyn Error>> {
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    let segments = [0.0, 10.0].map(|rate| Segment { rate: rate * DEG_PER_SECOND, duration: 300.0 });
    let gyro = TriadError::default()
        .with_bias(Axis::Z, 0.05 * DEG_PER_HOUR)
        .with_scale(Axis::Z, 300.0 * PPM);
    let scenario = Scenario {
        imu_error: ImuError { gyro, ..ImuError::default() },
        noise: Some(ImuNoise {
            gyro: NoiseModel::white(0.02 * DEG_PER_HOUR_PER_ROOT_HZ),
            ..ImuNoise::default()
        }),
        table: TableRecord::Angle(Encoder { noise: 0.5 * ARCSEC, ..Encoder::default() }),
        seed: Seed::new(1),
        ..Scenario::perfect(
            Station::with_normal_gravity(site),
            Dcm::identity(),
            Profile::new(&segments, Some(5.0 * DEG_PER_SECOND))?,
            0.02,
        )
    };
    let recording = simulate(&scenario)?.recording;

    let half = recording.len() / 2;
    let seen = |first: usize, end: usize| -> f64 {
        recording.increments[first..end].iter().map(|k| k.angle.components().z).sum()
    };
    let earth = site.earth_rate().components().z * 300.0;
    let at_rest = seen(0, half) - earth;
    let turning = seen(half, recording.len()) - earth;
    let angle = |k: usize| recording.table_angle.as_ref().map_or(f64::NAN, |list| list[k]);
    let turn = angle(2 * half - 1) - angle(half - 1);

    println!("samples             {:9}", recording.len());
    println!("bias z at rest      {:9.4} deg/h, true 0.0500", at_rest / 300.0 / DEG_PER_HOUR);
    println!("table turn          {:9.3} deg, true 2990", turn / DEG);
    println!("scale z in the spin {:9.3} ppm, true 300", (turning - turn - at_rest) / turn / PPM);
    Ok(())
}
