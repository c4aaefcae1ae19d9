//! A log that is read while it is written has the samples of the finished log.

use std::path::Path;

use rins_io::{IoError, LiveLog, Rig};
use rins_motion::Recording;

use crate::support::{RIG, log, plain_rig, read_files, replaced, with_line};

fn append(to: &mut Recording, more: Recording) {
    to.times.extend(more.times);
    to.increments.extend(more.increments);
    for (to, more) in
        [(&mut to.table_angle, more.table_angle), (&mut to.table_rate, more.table_rate)]
    {
        if let Some(more) = more {
            to.get_or_insert_default().extend(more);
        }
    }
}

/// The samples of a log that comes in parts of this many bytes, and the error that ends it, if there is one.
fn live(rig: &str, text: &str, part: usize) -> (Recording, Option<IoError>) {
    let rig = Rig::parse(rig, Path::new("rig.toml")).unwrap();
    let mut log = LiveLog::new(rig, Path::new("live")).unwrap();
    let mut all = Recording::default();
    for bytes in text.as_bytes().chunks(part) {
        match log.feed(bytes) {
            Ok(more) => append(&mut all, more),
            Err(error) => return (all, Some(error)),
        }
    }
    loop {
        match log.end() {
            Ok(more) if more.is_empty() => return (all, None),
            Ok(more) => append(&mut all, more),
            Err(error) => return (all, Some(error)),
        }
    }
}

#[test]
fn samples_are_those_of_the_finished_log() {
    let plain = log(400);
    let lines: Vec<&str> = plain.lines().collect();
    let lost: String = lines
        .iter()
        .enumerate()
        .filter(|(line, _)| *line != 77)
        .map(|(_, l)| format!("{l}\n"))
        .collect();
    let comments =
        replaced(&plain, "t,gx", "# of a logger\n\nt,gx").replace("\n0.40", "\n\n# note\n0.40");
    let twice = with_line(&plain, 100, &format!("{}\n{}", lines[99], lines[99]));
    let preamble = format!("Logger 7\nserial 12, run 3\n{plain}");
    let turned = replaced(RIG, "\"gz\"], unit", "\"gz\"], axes = [\"-y\", \"x\", \"z\"], unit");
    let paced = replaced(RIG, "rate = \"50 Hz\"\n", "");
    let start = replaced(RIG, "unit = \"s\" }", "unit = \"s\", stamp = \"start\" }");
    for (what, rig, text) in [
        ("plain", RIG, &plain),
        ("a lost row", RIG, &lost),
        ("comments", RIG, &comments),
        ("a row twice", RIG, &twice),
        ("a preamble", RIG, &preamble),
        ("axes", &turned, &plain),
        ("no rate", &paced, &plain),
        ("stamps of the start", &start, &plain),
        ("Windows", RIG, &plain.replace('\n', "\r\n")),
    ] {
        let finished = read_files(&[("rig.toml", rig.as_bytes()), ("run.csv", text.as_bytes())]);
        let finished = finished.unwrap().recording;
        for part in [1, 97, 1 << 20] {
            let (mut found, failed) = live(rig, text, part);
            assert!(failed.is_none(), "{what}: {failed:?}");
            if what == "no rate" {
                // The median of ten steps is that of all but for rounding.
                let first = (&mut found.increments[0], &finished.increments[0]);
                assert!((first.0.interval - first.1.interval).abs() < 1e-12);
                *first.0 = *first.1;
            }
            assert!(found == finished, "{what}, parts of {part} bytes");
        }
    }
}

/// A row that cannot be read is an error with its line, after the samples before it.
#[test]
fn bad_row_is_named_after_the_samples_before_it() {
    let good = log(60);
    for (row, told) in [
        ("0.80,1,x,3,4,5,6,40", "live:41: column \"gy\": \"x\" is not a number"),
        ("0.80,1,2,3,4", "live:41: 5 fields, expected 8"),
        ("0.70,1,2,3,4,5,6,40", "live:41: time goes from 0.78 s to 0.7 s, it must increase"),
        ("0.80,1,2,3,4,5,6,220", "live:41: "),
        ("0.80,1e12,2,3,4,5,6,40", "live:41: column \"gx\": 1e12 rad/s is not plausible"),
        ("0.80,1,2,3,4,5,nan,40", "live:41: column \"az\": \"nan\" is not finite"),
    ] {
        for part in [1, 1 << 20] {
            let (before, failed) = live(RIG, &with_line(&good, 41, row), part);
            let failed = failed.unwrap().to_string();
            assert!(failed.starts_with(told), "{failed}");
            assert_eq!(before.len(), 39, "{failed}");
        }
    }
    let told = |text: &str| live(RIG, text, 64).1.unwrap().to_string();
    assert_eq!(told(""), "live: the file is empty");
    assert_eq!(told("t,gx,gy,gz,ax,ay,az,table\n"), "live: only a header, no samples");
    let unnamed = replaced(RIG, "\"gz\"", "\"rz\"");
    let failed = live(&unnamed, &log(300), 64).1.unwrap().to_string();
    assert!(failed.contains("no column \"rz\""), "{failed}");
    // The last line has no line end: it may be cut.
    let (whole, failed) = live(RIG, good.trim_end(), 64);
    assert!(failed.is_none() && whole.len() == 59);
}

#[test]
fn rig_without_a_reading_of_the_table_in_each_row_is_refused() {
    let refused = |rig: &str| {
        let rig = Rig::parse(rig, Path::new("rig.toml")).unwrap();
        LiveLog::new(rig, Path::new("live")).unwrap_err().to_string()
    };
    let found = refused(&plain_rig());
    assert_eq!(
        found,
        "rig.toml: [log] table_angle: a live log has a column table_angle or table_rate"
    );
    let found = refused(&replaced(RIG, "run.csv\"", "run.parquet\""));
    assert_eq!(found, "rig.toml: [log] format: a live log has columns of text");
    let found = refused(&replaced(RIG, "unit = \"s\" }", "unit = \"s\", stamp = \"middle\" }"));
    assert!(found.contains("stamps of the start or the end"), "{found}");
}
