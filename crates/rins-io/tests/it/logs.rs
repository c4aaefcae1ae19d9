//! Valid logs in all variants.

use nalgebra::Vector3;
use rins_frames::units::{ARCSEC, DEG, STANDARD_GRAVITY};
use rins_io::{Delimiter, Loaded, LogPolicy, Omission, Rig, peek, read_log};
use rins_motion::Recording;
use rins_testing::assert_close;

use crate::support::{RIG, folder, log, plain_rig, read_files, replaced, with_line};

fn load(rig: &str, log: &str) -> Loaded {
    read_files(&[("rig.toml", rig.as_bytes()), ("run.csv", log.as_bytes())]).unwrap()
}

fn vectors(recording: &Recording, sample: usize) -> (Vector3<f64>, Vector3<f64>) {
    let increments = &recording.increments[sample];
    (*increments.angle.components(), *increments.velocity.components())
}

#[test]
fn rates_become_increments_over_the_interval() {
    let loaded = load(RIG, &log(40));
    let recording = &loaded.recording;
    assert_eq!((recording.len(), loaded.summary.samples), (40, 40));
    let (angle, velocity) = vectors(recording, 9);
    assert_close!(angle.x, 10e-6 * 0.02, 1e-22);
    assert_close!(velocity.z, 9.80001 * 0.02, 1e-16);
    assert_close!(recording.times[9], 0.2, 1e-16);
    assert_close!(recording.table_angle.as_ref().unwrap()[9], 10.0 * DEG, 1e-16);
    assert_eq!(recording.increments[9].interval, 0.02);
    assert!(loaded.summary.gaps.is_empty());
}

#[test]
fn all_ways_to_write_one_table_say_the_same() {
    let right = log(40);
    let rows: Vec<&str> = right.lines().skip(1).collect();
    let expected = load(RIG, &right).recording;
    let by_number = RIG
        .replace("column = \"t\"", "column = \"1\"")
        .replace("[\"gx\", \"gy\", \"gz\"]", "[\"2\", \"3\", \"4\"]")
        .replace("[\"ax\", \"ay\", \"az\"]", "[\"5\", \"6\", \"7\"]")
        .replace("column = \"table\"", "column = \"8\"");
    let cases = [
        (RIG, right.replace(',', ";")),
        (RIG, right.replace(',', "\t")),
        (RIG, right.replace(',', "   ")),
        (RIG, right.replace(',', " , ")),
        (RIG, right.replace('\n', "\r\n")),
        (RIG, format!("\u{feff}{right}")),
        (RIG, format!("# a comment, with a comma\n\n% another\n{right}\n\n# the end\n")),
        (RIG, format!("# t,gx,gy,gz,ax,ay,az,table\n{}\n", rows.join("\n"))),
        (RIG, format!("{}\n{}", right.lines().next().unwrap(), rows.join(",\n") + ",\n")),
        (RIG, right.replace("gx", "\"gx\"").replace("0.1,", "\"0.1\",")),
        (&by_number, rows.join("\n") + "\n"),
        (&by_number, right.clone()),
    ];
    for (rig, text) in cases {
        assert_eq!(load(rig, &text).recording, expected, "{}", &text[..60]);
    }
}

#[test]
fn a_last_line_that_does_not_end_is_left_out_and_told() {
    let right = log(40);
    let all = load(RIG, &right).recording;
    // Whatever is cut off, down to the line before: a truncated number may still be a valid one.
    for cut in 1..right.lines().last().unwrap().len() {
        let loaded = load(RIG, &right[..right.len() - cut]);
        assert_eq!(loaded.recording, all.slice(0, 39), "{cut}");
        let [out] = &loaded.summary.left_out[..] else { panic!("one line") };
        assert_eq!((out.line, out.reason), (41, Omission::Unfinished));
        assert!(out.path.ends_with("run.csv"));
    }
    assert_eq!(load(RIG, &right).summary.left_out, []);
    assert_eq!(load(RIG, &format!("{right}# cut sho")).summary.left_out, []);
    assert_eq!(load(RIG, &format!("{right}   ")).summary.left_out, []);
}

