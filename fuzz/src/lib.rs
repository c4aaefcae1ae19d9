//! What the fuzz targets share: rigs that read what the fuzzer makes, and what must hold of a run.

pub mod elements;
pub mod rows;

use std::path::Path;
use std::sync::OnceLock;

use rins_io::{Loaded, LogPolicy, Rig, read_log};
use rins_motion::Recording;

const SITE: &str =
    "[site]\nlatitude = \"34.25 deg\"\nlongitude = \"108.9 deg\"\nheight = \"400 m\"\n[log]\n";

/// The keys of `[log]` under which a CSV log is read: one of these, as its first byte tells.
const CSV: [&str; 6] = [
    r#"path = "run.csv"
    time = { column = "t", unit = "s" }
    gyro = { columns = ["gx", "gy", "gz"], unit = "rad/s" }
    accel = { columns = ["ax", "ay", "az"], unit = "m/s^2" }"#,
    r#"path = "run.csv"
    rate = "50 Hz"
    time = { column = "t", unit = "s" }
    gyro = { columns = ["gx", "gy", "gz"], unit = "arcsec" }
    accel = { columns = ["ax", "ay", "az"], unit = "m/s", axes = ["-y", "x", "z"] }
    table_angle = { column = "table", unit = "deg" }
    gaps = "held""#,
    r#"path = "run.csv"
    time = { column = "1", unit = "ns", stamp = "middle" }
    gyro = { columns = ["2", "3", "4"], unit = "deg/s", scale = 1e-3, offset = 32768 }
    accel = { columns = ["5", "6", "7"], unit = "g" }
    table_rate = { column = "8", unit = "deg/s" }"#,
    r#"path = "run.csv"
    rate = "100 Hz"
    time = { column = "t", unit = "sample" }
    gyro = { columns = ["gx", "gy", "gz"], unit = "deg/h" }
    accel = { columns = ["ax", "ay", "az"], unit = "mg" }
    temperature = { column = "T", unit = "degC" }"#,
    r#"path = "run.csv"
    rate = "100 Hz"
    gyro = { columns = ["gx", "gy", "gz"], unit = "rad" }
    accel = { columns = ["ax", "ay", "az"], unit = "m/s" }
    gaps = "accumulated""#,
    r#"format = "csv"
    time = { column = "t", unit = "ms", stamp = "start" }
    gyro = { path = "run.csv", columns = ["gx", "gy", "gz"], unit = "rad/s" }
    accel = { path = "second.csv", columns = ["ax", "ay", "az"], unit = "m/s^2",
              time = { column = "t", unit = "us", offset = "3 ms" } }
    temperature = { path = "third.csv", time = "t", column = "T", unit = "degC" }"#,
];

/// A rig whose `[log]` has these keys.
fn rig(keys: &str) -> Rig {
    Rig::parse(&format!("{SITE}{keys}\n"), Path::new("rig.toml")).expect("a good rig file")
}

/// Reads `bytes` as a log under these keys of `[log]`, whose `path` is `run.csv`.
pub fn log(rig: &'static OnceLock<Rig>, keys: &str, bytes: &[u8]) -> Option<Loaded> {
    rins_io::fuzzing::put(Path::new("run.csv"), bytes);
    loaded(rig.get_or_init(|| self::rig(keys)))
}

/// Reads a CSV log, or several that follow each other between lines of `---`, under the keys that
/// `choice` picks.
pub fn csv(choice: u8, bytes: &[u8]) -> Option<Loaded> {
    static RIGS: OnceLock<Vec<Rig>> = OnceLock::new();
    let rigs = RIGS.get_or_init(|| CSV.iter().map(|keys| rig(keys)).collect());
    let choice = usize::from(choice) % rigs.len();
    let mut rest = bytes;
    for name in ["run.csv", "second.csv", "third.csv"] {
        let end = rest.windows(4).position(|window| window == b"---\n").filter(|_| choice == 5);
        let (file, after) = match end {
            Some(end) => (&rest[..end], &rest[end + 4..]),
            None => (rest, rest),
        };
        rins_io::fuzzing::put(Path::new(name), file);
        rest = after;
        if choice != 5 {
            break;
        }
    }
    loaded(&rigs[choice])
}

fn loaded(rig: &Rig) -> Option<Loaded> {
    let loaded = match read_log(rig.clone(), LogPolicy::default()) {
        Ok(loaded) => loaded,
        Err(error) => {
            let said = error.to_string();
            assert!(said.len() < 10_000 && !said.is_empty(), "{said}");
            return None;
        }
    };
    holds(&loaded.recording);
    Some(loaded)
}

/// What holds of every recording, whatever it was read from.
fn holds(recording: &Recording) {
    let samples = recording.times.len();
    assert!(samples > 0 && recording.increments.len() == samples);
    let signals = [&recording.table_angle, &recording.table_rate, &recording.temperature];
    for signal in signals.into_iter().flatten() {
        assert!(signal.len() == samples && signal.iter().all(|number| number.is_finite()));
    }
    assert!(recording.times.iter().all(|time| time.is_finite()));
    assert!(recording.times.windows(2).all(|pair| pair[0] < pair[1]), "time goes on");
    for sample in &recording.increments {
        assert!(sample.interval > 0.0 && sample.interval.is_finite());
        assert!(sample.angle.components().iter().all(|number| number.is_finite()));
        assert!(sample.velocity.components().iter().all(|number| number.is_finite()));
    }
}
