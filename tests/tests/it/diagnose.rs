//! `rins diagnose`: a hidden effect is reported with its amplitude, and nothing if there is none.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use rins_frames::units::{DEG_PER_HOUR, PPM};
use rins_tests::{outside_data, workspace};
use serde_json::Value;

use crate::support::{list, magnitude, number, result_in, rins_in, texts};

/// The tolerance of amplitudes in sigmas, which three in a thousand exceed; the runs contain a dozen.
const WITHIN: f64 = 3.0;

/// A shipped schedule with these lines added to its truth.
fn scenario(truth: &str) -> String {
    let schedule = workspace().join("scenarios/schedules/iii-three-rates.toml");
    fs::read_to_string(schedule).unwrap() + truth
}

/// The effects of a sample run, each parameter in the unit of results.
fn hidden(run: &Path) -> BTreeMap<String, f64> {
    let truth = fs::read_to_string(run.join("truth.json")).unwrap();
    let truth: Value = serde_json::from_str(&truth).unwrap();
    let mut values = BTreeMap::new();
    for effect in list(&truth, "/effects") {
        let id = effect[0].as_str().unwrap();
        let of = |pointer: &str| number(&effect[1], pointer);
        let mut is = |name: &str, value: f64| {
            values.insert(format!("{id}.{name}"), value);
        };
        match id {
            "accel_lever_arm" => {
                is("r_x", of("/r/0") / 1e-3);
                is("r_y", of("/r/1") / 1e-3);
            }
            "encoder_latency" => is("delay", of("/tau") / 1e-3),
            "gyro_scale_asymmetry" => is("z", of("/k/2") / PPM),
            "gyro_thermal_bias" => {
                for (axis, name) in ["x", "y", "z"].iter().enumerate() {
                    is(name, of(&format!("/c/{axis}")) / DEG_PER_HOUR);
                }
            }
            "gyro_g_sensitivity" => {
                for (row, name) in ["x", "y", "z"].iter().enumerate() {
                    for (column, other) in ["x", "y", "z"].iter().enumerate() {
                        // The truth is in rad/s per m/s².
                        let value = of(&format!("/G/{row}/{column}")) * 9.80665 / DEG_PER_HOUR;
                        is(&format!("{name}{other}"), value);
                    }
                }
            }
            _ => panic!("{id} is not expected here"),
        }
    }
    values
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn nothing_is_named_where_nothing_is_hidden() {
    for (name, noise) in [("clean_multirate", "given"), ("paper_constant_rate", "likely")] {
        let run = outside_data(&format!("synthetic/{name}"));
        let result = result_in(&run, &format!("diagnose rig.toml --noise {noise}"));
        assert_eq!(result["verdict"], "adequate", "{name}: {}", result["causes"]);
        assert_eq!(list(&result, "/causes").len(), 0);
        assert_eq!(result["gain"]["verdict"], "no_improvement", "{name}: {}", result["gain"]);
    }
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn what_one_rate_cannot_show_is_said_not_to_be_testable() {
    let run = outside_data("synthetic/paper_constant_rate");
    let result = result_in(&run, "diagnose rig.toml --noise given");
    let effects = list(&result, "/not_testable");
    let asymmetry = effects.iter().find(|one| one["effect"] == "gyro_scale_asymmetry");
    let why = asymmetry.expect("the scale shows at one rate only")["why"].as_str().unwrap();
    assert!(why.contains("rotation in both directions"), "{why}");
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn hidden_effects_are_named_with_their_size() {
    for name in [
        "lever_arm_multirate",
        "encoder_latency_reversal",
        "g_sensitivity_dwell",
        "thermal_and_asymmetry",
    ] {
        let run = outside_data(&format!("synthetic/{name}"));
        let truth = hidden(&run);
        let result = result_in(&run, "diagnose rig.toml --noise given");
        let causes = list(&result, "/causes");
        let rivals = causes.iter().any(|cause| !texts(cause, "/cannot_tell_from").is_empty());
        assert_eq!(result["verdict"], if rivals { "ambiguous" } else { "named" }, "{name}");
        let mut hidden: Vec<&str> =
            truth.keys().filter_map(|id| Some(id.rsplit_once('.')?.0)).collect();
        hidden.dedup();
        for effect in hidden {
            let cause = causes.iter().find(|cause| cause["effect"] == effect);
            let cause = cause.unwrap_or_else(|| panic!("{name}: no {effect} in {causes:#?}"));
            assert!(number(cause, "/ln_p") < (0.01_f64).ln(), "{name}: {cause:#}");
            assert_eq!(cause["plausible"], true, "{name}: {cause:#}");
            for parameter in list(cause, "/parameters") {
                let truth = truth[parameter["id"].as_str().unwrap()];
                let off = (number(parameter, "/value") - truth) / number(parameter, "/sigma");
                assert!(off.abs() < WITHIN, "{name}: {truth} found {off} sigma off: {parameter}");
            }
        }
    }
}

/// A driver that repeats old samples: they are reported and removed, and have no effect on the result.
#[test]
fn stuck_samples_are_named_and_do_no_harm() {
    let folder = tempfile::tempdir().unwrap();
    let truth = "\n[[truth.effects]]\nid = \"stuck_samples\"\nshare = 0.01\nlength = 5\n";
    fs::write(folder.path().join("scenario.toml"), scenario(truth)).unwrap();
    result_in(folder.path(), "simulate scenario.toml -o run");
    let result = result_in(folder.path(), "diagnose run/rig.toml");
    let [cause] = list(&result, "/causes") else { panic!("{}", result["causes"]) };
    assert_eq!((&cause["effect"], &result["verdict"]), (&"stuck_samples".into(), &"named".into()));
    let share = number(cause, "/parameters/0/value");
    let off = (share - 0.01) / number(cause, "/parameters/0/sigma");
    assert!(off.abs() < 3.0 && share > 0.003, "{share}, {off} sigma off");
}

/// The paper's Table 4: the table angle is half a sample old, which the rig file does not state.
#[test]
fn a_read_out_that_lags_by_half_a_sample_is_told_in_samples() {
    let folder = tempfile::tempdir().unwrap();
    let truth = "\n[[truth.effects]]\nid = \"readout_lag\"\ndelay = \"10 ms\"\n";
    fs::write(folder.path().join("scenario.toml"), scenario(truth)).unwrap();
    result_in(folder.path(), "simulate scenario.toml -o run");
    let rate = fs::read_to_string(folder.path().join("run/rig.toml")).unwrap();
    assert!(rate.contains("rate = \"50 Hz\"") && !rate.contains("ms"), "{rate}");
    let result = result_in(folder.path(), "diagnose run/rig.toml --bootstrap 10 -o out");
    let [cause] = list(&result, "/causes") else { panic!("{}", result["causes"]) };
    assert_eq!(cause["effect"], "encoder_latency");
    let samples = number(cause, "/parameters/0/samples");
    assert!((samples - 0.5).abs() < 1e-3, "{samples}");
    assert!(number(&result, "/false_alarms/rate") < 0.15, "{}", result["false_alarms"]);
    let page = fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(page.contains("(0.500 samples)") && page.contains("Harmonic order of the table angle"));
}

/// The other commands accept the written files, on another run of the same IMU too.
#[test]
fn extended_model_calibrates_and_navigates_another_run() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let hidden = scenario(
        r#"
        gyro = { scale = ["0 ppm", "0 ppm", "300 ppm"] }
        effects = [{ id = "gyro_scale_asymmetry", z = "6 ppm" }]
        "#,
    );
    fs::write(here.join("scenario.toml"), hidden).unwrap();
    for (arguments, to) in [("", "one"), (" --seed 8", "two")] {
        let made = rins_in(here, &format!("simulate scenario.toml{arguments} -o {to}"));
        assert_eq!(made.code, Some(0), "{}", made.err);
    }
    let result = result_in(here, "diagnose one/rig.toml --noise given -o found");
    assert_eq!(result["verdict"], "named", "{}", result["causes"]);
    let cause = &result["causes"][0];
    assert_eq!(cause["effect"], "gyro_scale_asymmetry");
    let (value, sigma) =
        (number(cause, "/parameters/0/value"), number(cause, "/parameters/0/sigma"));
    assert!(
        (value - 6.0).abs() < WITHIN * sigma && sigma < 0.6,
        "6 ppm found as {value} ± {sigma}"
    );
    assert_eq!(result["gain"]["verdict"], "improved", "{}", result["gain"]);
    let elsewhere = result_in(here, "diagnose one/rig.toml --noise given --held-out two/rig.toml");
    let gain = &elsewhere["gain"];
    assert_eq!((&gain["verdict"], &gain["rig"]), (&"improved".into(), &"two/rig.toml".into()));
    assert!(number(gain, "/log_score_rise") > 20.0, "{gain}");
    let drift = |when: &str| number(gain, &format!("/attitude_drift_deg/{when}"));
    assert!(drift("before") > 2.0 * drift("after"), "{gain}");
    let page = fs::read_to_string(here.join("found/report.html")).unwrap();
    assert!(page.contains("asymmetry of the gyro scale"));

    let nis = |model: &str| {
        let arguments = format!("calibrate two/rig.toml --noise given --model {model}");
        number(&result_in(here, &arguments), "/consistency/nis_mean")
    };
    // Of six figures each; without the effect they are twice as large.
    let (with, without) = (nis("found/model.toml"), nis("full"));
    assert!((5.5..6.5).contains(&with) && without > 9.0, "NIS {with} with, {without} without");
    let result = result_in(here, "navigate two/rig.toml --calibration found/calibration.toml");
    let [raw, undone] = [0, 1].map(|run| magnitude(&result, &format!("/runs/{run}/velocity_m_s")));
    assert!(raw > 20.0 * undone, "{raw} and {undone}");
}

/// A parameter that is unobservable in a run comes with a proposed run; simulated with the same effect, it makes the parameter
/// observable.
#[test]
fn the_next_test_tells_what_this_one_could_not() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let truth = "\n[[truth.effects]]\nid = \"cable_torque_tilt\"\nx = \"1 arcsec/turn\"\n";
    for (schedule, run) in [("i-constant-rate", "one"), ("ii-reversal", "next")] {
        let shipped = workspace().join(format!("scenarios/schedules/{schedule}.toml"));
        let scenario = fs::read_to_string(shipped).unwrap() + truth;
        fs::write(here.join("scenario.toml"), scenario).unwrap();
        let made = rins_in(here, &format!("simulate scenario.toml -o {run}"));
        assert_eq!(made.code, Some(0), "{}", made.err);
    }
    let result = result_in(here, "diagnose one/rig.toml --noise given -o found");
    assert_eq!(result["verdict"], "ambiguous");
    let [cause] = list(&result, "/causes") else { panic!("{}", result["causes"]) };
    let set: Vec<&str> =
        [vec![cause["effect"].as_str().unwrap()], texts(cause, "/cannot_tell_from")].concat();
    assert!(set.contains(&"cable_torque_tilt") && set.contains(&"base_tilt_ramp"), "{set:?}");
    let test = &cause["next_test"];
    assert!(test["schedule"].as_str().unwrap().starts_with("forward and back"), "{test}");
    assert!(number(test, "/sigmas") > 6.0, "{test}");
    let page = fs::read_to_string(here.join("found/report.html")).unwrap();
    assert!(
        page.contains("A run that separates it from")
            && page.contains("Detection power of this run")
    );

    let result = result_in(here, "diagnose next/rig.toml --noise given");
    let [cause] = list(&result, "/causes") else { panic!("{}", result["causes"]) };
    assert_eq!(cause["effect"], "cable_torque_tilt");
    assert!(!texts(cause, "/cannot_tell_from").contains(&"base_tilt_ramp"), "{cause}");
}

/// A latency of the encoder in a short fast rotation of a consumer IMU; `turned` is its duration \[s\].
fn short_turn(turned: u32) -> String {
    format!(
        r#"
        [site]
        latitude = "45 deg"
        longitude = "9 deg"
        height = "100 m"
        [log]
        rate = "64 Hz"
        table_angle = {{ noise = "360 arcsec" }}
        [table]
        profile = [
            {{ rate = "0 deg/s", duration = "2 s" }},
            {{ rate = "100 deg/s", duration = "{turned} s" }},
            {{ rate = "0 deg/s", duration = "4 s" }},
        ]
        acceleration = "100 deg/s^2"
        [attitude]
        roll = "0 deg"
        pitch = "0 deg"
        yaw = "0 deg"
        sigma = "0.1 deg"
        [imu.gyro]
        noise = "180 deg/h/sqrt(Hz)"
        bias_sigma = "0.5 deg/s"
        scale_sigma = "3 %"
        misalignment_sigma = "120 arcsec"
        [imu.accel]
        noise = "2000 ug/sqrt(Hz)"
        bias_sigma = "200 ug"
        scale_sigma = "300 ppm"
        misalignment_sigma = "60 arcsec"
        [truth]
        seed = 1
        [[truth.effects]]
        id = "encoder_latency"
        delay = "60 ms"
        "#
    )
}

/// The diagnosis of a run of half a minute or less does not depend on whether a test of twice its length distinguishes the
/// causes.
#[test]
fn diagnosis_stands_without_a_next_test() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for (turned, proposed) in [(7, false), (21, true)] {
        fs::write(here.join("scenario.toml"), short_turn(turned)).unwrap();
        let made = rins_in(here, &format!("simulate scenario.toml -o {turned}"));
        assert_eq!(made.code, Some(0), "{}", made.err);
        let result = result_in(here, &format!("diagnose {turned}/rig.toml"));
        let causes = list(&result, "/causes");
        assert!(!causes.is_empty(), "{result}");
        for cause in causes {
            assert!(!texts(cause, "/cannot_tell_from").is_empty(), "{cause}");
        }
        assert_eq!(causes.iter().any(|cause| cause["next_test"].is_object()), proposed, "{result}");
    }
}