#[test]
fn a_row_that_is_logged_twice_counts_once() {
    let right = log(40);
    let line = right.lines().nth(16).unwrap();
    let twice = right.replace(line, &format!("{line}\n{line}"));
    let loaded = load(RIG, &twice);
    assert_eq!(loaded.recording, load(RIG, &right).recording);
    let left_out: Vec<_> =
        loaded.summary.left_out.iter().map(|out| (out.line, out.reason)).collect();
    assert_eq!(left_out, [(18, Omission::Repeated)]);
}

#[test]
fn short_gaps_are_kept_and_counted() {
    let mut lines: Vec<String> = log(40).lines().map(Into::into).collect();
    lines.drain(20..22);
    let loaded = load(RIG, &lines.join("\n"));
    let [gap] = loaded.summary.gaps[..] else { panic!("one gap") };
    assert_eq!((gap.sample, gap.line, gap.after), (19, 21, 0.38));
    assert_close!(gap.length, 0.06, 1e-15);
    assert_close!(loaded.recording.increments[19].interval, 0.06, 1e-15);
    // The mean rate of the sample at the end of the gap is held over it.
    assert_close!(vectors(&loaded.recording, 19).0.x, 22e-6 * 0.06, 1e-20);
}

#[test]
fn increments_after_a_gap_are_what_the_rig_says() {
    let rig = plain_rig().replace("\"rad/s\"", "\"arcsec\"").replace("\"m/s^2\"", "\"ug*s\"");
    let mut lines: Vec<String> = log(40).lines().map(Into::into).collect();
    lines.remove(20);
    let after_gap = |gaps: &str| {
        let rig = replaced(&rig, "rate = ", &format!("gaps = \"{gaps}\"\nrate = "));
        let (angle, velocity) = vectors(&load(&rig, &lines.join("\n")).recording, 19);
        (angle.x / ARCSEC, velocity.z / (1e-6 * STANDARD_GRAVITY))
    };
    let (angle, velocity) = after_gap("accumulated");
    assert_close!(angle, 21e-6, 1e-18);
    assert_close!(velocity, 9.800021, 1e-14);
    let (angle, velocity) = after_gap("held");
    assert_close!(angle, 42e-6, 1e-18);
    assert_close!(velocity, 2.0 * 9.800021, 1e-14);
}

#[test]
fn jitter_is_measured() {
    let row = |n: usize| {
        let late = if n.is_multiple_of(2) { 1e-4 } else { 0.0 };
        format!("{:.4},{n},{},{},1,2,3\n", n as f64 * 0.02 + late, n + 1, n + 2)
    };
    let rows: String = (1..101).map(row).collect();
    let loaded = load(&plain_rig(), &format!("t,gx,gy,gz,ax,ay,az\n{rows}"));
    assert_close!(loaded.summary.jitter_rms, 1e-4, 1e-9);
    assert_close!(loaded.summary.nominal_interval, 0.02, 1e-15);
}

#[test]
fn counters_and_missing_times_follow_the_rate() {
    let text: String = (0..30).map(|n| format!("{n},{n},{},{},1,2,3\n", n + 1, n + 2)).collect();
    let text = format!("t,gx,gy,gz,ax,ay,az\n{text}");
    let counter = replaced(&plain_rig(), "unit = \"s\"", "unit = \"sample\"");
    let recording = load(&counter, &text).recording;
    assert_close!(recording.times[29], 0.58, 1e-15);
    assert!(recording.increments.iter().all(|sample| sample.interval == 0.02));
    // Sample 10 is missing.
    let gap = load(&counter, &text.replace("10,10,11,12,1,2,3\n", "")).summary.gaps;
    assert_eq!((gap.len(), gap[0].sample), (1, 10));

    let none = replaced(&plain_rig(), "time = { column = \"t\", unit = \"s\" }\n", "");
    let recording = load(&none, &text).recording;
    assert_close!(recording.times[0], 0.02, 1e-18);
    assert_close!(recording.times[29], 0.6, 1e-15);
}

