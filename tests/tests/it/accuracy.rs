//! The accuracy of what a calibration is referred to, as part of its uncertainty.

use std::fs;
use std::path::Path;

use rins_testing::{data_sheets, site};
use serde_json::Value;

use crate::support::{list, number, parameter, result_in, rins_in};

const SCENARIO: &str = concat!(
    site!(),
    data_sheets!(),
    r#"[log]
rate = "20 Hz"
table_angle = { noise = "1 arcsec" }
[table]
acceleration = "10 deg/s^2"
profile = [{ rate = "0 deg/s", duration = "30 s" }, { rate = "10 deg/s", duration = "120 s" }]
[attitude]
roll = "30 deg"
pitch = "20 deg"
yaw = "40 deg"
sigma = "0.05 deg"
[truth]
seed = 3
gyro = { scale = ["0 ppm", "0 ppm", "84 ppm"] }
"#
);

/// The calibration of the run with further keys in sections of its rig file.
fn calibrated(folder: &Path, keys: &[(&str, &str)]) -> Value {
    let mut rig = fs::read_to_string(folder.join("run/rig.toml")).unwrap();
    for (section, key) in keys {
        let heading = format!("[{section}]\n");
        assert!(rig.contains(&heading), "{rig}");
        rig = rig.replace(&heading, &format!("{heading}{key}\n"));
    }
    fs::write(folder.join("run/stated.toml"), rig).unwrap();
    result_in(folder, "calibrate run/stated.toml --model full")
}

/// A contribution to the uncertainty of a parameter.
fn contribution(parameter: &Value, reference: &str) -> f64 {
    let all = list(parameter, "/uncertainty/type_b");
    let own = all.iter().find(|one| one["reference"] == reference);
    number(own.unwrap_or_else(|| panic!("{parameter:#}")), "/contribution")
}

#[test]
fn rate_of_the_table_limits_the_scale_error() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("scenario.toml"), SCENARIO).unwrap();
    result_in(folder, "simulate scenario.toml -o run");
    let alone = calibrated(folder, &[]);
    let scale = parameter(&alone, "gyro.scale.z");
    assert!(scale["uncertainty"].is_null());
    let noise = number(scale, "/sigma");

    // 0.0001 deg/s of 10 deg/s are 10 ppm, and a rectangular distribution.
    let stated = calibrated(folder, &[("table", "rate_accuracy = \"0.0001 deg/s\"")]);
    let scale = parameter(&stated, "gyro.scale.z");
    let of_rate = contribution(scale, "table.rate_accuracy");
    assert!((of_rate.abs() / (10.0 / 3.0_f64.sqrt()) - 1.0).abs() < 0.03, "{scale:#}");
    let type_a = number(scale, "/uncertainty/type_a");
    assert!((type_a / noise - 1.0).abs() < 0.05 && noise < 0.5, "{scale:#}");
    let combined = number(scale, "/uncertainty/combined");
    assert!(
        (combined - of_rate.hypot(type_a)).abs() < 1e-6
            && scale["sigma"] == scale["uncertainty"]["combined"]
    );
    let expanded = number(scale, "/uncertainty/expanded");
    assert!((9.0..10.0).contains(&expanded), "{scale:#}");
    assert!((number(scale, "/value") - 84.0).abs() < 4.0 * noise, "{scale:#}");

    // A clock that is 20 ppm off, and a latitude.
    let keys =
        [("log", "clock_accuracy = \"20 ppm\""), ("site", "latitude_accuracy = \"60 arcsec\"")];
    let stated = calibrated(folder, &keys);
    let of_clock = contribution(parameter(&stated, "gyro.scale.z"), "log.clock_accuracy");
    // Increments are right whatever the clock is: the Earth turns 20 ppm further.
    assert!(of_clock.abs() < 0.1, "{of_clock}");
    let bias = contribution(parameter(&stated, "gyro.bias.x"), "site.latitude_accuracy").abs();
    assert!((1e-5..5e-3).contains(&bias), "{bias}");
    let text = rins_in(folder, "calibrate run/stated.toml").out;
    assert!(text.contains("The model is full: the accuracy of a reference"), "{text}");
    let refused = rins_in(folder, "calibrate run/stated.toml --model paper12");
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("full does"), "{}", refused.err);
}

