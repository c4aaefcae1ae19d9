//! Times in two columns: seconds and their parts, weeks, dates.

use rins_io::{LogFile, Overwrite, convert};
use rins_testing::{assert_close, assert_rows, is};

use crate::support::{folder, log, plain_rig, read_files, refusal, replaced, with_line};

/// The log of 40 rows, in which `stamps` writes each time.
fn stamped(stamps: impl Fn(u64) -> String) -> String {
    let rows = log(40).lines().skip(1).enumerate().fold(String::new(), |text, (row, line)| {
        let rest = line.split_once(',').unwrap().1;
        text + &format!("{},{rest}\n", stamps(row as u64 + 1))
    });
    format!("coarse,fine,gx,gy,gz,ax,ay,az,table\n{rows}")
}

fn rig(units: &str) -> String {
    let time = "time = { column = \"t\", unit = \"s\" }";
    let two = format!("time = {{ columns = [\"coarse\", \"fine\"], unit = {units} }}");
    replaced(&plain_rig(), time, &two)
}

/// Whatever its two columns, a time is that of the same log with one.
#[test]
fn the_sum_of_two_columns_is_the_time() {
    let plain =
        read_files(&[("rig.toml", plain_rig().as_bytes()), ("run.csv", log(40).as_bytes())]);
    let plain = plain.unwrap();
    let unix = |row: u64, per_second: u64| {
        let parts = 1_599_999_999_990_000_000 + row * 20_000_000;
        format!(
            "{},{}",
            parts / 1_000_000_000,
            parts % 1_000_000_000 / (1_000_000_000 / per_second)
        )
    };
    let week = |row: u64| {
        let milliseconds = 604_799_800 + row * 20;
        let (week, rest) = (2209 + milliseconds / 604_800_000, milliseconds % 604_800_000);
        format!("{week},{}.{:03}", rest / 1000, rest % 1000)
    };
    let date = |row: u64| {
        let milliseconds = 86_399_800 + row * 20;
        let (day, rest) = (milliseconds / 86_400_000, milliseconds % 86_400_000);
        let (hour, minute) = (rest / 3_600_000, rest / 60_000 % 60);
        let (second, part) = (rest / 1000 % 60, rest % 1000);
        format!("{}.12.2024,{hour:02}:{minute:02}:{second:02}.{part:03}", 30 + day)
    };
    let logs = [
        ("[\"s\", \"ns\"]", stamped(|row| unix(row, 1_000_000_000))),
        ("[\"s\", \"us\"]", stamped(|row| unix(row, 1_000_000))),
        ("[\"s\", \"ms\"]", stamped(|row| unix(row, 1_000))),
        ("[\"week\", \"s\"]", stamped(week)),
        ("[\"date\", \"s\"]", stamped(date)),
    ];
    for (units, log) in logs {
        let files = [("rig.toml", rig(units)), ("run.csv", log)];
        let files = files.each_ref().map(|(name, text)| (*name, text.as_bytes()));
        let loaded = read_files(&files).unwrap_or_else(|error| panic!("{units}: {error}"));
        assert_eq!(loaded.summary.samples, 40, "{units}");
        assert!(loaded.summary.gaps.is_empty() && loaded.summary.time_origin > 1e8, "{units}");
        for (found, expected) in loaded.recording.increments.iter().zip(&plain.recording.increments)
        {
            assert_close!(found.interval, expected.interval, 1e-12);
            let difference = found.velocity.components() - expected.velocity.components();
            assert_close!(difference.norm(), 0.0, 1e-11);
        }
    }
}

/// Columns of binary files are added too: here a table angle and a temperature stand for the parts of a time.
#[test]
fn two_columns_of_a_binary_file_are_a_time() {
    let log = stamped(|row| format!("7,{}", row * 20)).replacen("coarse,fine", "coarse,t", 1);
    let rig = replaced(
        &replaced(&plain_rig(), "unit = \"s\" }", "unit = \"ms\" }"),
        "[attitude]",
        "table_angle = { column = \"coarse\", unit = \"rad\" }\n\
         temperature = { column = \"t\", unit = \"degC\" }\n[attitude]",
    );
    for (file, format) in [(LogFile::Parquet, "parquet"), (LogFile::Mat, "mat")] {
        let folder = folder(&[("rig.toml", rig.as_bytes()), ("run.csv", log.as_bytes())]);
        let path = |name: &str| folder.path().join(name);
        let new = path(&format!("new.{format}"));
        convert(&path("rig.toml"), &new, file, Overwrite::Refuse).unwrap();
        let text = std::fs::read_to_string(path("new.toml")).unwrap();
        let column = |name| text.split_once(name).unwrap().1.split('"').nth(1).unwrap();
        let (coarse, fine) = (column("table_angle = "), column("temperature = "));
        let time = format!("time = {{ columns = [{coarse:?}, {fine:?}], unit = [\"s\", \"ms\"] }}");
        let lines = text.lines().filter(|line| !line.starts_with("rate"));
        let lines = lines.map(|line| if line.starts_with("time") { &time } else { line });
        std::fs::write(path("new.toml"), lines.collect::<Vec<_>>().join("\n")).unwrap();
        let loaded = rins_io::read(&path("new.toml")).unwrap();
        assert_close!(loaded.recording.times[0], 7.02, 1e-9);
        assert_close!(loaded.recording.times[39], 7.8, 1e-9);
    }
}

#[test]
fn wrong_parts_of_a_time_are_named() {
    let right = stamped(|row| format!("{},{}", 1_600_000_000 + row / 50, row % 50 * 20_000_000));
    let cases = [
        (
            "[\"s\", \"us\"]",
            "run.csv:2: column \"fine\": \"20000000\" is not from 0 to less than 1 s; check time.unit",
        ),
        (
            "[\"date\", \"s\"]",
            "run.csv:2: column \"coarse\": \"1600000000\" is not a date such as 2021-07-05 or 05.07.2021",
        ),
        (
            "[\"ns\", \"s\"]",
            "rig.toml:10: [log] time.unit: [\"ns\", \"s\"] is not allowed, expected the units of the two columns",
        ),
        (
            "[\"s\", \"s\"]",
            "rig.toml:10: [log] time.unit: [\"s\", \"s\"] is not allowed, expected the units of the two columns",
        ),
        (
            "[\"s\"]",
            "rig.toml:10: [log] time.unit: [\"s\"] is not allowed, expected the units of the two columns",
        ),
        (
            "\"s\"",
            "rig.toml:10: [log] time.unit: \"s\" is a text, expected the units of the two columns",
        ),
    ];
    assert_rows(cases.iter().map(|(units, message)| {
        let rig = rig(units);
        let said = refusal(&[("rig.toml", rig.as_bytes()), ("run.csv", right.as_bytes())]);
        let found = if said.starts_with(message) { *message } else { said.as_str() };
        (units.to_string(), is(found, *message))
    }));
    let rig = rig("[\"s\", \"ns\"]");
    let line = "1600000000.5,320000000,1e-6,2e-6,1e-6,0.1,0.2,9.8,16";
    let log = with_line(&with_line(&right, 17, line), 19, line);
    let said = refusal(&[("rig.toml", rig.as_bytes()), ("run.csv", log.as_bytes())]);
    let message = "run.csv:17: column \"coarse\": \"1600000000.5\" is not a whole number; ";
    assert!(said.starts_with(message), "{said}");
}
