//! Errors of axes, units and columns in a rig file: each is reported with its correction, and a correct
//! rig file is accepted.

use std::fs;
use std::path::{Path, PathBuf};

use rins_tests::{outside_data, workspace};
use serde_json::{Value, json};

use crate::support::{list, object, result_in, rins_in, texts};

/// The units of the logs of simulated runs, and all units that a rig file may state.
const GYRO: (&str, [&str; 6]) = ("rad", ["rad/s", "deg/s", "deg/h", "rad", "deg", "arcsec"]);
const ACCEL: (&str, [&str; 6]) = ("m/s", ["m/s^2", "g", "mg", "ug", "m/s", "ug*s"]);
const TABLE: (&str, [&str; 4]) = ("rad", ["rad", "deg", "arcsec", "gon"]);

/// A scenario of a tilted table, with a recorded angle and a known attitude.
struct Bench {
    profile: Vec<(f64, f64)>,
    angles: [f64; 3],
    latitude: f64,
    rate: u32,
    /// The ratio of all sensor errors to those of a navigation-grade IMU.
    errors: f64,
    seed: u32,
}

const USUAL: Bench = Bench {
    profile: Vec::new(),
    angles: [30.0, 20.0, 40.0],
    latitude: 34.25,
    rate: 25,
    errors: 1.0,
    seed: 1,
};

impl Bench {
    /// Simulates it into `folder`/run; returns the text of its rig file.
    fn simulated(&self, folder: &Path) -> String {
        let Self { profile, angles: [roll, pitch, yaw], latitude, rate, errors, seed } = self;
        let profile: Vec<String> = profile
            .iter()
            .map(|(rate, lasting)| {
                format!("{{ rate = \"{rate} deg/s\", duration = \"{lasting} s\" }}")
            })
            .collect();
        let of = |size: f64, unit: &str| format!("{} {unit}", size * errors);
        // Errors of one to two sigma, with both signs.
        let sign = |place: u32| f64::from((seed * 7 + place * 5) % 9) / 2.0 - 2.0;
        let three = |size: f64, unit: &str, from: u32| -> String {
            let list =
                (from..from + 3).map(|place| format!("\"{} {unit}\"", size * errors * sign(place)));
            list.collect::<Vec<_>>().join(", ")
        };
        let scenario = format!(
            r#"[site]
latitude = "{latitude} deg"
longitude = "11 deg"
height = "200 m"
[log]
rate = "{rate} Hz"
table_angle = {{ noise = "1 arcsec", resolution = "0.1 arcsec" }}
[table]
acceleration = "10 deg/s^2"
profile = [{}]
[attitude]
roll = "{roll} deg"
pitch = "{pitch} deg"
yaw = "{yaw} deg"
sigma = "0.1 deg"
[imu.gyro]
noise = "{}"
bias_sigma = "{}"
scale_sigma = "{}"
misalignment_sigma = "{}"
[imu.accel]
noise = "{}"
bias_sigma = "{}"
scale_sigma = "{}"
misalignment_sigma = "{}"
[truth]
seed = {seed}
gyro = {{ bias = [{}], scale = [{}] }}
accel = {{ bias = [{}], scale = [{}] }}
"#,
            profile.join(", "),
            of(0.02, "deg/h/sqrt(Hz)"),
            of(0.1, "deg/h"),
            of(300.0, "ppm"),
            of(60.0, "arcsec"),
            of(30.0, "ug/sqrt(Hz)"),
            of(200.0, "ug"),
            of(300.0, "ppm"),
            of(60.0, "arcsec"),
            three(0.1, "deg/h", 0),
            three(300.0, "ppm", 3),
            three(200.0, "ug", 6),
            three(300.0, "ppm", 9),
        );
        fs::write(folder.join("scenario.toml"), scenario).unwrap();
        result_in(folder, "simulate scenario.toml -o run --force");
        fs::read_to_string(folder.join("run/rig.toml")).unwrap()
    }
}

