//! The time that an online filter takes for a sample with 27 parameters: `cargo run --release --example online_latency`.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::time::Instant;

use rins_estimation::{OnlineFilter, OnlineSample, OnlineSetup, Reference, Rig};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{Axis, ImuError, ImuNoise, ImuSpec, NoiseModel, Seed, TriadError, TriadSpec};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Encoder, Scenario, TableRecord, simulate};
use rins_terms::Model;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gyro =
        TriadSpec::white(0.005 * DEG_PER_HOUR, 0.05 * DEG_PER_HOUR, 500.0 * PPM, 120.0 * ARCSEC);
    let accel = TriadSpec::white(30.0 * MICRO_G, 200.0 * MICRO_G, 300.0 * PPM, 60.0 * ARCSEC);
    let imu = ImuSpec { gyro, accel };
    let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 400.0 };
    let station = Station::with_normal_gravity(site);
    let nav_from_table = EulerAngles { roll: 20.0 * DEG, pitch: 0.0, yaw: 0.0 }.dcm();
    let turn = |rate: f64, duration| Segment { rate: rate * DEG_PER_SECOND, duration };
    let profile = Profile::new(
        &[turn(0.0, 60.0), turn(10.0, 150.0), turn(-10.0, 150.0)],
        Some(20.0 * DEG_PER_SECOND),
    )?;
    println!("samples  rate [Hz]  mean [us]  p50 [us]  p99 [us]  max [us]");
    for rate in [50.0, 100.0, 200.0, 400.0] {
        let error = TriadError::default().with_scale(Axis::Z, 300.0 * PPM).with_bias(Axis::X, 1e-7);
        let scenario = Scenario {
            imu_error: ImuError { gyro: error, ..ImuError::default() },
            noise: Some(ImuNoise {
                gyro: NoiseModel::white(gyro.noise_density),
                accel: NoiseModel::white(accel.noise_density),
            }),
            table: TableRecord::Angle(Encoder { noise: ARCSEC, resolution: None, zero: 0.0 }),
            seed: Seed::new(1),
            ..Scenario::perfect(station, nav_from_table, profile.clone(), 1.0 / rate)
        };
        let recording = simulate(&scenario)?.recording;
        let reference = Reference::Encoder { noise: ARCSEC };
        let rig = Rig { station, nav_from_table, reference, wobble: ARCSEC, velocity: 1e-6 };
        let mut filter = OnlineFilter::new(OnlineSetup::new(rig, Model::full(), imu, 1.0 / rate))?;
        let angles = recording.table_angle.as_ref().ok_or("no table angle")?;
        let mut times = Vec::with_capacity(recording.len());
        let samples = recording.times.iter().zip(&recording.increments).zip(angles);
        for ((&time, &increments), &angle) in samples {
            let start = Instant::now();
            filter.push(&OnlineSample { time, increments, table: Some(angle) })?;
            let compensated = filter.compensate(&increments);
            times.push(start.elapsed().as_secs_f64() * 1e6);
            std::hint::black_box(compensated);
        }
        let mean = times.iter().sum::<f64>() / times.len() as f64;
        times.sort_by(f64::total_cmp);
        let at = |part: usize| times[(times.len() - 1) * part / 1000];
        println!(
            "{:7}  {rate:9}  {mean:9.1}  {:8.1}  {:8.1}  {:8.1}",
            times.len(),
            at(500),
            at(990),
            at(1000)
        );
    }
    Ok(())
}
