//! The form of text logs: decimal commas, and lines before the header.

use rins_io::{draft_rig, read};
use rins_testing::{assert_rows, filled, is};

use crate::support::{RIG, folder, log, read_files, refusal, replaced};

fn rig(keys: &str) -> String {
    replaced(RIG, "path = \"run.csv\"\n", &format!("path = \"run.csv\"\n{keys}"))
}

/// The log of 40 rows with decimal commas and this delimiter.
fn with_commas(delimiter: &str) -> String {
    log(40).replace(',', delimiter).replace('.', ",")
}

/// The log with fields in quotation marks.
fn quoted() -> String {
    let field = |field: &str| format!("\"{}\"", field.replace('.', ","));
    let line = |line: &str| line.split(',').map(field).collect::<Vec<_>>().join(",");
    log(40).lines().map(|text| line(text) + "\n").collect()
}

#[test]
fn decimal_commas_are_read_as_points() {
    let plain = read_files(&[("rig.toml", RIG.as_bytes()), ("run.csv", log(40).as_bytes())]);
    let plain = plain.unwrap();
    let rig = rig("decimal = \",\"\n");
    for log in [with_commas(";"), with_commas("\t"), with_commas("  "), quoted()] {
        let loaded = read_files(&[("rig.toml", rig.as_bytes()), ("run.csv", log.as_bytes())]);
        assert_eq!(loaded.unwrap().recording, plain.recording, "{log}");
    }
}

#[test]
fn stated_lines_are_passed_over() {
    let plain = read_files(&[("rig.toml", RIG.as_bytes()), ("run.csv", log(40).as_bytes())]);
    let plain = plain.unwrap();
    // Words that look like a header, a row that looks like a sample, and what is not text.
    let before = b"t,gx,gy,gz,ax,ay,az,table\n0.02,1,2,3,4,5,6,7\n\n\xff\xfe\0\n";
    let log = [before.as_slice(), log(40).as_bytes()].concat();
    let rig = rig("skip = 4\n");
    let loaded = read_files(&[("rig.toml", rig.as_bytes()), ("run.csv", &log)]).unwrap();
    assert_eq!(loaded.recording, plain.recording);
}

#[test]
fn forms_that_do_not_fit_are_refused_with_the_key() {
    let (commas, points) = (with_commas(";"), log(40));
    let hint = "if commas are decimal marks, state decimal = \",\" in [log]";
    let undeclared = format!("run.csv:2: column \"t\": \"0,02\" is not a number; {hint}");
    let cases: [(&str, &str, &str); 6] = [
        ("", &commas, &undeclared),
        ("decimal = \",\"\n", &points, "run.csv:2: column \"gx\": \"0.000001\" is not a number"),
        (
            "decimal = \";\"\n",
            &points,
            "rig.toml:9: [log] decimal: \";\" is not known, expected one of \".\", \",\"",
        ),
        (
            "skip = 41\n",
            &points,
            "run.csv: the file has no line after the 41 that [log] skip leaves out",
        ),
        (
            "skip = -1\n",
            &points,
            "rig.toml:9: [log] skip: -1 is not allowed, expected a number of lines before the header or the first row, such as 12",
        ),
        (
            "format = \"mat\"\nskip = 1\n",
            &points,
            "rig.toml:10: [log] skip: only columns of text have it",
        ),
    ];
    assert_rows(cases.iter().map(|(keys, log, message)| {
        let rig = rig(keys);
        let said = refusal(&[("rig.toml", rig.as_bytes()), ("run.csv", log.as_bytes())]);
        let found = if said.starts_with(message) { *message } else { said.as_str() };
        (keys.to_string(), is(found, *message))
    }));
}

#[test]
fn decimal_commas_are_drafted_where_they_are_certain() {
    let headless = |log: String| log.split_once('\n').unwrap().1.to_string();
    let cases = [
        (with_commas(";"), true),
        (with_commas("\t"), true),
        (with_commas(" "), true),
        (quoted(), true),
        (headless(with_commas(" ")), true),
        (headless(with_commas(";")), true),
        (log(40), false),
        // Both marks are in use.
        (log(40).replace(',', ";").replace("9.8", "9,8"), false),
    ];
    for (log, is_certain) in cases {
        let folder = folder(&[("run.csv", log.as_bytes())]);
        let Ok(draft) = draft_rig(&folder.path().join("run.csv"), folder.path()) else {
            assert!(!is_certain, "{log}");
            continue;
        };
        assert_eq!(draft.text.contains("decimal = \",\"\n"), is_certain, "{}", draft.text);
        if is_certain && draft.text.contains("t\"") {
            let units = [
                ("log.gyro.unit", "\"rad/s\""),
                ("log.table_angle.unit", "\"deg\""),
                ("site.latitude", "\"34.25 deg\""),
                ("site.height", "\"400 m\""),
            ];
            let open =
                |(key, _): &&(&str, &str)| draft.to_fill_in.iter().any(|open| open.key == *key);
            let units: Vec<_> = units.iter().filter(open).copied().collect();
            let rig = folder.path().join("rig.toml");
            std::fs::write(&rig, filled(&draft.text, &units)).unwrap();
            let loaded = read(&rig).unwrap_or_else(|error| panic!("{error}\n{}", draft.text));
            assert_eq!(loaded.recording.len(), 40);
        }
    }
}
