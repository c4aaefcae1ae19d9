//! The paper's simulated run, compensated while the table turns, beside the finished estimate and no compensation:
//! `cargo run --release -p rins --example online -- scenarios/paper/simulation.toml`.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::path::PathBuf;

use rins::live::{LiveCalibration, LiveOptions};
use rins::motion::Recording;
use rins::{Log, Outcome, Overwrite};
use rins_calibration::{navigate_online, table_angles};
use rins_imu::{Compensation, ImuError};

/// The times at which navigation starts \[s\].
const STARTS: [f64; 3] = [0.0, 30.0, 180.0];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scenario = std::env::args().nth(1).map(PathBuf::from).ok_or("usage: online SCENARIO")?;
    let folder = tempfile::tempdir()?;
    let run = folder.path().join("run");
    rins::simulate(&scenario, None)?.write(&run, Overwrite::Refuse)?;
    let rig = run.join("rig.toml");
    let log = Log::open(&rig)?;
    let recording = &log.loaded.recording;
    let options = LiveOptions { start: 2.0, ..LiveOptions::default() };
    let mut live = LiveCalibration::new(&rig, None, options)?;
    // The compensation that is known before each sample, row by row.
    let none = ImuError::default().compensation()?;
    let mut online: Vec<Compensation> = Vec::new();
    for row in std::fs::read(&log.loaded.rig.log.path)?.split_inclusive(|byte| *byte == b'\n') {
        let before = live.filter().map_or(none, |filter| *filter.compensation());
        let more = live.feed(row)?;
        online.resize(online.len() + more, before);
    }
    let outcome = live.end(rins::live::LiveEnd::Closed)?;
    print!("{outcome}");
    online.resize(recording.len(), none);
    let finished = vec![*outcome.filter().compensation(); recording.len()];
    let uncompensated = vec![none; recording.len()];
    let attitude = log.loaded.rig.attitude.ok_or("the scenario states no attitude")?;
    println!(
        "\n  from [s]  compensation  v_E [m/s]  v_N [m/s]  roll [deg]  pitch [deg]  yaw [deg]"
    );
    for start in STARTS {
        let first = recording.times.partition_point(|time| *time <= start);
        let part: Recording = recording.slice(first, recording.len());
        let angles = table_angles(recording, 0.0).ok_or("no table angle")?;
        for (name, list) in [("none", &uncompensated), ("online", &online), ("batch", &finished)] {
            let end = navigate_online(
                &part,
                &angles[first..],
                attitude.angles.dcm(),
                &log.loaded.station,
                &list[first..],
            );
            let attitude = end.attitude_error;
            println!(
                "{start:10.0}  {name:12}  {:9.4}  {:9.4}  {:10.5}  {:11.5}  {:9.5}",
                end.velocity.x,
                end.velocity.y,
                attitude.roll.to_degrees(),
                attitude.pitch.to_degrees(),
                attitude.yaw.to_degrees()
            );
        }
    }
    Ok(())
}
