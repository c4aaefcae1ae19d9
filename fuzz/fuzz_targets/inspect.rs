//! Logs made of rows, looked through as `rins check` does.
#![no_main]

use rins_frames::EulerAngles;
use rins_fuzz::rows::Table;
use rins_inspection::{Expected, ExpectedAxis, ExpectedTriad, inspect};

libfuzzer_sys::fuzz_target!(|table: Table| {
    let Some(loaded) = rins_fuzz::csv(table.choice, table.text().as_bytes()) else { return };
    let triad = ExpectedTriad { bias_sigma: Some(1e-3), range: Some(20.0), unit: None };
    let angles = EulerAngles { roll: 0.5, pitch: 0.3, yaw: 0.7 };
    let seen = inspect(
        &loaded.recording,
        &Expected {
            station: Some(loaded.station),
            axis: Some(ExpectedAxis { angles, sigma: 1e-3 }),
            table_latency: 0.0,
            table_unit: None,
            gyro: triad,
            accel: triad,
        },
    );
    assert!(seen.turns.is_finite() && seen.timing.interval > 0.0);
    assert!(seen.longest_repeat.iter().all(|run| (1..=loaded.recording.len()).contains(run)));
});
