//! Calibrations with any model: hidden errors are found, alone or in the reported combination.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use nalgebra::{DMatrix, DVector};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G, PPM};
use rins_frames::{Dcm, EulerAngles, Nav, Table};
use rins_testing::{data_sheets, site};
use rins_tests::outside_data;
use serde_json::Value;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use tempfile::TempDir;

use crate::support::{
    assert_found, list, magnitude, number, numbers, parameter, result_in, rins_in, texts,
};

/// Values by id, in the units of results.
type Truth = BTreeMap<String, f64>;

/// The errors that an independent generator hid in a sample run.
fn hidden(run: &Path) -> Truth {
    let truth = fs::read_to_string(run.join("truth.json")).unwrap();
    let truth: Value = serde_json::from_str(&truth).unwrap();
    let mut values = Truth::new();
    let names = ["x", "y", "z"];
    for (triad, bias, matrix, unit) in
        [("gyro", "bg", "Mg", DEG_PER_HOUR), ("accel", "ba", "Ma", MICRO_G)]
    {
        for (row, name) in names.iter().enumerate() {
            let bias = number(&truth, &format!("/{bias}/{row}"));
            values.insert(format!("{triad}.bias.{name}"), bias / unit);
            for (column, other) in names.iter().enumerate() {
                let value = number(&truth, &format!("/{matrix}/{row}/{column}"));
                if row == column {
                    values.insert(format!("{triad}.scale.{name}"), value / PPM);
                } else {
                    values.insert(format!("{triad}.misalignment.{name}{other}"), value / ARCSEC);
                }
            }
        }
    }
    let angles = |roll: f64, pitch: f64, yaw: f64| -> Dcm<Nav, Table> {
        EulerAngles { roll: roll * DEG, pitch: pitch * DEG, yaw: yaw * DEG }.dcm()
    };
    let [roll, pitch, yaw] = [0, 1, 2].map(|axis| number(&truth, &format!("/rpy_deg/{axis}")));
    // The rig files state 30, 20 and 40 deg.
    let off = (angles(30.0, 20.0, 40.0).inverse() * angles(roll, pitch, yaw)).rotation_vector();
    for (axis, name) in names.iter().enumerate() {
        values.insert(format!("axis.attitude.{name}"), off[axis] / ARCSEC);
    }
    values
}

/// The error of a parameter of a result, or of its reported combination, in sigmas.
fn off(parameter: &Value, truth: &Truth) -> f64 {
    let id = parameter["id"].as_str().unwrap();
    let partners = texts(parameter, "/aliases");
    let coefficients = numbers(parameter, "/alias_coefficients");
    let others: f64 = partners.iter().zip(coefficients).map(|(id, c)| truth[*id] * c).sum();
    (number(parameter, "/value") - truth[id] - others) / number(parameter, "/sigma")
}

/// The sample run of this name, calibrated with all of eq. (1).
fn sample(name: &str) -> (PathBuf, Value) {
    let run = outside_data(&format!("synthetic/{name}"));
    let result = result_in(&run, "calibrate rig.toml --model full");
    (run, result)
}

