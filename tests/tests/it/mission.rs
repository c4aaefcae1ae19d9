//! Navigation errors over days in service.

use std::fs;

use rins_testing::assert_close;
use rins_tests::workspace;
use serde_json::Value;

use crate::support::{list, number, numbers, result_in, rins_in, texts};

/// A mission of these sections.
fn write(folder: &std::path::Path, rest: &str) {
    let site = "[site]\nlatitude = \"45 deg\"\nlongitude = \"0 deg\"\nheight = \"0 m\"\n";
    fs::write(folder.join("mission.toml"), format!("{site}{rest}")).unwrap();
}

fn scheme<'r>(result: &'r Value, name: &str) -> &'r Value {
    list(result, "/schemes").iter().find(|scheme| scheme["name"] == name).unwrap()
}

/// The shipped mission, against figures of an independent linear model.
#[test]
fn shipped_mission_drifts_as_an_independent_model_says() {
    let result = result_in(workspace(), "mission scenarios/service/fixed-45deg.toml");
    let east = |name: &str, hours: usize| {
        let scheme = scheme(&result, name);
        assert_close!(numbers(scheme, "/hours")[hours - 1], hours as f64, 1e-9);
        numbers(scheme, "/east_nmi")[hours - 1]
    };
    for (name, hours, want) in [
        ("static", 24, 14.78),
        ("continuous", 24, 85.08),
        ("reciprocating", 24, 7.444),
        ("reciprocating", 72, 21.88),
        ("four-position", 24, 7.46),
    ] {
        let got = east(name, hours);
        assert!((got / want - 1.0).abs() < 0.01, "{name}, {hours} h: {got} nmi, not {want}");
    }
    let law = numbers(scheme(&result, "continuous"), "/law_nmi")[23];
    assert!((law / 84.96 - 1.0).abs() < 0.01, "{law}");
    // One scale error of 5 ppm makes the most of it: 2.6 deg of longitude a day.
    let first = &list(scheme(&result, "continuous"), "/budget")[0];
    assert_eq!(first["source"], "gyro.scale.z");
    let radial = number(first, "/radial_nmi");
    assert!((radial / (3.0 * 77.76) - 1.0).abs() < 0.01, "{radial}");
}

/// CEP50, CEP95 and TRMS are of one distribution, and twice the sigmas are twice the radii.
#[test]
fn radii_scale_with_the_data_sheet() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let radii = |bias: &str| {
        write(
            folder,
            &format!(
                "[mission]\nduration = \"12 h\"\n[[scheme]]\nname = \"static\"\n[imu.gyro]\nnoise = \"1e-6 deg/h/sqrt(Hz)\"\n\
                 bias_sigma = \"{bias}\"\nscale_sigma = \"1e-4 ppm\"\nmisalignment_sigma = \"1e-4 arcsec\"\n[imu.accel]\n\
                 noise = \"1e-3 ug/sqrt(Hz)\"\nbias_sigma = \"1e-3 ug\"\nscale_sigma = \"1e-4 ppm\"\nmisalignment_sigma = \"1e-4 arcsec\"\n"
            ),
        );
        let result = result_in(folder, "mission mission.toml");
        let scheme = scheme(&result, "static").clone();
        assert!(scheme["east_nmi"].is_null());
        ["cep50_nmi", "cep95_nmi", "trms_nmi"].map(|key| numbers(&scheme, &format!("/{key}"))[11])
    };
    let [once, twice] = ["0.01 deg/h", "0.02 deg/h"].map(radii);
    for (one, two) in once.iter().zip(twice) {
        assert!((two / one - 2.0).abs() < 1e-3, "{one} {two}");
    }
    // Between those of a line and of a circle.
    assert!((0.67..0.84).contains(&(once[0] / once[2])), "{once:?}");
    assert!((1.72..1.97).contains(&(once[1] / once[2])), "{once:?}");
}

/// What a calibration leaves: its sigmas replace those of the data sheet.
#[test]
fn calibration_shows_what_it_is_worth_in_service() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let cycle = "[mission]\nduration = \"24 h\"\ninterval = \"24 h\"\n[[scheme]]\nname = \"continuous\"\nrate = \"10 deg/s\"\n";
    write(folder, cycle);
    let refused = rins_in(folder, "mission mission.toml");
    assert_eq!(refused.code, Some(1));
    assert!(
        refused.err.contains("neither [errors] nor [imu] nor a calibration"),
        "{}",
        refused.err
    );

    result_in(folder, "demo -o demo");
    let calibration = fs::read_dir(folder.join("demo"))
        .unwrap()
        .filter_map(|entry| Some(entry.ok()?.path().join("calibration.toml")))
        .chain([folder.join("demo/calibration.toml")])
        .find(|path| path.exists())
        .unwrap();
    let name = calibration.strip_prefix(folder).unwrap().display().to_string();
    let result = result_in(folder, &format!("mission mission.toml --calibration {name}"));
    let left = scheme(&result, "continuous");
    let source = &list(left, "/budget")[0];
    // The demo calibrates the gyro about the axis to parts per million: a few tens of nautical miles a day are left of thousands.
    assert!((0.01..100.0).contains(&number(left, "/trms_nmi/0")), "{left}");
    assert!(number(source, "/radial_nmi") > 0.0, "{left}");
    let inputs = list(&result, "/provenance/inputs");
    assert_eq!(inputs.len(), 2);
    assert!(!texts(&result, "/notes").is_empty());
}