/// One run that begins at rest, and one that rotates from its first sample to its last.
fn good_runs() -> Vec<(tempfile::TempDir, String)> {
    let profiles =
        [vec![(0.0, 30.0), (10.0, 45.0), (-10.0, 40.0)], vec![(12.0, 65.0), (-12.0, 65.0)]];
    let run = |profile: Vec<(f64, f64)>| {
        let folder = tempfile::tempdir().unwrap();
        let rig = Bench { profile, ..USUAL }.simulated(folder.path());
        (folder, rig)
    };
    profiles.into_iter().map(run).collect()
}

/// The result of `rins check` for the run in `folder` with another rig file.
fn checked(folder: &Path, rig: &str) -> Value {
    fs::write(folder.join("run/wrong.toml"), rig).unwrap();
    let finished = rins_in(folder, "check run/wrong.toml --json");
    let check = object(&finished);
    let suspected = !list(&check, "/suspicions").is_empty();
    assert_eq!(finished.code, Some(i32::from(suspected)), "{}", finished.err);
    check
}

/// All orders and signs of three axes except the correct one.
fn mistakes() -> Vec<[String; 3]> {
    let orders = [
        ["x", "y", "z"],
        ["y", "x", "z"],
        ["x", "z", "y"],
        ["z", "y", "x"],
        ["y", "z", "x"],
        ["z", "x", "y"],
    ];
    let signed = |names: [&str; 3], bits: usize| {
        let mut place = 0;
        names.map(|name| {
            let sign = if bits >> place & 1 == 1 { "-" } else { "" };
            place += 1;
            format!("{sign}{name}")
        })
    };
    let all = orders.into_iter().flat_map(|names| (0..8).map(move |bits| signed(names, bits)));
    all.skip(1).collect()
}

/// The line of `key` in a rig file.
fn line<'r>(rig: &'r str, key: &str) -> &'r str {
    rig.lines().find(|line| line.starts_with(&format!("{key} = "))).unwrap()
}

/// A rig file with a replacement in the line of `key`.
fn replaced(rig: &str, key: &str, from: &str, to: &str) -> String {
    let old = line(rig, key);
    assert!(old.contains(from), "{old}");
    rig.replacen(old, &old.replacen(from, to, 1), 1)
}

/// The correction of axes in `rins check --json` if the table's direction of rotation is correct.
fn mend(gyro: Option<[&str; 3]>, accel: Option<[&str; 3]>) -> Value {
    json!({"gyro_axes": gyro, "accel_axes": accel, "table_direction": null})
}

#[test]
fn every_order_and_sign_of_axes_is_told_with_the_lines_that_undo_it() {
    assert_eq!(mistakes().len(), 47);
    let right = Some(["x", "y", "z"]);
    for (folder, rig) in good_runs() {
        for axes in mistakes() {
            for (sensors, mend) in [
                (&["gyro"][..], mend(right, None)),
                (&["accel"], mend(None, right)),
                (&["gyro", "accel"], mend(right, right)),
            ] {
                let mut wrong = rig.clone();
                for sensor in sensors {
                    wrong = replaced(&wrong, sensor, " }", &format!(", axes = {axes:?} }}"));
                }
                let check = checked(folder.path(), &wrong);
                assert_eq!(check["corrections"], json!([mend]), "{sensors:?} {axes:?}: {check:#}");
            }
        }
    }
}

/// The correction starts from the stated axes, and from the sensor's axes.
#[test]
fn a_mend_takes_account_of_axes_and_spin_that_are_there() {
    let (folder, rig) = good_runs().remove(0);
    // The same IMU with other names of axes: the spin axis is its x axis.
    let mut turned = format!("{rig}\n[axis]\nspin = \"x\"\n");
    for sensor in ["gyro", "accel"] {
        turned = replaced(&turned, sensor, " }", ", axes = [\"z\", \"x\", \"y\"] }");
    }
    assert_eq!(checked(folder.path(), &turned)["suspicions"], json!([]));
    let wrong = replaced(&turned, "gyro", "\"z\", \"x\", \"y\"", "\"z\", \"-y\", \"x\"");
    let mend = mend(Some(["z", "x", "y"]), None);
    assert_eq!(checked(folder.path(), &wrong)["corrections"], json!([mend]));
}

/// The commands that compute a result from a log, without the name of the rig file.
const COMMANDS: [&str; 7] = [
    "calibrate --model paper12",
    "calibrate --model full",
    "diagnose",
    "align",
    "allan",
    "navigate",
    "apply --calibration right/calibration.toml -o clean.csv",
];

