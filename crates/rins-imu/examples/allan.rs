//! Prints the Allan deviation of a simulated gyro beside that of its coefficients.
//!
//! `cargo run --release -p rins-imu --example allan`
#![expect(clippy::print_stdout, reason = "an example prints")]

use std::f64::consts::{LN_2, PI};

use rins_frames::units::{DEG_PER_HOUR, DEG_PER_HOUR_PER_ROOT_HZ};
use rins_imu::{NoiseModel, Seed, Span, Triad, TriadNoise};

const INTERVAL: f64 = 0.02;
const N_SAMPLES: usize = 1 << 20;

fn main() -> Result<(), rins_imu::NoiseError> {
    let model = NoiseModel {
        white_density: 0.02 * DEG_PER_HOUR_PER_ROOT_HZ,
        flicker: Some(0.002 * DEG_PER_HOUR),
        ..NoiseModel::default()
    };
    let span = Span { interval: INTERVAL, duration: INTERVAL * N_SAMPLES as f64 };
    let mut noise = TriadNoise::new(&model, &span, Triad::Gyro, Seed::new(1))?;

    let mut angles = vec![0.0];
    let mut angle = 0.0;
    for _ in 0..N_SAMPLES {
        angle += noise.next(INTERVAL).components().x;
        angles.push(angle);
    }

    println!("     tau [s]   found [deg/h]  theory [deg/h]");
    let floor = 0.002 * (2.0 * LN_2 / PI).sqrt();
    for cluster in (0..17).step_by(2).map(|power| 1_usize << power) {
        let time = cluster as f64 * INTERVAL;
        let n_terms = angles.len() - 2 * cluster;
        let squares =
            (0..n_terms).map(|k| angles[k + 2 * cluster] - 2.0 * angles[k + cluster] + angles[k]);
        let mean = squares.map(|x| x * x).sum::<f64>() / n_terms as f64;
        let found = (mean / 2.0).sqrt() / time / DEG_PER_HOUR;
        let theory = (0.02 / time.sqrt()).hypot(floor);
        println!("{time:12.2} {found:15.5} {theory:15.5}");
    }
    Ok(())
}
