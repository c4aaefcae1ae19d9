//! A table without a recorded angle: gravity is the angle reference.

use std::fs;

use rins_testing::{data_sheets, site};

use crate::support::{assert_found, number, parameter, result_in, texts};

/// A static interval, and two rotations, of which the second is longer: it begins at an unknown table angle.
const SCENARIO: &str = concat!(
    site!(),
    r#"
[log]
rate = "50 Hz"
table_angle = { noise = "0.3 arcsec" }

[table]
acceleration = "10 deg/s^2"
profile = [
    { rate = "0 deg/s", duration = "20 s" },
    { rate = "15 deg/s", duration = "60 s" },
    { rate = "-20 deg/s", duration = "100 s" },
]

[attitude]
roll = "25 deg"
pitch = "10 deg"
yaw = "30 deg"
sigma = "0.05 deg"

"#,
    data_sheets!(),
    r#"
[truth]
seed = 3

[truth.gyro]
bias = ["0.05 deg/h", "-0.03 deg/h", "0.08 deg/h"]
scale = ["100 ppm", "-200 ppm", "300 ppm"]
misalignment = { xy = "20 arcsec", xz = "60 arcsec", yx = "20 arcsec", yz = "-40 arcsec", zx = "20 arcsec", zy = "20 arcsec" }
"#
);

/// The stated attitude refers to a table angle of zero. Without an angle reference the axis still has its surveyed
/// direction, and no effect is found in a run without effects.
#[test]
fn its_axis_points_where_it_was_surveyed() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scenario.toml"), SCENARIO).unwrap();
    result_in(folder.path(), "simulate scenario.toml -o run");
    let rig = folder.path().join("run/rig.toml");
    let text = fs::read_to_string(&rig).unwrap();
    let (before, table) = text.split_once("[table]").unwrap();
    let (_, after) = table.split_once("[attitude]").unwrap();
    let lines = before.lines().filter(|line| !line.starts_with("table_angle"));
    let unread: Vec<&str> = lines.chain(["[attitude]"]).chain(after.lines()).collect();
    fs::write(&rig, unread.join("\n")).unwrap();

    let result = result_in(folder.path(), "calibrate run/rig.toml");
    assert!(
        texts(&result, "/notes").iter().any(|note| note.contains("The log has no table angle"))
    );
    for (id, truth) in [
        ("axis.attitude.x", 0.0),
        ("axis.attitude.y", 0.0),
        ("gyro.scale.z", 300.0),
        ("gyro.misalignment.xz", 60.0),
        ("gyro.misalignment.yz", -40.0),
    ] {
        assert_found(&result, id, truth);
    }
    // An axis that is known from gravity alone has a prior of two degrees.
    assert!(number(parameter(&result, "axis.attitude.x"), "/sigma") < 720.0);
    let diagnosis = result_in(folder.path(), "diagnose run/rig.toml");
    assert_eq!(diagnosis["verdict"], "adequate", "{}", diagnosis["causes"]);
}
