//! Prints the Allan deviation of a simulated gyro with that of its noise parameters.
//!
//! `cargo run --release -p rins-imu --example allan`
#![expect(clippy::print_stdout, reason = "an example prints")]

use std::f64::consts::{LN_2, PI};

use rins_frames::units::{DEG_PER_HOUR, DEG_PER_HOUR_PER_ROOT_HZ};
use rins_imu::{AllanPlan, NoiseModel, Seed, Span, Triad, TriadNoise};

const INTERVAL: f64 = 0.02;
const N_SAMPLES: usize = 1 << 20;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = NoiseModel {
        white_density: 0.02 * DEG_PER_HOUR_PER_ROOT_HZ,
        flicker: Some(0.002 * DEG_PER_HOUR),
        ..NoiseModel::default()
    };
    let span = Span { interval: INTERVAL, duration: INTERVAL * N_SAMPLES as f64 };
    let mut noise = TriadNoise::new(&model, &span, Triad::Gyro, Seed::new(1))?;

    let angles: Vec<f64> = (0..N_SAMPLES).map(|_| noise.next(INTERVAL).components().x).collect();
    let seen = AllanPlan::new(N_SAMPLES, INTERVAL)?.noise(&angles)?;

    println!("     tau [s]   found [deg/h]     95 % bounds [deg/h]  theory [deg/h]");
    let floor = 0.002 * (2.0 * LN_2 / PI).sqrt();
    for point in seen.points {
        let theory = (0.02 / point.time.sqrt()).hypot(floor);
        let [found, low, high] =
            [point.deviation, point.bounds.0, point.bounds.1].map(|rate| rate / DEG_PER_HOUR);
        println!("{:12.2} {found:15.5}  {low:10.5} {high:10.5} {theory:15.5}", point.time);
    }
    Ok(())
}
