//! Is the covariance of the paper's filter consistent under its own model? A test with 400 runs of one minute.
#![expect(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;
use std::hash::{DefaultHasher, Hasher};

use rayon::prelude::*;
use rins_calibration::{AxisAttitude, Setup, TableSpec};
use rins_campaign::{Campaign, Cell, PARAMETERS, RunResult, Statistics};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{Axis, ImuError, ImuNoise, ImuSpec, NoiseModel, TriadError, TriadSpec};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Scenario, TableRecord};

fn main() -> Result<(), Box<dyn Error>> {
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    let station = Station::with_normal_gravity(site);
    let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let triad = |noise_density| TriadSpec::white(noise_density, 0.0, 500.0 * PPM, 120.0 * ARCSEC);
    let imu = ImuSpec { gyro: triad(0.02 * DEG_PER_HOUR), accel: triad(30.0 * MICRO_G) };
    let noise = ImuNoise { gyro: NoiseModel::from(&imu.gyro), accel: NoiseModel::from(&imu.accel) };
    let turn = Segment { rate: 10.0 * DEG_PER_SECOND, duration: 60.0 };
    let gyro = TriadError::default().with_scale(Axis::Z, 300.0 * PPM);
    let scenario = Scenario {
        imu_error: ImuError { gyro, ..ImuError::default() },
        noise: Some(noise),
        table: TableRecord::CommandedRate,
        ..Scenario::perfect(station, angles.dcm(), Profile::new(&[turn], None)?, 0.02)
    };
    let setup = Setup {
        station,
        axis: Some(AxisAttitude { angles, sigma: 0.01 * DEG }),
        table: TableSpec { angle_noise: 0.0, wobble: 0.0, rate_noise: 0.0, latency: 0.0 },
        imu,
        velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
    };

    let campaign = Campaign { cells: vec![Cell { scenario, setup }], runs: 400 };
    let prepared = campaign.cells[0].prepare()?;
    let chunks: Vec<_> = campaign.chunks().collect();
    let runs: Vec<Vec<RunResult>> =
        chunks.into_par_iter().map(|chunk| prepared.run(chunk.runs)).collect();
    let runs = runs.concat();
    println!("{:016x} of all estimates and covariances, on any machine", fingerprint(&runs));
    let statistics = Statistics::of(&campaign.cells[0].truth(), &runs)
        .ok_or("fewer than two runs have estimates")?;
    for (id, parameter) in PARAMETERS.iter().zip(&statistics.parameters) {
        let ratio = parameter.spread / parameter.claimed;
        println!("{id}: spread over claimed sigma {ratio:.3}");
    }
    let [least, most] = statistics.nees_bounds;
    println!("NEES {:.3}, honest between {least:.3} and {most:.3}", statistics.nees);
    Ok(())
}

/// A hash that changes with any bit of the results.
fn fingerprint(runs: &[RunResult]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for found in runs.iter().flatten() {
        let numbers = found.value.iter().chain(&found.covariance).chain([&found.nis_ratio]);
        numbers.for_each(|number| hasher.write_u64(number.to_bits()));
    }
    hasher.finish()
}
