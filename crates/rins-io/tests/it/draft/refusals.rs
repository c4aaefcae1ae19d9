//! The reader reports the keys that a draft leaves open, and files that are not logs are refused.

use proptest::prelude::*;
use rins_io::{draft_rig, read};
use rins_testing::filled;

use super::support::{SITE, draft};
use crate::support::{folder, log, without};

/// Keys with the values to be filled in.
type Values = &'static [(&'static str, &'static str)];

/// The error of reading the draft of `log` with these values filled in.
fn error_of_draft(log: &str, values: &[(&str, &str)]) -> String {
    let folder = folder(&[("run.csv", log.as_bytes())]);
    let draft = draft(folder.path(), "run.csv");
    let rig = folder.path().join("rig.toml");
    std::fs::write(&rig, filled(&draft.text, values)).unwrap();
    let error = without(&read(&rig).unwrap_err(), folder.path());
    // Line numbers depend on the comments of a draft.
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    error.split(':').filter(|part| !digits(part)).collect::<Vec<_>>().join(":")
}

#[test]
fn a_key_that_is_left_open_is_named() {
    let plain = log(300);
    let counted = plain.replacen("t,", "n,", 1);
    let counted: String = counted
        .lines()
        .enumerate()
        .map(|(row, line)| match row {
            0 => format!("{line}\n"),
            _ => format!("{row},{}\n", line.split_once(',').unwrap().1),
        })
        .collect();
    let raw = "t,gx,gy,gz\n0.01,1,2,3\n0.02,2,2,9\n0.03,1,5,3\n";
    let cases: [(&str, Values, &str); 7] = [
        (
            &plain,
            &[("log.gyro.unit", "\"rad/s\""), ("log.table_angle.unit", "\"deg\"")],
            "rig.toml: [site] latitude: missing, expected a latitude such as \"34.25 deg\"",
        ),
        (
            &plain,
            &[],
            "rig.toml: [log] gyro.unit: missing, expected an angular rate or an angle increment such as \"deg/s\"",
        ),
        (
            &counted,
            &[],
            "rig.toml: [log] rate: missing, expected a sampling rate such as \"50 Hz\", as time counts samples",
        ),
        (
            raw,
            &[("log.accel.columns", "[\"1\", \"2\", \"3\"]")],
            "rig.toml: [log] gyro.unit: missing, expected an angular rate or an angle increment such as \"deg/s\"",
        ),
        (
            "a,b\n1,2\n1,3\n",
            &[],
            "rig.toml: [log] time: missing, expected { column = \"t\", unit = \"s\" }, or a rate where there is no time column",
        ),
        // Placeholders that are uncommented without a value are refused too.
        (
            &plain,
            &[("log.gyro.unit", "\"?\"")],
            "rig.toml: [log] gyro.unit: \"?\" is not a product of units such as \"deg/h/sqrt(Hz)\"",
        ),
        (
            &plain,
            &[
                ("log.gyro.unit", "\"rad/s\""),
                ("log.table_angle.unit", "\"deg\""),
                ("site.latitude", "\"? deg\""),
            ],
            "rig.toml: [site] latitude: \"? deg\" does not begin with a number",
        ),
    ];
    for (log, values, expected) in cases {
        assert_eq!(error_of_draft(log, values), expected);
    }
}

#[test]
fn whole_numbers_are_asked_for_their_scale() {
    let mut log = String::from("n_samples,gx,gy,gz,ax,ay,az\n");
    for row in 0..200 {
        log.push_str(&format!("{row},{},3,-2,5,-7,{}\n", row % 9, 16384 + row % 3));
    }
    let folder = folder(&[("raw.csv", log.as_bytes())]);
    let draft = draft(folder.path(), "raw.csv");
    let open: Vec<&str> = draft.to_fill_in.iter().map(|key| key.key.as_str()).collect();
    let expected =
        ["log.rate", "log.gyro.unit", "log.gyro.scale", "log.accel.unit", "log.accel.scale"];
    assert_eq!(
        open.iter().filter(|key| key.starts_with("log.")).copied().collect::<Vec<_>>(),
        expected
    );
    assert!(draft.text.contains("the steady magnitude is 16390"), "{}", draft.text);
    // With the values filled in, the log is read: gy and gz are stuck, which the reader reports.
    let mut values = SITE.to_vec();
    values.extend([
        ("log.rate", "\"100 Hz\""),
        ("log.gyro.unit", "\"deg/s\""),
        ("log.gyro.scale", "0.061"),
        ("log.accel.unit", "\"g\""),
        ("log.accel.scale", "6.1035e-5"),
    ]);
    let rig = folder.path().join("rig.toml");
    std::fs::write(&rig, filled(&draft.text, &values)).unwrap();
    let error = without(&read(&rig).unwrap_err(), folder.path());
    assert_eq!(
        error,
        "raw.csv: gyro y (\"gy\") is 3 in every sample: the channel is stuck or the wrong column"
    );
}

