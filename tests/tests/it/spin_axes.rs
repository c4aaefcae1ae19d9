//! A table that rotates an IMU about any of its axes: names, signs and columns are those of the sensors.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::support::{list, number, numbers, object, result_in, rins_in};

/// A mounting of an IMU: for each axis of the run, of which z is the spin axis, the corresponding axis of the sensors, and
/// whether it is reversed.
#[derive(Clone, Copy, Debug)]
struct Mounting {
    spin: &'static str,
    axes: [(&'static str, f64); 3],
}

/// All six, written by hand.
const MOUNTINGS: [Mounting; 6] = [
    Mounting { spin: "x", axes: [("y", 1.0), ("z", 1.0), ("x", 1.0)] },
    Mounting { spin: "y", axes: [("z", 1.0), ("x", 1.0), ("y", 1.0)] },
    Mounting { spin: "z", axes: [("x", 1.0), ("y", 1.0), ("z", 1.0)] },
    Mounting { spin: "-x", axes: [("y", 1.0), ("z", -1.0), ("x", -1.0)] },
    Mounting { spin: "-y", axes: [("z", 1.0), ("x", -1.0), ("y", -1.0)] },
    Mounting { spin: "-z", axes: [("x", 1.0), ("y", -1.0), ("z", -1.0)] },
];

impl Mounting {
    fn of(self, letter: char) -> (&'static str, f64) {
        self.axes["xyz".find(letter).unwrap()]
    }

    /// The name of a parameter of a run about z along the sensors' own axes, and the factor of its value.
    fn own(self, id: &str) -> (String, f64) {
        let (term, name) = id.rsplit_once('.').unwrap();
        if term == "axis.attitude" {
            return (id.into(), 1.0);
        }
        let named: Vec<(&str, f64)> = name.chars().map(|letter| self.of(letter)).collect();
        let sign: f64 = named.iter().map(|(_, sign)| sign).product();
        let name: String = named.iter().map(|(letter, _)| *letter).collect();
        (format!("{term}.{name}"), if term.ends_with("scale") { 1.0 } else { sign })
    }

    /// The value of `axes` with which a log of a run about z becomes that of an IMU in this mounting: the readings of the
    /// sensor's x, ...
    fn read_as(self) -> [String; 3] {
        ["x", "y", "z"].map(|own| {
            let place = self.axes.iter().position(|(letter, _)| *letter == own).unwrap();
            let sign = if self.axes[place].1 < 0.0 { "-" } else { "" };
            format!("{sign}{}", ["x", "y", "z"][place])
        })
    }
}

/// The errors of an IMU along its own axes: ppm and, of row and column, arcsec.
const SCALES: [(&str, f64); 3] = [("x", 1500.0), ("y", -2500.0), ("z", 3000.0)];
const MISALIGNMENTS: [(&str, f64); 6] =
    [("xy", 412.5), ("xz", -618.8), ("yx", -206.3), ("yz", 165.0), ("zx", 144.4), ("zy", -247.5)];

/// Simulates a run on a level table of the IMU in this mounting to `folder`/`name`, as one about z.
fn simulated(folder: &Path, name: &str, mounting: Mounting, seed: u32) {
    let value = |id: &str, list: &[(&str, f64)]| {
        let (own, sign) = mounting.own(id);
        let axes = own.rsplit_once('.').unwrap().1;
        sign * list.iter().find(|(of, _)| *of == axes).unwrap().1
    };
    let scale = |axis: &str| value(&format!("gyro.scale.{axis}"), &SCALES);
    let scales = ["x", "y", "z"].map(|axis| format!("\"{} ppm\"", scale(axis))).join(", ");
    let crossed = |(axes, _): (&str, f64)| {
        let value = value(&format!("gyro.misalignment.{axes}"), &MISALIGNMENTS);
        format!("{axes} = \"{value} arcsec\"")
    };
    let misalignments = MISALIGNMENTS.map(crossed).join(", ");
    let scenario = format!(
        r#"[site]
latitude = "52 deg"
longitude = "0 deg"
height = "0 m"
[log]
rate = "20 Hz"
table_angle = {{ noise = "2 arcsec" }}
[table]
acceleration = "20 deg/s^2"
profile = [
    {{ rate = "0 deg/s", duration = "15 s" }},
    {{ rate = "30 deg/s", duration = "36 s" }},
    {{ rate = "-30 deg/s", duration = "36 s" }},
]
[attitude]
roll = "0 deg"
pitch = "0 deg"
yaw = "0 deg"
sigma = "0.1 deg"
[imu.gyro]
noise = "0.05 deg/sqrt(h)"
bias_sigma = "50 deg/h"
scale_sigma = "5000 ppm"
misalignment_sigma = "1000 arcsec"
[imu.accel]
noise = "20 ug/sqrt(Hz)"
bias_sigma = "3 mg"
scale_sigma = "5000 ppm"
misalignment_sigma = "1000 arcsec"
[truth]
seed = {seed}
gyro = {{ bias = ["20 deg/h", "-30 deg/h", "10 deg/h"], scale = [{scales}], misalignment = {{ {misalignments} }} }}
accel = {{ bias = ["1 mg", "-2 mg", "1.5 mg"], scale = ["0 ppm", "0 ppm", "0 ppm"] }}
"#
    );
    fs::write(folder.join("scenario.toml"), scenario).unwrap();
    result_in(folder, &format!("simulate scenario.toml -o {name}"));
}

/// The rig file of that run for the IMU in this mounting.
fn mounted(folder: &Path, name: &str, mounting: Mounting) -> String {
    let rig = fs::read_to_string(folder.join(name).join("rig.toml")).unwrap();
    let axes = format!(", axes = {:?} }}", mounting.read_as());
    let lines = rig.lines().map(|line| match line.strip_suffix(" }") {
        Some(start) if line.starts_with("gyro = ") || line.starts_with("accel = ") => {
            format!("{start}{axes}")
        }
        _ => line.to_owned(),
    });
    let rig: Vec<String> = lines.collect();
    let file = format!("{name}/about{}.toml", mounting.spin);
    let text = format!("{}\n[axis]\nspin = {:?}\n", rig.join("\n"), mounting.spin);
    fs::write(folder.join(&file), text).unwrap();
    file
}

/// The parameters of a result by id.
fn parameters(result: &Value) -> BTreeMap<String, Value> {
    let parameter = |value: &Value| (value["id"].as_str().unwrap().to_owned(), value.clone());
    list(result, "/parameters").iter().map(parameter).collect()
}

/// Asserts that a result along the sensors' own axes is that of the run about z except for names and signs.
fn assert_same(plain: &Value, own: &Value, mounting: Mounting) {
    let (plain, own) = (parameters(plain), parameters(own));
    assert_eq!(plain.len(), own.len(), "{mounting:?}");
    for (id, before) in plain {
        let (id, sign) = mounting.own(&id);
        let after = own.get(&id).unwrap_or_else(|| panic!("{mounting:?}: no {id}"));
        let close = |key: &str, factor: f64| {
            let (a, b) = (before[key].as_f64().unwrap(), after[key].as_f64().unwrap());
            assert!((factor * a - b).abs() <= 1e-9 * b.abs(), "{mounting:?}: {id} {key}: {a} {b}");
        };
        close("value", sign);
        close("sigma", 1.0);
        assert_eq!(before["identifiable"], after["identifiable"], "{mounting:?}: {id}");
        assert_eq!(before["observability"], after["observability"], "{mounting:?}: {id}");
    }
}

fn run_about_z() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    simulated(folder.path(), "run", MOUNTINGS[2], 1);
    folder
}

#[test]
fn results_about_any_axis_differ_in_names_alone() {
    let folder = run_about_z();
    let of = |rig: &str, model: &str| {
        // Biases of this size are not part of the paper's model: the excessive innovations are reported in addition to the
        // result.
        object(&rins_in(folder.path(), &format!("calibrate {rig} --model {model} --json")))
    };
    let plain = ["paper12", "full"].map(|model| of("run/rig.toml", model));
    for mounting in MOUNTINGS {
        let rig = mounted(folder.path(), "run", mounting);
        assert_same(&plain[0], &of(&rig, "paper12"), mounting);
        assert_same(&plain[1], &of(&rig, "full"), mounting);
    }
}

/// The output of `apply` has the columns of the sensors in the log, and `navigate` does not depend on their names.
#[test]
fn compensation_is_of_the_sensors_that_were_read() {
    let folder = run_about_z();
    result_in(folder.path(), "calibrate run/rig.toml --model full -o plain");
    let command = "navigate run/rig.toml --calibration plain/calibration.toml";
    let expected = result_in(folder.path(), command);
    for mounting in [MOUNTINGS[0], MOUNTINGS[4], MOUNTINGS[5]] {
        let rig = mounted(folder.path(), "run", mounting);
        let out = format!("about{}", mounting.spin);
        result_in(folder.path(), &format!("calibrate {rig} --model full -o {out}"));
        let file = format!("{out}/calibration.toml");
        let text = fs::read_to_string(folder.path().join(&file)).unwrap();
        let line = format!("spin = {:?}", mounting.spin);
        assert_eq!(text.lines().any(|of| of == line), mounting.spin != "z", "{text}");
        let done = result_in(folder.path(), &format!("navigate {rig} --calibration {file}"));
        assert_eq!(done["runs"], expected["runs"], "{mounting:?}");
        result_in(folder.path(), &format!("apply {rig} --calibration {file} -o {out}.csv"));
        let clean = fs::read_to_string(folder.path().join(format!("{out}.csv"))).unwrap();
        let mut lines = clean.lines();
        let head: Vec<&str> = lines.next().unwrap().split(',').collect();
        let row: Vec<f64> =
            lines.nth(600).unwrap().split(',').map(|n| n.parse().unwrap()).collect();
        let turned = |axis: &str| row[head.iter().position(|h| *h == axis).unwrap()].to_degrees();
        // At 30 s the table rotates at 30 deg/s, or 1.5 deg per sample.
        for (place, letter) in ["x", "y", "z"].into_iter().enumerate() {
            let (own, sign) = mounting.axes[place];
            let expected = if letter == "z" { 1.5 * sign } else { 0.0 };
            let seen = turned(&format!("gyro_{own}"));
            assert!((seen - expected).abs() < 0.01, "{mounting:?}: gyro_{own} {seen}");
        }
        // Its rig file has the axis, and the remaining errors are zero.
        let again = result_in(folder.path(), &format!("calibrate {out}.toml --model paper12"));
        let scale = format!("gyro.scale.{}", mounting.axes[2].0);
        let left = &parameters(&again)[&scale];
        let (value, sigma) = (left["value"].as_f64().unwrap(), left["sigma"].as_f64().unwrap());
        assert!(value.abs() < 5.0 * sigma, "{mounting:?}: {scale} {value} ± {sigma}");
    }
}

/// The channels of a log are reported by the names of the sensors.
#[test]
fn channels_are_named_as_the_sensors_are() {
    let folder = run_about_z();
    let plain = result_in(folder.path(), "allan run/rig.toml");
    let deviations = |result: &Value| -> BTreeMap<String, f64> {
        let shortest = |channel: &Value| {
            let id = channel["channel"].as_str().unwrap().to_owned();
            (id, numbers(channel, "/deviation")[0])
        };
        list(result, "/channels").iter().map(shortest).collect()
    };
    let plain = deviations(&plain);
    for mounting in [MOUNTINGS[0], MOUNTINGS[4]] {
        let rig = mounted(folder.path(), "run", mounting);
        let own = deviations(&result_in(folder.path(), &format!("allan {rig}")));
        for (channel, value) in &plain {
            let (own_channel, _) = mounting.own(channel);
            let seen = own[&own_channel];
            assert!((seen / value - 1.0).abs() < 1e-9, "{mounting:?}: {own_channel}");
        }
        let aligned = |rig: &str| {
            numbers(&result_in(folder.path(), &format!("align {rig}")), "/accel_bias_ug")
        };
        let (before, after) = (aligned("run/rig.toml"), aligned(&rig));
        for (place, (own, sign)) in mounting.axes.into_iter().enumerate() {
            let seen = after["xyz".find(own).unwrap()];
            assert!((seen - sign * before[place]).abs() < 1e-6, "{mounting:?}: accel {own}");
        }
    }
}

/// The textbook calibration: one IMU in three mountings on a table determines all scale errors and misalignments of its gyros.
#[test]
fn three_mountings_give_all_scale_errors_and_misalignments_of_the_gyros() {
    let folder = tempfile::tempdir().unwrap();
    let rigs: Vec<String> = [MOUNTINGS[0], MOUNTINGS[4], MOUNTINGS[2]]
        .into_iter()
        .zip(["one", "two", "three"])
        .zip(1..)
        .map(|((mounting, name), seed)| {
            simulated(folder.path(), name, mounting, seed);
            mounted(folder.path(), name, mounting)
        })
        .collect();
    let rigs = rigs.join(" ");
    let result = result_in(folder.path(), &format!("calibrate {rigs} --model full -o cal"));
    let found = parameters(&result);
    let truths = SCALES.iter().map(|(axes, value)| (format!("gyro.scale.{axes}"), *value, 10.0));
    let crossed = MISALIGNMENTS
        .iter()
        .map(|(axes, value)| (format!("gyro.misalignment.{axes}"), *value, 2.0));
    for (id, truth, most) in truths.chain(crossed) {
        let (value, sigma) = (&found[&id]["value"], &found[&id]["sigma"]);
        let (value, sigma) = (value.as_f64().unwrap(), sigma.as_f64().unwrap());
        assert!((value - truth).abs() < 4.0 * sigma, "{id}: {value} ± {sigma}, truly {truth}");
        assert!(sigma < most, "{id}: {sigma}");
        assert_eq!(found[&id]["identifiable"], true, "{id}");
    }
    assert!(number(&result, "/consistency/whiteness_p") > 1e-4, "{}", result["consistency"]);
    // Each run's file has the whole matrix, and a diagnosis of runs about several axes is refused.
    let files = ["calibration.toml", "calibration-2.toml", "calibration-3.toml"].map(|file| {
        let text = fs::read_to_string(folder.path().join("cal").join(file)).unwrap();
        let gyro = text.split("[gyro]").nth(1).unwrap();
        gyro.lines().find(|line| line.starts_with("misalignment")).unwrap().to_owned()
    });
    assert!(files.iter().all(|line| *line == files[0]), "{files:#?}");
    let refused = rins_in(folder.path(), &format!("diagnose {rigs}"));
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("the runs have different spin axes"), "{}", refused.err);
}