#[test]
fn stamps_of_start_and_middle_move_the_interval_and_not_the_table() {
    // The table rotates by one degree per row, at 50 deg/s, and each row has the angle at its stamp.
    let stamped = |stamp: &str| {
        let rig = replaced(RIG, "unit = \"s\"", &format!("unit = \"s\", stamp = \"{stamp}\""));
        load(&rig, &log(40)).recording
    };
    for (stamp, samples, first_end) in
        [("start", 39, 0.04), ("middle", 39, 0.03), ("end", 40, 0.02)]
    {
        let recording = stamped(stamp);
        assert_eq!(recording.len(), samples, "{stamp}");
        assert_close!(recording.times[0], first_end, 1e-15);
        let angles = recording.table_angle.as_ref().unwrap();
        for (time, angle) in recording.times.iter().zip(angles) {
            assert_close!(*angle, 50.0 * DEG * time, 1e-14);
        }
        for sample in &recording.increments {
            assert_close!(sample.interval, 0.02, 1e-15);
        }
        assert_close!(vectors(&recording, 9).0.x, 10e-6 * 0.02, 1e-20);
    }
}

#[test]
fn seconds_since_1970_lose_no_nanoseconds() {
    let rig = plain_rig();
    let shifted = |line: &str| {
        let (time, rest) = line.split_once(',').unwrap();
        format!("17000000{:02}.{},{rest}\n", time[..1].parse::<u32>().unwrap(), &time[2..])
    };
    let text = log(60);
    let rows: String = text.lines().skip(1).map(shifted).collect();
    let loaded = load(&rig, &format!("{}\n{rows}", text.lines().next().unwrap()));
    assert_eq!(loaded.summary.time_origin, 1.7e9);
    assert_eq!(loaded.recording, load(&rig, &text).recording);
}

#[test]
fn raw_counts_axes_and_the_spin_axis() {
    let rig = replaced(
        &plain_rig(),
        "unit = \"rad/s\"",
        "unit = \"deg/s\", offset = [10, 0, 0], scale = 0.5, axes = [\"-y\", \"x\", \"z\"]",
    );
    let rows: String =
        (1..40_u32).map(|n| format!("{:.2},{n},7{n},9{n},1,2,3\n", f64::from(n) * 0.02)).collect();
    let text = format!("t,gx,gy,gz,ax,ay,az\n{rows}");
    let (angle, velocity) = vectors(&load(&rig, &text).recording, 0);
    let scale = 0.5 * DEG * 0.02;
    assert_close!((angle - Vector3::new(-71.0, -9.0, 91.0) * scale).norm(), 1e-30, 1e-15);
    assert_close!((velocity - Vector3::new(1.0, 2.0, 3.0) * 0.02).norm(), 1e-30, 1e-15);
    // With the spin axis along the former body y, y becomes z; z becomes x and x becomes y.
    let (angle, velocity) = vectors(&load(&(rig + "[axis]\nspin = \"y\"\n"), &text).recording, 0);
    assert_close!((angle - Vector3::new(91.0, -71.0, -9.0) * scale).norm(), 1e-30, 1e-15);
    assert_close!((velocity - Vector3::new(3.0, 1.0, 2.0) * 0.02).norm(), 1e-30, 1e-15);
}

#[test]
fn a_wrapped_table_angle_is_unwrapped() {
    let wrapped: String = (1..=60)
        .map(|n| {
            format!("{:.2},{n},{},{},1,2,3,{}\n", f64::from(n) * 0.02, n + 1, n + 2, (n * 25) % 360)
        })
        .collect();
    let loaded = load(RIG, &format!("t,gx,gy,gz,ax,ay,az,table\n{wrapped}"));
    let angles = loaded.recording.table_angle.unwrap();
    for (n, angle) in angles.iter().enumerate() {
        assert_close!(*angle, (n + 1) as f64 * 25.0 * DEG, 1e-12);
    }
}