/// A carrier of legs and sway for a mission of six hours.
const UNDER_WAY: &str = r#"
[mission]
duration = "6 h"
interval = "3 h"
sample_rate = "10 Hz"
[carrier]
turn_rate = "1 deg/s"
acceleration = "0.1 m/s^2"
sway = { roll = { amplitude = "4 deg", period = "9 s" }, heave = { amplitude = "0.5 m", period = "7 s" } }
[[carrier.leg]]
heading = "30 deg"
speed = "12 kn"
duration = "50 min"
[[carrier.leg]]
heading = "200 deg"
speed = "10 kn"
duration = "70 min"
[[scheme]]
name = "continuous"
rate = "6 deg/s"
stabilized = true
[imu.gyro]
noise = "0.003 deg/h/sqrt(Hz)"
bias_instability = "0.004 deg/h"
bias_sigma = "0.01 deg/h"
scale_sigma = "5 ppm"
misalignment_sigma = "5 arcsec"
[imu.accel]
noise = "5 ug/sqrt(Hz)"
bias_sigma = "20 ug"
scale_sigma = "20 ppm"
misalignment_sigma = "5 arcsec"
"#;

/// Simulated missions scatter as the linear covariance says, and their intervals hold it.
#[test]
fn simulated_missions_scatter_as_predicted() {
    const RUNS: u32 = 200;
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, UNDER_WAY);
    let result = result_in(folder, &format!("mission mission.toml --runs {RUNS} --seed 5"));
    let scheme = scheme(&result, "continuous");
    for place in 0..2 {
        for measure in ["cep50", "trms"] {
            let predicted = numbers(scheme, &format!("/{measure}_nmi"))[place];
            let found = numbers(scheme, &format!("/simulated/{measure}_nmi"))[place];
            let within = numbers(scheme, &format!("/simulated/{measure}_within_nmi/{place}"));
            // Twice as wide: four sigmas.
            let (low, high) = (2.0 * within[0] - found, 2.0 * within[1] - found);
            assert!((low..high).contains(&predicted), "{measure}: {predicted}, not {low}..{high}");
            assert!(high / low < 1.8, "{measure}: {low}..{high} says nothing");
        }
    }
    // The same draws again.
    let again = result_in(folder, &format!("mission mission.toml --runs {RUNS} --seed 5"));
    assert_eq!(
        again.pointer("/schemes/0/simulated/trms_nmi"),
        scheme.pointer("/simulated/trms_nmi")
    );
}

/// The uncertainties that a wanted figure asks for hold it, linearly and when they are simulated.
#[test]
fn wanted_figure_is_held_by_what_it_asks_for() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, UNDER_WAY);
    let want = |typed: &str| {
        let result = result_in(folder, &format!("mission mission.toml --runs 200 --want {typed}"));
        scheme(&result, "continuous")["want"].clone()
    };
    let held = want("2nmi/3h");
    assert_eq!(held["possible"], true);
    assert!(number(&held, "/present_nmi") > 2.0, "{held}");
    assert_close!(number(&held, "/reached_nmi"), 2.0, 1e-9);
    let simulated = number(&held, "/simulated_nmi");
    // Four sigmas of the rms of 200 draws along a line.
    assert!((simulated / 2.0 - 1.0).abs() < 4.0 / 400_f64.sqrt(), "{simulated}");
    // Whoever improves takes an equal share, and the others keep what they have.
    let parameters = list(&held, "/parameters");
    let improved = |one: &&Value| number(one, "/asked") < number(one, "/present");
    let shares: Vec<f64> =
        parameters.iter().filter(improved).map(|one| number(one, "/share_nmi")).collect();
    assert!(!shares.is_empty() && shares.len() < parameters.len());
    assert!(shares.iter().all(|share| (share / shares[0] - 1.0).abs() < 1e-9), "{shares:?}");

    let never = want("1m/6h");
    assert_eq!(never["possible"], false);
    let refused = rins_in(folder, "mission mission.toml --want 1nmi/5h");
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("none of the times of the results"), "{}", refused.err);
}