#[test]
fn nothing_is_computed_with_wrong_axes() {
    let (folder, rig) = good_runs().remove(1);
    result_in(folder.path(), "calibrate run/rig.toml -o right");
    for axes in [["x", "-y", "z"], ["-y", "x", "z"], ["z", "y", "x"], ["-x", "-y", "-z"]] {
        for sensors in [&["gyro"][..], &["accel"], &["gyro", "accel"]] {
            let mut wrong = rig.clone();
            for sensor in sensors {
                wrong = replaced(&wrong, sensor, " }", &format!(", axes = {axes:?} }}"));
            }
            fs::write(folder.path().join("run/wrong.toml"), wrong).unwrap();
            for command in COMMANDS {
                let finished = rins_in(folder.path(), &format!("{command} run/wrong.toml"));
                assert_eq!(finished.code, Some(1), "{command}: {axes:?}: {}", finished.out);
                let right = r#"axes = ["x", "y", "z"] under [log] "#;
                assert!(finished.err.contains(right), "{command}: {axes:?}: {}", finished.err);
            }
        }
    }
}

/// Asserts that every wrong unit of `key` is reported with the correct one.
fn assert_units(folder: &Path, rig: &str, key: &str, (meant, units): (&str, &[&str])) {
    for unit in units.iter().filter(|unit| **unit != meant) {
        let quoted = format!("unit = \"{meant}\"");
        let wrong = replaced(rig, key, &quoted, &format!("unit = \"{unit}\""));
        let check = checked(folder, &wrong);
        let told = texts(&check, "/suspicions");
        let named = format!("in {meant} were declared as {unit}");
        assert!(told.len() == 1 && told[0].contains(&named), "{key} as {unit}: {told:?}");
    }
}

#[test]
fn every_unit_taken_for_another_is_told() {
    for (folder, rig) in good_runs() {
        assert_units(folder.path(), &rig, "gyro", (GYRO.0, &GYRO.1));
        assert_units(folder.path(), &rig, "accel", (ACCEL.0, &ACCEL.1));
        assert_units(folder.path(), &rig, "table_angle", (TABLE.0, &TABLE.1));
    }
}

#[test]
fn exchanged_columns_and_a_table_of_the_other_sense_are_told() {
    for (folder, rig) in good_runs() {
        let exchanged = rig.replace("gyro_", "@").replace("accel_", "gyro_").replace('@', "accel_");
        let check = checked(folder.path(), &exchanged);
        let told = texts(&check, "/suspicions");
        let named = "the columns of gyro and accel are exchanged";
        assert!(told.len() == 1 && told[0].contains(named), "{told:?}");

        let log = fs::read_to_string(folder.path().join("run/run.csv")).unwrap();
        let place = log.lines().next().unwrap().split(',').position(|name| name == "table_angle");
        let backwards = |line: &str| {
            let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
            if let Ok(angle) = fields[place.unwrap()].parse::<f64>() {
                fields[place.unwrap()] = format!("{:e}", -angle);
            }
            fields.join(",") + "\n"
        };
        fs::write(
            folder.path().join("run/run.csv"),
            log.lines().map(backwards).collect::<String>(),
        )
        .unwrap();
        let check = checked(folder.path(), &rig);
        let told = texts(&check, "/suspicions");
        assert!(
            told[0].contains(
                "the direction of rotation of the table is opposite to that of the \
                                  gyro"
            ),
            "{told:?}"
        );
        let sense =
            |name| json!([{"gyro_axes": null, "accel_axes": null, "table_direction": name}]);
        assert_eq!(check["corrections"], sense("reversed"), "{told:?}");

        // The proposed correction removes the error, and causes one where it is not needed.
        let mended = replaced(&rig, "table_angle", " }", ", sense = \"reversed\" }");
        assert_eq!(checked(folder.path(), &mended)["suspicions"], json!([]));
        fs::write(folder.path().join("run/run.csv"), log).unwrap();
        assert_eq!(checked(folder.path(), &mended)["corrections"], sense("forward"));
        let aligned = rins_in(folder.path(), "navigate run/wrong.toml");
        assert_eq!(aligned.code, Some(1), "{}", aligned.out);
        let words = r#"set sense = "forward" under [log] table_angle"#;
        assert!(aligned.err.contains(words), "{}", aligned.err);
    }
}