/// The scale error of 84 ppm has an expanded uncertainty of 10 ppm by the rate of the table.
#[test]
fn statement_of_conformity_follows_from_tolerance_and_expanded_uncertainty() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("scenario.toml"), SCENARIO).unwrap();
    result_in(folder, "simulate scenario.toml -o run");
    let rig = fs::read_to_string(folder.join("run/rig.toml")).unwrap();
    let rig = rig.replace("[table]\n", "[table]\nrate_accuracy = \"0.0001 deg/s\"\n");
    let with = |scale: &str| {
        let tolerance = format!(
            "[tolerance.gyro]\nscale = [\"0 ppm\", \"0 ppm\", \"{scale}\"]\nmisalignment = {{ zx = \"5 arcsec\" }}\n"
        );
        fs::write(folder.join("run/stated.toml"), format!("{rig}\n{tolerance}")).unwrap();
    };
    for (tolerance, statement) in [
        ("100 ppm", "pass"),
        ("88 ppm", "conditional_pass"),
        ("80 ppm", "conditional_fail"),
        ("60 ppm", "fail"),
    ] {
        with(tolerance);
        let result = result_in(folder, "calibrate run/stated.toml");
        let all = list(&result, "/conformity");
        assert_eq!(all.len(), 2, "{all:#?}");
        assert_eq!(all[0]["id"], "gyro.misalignment.zx");
        // It would show if the table turned about x.
        assert_eq!(all[0]["statement"], "not_determined");
        assert_eq!(all[1]["statement"], statement, "{tolerance}: {all:#?}");
    }
    let text = rins_in(folder, "calibrate run/stated.toml").out;
    assert!(text.contains("tolerance 60.0 ppm: fail."), "{text}");
    with("-60 ppm");
    let refused = rins_in(folder, "calibrate run/stated.toml");
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("[tolerance.gyro] scale"), "{}", refused.err);
}

/// An error of the encoder once per revolution looks like a misalignment of the gyro about the axis: the Earth's rate turns once per
/// revolution too.
#[test]
fn what_the_stated_accuracy_of_an_encoder_explains_is_no_wrong_data_sheet() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let eccentric =
        "effects = [{ id = \"encoder_eccentricity\", cos = \"4 arcsec\", sin = \"0 arcsec\" }]\n";
    // Long and quiet enough to show it.
    let scenario = SCENARIO
        .replace("0.02 deg/h/sqrt(Hz)", "0.005 deg/h/sqrt(Hz)")
        .replace("1 arcsec", "0.3 arcsec")
        .replace("120 s", "300 s");
    fs::write(folder.join("scenario.toml"), format!("{scenario}{eccentric}")).unwrap();
    result_in(folder, "simulate scenario.toml -o run");
    let refused = rins_in(folder, "calibrate run/rig.toml --model full");
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("gyro.misalignment.z"), "{}", refused.err);
    let stated = calibrated(folder, &[("table", "angle_accuracy = \"5 arcsec\"")]);
    for id in ["gyro.misalignment.zx", "gyro.misalignment.zy"] {
        let misalignment = parameter(&stated, id);
        let (value, expanded) =
            (number(misalignment, "/value"), number(misalignment, "/uncertainty/expanded"));
        assert!(value.abs() < expanded, "{misalignment:#}");
    }
    assert!(list(&stated, "/prior_consistency").is_empty(), "{:#}", stated["prior_consistency"]);
}

#[test]
fn accuracy_is_positive_and_has_a_unit() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("scenario.toml"), SCENARIO).unwrap();
    result_in(folder, "simulate scenario.toml -o run");
    let rig = fs::read_to_string(folder.join("run/rig.toml")).unwrap();
    for (key, why) in [
        ("rate_accuracy = \"0 deg/s\"", "rate_accuracy"),
        ("rate_accuracy = \"10 ppm\"", "is a ratio, expected an angular rate"),
        ("angle_accuracy = 2", "angle_accuracy"),
    ] {
        fs::write(
            folder.join("run/wrong.toml"),
            rig.replace("[table]", &format!("[table]\n{key}")),
        )
        .unwrap();
        let refused = rins_in(folder, "calibrate run/wrong.toml");
        assert_eq!(refused.code, Some(1), "{key}");
        assert!(refused.err.contains(why), "{key}: {}", refused.err);
    }
}
