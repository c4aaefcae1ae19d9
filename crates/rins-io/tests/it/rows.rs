//! Rows of two sensors in one log.

use crate::support::{RIG, read_files, replaced};

fn logs() -> [String; 3] {
    let (mut both, mut gyro, mut accel) =
        ("type,n,ms,x,y,z\n".to_owned(), "n,ms,x,y,z\n".to_owned(), "n,ms,x,y,z\n".to_owned());
    for sample in 1..400_u32 {
        let wave = f64::from(sample % 7);
        let row = format!("{sample},{}.0,{wave}e-6,{}e-6,{}e-6\n", 10 * sample, -wave, 2.0 * wave);
        gyro += &row;
        both += &format!("Gyro,{row}");
        if sample % 2 == 0 {
            let row = format!("{sample},{}.0,0.1,0.{},9.8\n", 10 * sample + 1, sample % 5);
            accel += &row;
            both += &format!("Accel,{row}");
        }
        if sample % 50 == 0 {
            // Rows of other sensors have other fields.
            both += "Baro,1013.25\n";
        }
    }
    [both, gyro, accel]
}

const TIME: &str = "time = { column = \"ms\", unit = \"ms\" }";

fn rig(gyro: &str, accel: &str) -> String {
    let line = |key: &str| RIG.lines().find(|line| line.starts_with(key)).unwrap();
    let rig = replaced(RIG, line("rate"), "");
    let rig = replaced(&rig, line("table_angle"), "");
    let rig = replaced(&rig, line("time"), TIME);
    let triad = |key: &str, more: &str, unit: &str| {
        format!("{key} = {{ {more}, columns = [\"x\", \"y\", \"z\"], unit = \"{unit}\" }}")
    };
    let rig = replaced(&rig, line("gyro"), &triad("gyro", gyro, "rad/s"));
    replaced(&rig, line("accel"), &triad("accel", accel, "m/s^2"))
}

const GYRO: &str = "where = { column = \"type\", value = \"Gyro\" }";
const ACCEL: &str = "where = { column = \"type\", value = \"Accel\" }";

#[test]
fn interleaved_rows_are_those_of_two_files() {
    let [both, gyro, accel] = logs();
    let apart = rig("path = \"run.csv\"", &format!("path = \"accel.csv\", {TIME}"));
    let files = [
        ("rig.toml", apart.as_bytes()),
        ("run.csv", gyro.as_bytes()),
        ("accel.csv", accel.as_bytes()),
    ];
    let expected = read_files(&files).unwrap();
    let together = rig(GYRO, ACCEL);
    let loaded =
        read_files(&[("rig.toml", together.as_bytes()), ("run.csv", both.as_bytes())]).unwrap();
    assert_eq!(loaded.recording, expected.recording);
    assert_eq!(loaded.summary.redivided.unwrap().samples, 199);
}

#[test]
fn filters_that_select_nothing_or_one_sensor_are_refused() {
    let [both, ..] = logs();
    let said = |rig: String| {
        let files = [("rig.toml", rig.as_bytes()), ("run.csv", both.as_bytes())];
        read_files(&files).unwrap_err().to_string()
    };
    let nothing = rig(GYRO, &ACCEL.replace("Accel", "Acc"));
    assert!(said(nothing).ends_with("run.csv: no row has \"Acc\" in column \"type\""));
    let one = said(rig(GYRO, "offset = 0"));
    assert!(one.contains("accel.where: rows of one sensor"), "{one}");
}
