//! `rins observe`: the observability under the shipped schedules, and the next schedule.

use std::path::{Path, PathBuf};

use crate::support::{list, number, result_in, rins_in};
use serde_json::Value;

fn schedules() -> PathBuf {
    rins_tests::workspace().join("scenarios/schedules")
}

fn of<'v>(parameters: &'v [Value], id: &str) -> &'v Value {
    parameters.iter().find(|parameter| parameter["id"] == id).unwrap_or(&Value::Null)
}

#[test]
fn one_rate_is_said_to_tell_combinations() {
    let told = result_in(&schedules(), "observe i-constant-rate.toml");
    assert_eq!((&told["command"], &told["model"]), (&"observe".into(), &"full".into()));
    let parameters = list(&told, "/schedules/0/parameters");
    let misalignment = of(parameters, "gyro.misalignment.xz");
    assert_eq!(misalignment["identifiable"], false);
    assert_eq!(misalignment["aliases"][0], "gyro.bias.x");
    // A bias of 1 deg/h at 10 deg/s is a misalignment of 5.73 arcsec.
    assert!((number(misalignment, "/combination/0/coefficient") - 5.73).abs() < 0.01);
    assert!((number(misalignment, "/data_sigma") - 0.006).abs() < 0.0005);
    let bias = of(parameters, "gyro.bias.x");
    assert_eq!(bias["observability"], "combination");
    assert_eq!(bias["aliases"][0], misalignment["id"]);
    // The same combination, with a coefficient of one for the bias.
    let ratio = number(misalignment, "/data_sigma") / number(bias, "/data_sigma");
    assert!((ratio / number(misalignment, "/combination/0/coefficient") - 1.0).abs() < 1e-6);
    let finished = rins_in(&schedules(), "observe i-constant-rate.toml");
    let sentence = "observable only in the combination gyro.misalignment.xz + 5.73 arcsec/(deg/h) × gyro.bias.x";
    assert!(finished.out.contains(sentence), "{}", finished.out);
}

#[test]
fn baseline_loses_three_combinations_at_one_rate_and_none_otherwise() {
    let arguments = "observe --model baseline --compare i-constant-rate.toml ii-reversal.toml \
                     iii-three-rates.toml iv-dwells.toml v-two-tilts-a.toml+v-two-tilts-b.toml";
    let told = result_in(&schedules(), arguments);
    let losses: Vec<f64> = list(&told, "/schedules")
        .iter()
        .map(|schedule| number(schedule, "/null_space_dimension"))
        .collect();
    assert_eq!(losses, [3.0, 0.0, 0.0, 0.0, 0.0]);
}

/// The proposed schedule is a scenario that can be simulated, and distinguishes the requested effects.
#[test]
fn reversal_is_proposed_where_one_rate_confuses_two_effects() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = schedules().join("i-constant-rate.toml");
    let pair = "--separate gyro_g_sensitivity,encoder_eccentricity";
    let arguments = format!("observe {} {pair} -o out", scenario.display());
    let told = result_in(folder.path(), &arguments);
    let kappa = number(&told, "/schedules/0/separation/each/0/kappa");
    assert!((80.0..150.0).contains(&kappa), "{kappa}");
    assert_eq!(told["schedules"][0]["separation"]["separated"], false);
    let proposal = &told["proposal"];
    assert_eq!(proposal["sufficient"], true);
    let rates: Vec<f64> =
        list(proposal, "/profile").iter().map(|part| number(part, "/rate_deg_s").round()).collect();
    assert_eq!(rates, [10.0, -10.0], "{proposal:#}");
    assert!(number(proposal, "/separation_sigma") >= 6.0);
    assert!(folder.path().join("out/report.html").is_file());

    let again = result_in(folder.path(), &format!("observe out/next-1.toml {pair}"));
    assert_eq!(again["schedules"][0]["separation"]["separated"], true);
    assert_eq!(again["proposal"], Value::Null);
    let predicted = number(proposal, "/separation/each/0/separation_sigma");
    let seen = number(&again, "/schedules/0/separation/each/0/separation_sigma");
    assert!((predicted / seen - 1.0).abs() < 1e-6, "{predicted} {seen}");
    let simulated = rins_in(folder.path(), "simulate out/next-1.toml -o run");
    assert_eq!(simulated.code, Some(0), "{}", simulated.err);
}

#[test]
fn wanted_sigma_is_reached_by_a_longer_run() {
    let told = result_in(&schedules(), "observe ii-reversal.toml --want gyro.scale.z=0.025ppm");
    let given = number(of(list(&told, "/schedules/0/parameters"), "gyro.scale.z"), "/sigma");
    assert!(given > 0.025, "{given}");
    assert_eq!(told["proposal"]["sufficient"], true);
    assert!(number(&told, "/proposal/sigma") <= 0.025);
    assert!(number(&told, "/proposal/duration_s") > 360.0);
}

#[test]
fn several_scenarios_are_runs_of_one_imu() {
    let told = result_in(&schedules(), "observe v-two-tilts-a.toml v-two-tilts-b.toml");
    let parameters = list(&told, "/schedules/0/parameters");
    let runs = |id: &str| -> Vec<Value> {
        parameters.iter().filter(|p| p["id"] == id).map(|p| p["run"].clone()).collect()
    };
    assert_eq!(runs("gyro.scale.z"), [Value::Null]);
    assert_eq!(runs("gyro.bias.z"), [Value::from(1), Value::from(2)]);
}

#[test]
fn what_is_never_told_is_said_to_be_a_choice() {
    let scenario = "i-constant-rate.toml --separate accel.scale,wrong_gravity --max-duration";
    let finished = rins_in(&schedules(), &format!("observe {scenario} 120s"));
    assert_eq!(finished.code, Some(0), "{}", finished.err);
    assert!(finished.out.contains("No schedule of the library"), "{}", finished.out);
    assert!(finished.out.contains("the unit of force"), "{}", finished.out);
}

#[test]
fn what_cannot_be_meant_is_refused_with_a_hint() {
    let scenario = "observe ii-reversal.toml";
    let cases: [(&str, i32, &str); 11] = [
        ("--separate gyro_g_sensitivty,encoder_slip", 1, "did you mean \"gyro_g_sensitivity\"?"),
        ("--separate gyro.bias,gyro.bias.x", 1, "both hold gyro.bias.x"),
        ("--separate gyro.bias", 2, "expected two ids"),
        ("--separate outliers,encoder_slip", 1, "adds nothing to any signal"),
        ("--want gyro.scale.z=0.1deg", 1, "expected a quantity such as \"1 ppm\""),
        ("--want gyro.scale=1ppm", 1, "gyro.scale.x, gyro.scale.y, gyro.scale.z"),
        ("--want gyro.scale.z", 2, "ID=SIGMA"),
        ("--want gyro.scale.z=-1ppm", 2, "a sigma is more than zero"),
        ("--want gyro.scale.z=x", 2, "does not begin with a number"),
        ("--model fulll", 1, "did you mean \"full\"?"),
        ("--max-rate 3s", 2, "expected an angular rate"),
    ];
    for (arguments, code, hint) in cases {
        let finished = rins_in(&schedules(), &format!("{scenario} {arguments}"));
        assert_eq!((finished.code, finished.out.as_str()), (Some(code), ""), "{arguments}");
        assert!(finished.err.contains(hint), "{arguments}: {}", finished.err);
    }
    let nowhere = rins_in(Path::new("."), "observe nowhere.toml --json");
    assert_eq!(nowhere.code, Some(1));
}
