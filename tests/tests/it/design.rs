//! `rins design`: optimal schedules, with the proof of the equivalence theorem.

use std::path::PathBuf;

use serde_json::Value;

use crate::support::{list, number, result_in, rins_in};

fn schedules() -> PathBuf {
    rins_tests::workspace().join("scenarios/schedules")
}

fn sigma(schedule: &Value, id: &str) -> f64 {
    let own = list(schedule, "/parameters").iter().find(|parameter| parameter["id"] == id);
    number(own.unwrap_or_else(|| panic!("no {id}: {schedule:#}")), "/sigma")
}

/// Each criterion, in orientations among which the optimum is found quickly.
#[test]
fn every_criterion_has_a_small_gap_and_no_better_usual_schedule() {
    for (goal, least) in [
        ("D", 1.5),
        ("A:accel.bias,accel.scale", 2.5),
        ("accel.misalignment.xz", 10.0),
        ("position@24h", 0.98),
        ("gyro_g_sensitivity.zx/gyro_magnetic", 2.0),
    ] {
        let table = "--directions 2 --tilts 0deg,90deg";
        let table = if goal.starts_with("position") { "--directions 1" } else { table };
        let told =
            result_in(&schedules(), &format!("design ii-reversal.toml --for {goal} {table}"));
        let gap = number(&told, "/gap");
        assert!((0.0..0.01).contains(&gap), "{goal}: {gap}");
        let efficiency = number(&told, "/efficiency");
        let larger_is_better = told["criterion"] == "distance";
        // The rotations between the static intervals that separate two effects take time.
        let least_efficiency = if larger_is_better { 0.7 } else { 0.9 };
        assert!((least_efficiency..1.02).contains(&efficiency), "{goal}: {efficiency}");
        let value = number(&told, "/value");
        let times = |other: f64| if larger_is_better { value / other } else { other / value };
        let given = number(&told, "/given_value");
        assert!(times(given) > least, "{goal}: {value} instead of {given}");
        for other in list(&told, "/schedules") {
            if let Some(other) = other["value"].as_f64() {
                assert!(times(other) > 0.98, "{goal}: {value}, but {other:#}");
            }
        }
    }
}

/// No schedule is better than the angle noise against the angle of rotation.
#[test]
fn scale_error_about_the_axis_keeps_its_bound() {
    let told = result_in(&schedules(), "design ii-reversal.toml --for gyro.scale.z --directions 1");
    let (bound, reached) =
        (number(&told, "/scale_bound/bound_ppm"), number(&told, "/scale_bound/sigma_ppm"));
    assert!((bound / 0.0293 - 1.0).abs() < 0.002, "{bound}");
    assert!((1.0..1.06).contains(&(reached / bound)), "{reached} {bound}");
    let finished =
        rins_in(&schedules(), "design ii-reversal.toml --for gyro.scale.z --directions 1");
    assert!(finished.out.contains("There is no gain"), "{}", finished.out);
}

/// The scenarios of the schedule show what was predicted, within the limits of the table.
#[test]
fn schedule_can_be_run_and_shows_what_was_predicted() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = schedules().join("ii-reversal.toml");
    let table = "--tilts 0deg,90deg --directions 2 --max-rate 8deg/s --max-acceleration 4deg/s^2";
    let arguments = format!(
        "design {} --for accel.misalignment.xz --duration 200s {table} -o out",
        scenario.display()
    );
    let told = result_in(folder.path(), &arguments);
    let files: Vec<String> = list(&told, "/files")
        .iter()
        .map(|file| format!("out/{}", file.as_str().unwrap()))
        .collect();
    assert_eq!(files, ["out/next-1.toml", "out/next-2.toml"]);
    assert!(folder.path().join("out/report.html").is_file());
    let mut whole = 0.0;
    for run in list(&told, "/runs") {
        let mut before = 0.0;
        for segment in list(run, "/profile") {
            let (rate, duration) = (number(segment, "/rate_deg_s"), number(segment, "/duration_s"));
            assert!(rate.abs() <= 8.0 + 1e-9 && (rate - before).abs() / 4.0 <= duration + 1e-9);
            before = rate;
            whole += duration;
        }
    }
    assert!((whole - 200.0).abs() < 1e-6, "{whole}");

    let again = result_in(folder.path(), &format!("observe {}", files.join(" ")));
    let optimal = list(&told, "/schedules").last().unwrap();
    for id in ["accel.misalignment.xz", "gyro.scale.z", "accel.bias.x", "gyro.bias.z"] {
        let (predicted, seen) = (sigma(optimal, id), sigma(&list(&again, "/schedules")[0], id));
        assert!((predicted / seen - 1.0).abs() < 1e-4, "{id}: {predicted} {seen}");
    }
    let reached = sigma(optimal, "accel.misalignment.xz");
    assert!((reached / number(&told, "/value") - 1.0).abs() < 1e-9);
    let simulated = rins_in(folder.path(), "simulate out/next-2.toml -o run");
    assert_eq!(simulated.code, Some(0), "{}", simulated.err);
}