/// If only the commanded profile is known, its direction of rotation is stated there.
#[test]
fn a_profile_of_the_other_sense_is_told() {
    for (folder, rig) in good_runs() {
        let commanded: String =
            rig.split_inclusive('\n').filter(|line| !line.starts_with("table_angle")).collect();
        assert_ne!(rig, commanded);
        assert_eq!(checked(folder.path(), &commanded)["corrections"], json!([]));
        let reversed = commanded.replacen("[table]\n", "[table]\nsense = \"reversed\"\n", 1);
        assert_ne!(reversed, commanded);
        let check = checked(folder.path(), &reversed);
        let mend = json!([{"gyro_axes": null, "accel_axes": null, "table_direction": "forward"}]);
        assert_eq!(check["corrections"], mend, "{check:#}");
        let aligned = rins_in(folder.path(), "navigate run/wrong.toml");
        assert_eq!(aligned.code, Some(1), "{}", aligned.out);
        let words = r#"set sense = "forward" under [table]"#;
        assert!(aligned.err.contains(words), "{}", aligned.err);
    }
}

/// A hundred correct runs of all kinds.
fn hundred() -> impl Iterator<Item = Bench> {
    (1..=100_u32).map(|seed| {
        // Angles that differ in all runs, spread over their ranges by irrational steps.
        let spread = |step: f64, most: f64| ((f64::from(seed) * step).fract() * 2.0 - 1.0) * most;
        let rate = spread(0.618, 1.0);
        let rate = (2.0 + 38.0 * rate.abs()).copysign(rate);
        let turning = 2.0 * 360.0 / rate.abs() + 10.0;
        let profile = match seed % 4 {
            0 => vec![(rate, turning)],
            1 => vec![(0.0, 30.0), (rate, turning)],
            2 => vec![(rate, turning), (-rate, turning)],
            _ => vec![(0.0, 20.0), (rate, 40.0), (0.0, 15.0), (-1.5 * rate, 30.0), (0.0, 10.0)],
        };
        Bench {
            profile,
            angles: [spread(0.414, 60.0), spread(0.732, 60.0), spread(0.236, 180.0)],
            latitude: spread(0.303, 75.0),
            rate: [10, 25, 50, 100][seed as usize / 4 % 4],
            errors: [1.0, 0.1, 10.0, 60.0][seed as usize / 16 % 4],
            seed,
        }
    })
}

#[test]
fn of_a_hundred_good_runs_none_is_suspected() {
    let folder = tempfile::tempdir().unwrap();
    for bench in hundred() {
        let rig = bench.simulated(folder.path());
        let check = object(&rins_in(folder.path(), "check run/rig.toml --json"));
        assert_eq!(check["suspicions"], json!([]), "seed {}: {rig}", bench.seed);
    }
}

/// The shipped schedules.
#[test]
fn other_good_runs_are_not_suspected() {
    let folder = tempfile::tempdir().unwrap();
    let mut runs = Vec::new();
    for entry in fs::read_dir(workspace().join("scenarios/schedules")).unwrap() {
        let scenario = entry.unwrap().path();
        let name = scenario.file_stem().unwrap().to_str().unwrap().to_owned();
        result_in(folder.path(), &format!("simulate {} -o {name}", scenario.display()));
        runs.push(folder.path().join(name));
    }
    assert_unsuspected(&runs);
}

/// Runs of other programs.
#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn runs_of_other_programs_are_not_suspected() {
    let folders = fs::read_dir(outside_data("synthetic")).unwrap();
    let runs: Vec<PathBuf> =
        folders.map(|entry| entry.unwrap().path()).filter(|path| path.is_dir()).collect();
    assert_unsuspected(&runs);
}

fn assert_unsuspected(runs: &[PathBuf]) {
    assert!(!runs.is_empty());
    for run in runs {
        let check = result_in(run, "check rig.toml");
        assert_eq!(check["suspicions"], json!([]), "{}", run.display());
    }
}
