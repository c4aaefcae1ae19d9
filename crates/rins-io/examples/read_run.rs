//! Reads a run and prints its content: `cargo run -p rins-io --example read_run -- RIG`.
//!
//! Without a rig file a run is simulated, written to a temporary folder and read from there.
#![expect(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;
use std::path::Path;

use rins_frames::units::DEG_PER_HOUR;
use rins_io::{Loaded, Overwrite, ScenarioFile, read, write_folder};
use rins_simulation::simulate;

const SCENARIO: &str = r#"
[site]
latitude = "34.25 deg"
longitude = "108.9 deg"
height = "400 m"

[log]
rate = "50 Hz"
table_angle = { noise = "0.3 arcsec" }

[attitude]
roll = "30 deg"
pitch = "20 deg"
yaw = "40 deg"
sigma = "0.1 deg"

[table]
profile = [
    { rate = "0 deg/s", duration = "30 s" },
    { rate = "10 deg/s", duration = "36 s" },
]
acceleration = "20 deg/s^2"

[imu.gyro]
noise = "0.02 deg/h/sqrt(Hz)"
bias_sigma = "0.1 deg/h"
scale_sigma = "500 ppm"
misalignment_sigma = "120 arcsec"

[imu.accel]
noise = "30 ug/sqrt(Hz)"
bias_sigma = "200 ug"
scale_sigma = "300 ppm"
misalignment_sigma = "60 arcsec"

[truth]
seed = 1

[truth.gyro]
scale = ["0 ppm", "0 ppm", "300 ppm"]
misalignment = { xz = "60 arcsec", yz = "60 arcsec" }
"#;

fn main() -> Result<(), Box<dyn Error>> {
    if let Some(rig) = std::env::args().nth(1) {
        print(&read(Path::new(&rig))?);
        return Ok(());
    }
    let scenario = ScenarioFile::parse(SCENARIO, Path::new("scenario.toml"))?;
    let run = simulate(&scenario.scenario)?;
    let folder = std::env::temp_dir().join(format!("rins-read-run-{}", std::process::id()));
    write_folder(&folder, Overwrite::Refuse, |folder| scenario.write_run(&run.recording, folder))?;
    let loaded = read(&folder.join("rig.toml"));
    std::fs::remove_dir_all(&folder)?;
    let loaded = loaded?;
    print(&loaded);
    assert_eq!(loaded.recording, run.recording, "what is written is read again, to the last bit");
    Ok(())
}

fn print(loaded: &Loaded) {
    let Loaded { recording, summary, station, .. } = loaded;
    let duration: f64 = recording.increments.iter().map(|sample| sample.interval).sum();
    println!("{} samples, {duration:.3} s", summary.samples);
    println!("nominal interval {:.6} s", summary.nominal_interval);
    println!("jitter {:.3e} s rms, {} gaps", summary.jitter_rms, summary.gaps.len());
    println!("gravity {:.5} m/s^2", station.gravity);
    let first = recording.increments.iter().take(500);
    let (mut angle, mut velocity, mut time) = (0.0, 0.0, 0.0);
    for sample in first {
        angle += sample.angle.components().norm();
        velocity += sample.velocity.components().norm();
        time += sample.interval;
    }
    let (rate, force) = (angle / time / DEG_PER_HOUR, velocity / time);
    println!(
        "mean over the first {time:.1} s: rate {rate:.3} deg/h, specific force {force:.5} m/s^2"
    );
    if let Some(last) = recording.table_angle.as_ref().and_then(|angles| angles.last()) {
        println!("the table has turned by {:.4} deg", last.to_degrees());
    }
}