#[test]
fn the_other_sensors_file_is_found_beside() {
    let row =
        |row: u32| format!("{:.2} {} {} 7\n", f64::from(row) * 0.01, 30000 + row % 5, row % 3);
    let log: String = (0..200).map(row).collect();
    let folder = folder(&[("a_gyro.mat", log.as_bytes()), ("a_acc.mat", log.as_bytes())]);
    let draft = draft(folder.path(), "a_gyro.mat");
    assert!(draft.text.contains("accel.path = \"a_acc.mat\"  # GUESS"), "{}", draft.text);
    assert!(draft.text.contains("accel.columns = [\"2\", \"3\", \"4\"]  # GUESS"));
    assert!(draft.text.contains("format = \"csv\"\n"));
}

#[test]
fn three_columns_of_nobody_knows_what_are_left_to_the_user() {
    let row =
        |row: u32| format!("{:.2} {} {} 7\n", f64::from(row) * 0.01, 30000 + row % 5, row % 3);
    let log: String = (0..200).map(row).collect();
    let folder = folder(&[("what.mat", log.as_bytes())]);
    let draft = draft(folder.path(), "what.mat");
    assert!(
        draft.text.contains(
            "# Columns [\"2\", \"3\", \"4\"] are gyros or accelerometers; the data do not show which."
        ),
        "{}",
        draft.text
    );
}

#[test]
fn names_that_repeat_are_told_by_their_place() {
    let text = "t,gx,gy,gz,gx,gy,gz\n0.01,1,2,3,1,2,3\n0.02,2,3,4,2,3,4\n";
    let folder = folder(&[("run.csv", text.as_bytes())]);
    let draft = draft(folder.path(), "run.csv");
    let guess = draft.guesses.iter().find(|guess| guess.key == "log.gyro.columns").unwrap();
    assert_eq!(guess.value, r#"["2", "3", "4"]"#);
    assert_eq!(guess.why, "the first of several; there are also 5, 6, 7");
}

#[test]
fn what_is_no_log_is_refused() {
    let cases: [(&[u8], &str); 9] = [
        (b"", "run.csv: the file is empty"),
        (b"t,gx,gy\n", "run.csv: only a header, no samples"),
        (b"t,gx\ns,deg/s\nx,y\n2,3\n", "run.csv:3: column \"t\": \"x\" is not a number"),
        (
            b"t;gx\n0,1;2.5\n0,2;2.5\n",
            "run.csv:2: column \"t\": \"0,1\" is not a number; if commas are decimal marks, state decimal = \",\" in [log]",
        ),
        (
            b"t,gx\n1,2\n2,3,4,5\n1,2,3,4\n",
            "run.csv:3: 4 fields, expected 2; 2 of 3 rows are damaged, more than one in a hundred",
        ),
        (
            b"t,gx\n1,2\n2\n3\n",
            "run.csv:3: 1 fields, expected 2; is the line cut short?; 2 of 3 rows are damaged, more than one in a hundred",
        ),
        (b"t,\xff\n1,2\n", "run.csv:1: not UTF-8 text; is it binary or UTF-16?"),
        (
            b"% PSINS-format SIMU log file\n0 0 0 0 0 0\n134 0 0 0 10 9.78\n1 1 1 1 1 1\n",
            "run.csv:3: the header's latitude is 134, expected a latitude from -89.9 to 89.9 deg; the \
             poles at -90 and 90 deg are excluded: east is not defined there",
        ),
        (b"% PSINS-format SIMU log file\n0 0 0 0 0 0\n", "run.csv: the header has 1 of its 3 rows"),
    ];
    for (bytes, expected) in cases {
        let folder = folder(&[("run.csv", bytes)]);
        let error = draft_rig(&folder.path().join("run.csv"), folder.path()).unwrap_err();
        assert_eq!(without(&error, folder.path()), expected);
    }
    let folder = folder(&[]);
    let error = draft_rig(&folder.path().join("run.csv"), folder.path()).unwrap_err();
    assert_eq!(without(&error, folder.path()), "cannot read run.csv");
}

proptest! {
    #[test]
    fn any_file_is_drafted_or_refused(
        text in "([-+0-9.eE]{1,4}[,; \t]){0,5}[a-zA-Z()\\[\\]%#_]{0,9}(\n([-+0-9.]{0,4},){0,7}[0-9]{0,3}){0,12}"
    ) {
        let folder = folder(&[("run.csv", text.as_bytes())]);
        if let Ok(draft) = draft_rig(&folder.path().join("run.csv"), folder.path()) {
            prop_assert!(draft.text.parse::<toml::Table>().is_ok(), "{}", draft.text);
        }
    }
}
