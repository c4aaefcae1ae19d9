//! Several runs of one IMU: what is not the same in all of them, and what the next one will show.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::support::{list, number, result_in, rins_in};

/// A run on a tilted table with this scale error of gyro z \[ppm\]; `more` goes into `[truth]`.
fn simulated(folder: &Path, name: &str, scale: f64, (month, more): (usize, &str)) {
    let scenario = format!(
        r#"[site]
latitude = "45 deg"
longitude = "0 deg"
height = "100 m"
[log]
rate = "10 Hz"
table_angle = {{ noise = "1 arcsec" }}
[table]
acceleration = "10 deg/s^2"
profile = [
    {{ rate = "0 deg/s", duration = "20 s" }},
    {{ rate = "20 deg/s", duration = "70 s" }},
    {{ rate = "-10 deg/s", duration = "70 s" }},
]
[attitude]
roll = "20 deg"
pitch = "0 deg"
yaw = "0 deg"
sigma = "0.1 deg"
[imu.gyro]
noise = "0.05 deg/h/sqrt(Hz)"
bias_sigma = "1 deg/h"
scale_sigma = "500 ppm"
misalignment_sigma = "120 arcsec"
[imu.accel]
noise = "30 ug/sqrt(Hz)"
bias_sigma = "200 ug"
scale_sigma = "300 ppm"
misalignment_sigma = "60 arcsec"
[run]
serial = "A7"
started = "2026-{month:02}-10T08:00:00Z"
[truth]
seed = {month}
gyro = {{ bias = ["0.1 deg/h", "0.2 deg/h", "-0.1 deg/h"], scale = ["0 ppm", "0 ppm", "{scale} ppm"] }}
{more}"#
    );
    fs::write(folder.join("scenario.toml"), scenario).unwrap();
    result_in(folder, &format!("simulate scenario.toml -o {name}"));
}

/// What a list of results says of a parameter.
fn of<'v>(list: &'v [Value], id: &str) -> &'v Value {
    let found = list.iter().find(|one| one["id"] == id);
    found.unwrap_or_else(|| panic!("no {id} among {list:#?}"))
}

const RIGS: &str = "a/rig.toml b/rig.toml c/rig.toml";

#[test]
fn scale_error_that_differs_between_runs_is_no_event_within_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (place, (name, scale)) in [("a", 100.0), ("b", 200.0), ("c", 300.0)].into_iter().enumerate()
    {
        simulated(folder, name, scale, (place + 1, ""));
    }
    let calibration = result_in(folder, &format!("calibrate {RIGS}"));
    let scale = of(list(&calibration, "/homogeneity"), "gyro.scale.z");
    assert!(number(scale, "/p_value_beside_others") < 1e-9, "{scale:#}");
    for (run, truth) in [100.0, 200.0, 300.0].into_iter().enumerate() {
        let sigma = number(scale, &format!("/per_run/{run}/sigma"));
        let error = number(scale, &format!("/per_run/{run}/value")) - truth;
        assert!(error.abs() < 5.0 * sigma && sigma < 5.0, "run {run}: {error} ± {sigma}");
    }
    let text = rins_in(folder, &format!("calibrate {RIGS}")).out;
    let first: Vec<&str> = text.lines().take(2).collect();
    assert!(first[1].contains("differ between the runs: gyro.scale.z"), "{first:?}");

    let diagnosis = result_in(folder, &format!("diagnose {RIGS}"));
    let causes = list(&diagnosis, "/causes");
    assert_eq!(causes.len(), 1, "{causes:#?}");
    assert_eq!(causes[0]["effect"], "gyro_scale_between_runs");
    assert_eq!(causes[0]["across"], "runs");
    for (run, truth) in [100.0, 200.0, 300.0].into_iter().enumerate() {
        let parameter = &list(&causes[0], "/parameters")[run];
        let error = number(parameter, "/value") - truth;
        assert!(error.abs() < 5.0 * number(parameter, "/sigma"), "{parameter:#}");
    }
}

#[test]
fn what_is_the_same_in_all_runs_is_not_said_to_differ() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (place, name) in ["a", "b", "c"].into_iter().enumerate() {
        simulated(folder, name, 150.0, (place + 4, ""));
    }
    let calibration = result_in(folder, &format!("calibrate {RIGS}"));
    assert_eq!(list(&calibration, "/variations"), [] as [Value; 0]);
    for one in list(&calibration, "/homogeneity") {
        assert!(number(one, "/p_value") > 1e-5, "{one:#}");
    }
    let diagnosis = result_in(folder, "diagnose a/rig.toml b/rig.toml --held-out c/rig.toml");
    assert_eq!(diagnosis["verdict"], "adequate", "{:#}", diagnosis["causes"]);
    let held_out = &diagnosis["held_out"];
    assert_eq!(held_out["consistent"], true, "{held_out:#}");
    let scale = of(list(held_out, "/parameters"), "gyro.scale.z");
    assert!(number(scale, "/sigmas").abs() < 5.0 && scale["forecast"].is_object(), "{scale:#}");
}