/// A parameter that acts only in a run about one axis is not available in a run about another, and the message states it.
#[test]
fn models_and_calibrations_name_the_axes_that_the_run_has() {
    let folder = run_about_z();
    let rig = mounted(folder.path(), "run", MOUNTINGS[0]);
    let model = |axis: &str| {
        let text = format!(
            "schema = 1\nbase = \"full\"\n[[term]]\nid = \"gyro_scale_asymmetry\"\nestimate = [\"{axis}\"]\n"
        );
        fs::write(folder.path().join("model.toml"), text).unwrap();
        rins_in(
            folder.path(),
            &format!("calibrate {rig} --model model.toml -o with --force --json"),
        )
    };
    let refused = model("z");
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("model.toml:5: term[1].estimate"), "{}", refused.err);
    let found = model("x");
    assert_eq!(found.code, Some(0), "{}", found.err);
    let text = fs::read_to_string(folder.path().join("with/calibration.toml")).unwrap();
    assert!(text.contains("id = \"gyro_scale_asymmetry\"\nestimate = true\nx = "), "{text}");
    // A calibration with the asymmetry of gyro x does not apply to a run about z.
    let command = "apply run/rig.toml --calibration with/calibration.toml -o clean.csv";
    let refused = rins_in(folder.path(), command);
    assert_eq!(refused.code, Some(1));
    let reason = "gyro_scale_asymmetry.x was estimated in a run about x";
    assert!(refused.err.contains(reason), "{}", refused.err);
    assert!(!folder.path().join("clean.csv").exists());
    // Read again, the model is the estimated one.
    let again = result_in(folder.path(), &format!("calibrate {rig} --model with/model.toml"));
    assert!(parameters(&again).contains_key("gyro_scale_asymmetry.x"));
}
