//! Calibration of a log while it is written, fed by a program.

use std::fs;
use std::path::Path;

use rins::Outcome as _;
use rins::live::{LiveCalibration, LiveEnd, LiveOptions};

/// The result of a log that comes in portions of so many bytes.
fn result_of(rig: &Path, log: &[u8], portion: usize) -> String {
    let mut live = LiveCalibration::new(rig, None, LiveOptions::default()).unwrap();
    for part in log.chunks(portion) {
        live.feed(part).unwrap();
    }
    live.end(LiveEnd::Closed).unwrap().json().unwrap()
}

/// What is found from the samples at the start does not depend on where the portions end: the wobble of the axis, and the attitude
/// where it is not stated.
#[test]
fn portions_of_any_length_give_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let demo = rins::demo::log(folder.path()).unwrap();
    let rig = demo.loaded.rig.path.clone();
    let log = fs::read(&demo.loaded.rig.log.path).unwrap();
    let text = fs::read_to_string(&rig).unwrap();
    let attitude = text.find("[attitude]").unwrap();
    let next = text[attitude + 1..].find("\n[").unwrap() + attitude + 1;
    let unstated = folder.path().join("unstated.toml");
    fs::write(&unstated, [&text[..attitude], &text[next..]].concat()).unwrap();

    for rig in [&rig, &unstated] {
        let whole = result_of(rig, &log, log.len());
        for portion in [37, 4099, 1 << 16] {
            assert_eq!(result_of(rig, &log, portion), whole, "{}: {portion}", rig.display());
        }
    }
}