#[test]
fn the_commanded_profile_stands_in_for_the_table() {
    let table = "[table]\nacceleration = \"10 deg/s^2\"\n\
                 profile = [{ rate = \"5 deg/s\", duration = \"0.8 s\" }]\n";
    let recording = load(&(plain_rig() + table), &log(40)).recording;
    let rates = recording.table_rate.unwrap();
    // Half a second of acceleration, then 5 deg/s.
    assert_close!(rates[0], 0.1 * DEG, 1e-14);
    assert_close!(rates[39], 5.0 * DEG, 1e-12);
    let turned: f64 = rates.iter().map(|rate| rate * 0.02).sum();
    assert_close!(turned, (4.0 - 1.25) * DEG, 1e-13);
    // A measured angle takes precedence.
    assert_eq!(load(&format!("{RIG}{table}"), &log(40)).recording.table_rate, None);
}

#[test]
fn sensors_in_separate_files_are_joined() {
    let rig = replaced(&plain_rig(), "path = \"run.csv\"\n", "format = \"csv\"\n");
    let rig = rig.replace("gyro = { c", "gyro = { path = \"gyro.csv\", c");
    let rig = rig.replace("accel = { c", "accel = { path = \"accel.csv\", c");
    let text = log(40);
    let loaded = read_files(&[
        ("rig.toml", rig.as_bytes()),
        ("gyro.csv", text.as_bytes()),
        ("accel.csv", text.as_bytes()),
    ]);
    assert_eq!(loaded.unwrap().recording, load(&plain_rig(), &text).recording);
}

#[test]
fn a_slower_temperature_is_interpolated() {
    let temperature = "temperature = { path = \"t.csv\", time = \"t\", column = \"T\", unit = \"K\" }\n[attitude]";
    let rig = replaced(RIG, "[attitude]", temperature);
    let loaded = read_files(&[
        ("rig.toml", rig.as_bytes()),
        ("run.csv", log(40).as_bytes()),
        ("t.csv", b"t,T\n0.1,293.15\n0.5,295.15\n"),
    ]);
    let temperature = loaded.unwrap().recording.temperature.unwrap();
    assert_close!(temperature[0], 20.0, 1e-12);
    assert_close!(temperature[14], 21.0, 1e-12);
    assert_close!(temperature[39], 22.0, 1e-12);
}

#[test]
fn psins_logs_bring_their_own_units_and_place() {
    let text = "% PSINS\n1 2 3 0 0 0\n34 108 380 7 10 9.78\n0.1 0.2 0.3 100 200 300 \n\
                10 20 30 1 2 3\n4 5 6 0 0 80\n";
    let rig = "[log]\npath = \"laser.imu\"\nformat = \"psins\"\n";
    let loaded =
        read_files(&[("rig.toml", rig.as_bytes()), ("laser.imu", text.as_bytes())]).unwrap();
    let header = loaded.psins_header.unwrap();
    assert_close!(header.attitude.pitch, DEG, 1e-18);
    assert_close!(header.attitude.roll, 2.0 * DEG, 1e-17);
    assert_close!(loaded.station.site.longitude, 108.0 * DEG, 1e-15);
    assert_close!(loaded.recording.times[1], 7.02, 1e-14);
    let (angle, velocity) = vectors(&loaded.recording, 0);
    assert_close!((angle / ARCSEC - Vector3::new(1.0, 4.0, 9.0)).norm(), 1e-30, 1e-13);
    assert_close!((velocity / 9.78e-6 - Vector3::new(100.0, 400.0, 900.0)).norm(), 1e-30, 1e-10);
    assert_eq!(loaded.recording.increments[1].interval, 0.01);
}