/// The χ² probability of the errors of the parameters that are observable alone.
fn probability(result: &Value, truth: &Truth) -> f64 {
    let parameters = list(result, "/parameters");
    let alone: Vec<usize> =
        (0..parameters.len()).filter(|&p| parameters[p]["identifiable"] == true).collect();
    let correlation = DMatrix::from_fn(alone.len(), alone.len(), |row, column| {
        number(result, &format!("/correlation/{}/{}", alone[row], alone[column]))
    });
    let off =
        DVector::from_iterator(alone.len(), alone.iter().map(|&p| off(&parameters[p], truth)));
    let chi_square = off.dot(&correlation.cholesky().unwrap().solve(&off));
    ChiSquared::new(alone.len() as f64).unwrap().cdf(chi_square)
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn all_that_several_rates_show_is_found() {
    let (run, result) = sample("clean_multirate");
    let truth = hidden(&run);
    assert_eq!(result["consistency"]["verdict"], "fits", "{}", result["consistency"]);
    let parameters = list(&result, "/parameters");
    assert_eq!(parameters.len(), 27);
    for parameter in parameters {
        assert!(off(parameter, &truth).abs() < 4.0, "{parameter}");
    }
    // The errors for which the schedule is designed are observable alone, with a sigma well below the data sheet.
    for id in ["gyro.bias.z", "gyro.scale.z", "gyro.misalignment.xz", "gyro.misalignment.yz"] {
        let parameter = parameters.iter().find(|parameter| parameter["id"] == id).unwrap();
        assert_eq!(parameter["identifiable"], true, "{parameter}");
        assert!(number(parameter, "/sigma") < 0.1 * number(parameter, "/prior_sigma"));
    }
    let p = probability(&result, &truth);
    assert!((0.001..0.999).contains(&p), "the chi-square of what is off is at its {p} point");
    let before = magnitude(&result, "/navigation/before/velocity_m_s");
    let after = magnitude(&result, "/navigation/after/velocity_m_s");
    assert!(before > 20.0 * after, "{before} m/s before, {after} m/s after");
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn one_rate_after_a_rest_shows_the_rest_in_combinations() {
    let (run, result) = sample("paper_constant_rate");
    let truth = hidden(&run);
    let parameters = list(&result, "/parameters");
    for parameter in parameters {
        assert!(off(parameter, &truth).abs() < 4.0, "{parameter}");
    }
    // The accelerometers rotate about one axis only: some parameters are observable only in pairs.
    let scale = parameter(&result, "accel.scale.x");
    assert_eq!(scale["identifiable"], false, "{scale}");
    assert_eq!(texts(scale, "/aliases"), ["accel.scale.y"]);
    assert!(number(scale, "/sigma") < 0.1 * number(scale, "/marginal/sigma"), "{scale}");
    // The static minute distinguishes the gyro bias from errors proportional to the table rate, with a stated sigma.
    let alone = number(parameter(&result, "gyro.misalignment.xz"), "/sigma");
    let paper = result_in(&run, "calibrate rig.toml --model paper12");
    let with_bias = number(parameter(&paper, "gyro.misalignment.xz"), "/sigma");
    assert!(alone > 2.0 * with_bias, "{alone} against {with_bias}");
    let p = probability(&result, &truth);
    assert!((0.001..0.999).contains(&p), "the chi-square of what is off is at its {p} point");
}

/// A scenario with an axis tilted by `roll`, and with `effects` in addition to three gyro errors.
fn scenario(roll: f64, seed: u64, effects: &str) -> String {
    format!(
        r#"{site}
[log]
rate = "20 Hz"
table_angle = {{ noise = "0.3 arcsec" }}

[table]
acceleration = "5 deg/s^2"
profile = [
    {{ rate = "0 deg/s", duration = "30 s" }},
    {{ rate = "10 deg/s", duration = "100 s" }},
    {{ rate = "-30 deg/s", duration = "80 s" }},
]

[attitude]
roll = "{roll} deg"
pitch = "20 deg"
yaw = "40 deg"
sigma = "0.05 deg"

{data_sheets}
[truth]
seed = {seed}
effects = [{effects}]

[truth.gyro]
bias = ["0.05 deg/h", "-0.03 deg/h", "0.08 deg/h"]
scale = ["100 ppm", "-200 ppm", "300 ppm"]
misalignment = {{ xy = "20 arcsec", xz = "60 arcsec", yx = "20 arcsec", yz = "-40 arcsec", zx = "20 arcsec", zy = "20 arcsec" }}
"#,
        site = site!(),
        data_sheets = data_sheets!()
    )
}

const LEVER_ARM: &str = r#"{ id = "accel_lever_arm", r_x = "4 mm", r_y = "-2.5 mm" }"#;

const MODEL: &str = r#"schema = 1
base = "full"

[[term]]
id = "accel_lever_arm"
"#;

/// A folder with simulated runs `a`, `b`, ..., one for each tilt.
fn runs(rolls: &[f64], effects: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (place, (roll, name)) in rolls.iter().zip(["a", "b", "c"]).enumerate() {
        let text = scenario(*roll, 11 + place as u64, effects);
        fs::write(folder.path().join("scenario.toml"), text).unwrap();
        result_in(folder.path(), &format!("simulate scenario.toml -o {name}"));
    }
    fs::write(folder.path().join("model.toml"), MODEL).unwrap();
    folder
}

#[test]
fn a_hidden_lever_arm_is_estimated_written_and_undone() {
    let folder = runs(&[30.0], LEVER_ARM);
    let calibrate = "calibrate a/rig.toml --model model.toml -o out";
    let result = result_in(folder.path(), calibrate);
    assert_eq!(result["consistency"]["model_fits"], true, "{}", result["consistency"]);
    assert_found(&result, "accel_lever_arm.r_x", 4.0);
    assert_found(&result, "accel_lever_arm.r_y", -2.5);
    assert!(number(parameter(&result, "accel_lever_arm.r_x"), "/sigma") < 0.2);
    assert_eq!(list(&result, "/error_budget/parameters").len(), 29);

    // The same readings, compensated by navigate and by apply.
    let navigated =
        result_in(folder.path(), "navigate a/rig.toml --calibration out/calibration.toml");
    let compensated = &list(&navigated, "/runs")[1];
    let applied = result_in(
        folder.path(),
        "apply a/rig.toml --calibration out/calibration.toml -o clean.csv",
    );
    assert_eq!(applied["exact"], true, "{applied}");
    assert!(texts(&applied, "/compensated").contains(&"accel_lever_arm"));
    let clean = result_in(folder.path(), "navigate clean.toml");
    let velocities =
        [compensated, &list(&clean, "/runs")[0]].map(|run| numbers(run, "/velocity_m_s"));
    for (one, other) in velocities[0].iter().zip(&velocities[1]) {
        assert!((one - other).abs() < 1e-9, "{velocities:?}");
    }
    // Nothing more is found in the compensated log.
    let again = result_in(folder.path(), "calibrate clean.toml --model model.toml");
    for (id, was) in [("gyro.scale.z", 300.0), ("accel_lever_arm.r_x", 4.0)] {
        let left = number(parameter(&again, id), "/value");
        assert!(left.abs() < 1e-2 * was, "{id}: {left} left of {was}");
    }
}

#[test]
fn what_was_calibrated_is_the_next_model() {
    let folder = runs(&[30.0], LEVER_ARM);
    result_in(folder.path(), "calibrate a/rig.toml --model model.toml -o out");
    let first = result_in(folder.path(), "calibrate a/rig.toml --model model.toml");
    let again = result_in(folder.path(), "calibrate a/rig.toml --model out/model.toml");
    for id in ["gyro.scale.z", "accel_lever_arm.r_y"] {
        // The same data a second time: the same value, with a sigma smaller by the root of two, or by more
        // if the correlated parameters are known better.
        let [a, b] = [&first, &again].map(|result| parameter(result, id));
        let moved = (number(a, "/marginal/value") - number(b, "/marginal/value")).abs();
        assert!(moved < 0.2 * number(a, "/marginal/sigma"), "{id}: {a} {b}");
        let ratio = number(a, "/marginal/sigma") / number(b, "/marginal/sigma");
        assert!((1.3..4.0).contains(&ratio), "{id}: {ratio}");
    }
}

#[test]
fn two_tilts_share_the_sensors_and_show_more() {
    let folder = runs(&[30.0, -35.0], "");
    let one = result_in(folder.path(), "calibrate a/rig.toml --model full");
    let both = result_in(folder.path(), "calibrate a/rig.toml b/rig.toml --model full -o out");
    assert_eq!(texts(&both, "/rigs"), ["a/rig.toml", "b/rig.toml"]);
    assert_eq!(both["consistency"]["model_fits"], true, "{}", both["consistency"]);
    // 18 of the sensors, 9 of each run.
    assert_eq!(list(&both, "/parameters").len(), 36);
    let of_run =
        |run: u64| list(&both, "/parameters").iter().filter(move |p| p["run"] == run).count();
    assert_eq!([of_run(1), of_run(2)], [9, 9]);
    assert_found(&both, "gyro.scale.z", 300.0);
    assert_found(&both, "gyro.misalignment.xz", 60.0);
    // At the other tilt, the Earth rate is about another axis of the body.
    let sigma = |result: &Value| number(parameter(result, "gyro.scale.x"), "/marginal/sigma");
    assert!(sigma(&both) < 0.6 * sigma(&one), "{} of {}", sigma(&both), sigma(&one));
    for name in ["calibration.toml", "calibration-2.toml", "model.toml", "report.html"] {
        assert!(folder.path().join("out").join(name).is_file(), "{name}");
    }
}

#[test]
fn what_moved_between_two_calibrations_is_told_in_sigmas() {
    let folder = runs(&[30.0, 30.0], "");
    for run in ["a", "b"] {
        result_in(folder.path(), &format!("calibrate {run}/rig.toml --model full -o {run}-out"));
    }
    let compare = |a: &str, b: &str| {
        result_in(folder.path(), &format!("compare {a}/calibration.toml {b}/calibration.toml"))
    };
    let same = compare("a-out", "a-out");
    assert!(number(&same, "/together/chi_square") < 1e-9, "{same}");
    // Other noise, the same errors: the p-value is unremarkable.
    let alike = compare("a-out", "b-out");
    assert_eq!(list(&alike, "/parameters").len(), 24);
    assert!(number(&alike, "/together/p") > 1e-3, "{alike}");
    for parameter in list(&alike, "/parameters") {
        assert!(number(parameter, "/sigmas").abs() < 4.5, "{parameter}");
    }
    // A changed scale error is reported.
    let path = folder.path().join("b-out/calibration.toml");
    let text = fs::read_to_string(&path).unwrap();
    let line = text.lines().find(|line| line.starts_with("scale = ")).unwrap();
    let last = line.split('"').nth(5).unwrap();
    let changed = line.replace(last, "350 ppm");
    fs::write(&path, text.replacen(line, &changed, 1)).unwrap();
    let moved = compare("a-out", "b-out");
    let scale = parameter(&moved, "gyro.scale.z");
    assert!((40.0..60.0).contains(&number(scale, "/difference")), "{scale}");
    assert!(number(scale, "/sigmas") > 10.0 && number(&moved, "/together/p") < 1e-6, "{moved}");
}

#[test]
fn the_model_is_said_where_it_is_not_given() {
    let folder = runs(&[30.0, -35.0], "");
    let one = result_in(folder.path(), "calibrate a/rig.toml");
    assert_eq!(one["model"], "paper12");
    let two = rins_in(folder.path(), "calibrate a/rig.toml b/rig.toml --json --noise given");
    assert!(
        two.out.contains(r#""model":"full""#) && two.out.contains(r#""estimated":false"#),
        "{two:?}"
    );
}
