//! Grids of scenarios that are too large.

use std::fmt::Write as _;
use std::path::Path;

use rins_io::ScenarioGrid;

const SCENARIO: &str = r#"
[site]
latitude = "34.25 deg"
longitude = "108.9 deg"
height = "400 m"
[log]
rate = "50 Hz"
table_rate = {}
[table]
profile = [{ rate = "10 deg/s", duration = "36 s" }]
[truth]
seed = 1
attitude = { roll = "30 deg", pitch = "20 deg", yaw = "40 deg" }
noise = { gyro = "off", accel = "off" }
[grid]
"#;

/// A grid of `axes` keys that have 65,536 values each.
fn of(axes: usize) -> String {
    let mut text = SCENARIO.to_owned();
    for axis in 0..axes {
        writeln!(text, "k{axis} = {{ from = \"0 deg\", to = \"1 deg\", steps = 65536 }}").unwrap();
    }
    text
}

/// Four of them are 2⁶⁴ scenarios, which is none to whoever counts in 64 bits.
#[test]
fn more_scenarios_than_can_be_counted_are_refused() {
    for axes in [2, 4, 5] {
        let error = ScenarioGrid::parse(&of(axes), Path::new("s.toml")).unwrap_err().to_string();
        assert!(error.contains("more than 100000 combinations"), "{axes}: {error}");
    }
}
