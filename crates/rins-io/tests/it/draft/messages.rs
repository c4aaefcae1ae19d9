//! Logs of drivers: orientations beside inertial sensors, and times in two columns.

use rins_io::{Draft, read};
use rins_testing::filled;

use super::support::{Motion, Row, SITE, draft};
use crate::support::folder;

/// The numbers as fields.
fn fields(numbers: impl IntoIterator<Item = f64>) -> String {
    numbers.into_iter().map(|number| format!("{number:.6}")).collect::<Vec<_>>().join(",")
}

/// A message of a driver, with an orientation and three covariances.
fn message(row: &Row) -> String {
    let (half, nothing) = (row.table / 2.0, fields([0.0; 9]));
    let orientation = fields([0.0, 0.0, half.sin(), half.cos()]);
    let (rate, force) = (fields(row.rate.iter().copied()), fields(row.force.iter().copied()));
    format!("imu,{orientation},{nothing},{rate},{nothing},{force},{nothing}")
}

/// The log of a motion, each row after its time from a whole number of milliseconds.
fn logged(stamp: impl Fn(u64) -> String, row: impl Fn(&Row) -> String) -> String {
    let motion = Motion { rate: 40, ..Motion::default() };
    (1..).zip(motion.rows()).fold(String::new(), |log, (index, sample)| {
        log + &format!("{},{}\n", stamp(index * 25), row(&sample))
    })
}

fn drafted(log: &str) -> Draft {
    let folder = folder(&[("run.csv", log.as_bytes())]);
    let draft = draft(folder.path(), "run.csv");
    let rig = folder.path().join("rig.toml");
    std::fs::write(&rig, filled(&draft.text, &SITE)).unwrap();
    let loaded = read(&rig).unwrap_or_else(|error| panic!("{error}\n{}", draft.text));
    assert!(loaded.summary.gaps.is_empty() && loaded.summary.jitter_rms < 1e-9);
    draft
}

fn assert_says(draft: &Draft, lines: &[&str]) {
    for line in lines {
        assert!(draft.text.contains(line), "{line}\n{}", draft.text);
    }
}

/// Seconds and nanoseconds are the time, and an orientation is no gravity of 1 g.
#[test]
fn messages_without_names_are_told_by_their_numbers() {
    let stamp = |time: u64| format!("{},{}", 1_600_000_000 + time / 1000, time % 1000 * 1_000_000);
    let draft = drafted(&logged(stamp, message));
    let lines = [
        "time.columns = [\"1\", \"2\"]  # GUESS",
        "time.unit = [\"s\", \"ns\"]  # GUESS",
        "gyro.columns = [\"17\", \"18\", \"19\"]  # GUESS",
        "gyro.unit = \"rad/s\"  # GUESS",
        "accel.columns = [\"29\", \"30\", \"31\"]  # GUESS",
        "accel.unit = \"m/s^2\"  # GUESS",
    ];
    assert_says(&draft, &lines);
}

/// Accelerometers in g beside a column of zeros are no orientation.
#[test]
fn one_g_is_no_orientation() {
    let in_g = |row: &Row| {
        let noise = 1e-4 * (1e3 * row.time).sin();
        let force = row.force.map(|force| force / 9.80665 * (1.0 + noise));
        fields(row.rate.iter().chain(&force).copied().chain([0.0]))
    };
    let draft = drafted(&logged(|time| format!("{}", 1e-3 * time as f64), in_g));
    assert_says(&draft, &["accel.columns = [\"5\", \"6\", \"7\"]  # GUESS"]);
}

/// Named columns: a GNSS week, and a date with a time of day.
#[test]
fn times_in_two_named_columns_are_found() {
    let row = |row: &Row| fields(row.rate.iter().chain(&row.force).copied());
    let week = |time: u64| format!("2209,{:.3}", 1e-3 * (604_700_000 + time) as f64);
    let date = |time: u64| {
        format!("05.07.2021,10:{:02}:{:02}.{:03}", time / 60_000, time / 1000 % 60, time % 1000)
    };
    let clock =
        |time: u64| format!("x,10:{:02}:{:02}.{:03}", time / 60_000, time / 1000 % 60, time % 1000);
    let names = "gx,gy,gz,ax,ay,az\n";
    let cases: [(&str, String, &[&str]); 3] = [
        (
            "GPSWeek,GPSSeconds",
            logged(week, row),
            &["time.columns = [\"GPSWeek\", \"GPSSeconds\"]", "time.unit = [\"week\", \"s\"]"],
        ),
        (
            "Datum,Zeit",
            logged(date, row),
            &["time.columns = [\"Datum\", \"Zeit\"]", "time.unit = [\"date\", \"s\"]"],
        ),
        ("Name,Time", logged(clock, row), &["time.column = \"Time\"\n", "time.unit = \"s\""]),
    ];
    for (time, log, lines) in cases {
        assert_says(&drafted(&format!("{time},{names}{log}")), lines);
    }
}
