//! `rins demo`: a first run without any data gives a result, and next steps that work.

use std::fs;
use std::path::Path;

use std::sync::LazyLock;

use serde_json::Value;
use tempfile::TempDir;

use crate::support::{Finished, list, magnitude, number, object, rins_in};

/// The results of the demo, of a repetition, and of a repetition that may replace its result. It runs once for all
/// tests that only read the results.
struct Demo {
    finished: Finished,
    /// The folder of the first run.
    folder: TempDir,
    again: Finished,
    forced: Finished,
}

static DEMO: LazyLock<Demo> = LazyLock::new(|| {
    let [folder, other] = [(); 2].map(|()| tempfile::tempdir().expect("there is a place for it"));
    let finished = rins_in(folder.path(), "demo");
    let again = rins_in(folder.path(), "demo");
    // In this folder the result is replaced, so that the first one remains.
    let result = other.path().join("rins-demo");
    fs::create_dir(&result).expect("an empty folder takes a folder");
    fs::copy(folder.path().join("rins-demo/result.json"), result.join("result.json"))
        .expect("the demo has a result");
    let forced = rins_in(other.path(), "demo --force --json");
    Demo { finished, folder, again, forced }
});

/// Runs a line of a shell, in which `rins` is the command under test.
fn in_shell(line: &str, folder: &Path) -> (Option<i32>, String) {
    let program = rins_tests::rins().get_program().to_owned();
    let ours = Path::new(&program).parent().expect("a program lies in a folder").to_owned();
    let others = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(std::iter::once(ours).chain(std::env::split_paths(&others)));
    let mut shell = std::process::Command::new("sh");
    shell.args(["-c", line]).env("PATH", path.unwrap()).current_dir(folder);
    let output = shell.output().expect("there is a shell");
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn demo_leaves_a_result_that_others_can_read() {
    let Demo { finished, folder, .. } = &*DEMO;
    assert_eq!((finished.code, finished.err.as_str()), (Some(0), ""));
    assert!(finished.out.ends_with("\nReport: rins-demo/report.html\n"), "{}", finished.out);

    let mut names: Vec<String> = fs::read_dir(folder.path().join("rins-demo"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let expected = [
        "calibration.toml",
        "extended-calibration.toml",
        "extended-model.toml",
        "model.toml",
        "report.html",
        "result.json",
        "rig.toml",
        "run.csv",
    ];
    assert_eq!(names, expected);
    for (name, opening) in [("report.html", "<!"), ("run.csv", "time,"), ("result.json", "{")] {
        let content = fs::read_to_string(folder.path().join("rins-demo").join(name)).unwrap();
        assert!(content.starts_with(opening), "{name}");
    }
    // The report works without a network: nothing in it is fetched.
    let page = fs::read_to_string(folder.path().join("rins-demo/report.html")).unwrap();
    for fetched in ["src=\"http", "href=\"http", "src=\"//", "@import", "fetch("] {
        assert!(!page.contains(fetched), "the report holds {fetched}");
    }
    let written = fs::read_to_string(folder.path().join("rins-demo/result.json")).unwrap();
    let result: Value = serde_json::from_str(&written).unwrap();
    assert_eq!((&result["schema"], &result["command"]), (&2.into(), &"demo".into()));
    let (before, after) = (
        magnitude(&result, "/navigation/before/velocity_m_s"),
        magnitude(&result, "/navigation/after/velocity_m_s"),
    );
    assert!(before > 100.0 * after, "{before} m/s before, {after} m/s after");
}

/// The embedded run has the paper's errors, 60″ and 300 ppm, and a table angle with a latency of 0.1 ms.
#[test]
fn demo_prints_one_object_that_tells_the_truth() {
    let Demo { forced, .. } = &*DEMO;
    assert_eq!((forced.code, forced.err.as_str()), (Some(0), ""));
    let result = object(forced);
    assert_eq!(result["command"], "demo");
    let parameters = list(&result, "/parameters");
    assert_eq!(parameters.len(), 3);
    for (parameter, truth, floor) in
        [(&parameters[0], 60.0, 0.03), (&parameters[1], 60.0, 0.03), (&parameters[2], 300.0, 0.1)]
    {
        let (value, sigma) = (number(parameter, "/value"), number(parameter, "/sigma"));
        let within = 4.0 * sigma.max(floor);
        assert!((value - truth).abs() < within, "{truth} found as {value} ± {sigma}");
    }
    let diagnosis = &result["diagnosis"];
    assert_eq!(diagnosis["verdict"], "named", "{}", diagnosis["causes"]);
    let [cause] = list(diagnosis, "/causes") else { panic!("{diagnosis}") };
    assert_eq!(cause["effect"], "encoder_latency");
    let (delay, sigma) =
        (number(cause, "/parameters/0/value"), number(cause, "/parameters/0/sigma"));
    assert!((delay - 0.1).abs() < 4.0 * sigma && sigma < 0.001, "{delay} ± {sigma} ms");
    assert_eq!(diagnosis["gain"]["verdict"], "improved", "{}", diagnosis["gain"]);
}

#[cfg(unix)]
#[test]
fn next_steps_of_the_demo_work_as_they_are_printed() {
    let folder = tempfile::tempdir().unwrap();
    // A shell must see one word.
    let mut demo = rins_tests::rins();
    demo.args(["demo", "-o", "second run"]).current_dir(folder.path());
    let text = String::from_utf8(demo.output().unwrap().stdout).unwrap();
    let steps: Vec<&str> =
        text.lines().map(str::trim).filter(|line| line.starts_with("rins ")).collect();
    assert_eq!(steps.len(), 4, "{text}");
    for step in steps {
        let (code, error) = in_shell(step, folder.path());
        assert_eq!((code, error.as_str()), (Some(0), ""), "{step}");
    }
    assert!(folder.path().join("my-calibration/report.html").is_file());
}

#[test]
fn demo_replaces_its_result_only_if_told_to() {
    let Demo { finished, again, forced, .. } = &*DEMO;
    assert_eq!(finished.code, Some(0));
    assert_eq!((again.code, again.out.as_str()), (Some(1), ""));
    assert!(again.err.contains("rins-demo: exists already"), "{}", again.err);
    assert_eq!(object(forced)["command"], "demo");
}
