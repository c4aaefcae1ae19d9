//! Grids of scenarios that are too large.

use std::fmt::Write as _;
use std::path::Path;

use rins_io::ScenarioGrid;
use rins_testing::site;

const SCENARIO: &str = concat!(
    "\n",
    site!(),
    r#"[log]
rate = "50 Hz"
table_rate = {}
[table]
profile = [{ rate = "10 deg/s", duration = "36 s" }]
[truth]
seed = 1
attitude = { roll = "30 deg", pitch = "20 deg", yaw = "40 deg" }
noise = { gyro = "off", accel = "off" }
[grid]
"#
);

/// A grid of `axes` keys with 65,536 values each.
fn of(axes: usize) -> String {
    let mut text = SCENARIO.to_owned();
    for axis in 0..axes {
        writeln!(text, "k{axis} = {{ from = \"0 deg\", to = \"1 deg\", steps = 65536 }}").unwrap();
    }
    text
}

/// Four keys give 2⁶⁴ scenarios, which is zero in 64-bit arithmetic.
#[test]
fn more_scenarios_than_can_be_counted_are_refused() {
    for axes in [2, 4, 5] {
        let error = ScenarioGrid::parse(&of(axes), Path::new("s.toml")).unwrap_err().to_string();
        assert!(error.contains("more than 100000 combinations"), "{axes}: {error}");
    }
}

/// A few values of long scenarios need as much memory as many of short ones.
#[test]
fn scenarios_that_fill_memory_together_are_refused() {
    let comment = format!("# {}\n", "x".repeat(1 << 19));
    let grid = "\"site.height\" = { from = \"0 m\", to = \"1 m\", steps = 1000 }\n";
    let text = format!("{comment}{SCENARIO}{grid}");
    let error = ScenarioGrid::parse(&text, Path::new("s.toml")).unwrap_err().to_string();
    assert!(error.contains("1000 scenarios of 52") && error.contains("128 MiB"), "{error}");
    let text = format!("{SCENARIO}{grid}");
    assert_eq!(ScenarioGrid::parse(&text, Path::new("s.toml")).unwrap().cells.len(), 1000);
}
