//! A table angle in a file with its own clock.

use std::f64::consts::TAU;

use proptest::prelude::*;
use rins_frames::units::ARCSEC;

use crate::support::{RIG, read_files, replaced};

/// A table that turns forward, rests and turns back, with smooth changes of rate: its angle \[rad\] at a time \[s\].
fn angle(time: f64, rate: f64) -> f64 {
    // The rate is rate · sin³, so that it begins and ends without a step.
    let phase = TAU * time / 40.0;
    rate * 40.0 / TAU * (2.0 / 3.0 - phase.cos() + phase.cos().powi(3) / 3.0)
}

proptest! {
    /// At the ends of the samples the angle is the table's, whatever both clocks, the rate, the gyro's bias and scale error are.
    #[test]
    fn angle_of_another_clock_is_that_of_the_table(
        rows in 400..8000_u32,
        readings in 200..1200_u32,
        phase in 0.0..1.0_f64,
        offset in -5.0..5.0_f64,
        rate in -3.0..3.0_f64,
        scale in -0.01..0.01_f64,
        bias in -0.01..0.01_f64,
    ) {
        let (sampling, reading) = (f64::from(rows) / 20.0, f64::from(readings) / 20.0);
        let interval = 1.0 / sampling;
        let mut log = "t,gx,gy,gz,ax,ay,az\n".to_owned();
        for row in 1..=rows {
            let (end, start) = (f64::from(row) * interval, f64::from(row - 1) * interval);
            let mean = (angle(end, rate) - angle(start, rate)) / interval;
            let gyro = (1.0 + scale) * mean + bias;
            let wave = f64::from(row).sin() * 1e-5;
            log += &format!("{end:.9},{wave:e},{:e},{gyro:e},0.1,{wave:e},9.8\n", -wave);
        }
        let mut table = "clock,turned\n".to_owned();
        for row in 0..readings {
            let time = (f64::from(row) + phase) / reading;
            let turned = (angle(time, rate) / TAU).rem_euclid(1.0) * 360.0;
            table += &format!("{:.6},{turned:.9}\n", 1e3 * (time + offset));
        }
        let own = format!(
            "table_angle = {{ path = \"table.csv\", time = {{ column = \"clock\", unit = \"ms\", offset = \"{} ms\" }}, \
             column = \"turned\", unit = \"deg\" }}",
            1e3 * offset
        );
        let rig: String = RIG
            .lines()
            .map(|line| if line.starts_with("table_angle") { own.clone() } else { line.to_owned() } + "\n")
            .filter(|line| !line.starts_with("rate"))
            .collect();
        let files =
            [("rig.toml", rig.as_bytes()), ("run.csv", log.as_bytes()), ("table.csv", table.as_bytes())];
        let loaded = read_files(&files).map_err(|error| TestCaseError::fail(format!("{error:?}")))?;
        let recording = &loaded.recording;
        let angles = recording.table_angle.as_ref().expect("it has an angle");
        let turns = ((angles[0] - angle(recording.times[0], rate)) / TAU).round() * TAU;
        for (time, read) in recording.times.iter().zip(angles) {
            let off = read - turns - angle(*time, rate);
            prop_assert!(off.abs() < 10.0 * ARCSEC, "{time}: {} arcsec", off / ARCSEC);
        }
        let clock = loaded.summary.table_clock.expect("it has a clock of its own");
        prop_assert!((clock.rate / reading - 1.0).abs() < 1e-3);
        prop_assert!(clock.left_out as f64 <= 3.0 * sampling / reading + 1.0);
    }
}

#[test]
fn rare_readings_are_refused() {
    let rows: String = (1..200)
        .map(|row| {
            format!(
                "{:.2},{}e-6,{}e-6,{}e-6,0.1,0.2,9.8\n",
                0.02 * f64::from(row),
                row % 7,
                row % 3,
                row % 5
            )
        })
        .collect();
    let log = format!("t,gx,gy,gz,ax,ay,az\n{rows}");
    let table: String = (0..5).map(|row| format!("{row},{row}\n")).collect();
    let table = format!("clock,turned\n{table}");
    let own = "table_angle = { path = \"table.csv\", time = { column = \"clock\", unit = \"s\" }, column = \"turned\", unit = \"deg\" }";
    let line = RIG.lines().find(|line| line.starts_with("table_angle")).unwrap();
    let rig = replaced(RIG, line, own);
    let files = [
        ("rig.toml", rig.as_bytes()),
        ("run.csv", log.as_bytes()),
        ("table.csv", table.as_bytes()),
    ];
    let said = read_files(&files).unwrap_err().to_string();
    assert!(
        said.contains("table.csv: the table angle is read at 1.000 Hz, expected at least"),
        "{said}"
    );
}
