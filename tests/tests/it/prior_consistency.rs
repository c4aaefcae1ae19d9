//! A calibration is compared with the data sheet, in its first lines and in the JSON result.

use std::fs;
use std::path::Path;

use crate::support::{list, number, object, rins_in};

/// A run of an IMU with this scale error of its accelerometers, with a rig that states this gravity.
fn simulated(folder: &Path, scale: f64, gravity: &str) {
    let scenario = format!(
        r#"[site]
latitude = "45 deg"
longitude = "0 deg"
height = "400 m"
[log]
rate = "50 Hz"
table_angle = {{ noise = "1 arcsec" }}
[table]
acceleration = "20 deg/s^2"
profile = [
    {{ rate = "0 deg/s", duration = "20 s" }},
    {{ rate = "15 deg/s", duration = "50 s" }},
    {{ rate = "-15 deg/s", duration = "50 s" }},
]
[attitude]
roll = "30 deg"
pitch = "20 deg"
yaw = "40 deg"
sigma = "0.05 deg"
{data_sheets}
[truth]
seed = 4
accel = {{ bias = ["0 ug", "0 ug", "0 ug"], scale = ["{scale} ppm", "{scale} ppm", "{scale} ppm"] }}
"#,
        data_sheets = rins_testing::data_sheets!()
    );
    fs::write(folder.join("scenario.toml"), scenario).unwrap();
    let simulated = rins_in(folder, "simulate scenario.toml -o run --force");
    assert_eq!(simulated.code, Some(0), "{}", simulated.err);
    let rig = folder.join("run/rig.toml");
    let text = fs::read_to_string(&rig).unwrap();
    let site = text.replacen("[site]\n", &format!("[site]\n{gravity}\n"), 1);
    assert_ne!(site, text);
    fs::write(rig, site).unwrap();
}

#[test]
fn estimates_beyond_the_data_sheet_are_told_first() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (scale, gravity, departs, code) in [
        (100.0, "", false, 0),
        (2500.0, "", true, 0),
        (10_000.0, "", true, 1),
        (-10_000.0, "", true, 1),
        // Half a percent below the actual gravity.
        (0.0, "gravity = \"9.757 m/s^2\"", true, 1),
    ] {
        simulated(folder, scale, gravity);
        let finished = rins_in(folder, "calibrate run/rig.toml --model full --json");
        let said = format!("{scale} ppm, {gravity:?}: {}", finished.err);
        assert_eq!(finished.code, Some(code), "{said}");
        let result = object(&finished);
        let departed = list(&result, "/prior_consistency");
        assert_eq!(!departed.is_empty(), departs, "{said} {departed:?}");
        if let [first, ..] = departed {
            assert!(first["id"].as_str().unwrap().starts_with("accel.scale"), "{first}");
            let [value, expected, sigma, sigmas] =
                ["/value", "/expected", "/sigma", "/sigmas"].map(|key| number(first, key));
            let off = (value - expected) / sigma;
            assert!((off / sigmas - 1.0).abs() < 0.05 && sigmas.abs() > 4.0, "{first}");
            assert_eq!(sigmas.abs() > 10.0, code == 1, "{first}");
        }
        let text = rins_in(folder, "calibrate run/rig.toml --model full").out;
        let first = text.lines().nth(1).unwrap();
        assert_eq!(first.contains("was stated beforehand"), departs, "{said} {first}");
    }
}

/// The model file of a calibration has its sigmas as priors: for the same log they would count twice, which is said; for another run they are
/// what was known before.
#[test]
fn priors_from_the_same_log_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = rins_tests::workspace().join("scenarios/schedules/ii-reversal.toml");
    let done = |arguments: &str| {
        let finished = rins_in(folder.path(), arguments);
        assert_eq!(finished.code, Some(0), "{arguments}: {}", finished.err);
        finished.out
    };
    for seed in 1..=2 {
        done(&format!("simulate {} -o run{seed} --seed {seed}", scenario.display()));
    }
    done("calibrate run1/rig.toml --model full --noise given -o cal");
    let again = done("calibrate run1/rig.toml --model cal/model.toml --noise given");
    assert!(again.contains("these data count twice"), "{again}");
    let other = done("calibrate run2/rig.toml --model cal/model.toml --noise given");
    assert!(!other.contains("count twice"), "{other}");
}