#[test]
fn kf_gins_logs_are_turned_from_front_right_down() {
    let text: String = (1..30)
        .map(|n| {
            format!(
                "{:.2} {n}e-6 {}e-6 {}e-6 0.001 0.002 -0.098\n",
                f64::from(n) * 0.01,
                n + 5,
                n + 9
            )
        })
        .collect();
    let site = &RIG[..RIG.find("[log]").unwrap()];
    let rig = format!("{site}[log]\npath = \"run.csv\"\nformat = \"kf-gins\"\nrate = \"100 Hz\"\n");
    let recording = load(&rig, &text).recording;
    let (angle, velocity) = vectors(&recording, 0);
    assert_eq!(angle, Vector3::new(6e-6, 1e-6, -10e-6));
    assert_eq!(velocity, Vector3::new(0.002, 0.001, 0.098));
}

#[test]
fn a_policy_may_accept_more() {
    let text = with_line(&log(40), 41, "9.9,1e-6,1e-6,1e-6,0.1,0.2,9.8,40");
    let folder = folder(&[("rig.toml", RIG.as_bytes()), ("run.csv", text.as_bytes())]);
    let rig = Rig::read(&folder.path().join("rig.toml")).unwrap();
    let loaded =
        read_log(rig, LogPolicy { largest_gap: 60.0, largest_loss: 0.95, ..LogPolicy::default() })
            .unwrap();
    assert_eq!(loaded.summary.gaps.len(), 1);
}

#[test]
fn slow_logs_have_no_gaps() {
    let rows: String =
        (1..20_u32).map(|n| format!("{},{n},{},{},1,2,3\n", n * 5, n + 1, n + 2)).collect();
    let text = format!("t,gx,gy,gz,ax,ay,az\n{rows}");
    let rig = replaced(&plain_rig(), "rate = \"50 Hz\"\n", "");
    let summary = load(&rig, &text).summary;
    assert_eq!((summary.nominal_interval, summary.gaps.len()), (5.0, 0));
}

#[test]
fn a_peek_tells_what_a_rig_file_needs() {
    let folder = folder(&[("run.csv", b"# by hand\nt;gyro x\n0.1;2\n0.2;3\n0.3;4\n")]);
    let head = peek(&folder.path().join("run.csv")).unwrap();
    assert_eq!(head.delimiter, Delimiter::Semicolon);
    assert_eq!(head.names.unwrap(), ["t", "gyro x"]);
    assert_eq!(head.rows, [["0.1", "2"]]);
}

#[test]
fn coarse_time_stamps_do_not_spoil_the_rate() {
    // 64 Hz in hundredths of a second: steps of 10 and 20 ms.
    let row = |n: u32| {
        let time = (f64::from(n) / 0.64).floor() / 100.0;
        format!("{time:.2},{n},{},{},1,2,3\n", n + 1, n + 2)
    };
    let text = format!("t,gx,gy,gz,ax,ay,az\n{}", (1..200).map(row).collect::<String>());
    let rig = replaced(&plain_rig(), "50 Hz", "64 Hz");
    assert_close!(load(&rig, &text).summary.nominal_interval, 1.0 / 64.0, 1e-18);
}

/// A driver without a new sample sends an empty message: a lost sample, whose time the next one covers.
#[test]
fn rows_of_zeros_are_lost_samples() {
    let right = log(40);
    let mut rows: Vec<String> = right.lines().map(String::from).collect();
    for row in [5, 6, 20] {
        let fields: Vec<&str> = rows[row].split(',').collect();
        rows[row] = format!("{},0,0,0,0.0,-0,0e0,{}", fields[0], fields[7]);
    }
    let loaded = load(RIG, &(rows.join("\n") + "\n"));
    assert_eq!(loaded.recording.len(), 37);
    let left_out: Vec<_> =
        loaded.summary.left_out.iter().map(|out| (out.line, out.reason)).collect();
    assert_eq!(left_out, [6, 7, 21].map(|line| (line, Omission::Empty)));
    assert_close!(loaded.recording.increments[4].interval, 0.06, 1e-12);
    assert_eq!(loaded.summary.gaps.len(), 2);
}