/// Other axes of the IMU along the spin axis: the schedule gains, its files are of one power-on about several axes, and what is simulated
/// and calibrated from them is what was predicted.
#[test]
fn mountings_are_part_of_the_schedule() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = schedules().join("ii-reversal.toml");
    let design = |more: &str| {
        let arguments = format!(
            "design {} --for D:gyro.scale,gyro.misalignment --tilts 0deg,90deg {more}",
            scenario.display()
        );
        result_in(folder.path(), &arguments)
    };
    let one = design("");
    let told = design("--mountings x,y,z -o out");
    let value = |told: &Value| number(told, "/value");
    assert!(value(&told) < 0.2 * value(&one), "{} {}", value(&told), value(&one));
    assert!((0.0..0.01).contains(&number(&told, "/gap")));
    let spins: Vec<&str> =
        list(&told, "/runs").iter().map(|run| run["spin"].as_str().unwrap()).collect();
    let mut sorted = spins.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, ["x", "y", "z"]);
    let compared = list(&told, "/schedules");
    let nineteen = compared.iter().find(|one| one["name"] == "19 positions").unwrap();
    assert!((number(nineteen, "/duration_s") - 360.0).abs() < 1e-6);
    assert!(number(nineteen, "/value") > value(&told));
    assert!(!list(&one, "/schedules").iter().any(|one| one["name"] == "19 positions"));
    // The shipped scenarios are the same schedule.
    let shipped = rins_tests::workspace().join("scenarios/nineteen-positions");
    let shipped = result_in(&shipped, "observe 1.toml 2.toml 3.toml 4.toml");
    for id in ["gyro.scale.x", "gyro.misalignment.zy", "accel.misalignment.yz", "accel.bias.z"] {
        let (told, own) = (sigma(nineteen, id), sigma(&list(&shipped, "/schedules")[0], id));
        assert!((told / own - 1.0).abs() < 0.01, "{id}: {told} {own}");
    }
    let files: Vec<&str> =
        list(&told, "/files").iter().map(|file| file.as_str().unwrap()).collect();
    let observed = format!("observe out/{}", files.join(" out/"));
    let observed = result_in(folder.path(), &observed);
    let sigma_of = |parameters: &[Value], id: &str| {
        let own = parameters.iter().find(|one| one["id"] == id);
        number(own.unwrap_or_else(|| panic!("no {id}")), "/sigma")
    };
    let optimal = list(compared.last().unwrap(), "/parameters");
    let observed = list(&list(&observed, "/schedules")[0], "/parameters");
    for id in ["gyro.scale.x", "gyro.scale.y", "gyro.misalignment.xy", "accel.bias.x"] {
        let (seen, wanted) = (sigma_of(observed, id), sigma_of(optimal, id));
        assert!((seen / wanted - 1.0).abs() < 0.01, "{id}: {seen} {wanted}");
    }
    for (place, file) in files.iter().enumerate() {
        rins_in(folder.path(), &format!("simulate out/{file} -o run{place}"));
    }
    let runs: Vec<String> = (0..files.len()).map(|place| format!("run{place}/rig.toml")).collect();
    let found = result_in(
        folder.path(),
        &format!("calibrate {} --model full --noise given", runs.join(" ")),
    );
    for id in ["gyro.scale.x", "gyro.scale.y", "gyro.scale.z", "gyro.misalignment.xy"] {
        let (seen, wanted) = (sigma_of(list(&found, "/parameters"), id), sigma_of(optimal, id));
        assert!((seen / wanted - 1.0).abs() < 0.1, "{id}: {seen} {wanted}");
    }
}

#[test]
fn impossible_requests_are_refused_with_a_hint() {
    let scenario = "design ii-reversal.toml";
    let cases: [(&str, i32, &str); 14] = [
        ("", 2, "--for"),
        ("--for position@24deg", 2, "expected a time"),
        ("--for D:", 2, "expected ids after the colon"),
        ("--for gyro.bias/", 2, "expected two ids"),
        ("--for gyro.scael.z", 1, "did you mean \"gyro.scale.z\"?"),
        ("--for gyro.scale", 1, "gyro.scale.x, gyro.scale.y, gyro.scale.z"),
        ("--for gyro.bias/gyro.bias.x", 1, "both hold gyro.bias.x"),
        ("--for axis.attitude.x", 1, "belongs to one orientation"),
        ("--for outliers", 1, "adds nothing to any signal"),
        ("--for D --duration 5s", 1, "too short for a schedule"),
        ("--for D --max-acceleration 0.01deg/s^2", 1, "a ramp to 10"),
        ("--for D --directions 7", 2, "expected 1 to 6"),
        ("--for D --tilts=-20deg,10deg", 1, "from the vertical"),
        ("--for position@24h --service nowhere.toml", 1, "nowhere.toml"),
    ];
    for (arguments, code, hint) in cases {
        let finished = rins_in(&schedules(), &format!("{scenario} {arguments}"));
        assert_eq!((finished.code, finished.out.as_str()), (Some(code), ""), "{arguments}");
        assert!(finished.err.contains(hint), "{arguments}: {}", finished.err);
    }
}
