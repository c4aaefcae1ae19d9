//! Rows that cannot be read are lost samples: their times stay empty, and no other sample changes.

use rins_io::{Loaded, Omission};
use rins_testing::assert_close;

use crate::support::{folder, log, plain_rig, read_files, refusal, replaced, with_line, without};

const TIME: &str = "time = { column = \"t\", unit = \"s\" }\n";

fn loaded(rig: &str, log: &str) -> Loaded {
    read_files(&[("rig.toml", rig.as_bytes()), ("run.csv", log.as_bytes())]).unwrap()
}

/// The samples of `found` beside the one in line 17 are those of `whole`, which is followed by one of two intervals.
fn assert_lost(found: &Loaded, whole: &Loaded) {
    let (found, whole) = (&found.recording, &whole.recording);
    let expected: Vec<f64> = whole
        .times
        .iter()
        .enumerate()
        .filter(|(row, _)| *row != 15)
        .map(|(_, time)| *time)
        .collect();
    assert_eq!(found.times.len(), expected.len());
    for (found, expected) in found.times.iter().zip(&expected) {
        assert_close!(*found, *expected, 1e-12);
    }
    for (row, sample) in found.increments.iter().enumerate() {
        let same = whole.increments[if row < 15 { row } else { row + 1 }];
        let held = if row == 15 { 2.0 } else { 1.0 };
        assert_close!(sample.interval, held * same.interval, 1e-12);
        let difference = sample.velocity.components() - same.velocity.components() * held;
        assert_close!(difference.norm(), 0.0, 1e-12);
    }
}

/// Without a time column too, the samples after a damaged row keep their times.
#[test]
fn a_damaged_row_takes_its_time() {
    let damaged = with_line(&log(40), 17, "0.32,1e-6,error");
    let timed = plain_rig();
    let untimed = replaced(&timed, TIME, "");
    for rig in [timed, untimed] {
        let found = loaded(&rig, &damaged);
        assert_lost(&found, &loaded(&rig, &log(40)));
        let [gap] = found.summary.gaps[..] else { panic!("{:?}", found.summary.gaps) };
        assert_eq!((gap.line, gap.damaged), (18, true));
    }
}

/// The increment of a damaged row is lost with it: the next one does not cover it, whatever the sensor does in other gaps.
#[test]
fn increments_of_damaged_rows_are_lost() {
    let rig = replaced(&plain_rig(), "unit = \"rad/s\"", "unit = \"rad\"");
    let rig = replaced(&rig, "unit = \"m/s^2\"", "unit = \"m/s\"");
    let damaged = with_line(&log(40), 17, "0.32,1e-6,error");
    let stated = replaced(&rig, "rate = \"50 Hz\"\n", "rate = \"50 Hz\"\ngaps = \"accumulated\"\n");
    for rig in [&rig, &stated] {
        assert_lost(&loaded(rig, &damaged), &loaded(rig, &log(40)));
    }
    // A row that is missing in the log asks for the key.
    let missing = log(40)
        .lines()
        .enumerate()
        .filter(|(line, _)| *line != 16)
        .fold(String::new(), |text, (_, line)| text + line + "\n");
    let said = refusal(&[("rig.toml", rig.as_bytes()), ("run.csv", missing.as_bytes())]);
    assert!(said.contains("gaps = \"accumulated\" or gaps = \"held\""), "{said}");
}

/// A sample that is damaged in one of two files is left out of both.
#[test]
fn files_of_one_run_lose_the_same_sample() {
    let rig = replaced(&plain_rig(), "accel = { ", "accel = { path = \"accel.csv\", ");
    let damaged = with_line(&log(40), 17, "0.32");
    let whole = log(40);
    let read = |run: &str, accel: &str| {
        let files = [("rig.toml", rig.as_str()), ("run.csv", run), ("accel.csv", accel)];
        read_files(&files.map(|(name, text)| (name, text.as_bytes()))).unwrap()
    };
    let expected = read(&whole, &whole);
    for found in [read(&damaged, &whole), read(&whole, &damaged)] {
        assert_lost(&found, &expected);
        let out: Vec<_> = found.summary.left_out.iter().map(|out| (out.line, out.reason)).collect();
        assert_eq!(out, [(17, Omission::Damaged); 2]);
    }
}

/// One row in a hundred may be damaged.
#[test]
fn more_than_one_row_in_a_hundred_is_refused() {
    let damaged = |lines: &[usize]| {
        lines.iter().fold(log(200), |log, line| with_line(&log, *line, "0.32,cut"))
    };
    assert_eq!(loaded(&plain_rig(), &damaged(&[20, 90])).recording.len(), 198);
    let rig = plain_rig();
    let three = damaged(&[20, 90, 150]);
    let said = refusal(&[("rig.toml", rig.as_bytes()), ("run.csv", three.as_bytes())]);
    let message = "run.csv:20: column \"gx\": \"cut\" is not a number; 3 of 200 rows are damaged, more than one in a hundred";
    assert_eq!(said, message);
}

/// The first row of a log without names may have no beginning.
#[test]
fn a_first_row_without_its_beginning_is_lost() {
    let rig = replaced(&plain_rig(), TIME, "time = { column = \"1\", unit = \"s\" }\n");
    let rig = replaced(&rig, "[\"gx\", \"gy\", \"gz\"]", "[\"2\", \"3\", \"4\"]");
    let rig = replaced(&rig, "[\"ax\", \"ay\", \"az\"]", "[\"5\", \"6\", \"7\"]");
    let rows = log(40).split_once('\n').unwrap().1.replacen(",2.5e-6,", ",3e-6,", 2);
    let cut = rows.split_once(',').unwrap().1;
    let found = loaded(&rig, cut);
    assert_eq!((found.recording.len(), found.summary.left_out[0].line), (39, 1));
    let folder = folder(&[("run.csv", cut.as_bytes())]);
    let draft = rins_io::draft_rig(&folder.path().join("run.csv"), folder.path());
    let draft = draft.map_err(|error| without(&error, folder.path())).unwrap();
    assert!(draft.text.contains("time.column = \"1\""), "{}", draft.text);
}
