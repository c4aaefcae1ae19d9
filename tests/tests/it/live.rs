//! Calibration of a log while it is written.

use std::fs::{self, OpenOptions};
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use rins_tests::rins;
use serde_json::Value;

use crate::support::{Finished, assert_found, list, number, object, parameter, result_in, rins_in};

/// A run of 40 s with an encoder in `folder`: `run/rig.toml` and `run/run.csv`.
fn simulate(folder: &Path) {
    let demo = rins_tests::workspace().join("crates/rins/data/demo/scenario.toml");
    let scenario = fs::read_to_string(demo).unwrap();
    let short = scenario
        .replace("\"25 Hz\"", "\"50 Hz\"")
        .replace("\"180 s\"", "\"15 s\"")
        .replace("\"20 s\"", "\"10 s\"")
        .replace("acceleration", "wobble = \"0.1 arcsec\"\nacceleration");
    let effects = short.find("[[truth.effects]]").unwrap();
    fs::write(folder.join("scenario.toml"), &short[..effects]).unwrap();
    let simulated = rins_in(folder, "simulate scenario.toml -o run");
    assert_eq!(simulated.code, Some(0), "{}", simulated.err);
}

/// `rins calibrate run/rig.toml --live=-` with this input, whose pipe breaks at its end.
fn live_of(folder: &Path, input: &[u8], more: &str) -> Finished {
    let mut command = rins();
    let arguments = format!("calibrate run/rig.toml --live=- --json --every 3600 {more}");
    command.args(arguments.split_whitespace()).current_dir(folder);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut pipe = child.stdin.take().unwrap();
    // A command that refuses a row does not read the rest.
    let _ = pipe.write_all(input);
    drop(pipe);
    child.wait_with_output().unwrap().into()
}

fn without_end(mut result: Value) -> Value {
    result.as_object_mut().unwrap().remove("end");
    result
}

/// The errors are found; a log that grows, standard input, and a run that broke off and was resumed give the same bits.
#[test]
fn live_estimates_do_not_depend_on_how_the_log_comes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder);
    let log = fs::read(folder.join("run/run.csv")).unwrap();

    let piped = live_of(folder, &log, "");
    assert_eq!(piped.code, Some(0), "{}", piped.err);
    let live = object(&piped);
    assert_eq!(live["end"], "closed");
    assert_eq!(list(&live, "/parameters").len(), 27);
    for (id, truth) in
        [("gyro.scale.z", 300.0), ("gyro.misalignment.xz", 60.0), ("gyro.misalignment.yz", 60.0)]
    {
        assert_found(&live, id, truth);
        assert_eq!(parameter(&live, id)["identified"], true, "{id}");
    }
    let variance = number(&live, "/innovation_variance");
    assert!((0.5..1.1).contains(&variance), "{variance}");

    // The finished log says the same.
    let finished = result_in(folder, "calibrate run/rig.toml --model full --noise given");
    // Of a combination the result states the sum.
    let alone = |one: &&Value| one["observability"] != "combination";
    let estimates: Vec<&Value> = list(&finished, "/parameters").iter().filter(alone).collect();
    assert!(estimates.len() > 10, "{finished}");
    for estimate in estimates {
        let id = estimate["id"].as_str().unwrap();
        let here = parameter(&live, id);
        let sigma = number(estimate, "/sigma");
        let off = (number(here, "/value") - number(estimate, "/value")) / sigma;
        assert!(off.abs() < 0.01, "{id}: {off} sigma");
        assert!((number(here, "/sigma") / sigma - 1.0).abs() < 0.01, "{id}");
    }

    // The log grows, and its writer breaks off within a row.
    let half = log.len() / 2;
    fs::write(folder.join("run/run.csv"), &log[..half]).unwrap();
    let growing = folder.join("run/run.csv");
    let rest = log[half..].to_vec();
    let writer = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(300));
        let mut file = OpenOptions::new().append(true).open(growing).unwrap();
        for part in rest.chunks(rest.len() / 3) {
            file.write_all(part).unwrap();
            std::thread::sleep(Duration::from_millis(100));
        }
        file.write_all(b"40.04,1.0,").unwrap();
    });
    let followed = rins_in(folder, "calibrate run/rig.toml --live --idle 2 --json");
    writer.join().unwrap();
    assert_eq!(followed.code, Some(0), "{}", followed.err);
    let followed = object(&followed);
    assert_eq!(followed["end"], "idle");
    assert_eq!(without_end(followed), without_end(live.clone()));

    // A bad row is an error with its line; what was read before it is in the checkpoint.
    let lines: Vec<&[u8]> = log.split_inclusive(|byte| *byte == b'\n').collect();
    let spoilt =
        [lines[..1401].concat(), b"28.02,1,2,three,4,5,6,7\n".to_vec(), lines[1402..].concat()];
    let refused = live_of(folder, &spoilt.concat(), "--checkpoint state.json");
    assert_eq!((refused.code, refused.out.as_str()), (Some(1), ""));
    assert!(refused.err.contains("standard input:1402: "), "{}", refused.err);
    let resumed = live_of(folder, &log, "--checkpoint state.json --resume");
    assert_eq!(resumed.code, Some(0), "{}", resumed.err);
    assert_eq!(object(&resumed), live);
}

