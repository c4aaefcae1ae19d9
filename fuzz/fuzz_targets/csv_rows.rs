//! CSV logs made of rows; what is read of one is written and read again as the same.
#![no_main]

use std::path::Path;
use std::sync::OnceLock;

use rins_fuzz::rows::Table;
use rins_io::{LogFile, Rig, write_log, write_recording};

libfuzzer_sys::fuzz_target!(|table: Table| {
    let Some(loaded) = rins_fuzz::csv(table.choice, table.text().as_bytes()) else { return };
    for format in LogFile::ALL {
        // Some formats have no room for some logs, and say so.
        let _ = write_log(&loaded, format, Path::new("new"), &mut Vec::new());
    }
    let mut written = Vec::new();
    write_recording(&loaded.recording, &mut written).expect("memory takes it");
    static RIG: OnceLock<Rig> = OnceLock::new();
    let keys = r#"path = "run.csv"
        time = { column = "time", unit = "s" }
        gyro = { columns = ["gyro_x", "gyro_y", "gyro_z"], unit = "rad" }
        accel = { columns = ["accel_x", "accel_y", "accel_z"], unit = "m/s" }
        gaps = "accumulated""#;
    // A sum of what was read may be more than is believed of a single reading, and then is refused.
    let Some(again) = rins_fuzz::log(&RIG, keys, &written) else { return };
    if again.summary.left_out.is_empty() {
        assert_eq!(again.recording.times, loaded.recording.times);
        let parts = |run: &rins_io::Loaded| -> Vec<_> {
            run.recording.increments.iter().map(|s| (s.angle, s.velocity)).collect()
        };
        assert_eq!(parts(&again), parts(&loaded));
    }
});
