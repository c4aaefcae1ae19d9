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
