//! Measured logs of third parties, with all their anomalies.
//!
//! Expected figures were computed from the files with awk, or are those of the project that measured
//! them; none is an output of `rins`. The rigs are in `tests/rigs`, with the origin of their values.

mod chamber;
mod drafts;
mod least_squares;
mod logs;

use std::fs;

use rins_testing::assert_close;
use rins_tests::{outside_data, workspace};
use serde_json::Value;
use tempfile::TempDir;

use crate::support::{list, magnitude, number, numbers, parameter, result_in, rins_in, texts};

/// A folder with a rig of `tests/rigs` that refers to the measured log.
fn rig(name: &str) -> TempDir {
    outside_data(&format!("real/{name}"));
    let data = outside_data("").canonicalize().unwrap();
    let rig = fs::read_to_string(workspace().join(format!("tests/rigs/{name}.toml"))).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let rig = rig.replace("RINS_DATA", &data.display().to_string());
    fs::write(folder.path().join("rig.toml"), rig).unwrap();
    folder
}

fn checked(folder: &TempDir) -> Value {
    result_in(folder.path(), "check rig.toml")
}

/// Whether an anomaly is reported with these words.
fn is_odd(check: &Value, words: &str) -> bool {
    texts(check, "/remarks").iter().any(|oddity| oddity.contains(words))
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn laser_gyro_is_at_rest_and_sees_the_earth_turn() {
    let folder = rig("psins_lasergyro");
    let check = checked(&folder);
    assert_eq!(check["samples"], 184718);
    assert_close!(number(&check, "/rate_hz"), 100.0, 1e-6);
    assert!(list(&check, "/gaps").is_empty());
    assert!(texts(&check, "/suspicions").is_empty(), "{check}");
    assert_eq!(check["earth_rate_visible"], true);
    assert!(is_odd(&check, "no time column"), "{check}");
    let rests = list(&check, "/static_means");
    assert_eq!(rests.len(), 1);
    // Except for the last part of a second, it is static throughout.
    assert!(number(&rests[0], "/to_s") - number(&rests[0], "/from_s") > 1846.0);
    // The header's g and the normal gravity differ by less than an accelerometer's scale error.
    assert_close!(number(&rests[0], "/gravity_m_s2"), 9.7955, 1e-3);
    assert_close!(number(&rests[0], "/rate_deg_h"), 15.0, 0.3);
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn laser_gyro_finds_its_latitude_and_north() {
    let folder = rig("psins_lasergyro");
    let align = result_in(folder.path(), "align rig.toml");
    let latitude_sigma = number(&align, "/apparent/latitude_sigma_deg");
    let rate_sigma = number(&align, "/apparent/earth_rate_sigma_deg_h");
    // An excessive sigma would not be a result.
    assert!((1e-3..0.2).contains(&latitude_sigma), "{latitude_sigma} deg");
    assert!((1e-4..0.1).contains(&rate_sigma), "{rate_sigma} deg/h");
    assert_close!(number(&align, "/apparent/latitude_deg"), 34.246048, 4.0 * latitude_sigma);
    assert_close!(number(&align, "/apparent/earth_rate_deg_h"), 15.041067, 4.0 * rate_sigma);
    // The header states the heading to a tenth of a degree, and zero for roll and pitch.
    assert_close!(number(&align, "/header_attitude_deg/yaw"), -90.6, 1e-9);
    let heading = number(&align, "/attitude_deg/yaw");
    assert_close!(heading, -90.6, 0.1 + 4.0 * number(&align, "/sigma_deg/up"));
    for angle in ["roll", "pitch"] {
        assert!(number(&align, &format!("/attitude_deg/{angle}")).abs() < 1.5, "{align}");
    }
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn laser_gyro_navigates_within_a_mile() {
    let folder = rig("psins_lasergyro");
    let navigate = result_in(folder.path(), "navigate rig.toml");
    assert_close!(number(&navigate, "/duration_s"), 1847.18, 1e-6);
    let runs = list(&navigate, "/runs");
    let names: Vec<&str> = runs.iter().filter_map(|run| run["name"].as_str()).collect();
    assert_eq!(names, ["as recorded", "gyro bias removed"]);
    for run in runs {
        // In half an hour a navigation-grade IMU has an error of about one nautical mile at most.
        let (speed, position) =
            (magnitude(run, "/velocity_m_s"), magnitude(run, "/position_error_m"));
        assert!((0.01..3.0).contains(&speed), "{run}");
        assert!((10.0..1852.0).contains(&position), "{run}");
        for angle in ["roll", "pitch", "yaw"] {
            let error = number(run, &format!("/attitude_error_deg/{angle}"));
            assert!(error.abs() < 0.5, "{angle} in {run}");
        }
    }
    let [recorded, removed] = [0, 1].map(|run| numbers(&runs[run], "/velocity_m_s"));
    let change = (recorded[0] - removed[0]).hypot(recorded[1] - removed[1]);
    assert!(change > 0.05, "removing the gyro bias changes the velocity by {change} m/s only");
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn wheel_has_gaps_and_no_rest() {
    let folder = rig("worklab_wheel_right");
    let check = checked(&folder);
    // 14039 lines, of which 31 repeat the previous one.
    assert_eq!(check["samples"], 14008);
    assert_close!(number(&check, "/rate_hz"), 1.0 / 0.0024638, 0.5);
    let gaps: Vec<f64> = list(&check, "/gaps").iter().map(|gap| number(gap, "/length_s")).collect();
    let long: Vec<f64> = gaps.iter().copied().filter(|gap| *gap > 0.01).collect();
    // 236 single samples are missing; 15 intervals are longer than 14 ms, and one is 17.2 ms.
    assert_eq!((gaps.len(), long.len()), (251, 15));
    assert_close!(gaps.iter().copied().fold(0.0, f64::max), 0.01725, 1e-4);
    // Gaps explain all of the 0.516 ms of scatter of the steps; the others hardly contribute.
    let (count, jitter) = (14007.0, number(&check, "/jitter_rms_s"));
    assert!(jitter < 0.05e-3, "{jitter}");
    let mean = 0.00251889;
    let regular = 1.0 / number(&check, "/rate_hz");
    let off = |step: f64| (step - mean) * (step - mean);
    let others = (count - gaps.len() as f64) * (off(regular) + jitter * jitter);
    let scatter = ((gaps.iter().copied().map(off).sum::<f64>() + others) / count).sqrt();
    assert_close!(scatter, 0.516e-3, 0.01e-3);

    assert!(list(&check, "/static_means").is_empty());
    assert!(is_odd(&check, "251 gap(s)") && is_odd(&check, "never static"), "{check}");
    // About 16 turns of the wheel, and swaying about its axis before and after.
    assert!((16.0..24.0).contains(&number(&check, "/turns")), "{check}");
    for (command, rest) in [("align", 5), ("navigate", 5), ("allan", 10)] {
        let refused = rins_in(folder.path(), &format!("{command} rig.toml --json"));
        assert_eq!((refused.code, refused.out.as_str()), (Some(1), ""));
        let why = format!("sensors.csv: the IMU is never static for {rest} s");
        assert!(refused.err.contains(&why), "{}", refused.err);
    }
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn nilspod_counts_samples_and_reads_gravity_by_its_side() {
    let folder = rig("imucal_nilspod");
    let check = checked(&folder);
    assert_eq!(check["samples"], 10376);
    assert_close!(number(&check, "/rate_hz"), 102.4, 1e-6);
    assert!(list(&check, "/gaps").is_empty() && number(&check, "/jitter_rms_s") < 1e-9);
    let rests = list(&check, "/static_means");
    assert_eq!(rests.len(), 13);
    let gravity: Vec<f64> = rests.iter().map(|rest| number(rest, "/gravity_m_s2")).collect();
    let (least, most) = (
        gravity.iter().copied().fold(f64::MAX, f64::min),
        gravity.iter().copied().fold(0.0, f64::max),
    );
    assert!((9.1..9.4).contains(&least) && (10.3..10.6).contains(&most), "{gravity:?}");
    // A bias of some percent is not a wrong unit.
    assert!(texts(&check, "/suspicions").is_empty(), "{check}");
    assert!(is_odd(&check, "the accelerometers are not calibrated"), "{check}");
    assert_eq!(check["earth_rate_visible"], false);

    let align = result_in(folder.path(), "align rig.toml");
    assert!(align["attitude_deg"]["yaw"].is_null() && align["apparent"]["latitude_deg"].is_null());
    let rins = rins_in(folder.path(), "align rig.toml");
    assert!(rins.out.contains("the gyros do not show north"), "{}", rins.out);
}

/// The content of its columns; its static intervals are another test.
#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn xsens_is_read_from_two_files_of_counts() {
    let folder = rig("imu_tk_xsens");
    let check = checked(&folder);
    assert_eq!(check["samples"], 51175);
    assert_close!(number(&check, "/rate_hz"), 100.0, 0.1);
    assert!(list(&check, "/gaps").is_empty());
    assert_eq!(check["earth_rate_visible"], false);
    assert!(texts(&check, "/suspicions").is_empty(), "{check}");
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn xsens_rests_38_times_and_reads_gravity_each_time() {
    let folder = rig("imu_tk_xsens");
    let check = checked(&folder);
    let rests = list(&check, "/static_means");
    assert!((36..=40).contains(&rests.len()), "{} rests", rests.len());
    // The first lasts 52 s.
    assert!(number(&rests[0], "/to_s") - number(&rests[0], "/from_s") > 45.0, "{}", rests[0]);
    for rest in rests {
        // The largest difference is 0.1 m/s^2, due to misalignment.
        assert_close!(number(rest, "/gravity_m_s2"), 9.8065, 0.13);
    }
    let align = result_in(folder.path(), "align rig.toml");
    assert!(align["attitude_deg"]["yaw"].is_null(), "{align}");
}

/// This concerns the errors of the model only: the chair moves, and the errors may exceed their sigmas.
#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn wheel_shows_its_lever_arm_by_gravity_and_that_the_model_does_not_fit() {
    let folder = rig("worklab_wheel_right");
    let result = result_in(folder.path(), "calibrate rig.toml");
    assert_eq!(
        (&result["model"], &result["runs"][0]["reference"]),
        (&"full".into(), &"gravity".into())
    );
    assert_eq!(result["consistency"]["verdict"], "misfit");
    assert_eq!(result["consistency"]["nis_dof"], 5);
    // A simple regression of the readings on the rotation of gravity, w² and w' gives 43 mm along z, -20 mm along x.
    let arm = |axis: &str| parameter(&result, &format!("accel_lever_arm.r_{axis}"));
    assert_close!(number(arm("z"), "/value"), 43.0, 5.0);
    assert_close!(number(arm("x"), "/value"), -20.0, 12.0);
    assert!(number(arm("z"), "/sigma") < 5.0, "{}", arm("z"));
    // Most of gravity rotates in the plane of a wheel.
    let across = number(&result, "/runs/0/gravity_across_axis_m_s2");
    assert!((8.5..9.81).contains(&across), "{across}");
    let scale = parameter(&result, "gyro.scale.y");
    let (value, sigma) = (number(scale, "/marginal/value"), number(scale, "/marginal/sigma"));
    // The scale error of a consumer gyro, with a sigma of a part in a thousand and not better: the chair rotates too.
    assert!((300.0..10000.0).contains(&sigma) && value.abs() < 2e4, "{scale}");
    assert!(texts(&result, "/notes").iter().any(|note| note.contains("lever arm")), "{result}");
}

/// The vehicle that carries it sways by hundreds of arcseconds: that is not noise of the gyros.
#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn laser_gyro_is_quiet_on_a_base_that_sways() {
    let folder = rig("psins_lasergyro");
    let result = result_in(folder.path(), "calibrate rig.toml");
    assert_eq!(result["runs"][0]["reference"], "static");
    let white = number(&result, "/noise/gyro/white_deg_h_sqrt_hz");
    // That of laser gyros of navigation grade: a thousandth to some hundredths of a degree per root hour.
    assert!((0.003..0.3).contains(&white), "{white} deg/h/√Hz");
    let sway = numbers(&result, "/runs/0/base_sway_arcsec_sqrt_s");
    assert!(sway[..2].iter().all(|sway| (5.0..200.0).contains(sway)), "{sway:?}");
    // The resolution of velocity is 2.4 mm/s.
    let velocity = number(&result, "/runs/0/base_velocity_m_s");
    assert!((0.5e-3..3e-3).contains(&velocity), "{velocity} m/s");
    assert_close!(number(&result, "/consistency/nis_mean"), 6.0, 0.3);
    // The swaying of the vehicle is nonstationary.
    assert_eq!(result["consistency"]["verdict"], "misfit");
    let after = magnitude(&result, "/navigation/after/velocity_m_s");
    assert!(after < 0.5, "{after} m/s after half an hour");
    let hidden = texts(&result, "/identifiability/unobservable");
    for id in ["gyro.scale.x", "gyro.scale.z", "gyro.misalignment.xy", "accel.misalignment.xy"] {
        assert!(hidden.contains(&id), "{id} is not named: {hidden:?}");
    }
    // Along the vertical only a combination of bias and scale error is observable, to a few micro-g.
    let up = parameter(&result, "accel.scale.z");
    assert_eq!(texts(up, "/aliases")[0], "accel.bias.z");
    assert!(number(up, "/sigma") < 10.0, "{up}");
}

/// Compared with nine parameters that an independent program fitted to the means over 38 static intervals: least squares of the
/// magnitude of gravity, with a residual of 0.98 mm/s² and symmetric misalignments.
#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn xsens_turned_over_38_times_shows_what_its_accelerometers_get_wrong() {
    /// The tolerance, in the larger of the two sigmas: the data are the same, the intervals and weights differ slightly.
    const APART: f64 = 1.0;
    let folder = rig("imu_tk_xsens");
    let result = result_in(folder.path(), "calibrate rig.toml --model full");
    assert_eq!(result["runs"][0]["reference"], "static");
    assert_eq!(result["runs"][0]["static_intervals_used"], 38);
    let fitted = [
        ("accel.bias.x", 411.3, 60.7),
        ("accel.bias.y", -756.5, 34.2),
        ("accel.bias.z", -1722.7, 37.2),
        ("accel.scale.x", 832.9, 63.8),
        ("accel.scale.y", -452.6, 34.1),
        ("accel.scale.z", 1677.5, 38.7),
    ];
    for (id, value, sigma) in fitted {
        let own = parameter(&result, id);
        assert_eq!(own["identifiable"], true, "{own}");
        let own_sigma = number(own, "/sigma");
        assert!((0.7..5.0).contains(&(own_sigma / sigma)), "{own}");
        assert_close!(number(own, "/value"), value, APART * own_sigma);
    }
    for (one, other, value) in [("xy", "yx", 726.5), ("xz", "zx", 1903.3), ("yz", "zy", 4408.1)] {
        let [one, other] =
            [one, other].map(|name| parameter(&result, &format!("accel.misalignment.{name}")));
        let sum = number(one, "/marginal/value") + number(other, "/marginal/value");
        assert_close!(sum, value, 200.0);
    }
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn xsens_shows_its_gyros_between_its_rests() {
    let folder = rig("imu_tk_xsens");
    let result = result_in(folder.path(), "calibrate rig.toml --model full");
    for axis in ["x", "y", "z"] {
        let scale = parameter(&result, &format!("gyro.scale.{axis}"));
        assert!(scale["identifiable"] == true && number(scale, "/sigma") < 1500.0, "{scale}");
        let bias = parameter(&result, &format!("gyro.bias.{axis}"));
        assert_eq!(bias["identifiable"], true, "{bias}");
        // The offsets in the rig file are means over all static intervals.
        assert!(number(bias, "/value").abs() < 4.0 * number(bias, "/sigma"), "{bias}");
    }
    let ids =
        list(&result, "/parameters").iter().map(|parameter| parameter["id"].as_str().unwrap());
    assert!(ids.filter(|id| id.starts_with("axis.")).count() == 0, "{result:#}");
    assert_eq!(texts(&result, "/notes").len(), 1, "{result:#}");
}

/// A rate that repeats with every turn of the wheel belongs to the base: the chair rotates, at about 3 deg/s.
#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn chair_that_turns_under_the_wheel_is_named() {
    let folder = rig("worklab_wheel_right");
    let result = result_in(folder.path(), "diagnose rig.toml");
    let causes = list(&result, "/causes");
    let chair = causes.iter().find(|cause| cause["effect"] == "base_rotation");
    let chair = chair.unwrap_or_else(|| panic!("{causes:#?}"));
    assert!(number(chair, "/ln_p") < -100.0 && chair["plausible"] == true, "{chair:#}");
    let [rate] = list(chair, "/parameters") else { panic!("{chair:#}") };
    let (value, sigma) = (number(rate, "/value"), number(rate, "/sigma"));
    assert!((value - 10_900.0).abs() < 1_500.0 && sigma < 700.0, "{rate}");
    // The wheel rolls, as it slows down; a wheelchair's main wheels have diameters of 22 to 26 inches.
    let rolling = causes.iter().find(|cause| cause["effect"] == "base_rolling");
    let rolling = rolling.unwrap_or_else(|| panic!("{causes:#?}"));
    let radius = &list(rolling, "/parameters")[0];
    let (value, sigma) = (number(radius, "/value").abs(), number(radius, "/sigma"));
    assert!((270.0..350.0).contains(&value) && sigma < 15.0, "{radius}");
    assert!(number(&result, "/gain/log_score_rise_95/0") > 100.0, "{:#}", result["gain"]);
    // With this effect in the model, no harmonic of the first order remains.
    let structures = list(&result, "/unexplained");
    assert!(structures.iter().all(|one| one["structure"] != "1st order in table angle"));
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn laser_gyro_shows_its_noise_beyond_its_dither() {
    let folder = rig("psins_lasergyro");
    let allan = result_in(folder.path(), "allan rig.toml");
    let channels = list(&allan, "/channels");
    let names: Vec<&str> = channels.iter().filter_map(|one| one["channel"].as_str()).collect();
    assert_eq!(names, ["gyro.x", "gyro.y", "gyro.z", "accel.x", "accel.y", "accel.z"]);
    for channel in channels {
        let [deviation, low, high] =
            ["/deviation", "/low", "/high"].map(|column| numbers(channel, column));
        // Powers of two of 10 ms up to a fifth of 1847 s.
        assert_eq!(deviation.len(), 16);
        for k in 0..16 {
            assert!(0.0 < low[k] && low[k] < deviation[k] && deviation[k] < high[k], "{channel}");
        }
        let terms = list(channel, "/terms");
        assert_eq!(terms.len(), 4);
        for term in terms {
            if term["significant"] == true {
                let (value, sigma) = (number(term, "/value"), number(term, "/sigma"));
                assert!(0.0 < sigma && sigma < value, "{term}");
            } else {
                assert!(number(term, "/upper_bound") > 0.0, "{term}");
            }
        }
    }
    // Dither dominates at the shortest times.
    assert!(number(&channels[0], "/explained_from_s") > 0.1, "{}", channels[0]);
}
