//! `rins convert`: a run is the same in every format.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::support::{list, magnitude, number, result_in, rins_in, texts};

/// A folder with the demo's run.
fn run() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let demo = rins_tests::workspace().join("crates/rins/data/demo");
    for name in ["rig.toml", "run.csv"] {
        fs::copy(demo.join(name), folder.path().join(name)).unwrap();
    }
    folder
}

fn converted(folder: &Path, name: &str, format: &str) -> Value {
    result_in(folder, &format!("convert rig.toml -o {name} --format {format}"))
}

#[test]
fn a_calibration_does_not_depend_on_the_format() {
    let folder = run();
    let expected = result_in(folder.path(), "calibrate rig.toml");
    for format in ["parquet", "mat", "csv"] {
        let done = converted(folder.path(), &format!("{format}.log"), format);
        assert_eq!((&done["exact"], &done["format"]), (&Value::Bool(true), &format.into()));
        assert!(list(&done, "/left_out").is_empty());
        let again = result_in(folder.path(), &format!("calibrate {format}.toml"));
        for part in ["parameters", "correlation", "navigation", "consistency"] {
            assert_eq!(again[part], expected[part], "{format}: {part}");
        }
    }
}

#[test]
fn what_has_no_room_is_told() {
    let folder = run();
    for format in ["psins", "psins-bin", "kf-gins", "euroc"] {
        let done = converted(folder.path(), &format!("{format}.log"), format);
        assert_eq!(texts(&done, "/left_out"), ["table_angle"], "{format}");
        let check = result_in(folder.path(), &format!("check {format}.toml"));
        assert_eq!(check["samples"], done["samples"]);
        let rest = &list(&check, "/static_means")[0];
        assert!((number(rest, "/gravity_m_s2") - 9.795).abs() < 0.01, "{rest}");
    }
    let told = rins_in(folder.path(), "convert rig.toml -o a.bin").out;
    assert!(told.contains("! table_angle is left out: the format has no room for it"), "{told}");
}

#[test]
fn a_name_that_tells_no_format_is_refused() {
    let folder = run();
    let refused = rins_in(folder.path(), "convert rig.toml -o a.txt");
    assert_eq!((refused.code, refused.out.as_str()), (Some(1), ""));
    assert!(
        refused
            .err
            .starts_with("rins: a.txt: the file name has no known extension; state --format")
    );
    let refused = rins_in(folder.path(), "convert rig.toml -o run.csv --force");
    assert!(refused.err.contains("run.csv: is an input of the same command"), "{}", refused.err);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

/// The run navigates with another format as with that of rins: the final velocity is the same.
#[test]
fn a_navigation_does_not_depend_on_the_format() {
    let folder = run();
    let velocity = |rig: &str| -> f64 {
        let navigate = result_in(folder.path(), &format!("navigate {rig}"));
        magnitude(&list(&navigate, "/runs")[0], "/velocity_m_s")
    };
    let expected = velocity("rig.toml");
    for format in ["kf-gins", "psins-bin"] {
        converted(folder.path(), &format!("{format}.log"), format);
        let got = velocity(&format!("{format}.toml"));
        assert!((got / expected - 1.0).abs() < 0.05, "{format}: {got} m/s, {expected} m/s");
    }
}