/// A carrier under way costs what one at rest does not: without isolation its turns act as rates of the table.
#[test]
fn isolation_from_the_heading_matters() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let errors = "[errors.gyro]\nscale = [\"0 ppm\", \"0 ppm\", \"1000 ppm\"]\n";
    let mission = |stabilized: bool| {
        write(
            folder,
            &format!(
                "[mission]\nduration = \"1 h\"\n[carrier]\nturn_rate = \"1 deg/s\"\n[[carrier.leg]]\nheading = \"0 deg\"\nspeed = \"0 m/s\"\n\
                 duration = \"10 min\"\n[[carrier.leg]]\nheading = \"120 deg\"\nspeed = \"0 m/s\"\nduration = \"10 min\"\n[[carrier.leg]]\n\
                 heading = \"240 deg\"\nspeed = \"0 m/s\"\nduration = \"10 min\"\n[[scheme]]\nname = \"static\"\nstabilized = {stabilized}\n{errors}"
            ),
        );
        let result = result_in(folder, "mission mission.toml");
        let scheme = scheme(&result, "static").clone();
        numbers(&scheme, "/east_nmi")[0].hypot(numbers(&scheme, "/north_nmi")[0])
    };
    let [isolated, carried] = [true, false].map(mission);
    // 1000 ppm of 540 deg of turns is an azimuth error; of the Earth's rate, next to nothing.
    assert!(carried > 5.0 * isolated, "{carried} {isolated}");
}

#[test]
fn carriers_that_jump_are_refused_with_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (instead_of, put, want) in [
        (
            "turn_rate = \"1 deg/s\"\n",
            "",
            "[carrier] leg[2].heading: leg 2: the heading jumps by 170",
        ),
        ("acceleration = \"0.1 m/s^2\"\n", "", "leg[2].speed: leg 2: the speed jumps"),
        ("duration = \"70 min\"", "duration = \"100 s\"", "leg[2].duration"),
        ("speed = \"10 kn\"", "speed = \"10 knots\"", "kn"),
        ("period = \"9 s\"", "period = \"0 s\"", "sway.roll.period"),
        ("amplitude = \"4 deg\"", "amplitude = \"4 m\"", "sway.roll.amplitude"),
        ("stabilized = true", "stabilized = \"yes\"", "true or false"),
        ("heading = \"30 deg\"", "course = \"30 deg\"", "course"),
    ] {
        let changed = UNDER_WAY.replace(instead_of, put);
        assert_ne!(changed, UNDER_WAY);
        write(folder, &changed);
        let refused = rins_in(folder, "mission mission.toml -o out");
        assert_eq!((refused.code, refused.out.as_str()), (Some(1), ""), "{put}");
        assert!(refused.err.contains(want), "{put}: {}", refused.err);
        assert!(refused.err.contains("mission.toml:"), "{put}: {}", refused.err);
        assert!(!folder.join("out").exists(), "{put}");
    }
    let alone = UNDER_WAY.find("[carrier]").unwrap()..UNDER_WAY.find("[[scheme]]").unwrap();
    let mut ashore = UNDER_WAY.to_owned();
    ashore.replace_range(alone, "");
    write(folder, &ashore);
    let refused = rins_in(folder, "mission mission.toml");
    assert!(refused.err.contains("there is no [carrier]"), "{}", refused.err);
    write(folder, UNDER_WAY);
    let none = rins_in(folder, "mission mission.toml --runs 0");
    assert!(none.err.contains("at least one mission"), "{}", none.err);
}

#[test]
fn mistakes_are_told_with_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let errors = "[errors.gyro]\nscale = [\"0 ppm\", \"0 ppm\", \"5 ppm\"]\n";
    let day = "[mission]\nduration = \"24 h\"\n";
    for (rest, want) in [
        (format!("{day}{errors}"), "scheme"),
        (format!("{day}[[scheme]]\nname = \"spinning\"\n{errors}"), "profile"),
        (format!("{day}[[scheme]]\nname = \"continuous\"\n{errors}"), "rate"),
        (format!("{day}[[scheme]]\nname = \"static\"\nrate = \"6 deg/s\"\n{errors}"), "rate"),
        (
            format!("{day}[[scheme]]\nname = \"continuous\"\nrate = \"0 deg/s\"\n{errors}"),
            "other than zero",
        ),
        (
            format!("{day}[[scheme]]\nname = \"four-position\"\nrate = \"6 deg/s\"\n{errors}"),
            "dwell",
        ),
        (
            format!("{day}[[scheme]]\nname = \"static\"\n[[scheme]]\nname = \"static\"\n{errors}"),
            "has this name",
        ),
        (
            format!("[mission]\nduration = \"24 deg\"\n[[scheme]]\nname = \"static\"\n{errors}"),
            "duration",
        ),
        (
            format!(
                "[mission]\nduration = \"900000 h\"\ninterval = \"1 s\"\n[[scheme]]\nname = \"static\"\n{errors}"
            ),
            "interval",
        ),
        (format!("{day}[[scheme]]\nname = \"mine\"\nprofile = []\n{errors}"), "profile"),
    ] {
        write(folder, &rest);
        let refused = rins_in(folder, "mission mission.toml -o out");
        assert_eq!((refused.code, refused.out.as_str()), (Some(1), ""), "{rest}");
        assert!(refused.err.contains("mission.toml"), "{rest}: {}", refused.err);
        assert!(refused.err.contains(want), "{rest}: {}", refused.err);
        assert!(!folder.join("out").exists(), "{rest}");
    }
}