#[test]
fn scale_error_of_a_held_out_run_is_told_where_the_other_run_shows_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulated(folder, "a", 100.0, (7, ""));
    simulated(folder, "b", 300.0, (8, ""));
    let diagnosis = result_in(folder, "diagnose a/rig.toml --held-out b/rig.toml -o out");
    assert_eq!(diagnosis["verdict"], "adequate", "{:#}", diagnosis["causes"]);
    let held_out = &diagnosis["held_out"];
    assert_eq!(held_out["consistent"], false, "{held_out:#}");
    let first = &list(held_out, "/parameters")[0];
    assert_eq!(first["id"], "gyro.scale.z");
    let difference = number(first, "/held_out/value") - number(first, "/other_runs/value");
    let sigma = difference / number(first, "/sigmas");
    assert!((difference - 200.0).abs() < 5.0 * sigma && sigma < 5.0, "{first:#}");
    let page = fs::read_to_string(folder.join("out/report.html")).unwrap();
    assert!(page.contains("In b/rig.toml gyro.scale.z is"), "the page does not tell");
}

#[test]
fn temperature_between_runs_is_named_and_the_next_run_predicted() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("runs")).unwrap();
    let at = |temperature: f64| 100.0 + 2.0 * (temperature - 20.0);
    for (place, temperature) in [20.0, -10.0, 45.0, 5.0, 60.0].into_iter().enumerate() {
        let more = format!(r#"temperature = "{temperature} degC""#);
        simulated(folder, &format!("runs/{place}"), at(temperature), (place + 1, &more));
    }
    let history = result_in(folder, "history runs --temperature 30 --date 2027-01-01T00:00:00Z");
    let causes = list(&history, "/causes");
    assert_eq!(causes.len(), 1, "{causes:#?}");
    assert_eq!(
        (&causes[0]["id"], &causes[0]["variation"]),
        (&"gyro.scale.z".into(), &"temperature_linear".into())
    );
    let forecast = of(list(&history, "/forecast"), "gyro.scale.z");
    let error = number(forecast, "/value/value") - at(30.0);
    assert!(error.abs() < 5.0 * number(forecast, "/value/sigma"), "{forecast:#}");
    assert!(number(forecast, "/value/sigma") < 10.0, "{forecast:#}");

    // The same from calibration files, and the page and result in a folder.
    for place in 0..5 {
        let calibrate = format!("calibrate runs/{place}/rig.toml --model full -o cal-{place}");
        result_in(folder, &calibrate);
    }
    let files: Vec<String> = (0..5).map(|place| format!("cal-{place}/calibration.toml")).collect();
    let again = result_in(folder, &format!("history {} -o out", files.join(" ")));
    assert_eq!(list(&again, "/causes")[0]["variation"], "temperature_linear");
    assert!(folder.join("out/report.html").is_file());
    let [rigs, calibrations] = [&history, &again]
        .map(|result| number(of(list(result, "/homogeneity"), "gyro.scale.z"), "/chi_square"));
    assert!((rigs / calibrations - 1.0).abs() < 1e-3, "{rigs} {calibrations}");

    // A calibration of January, applied in April, and to another IMU.
    let navigate = |rig: &str| format!("navigate {rig} --calibration cal-0/calibration.toml");
    let navigated = result_in(folder, &navigate("runs/3/rig.toml"));
    let days = number(&navigated, "/outside_calibrated_range/days");
    assert!((days - 90.0).abs() < 0.1, "{days}");
    let rig = fs::read_to_string(folder.join("runs/3/rig.toml")).unwrap();
    fs::write(folder.join("runs/3/other.toml"), rig.replace("A7", "B8")).unwrap();
    let refused = rins_in(folder, &navigate("runs/3/other.toml"));
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("use one of the same IMU"), "{}", refused.err);
}

#[test]
fn history_without_runs_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("empty")).unwrap();
    simulated(folder, "a", 100.0, (1, ""));
    fs::write(folder.join("other.toml"), "key = 1\n").unwrap();
    let refused = |arguments: &str, code: i32, expected: &str| {
        let finished = rins_in(folder, &format!("history {arguments}"));
        assert_eq!(finished.code, Some(code), "{arguments}: {}", finished.err);
        assert!(finished.err.contains(expected), "{arguments}: {}", finished.err);
    };
    refused("a/rig.toml", 1, "one run has no history");
    refused("empty", 1, "empty: there is neither calibration.toml nor rig.toml");
    refused("other.toml a", 1, "other.toml: neither a calibration file");
    refused("a a/rig.toml", 1, "a/rig.toml is given twice");
    refused("nowhere a", 1, "nowhere");
    refused("a --date 2027-01-01", 2, "with its offset from UTC");
    refused("a --temperature warm", 2, "expected a finite number");
    refused("", 2, "<PATH>");
    let text = fs::read_to_string(folder.join("a/rig.toml")).unwrap();
    let wrong = text.replace("2026-01-10T08:00:00Z", "10 January");
    fs::write(folder.join("a/wrong.toml"), wrong).unwrap();
    refused("a/wrong.toml a", 1, "[run] started: \"10 January\" is not allowed");
}