/// The page and the estimates of a calibration that goes on, over HTTP.
#[test]
fn estimates_are_served_while_the_log_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder);
    let log = fs::read(folder.join("run/run.csv")).unwrap();
    let mut command = rins();
    let arguments = "calibrate run/rig.toml --live=- --serve=127.0.0.1:0 --every 0.05";
    command.args(arguments.split_whitespace()).current_dir(folder);
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut pipe = child.stdin.take().unwrap();
    pipe.write_all(&log).unwrap();
    let mut told = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    told.read_line(&mut line).unwrap();
    let address =
        line.trim().strip_prefix("page: http://").unwrap().trim_end_matches('/').to_owned();
    let ask = |request: &str| {
        let mut stream = TcpStream::connect(&address).unwrap();
        write!(stream, "{request} HTTP/1.1\r\nHost: {address}\r\n\r\n").unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    };
    assert!(ask("GET /").contains("Calibration while the table turns"));
    assert!(ask("GET /etc/passwd").starts_with("HTTP/1.1 404"));
    assert!(ask("POST /").starts_with("HTTP/1.1 405"));
    let served = (0..100).find_map(|_| {
        std::thread::sleep(Duration::from_millis(50));
        let answer = ask("GET /estimates.json");
        let (_, body) = answer.split_once("\r\n\r\n").unwrap();
        let now: Value = serde_json::from_str(body).unwrap();
        (list(&now, "/parameters").len() == 27 && number(&now, "/time_s") > 30.0).then_some(now)
    });
    assert!(number(&served.unwrap(), "/samples") > 1500.0);
    drop(pipe);
    assert!(child.wait().unwrap().success());
}

#[test]
fn live_log_that_cannot_be_used_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder);
    let log = fs::read(folder.join("run/run.csv")).unwrap();
    let told = |finished: &Finished, code: i32, words: &str| {
        assert_eq!(finished.code, Some(code), "{}", finished.err);
        assert!(finished.err.contains(words), "{words:?} not in {}", finished.err);
        assert!(!finished.err.contains("panicked"), "{}", finished.err);
    };
    told(&live_of(folder, b"", ""), 1, "standard input: the file is empty");
    told(&live_of(folder, &log[..500], ""), 1, "too short");
    told(&live_of(folder, &log, "--resume"), 2, "--checkpoint");
    told(&live_of(folder, &log, "--model paper12"), 2, "--live takes full or a model file");
    told(&live_of(folder, &log, "--checkpoint none.json --resume"), 1, "cannot read none.json");
    fs::write(folder.join("state.json"), "{}").unwrap();
    let damaged = live_of(folder, &log, "--checkpoint state.json --resume");
    told(&damaged, 1, "state.json: not a checkpoint");

    let rig = folder.join("run/rig.toml");
    let text = fs::read_to_string(&rig).unwrap();
    fs::write(&rig, text.replace("run.csv", "other.csv")).unwrap();
    let absent = rins_in(folder, "calibrate run/rig.toml --live --idle 0.2");
    told(&absent, 1, "other.csv");
    fs::write(&rig, text.replace("table_angle = {", "table_angle = { latency = \"1 ms\","))
        .unwrap();
    told(&live_of(folder, &log, ""), 1, "a live log has a table angle without latency");
}