/// A hypothesis is evaluated whether significant or not, and an invalid hypothesis is refused.
#[test]
fn a_supposed_effect_is_measured_and_not_searched_for() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let truth = "\n[[truth.effects]]\nid = \"gyro_scale_asymmetry\"\nz = \"6 ppm\"\n";
    // Enough revolutions at the fastest rate.
    let longer = scenario(truth).replace("36 s", "72 s");
    fs::write(here.join("scenario.toml"), longer).unwrap();
    result_in(here, "simulate scenario.toml -o run");
    let supposing = |ids: &[&str]| {
        let terms: Vec<String> =
            ids.iter().map(|id| format!("[[term]]\nid = \"{id}\"\nestimate = true\n")).collect();
        let text = format!("schema = 1\nbase = \"none\"\n{}", terms.concat());
        fs::write(here.join("supposed.toml"), text).unwrap();
        "diagnose run/rig.toml --noise given --suppose supposed.toml --transfer"
    };
    let right = result_in(here, supposing(&["gyro_scale_asymmetry"]));
    assert_eq!(right["verdict"], "named");
    let cause = &right["causes"][0];
    let off = (number(cause, "/parameters/0/value") - 6.0) / number(cause, "/parameters/0/sigma");
    assert!(off.abs() < WITHIN, "{off}");
    assert!(number(&right, "/gain/log_score_rise") > 20.0, "{}", right["gain"]);
    assert_eq!(right["transfer"]["verdict"], "improved", "{}", right["transfer"]);
    assert_eq!(right["transfer"]["held_out"], "all at the fastest rate");

    let wrong = result_in(here, supposing(&["gyro_lag"]));
    assert_eq!(wrong["causes"][0]["effect"], "gyro_lag");
    assert!(number(&wrong, "/gain/log_score_rise") < 0.5 * number(&right, "/gain/log_score_rise"));

    let refused = rins_in(here, supposing(&["gyro.bias"]));
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("no hypothesis to evaluate"), "{}", refused.err);
}
