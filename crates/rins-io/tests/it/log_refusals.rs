//! Refused logs, with their error messages.

use rins_io::{LogPolicy, Omission, Rig, read_log};
use rins_testing::{assert_rows, is};

use crate::support::{
    RIG, folder, log, plain_rig, read_files, refusal, replaced, with_line, without,
};

/// Asserts that this log with this rig is refused with this message.
fn check(rig: &str, log: impl AsRef<[u8]>, message: &str) {
    assert_eq!(said(rig, log), message);
}

fn said(rig: &str, log: impl AsRef<[u8]>) -> String {
    refusal(&[("rig.toml", rig.as_bytes()), ("run.csv", log.as_ref())])
}

/// A row that cannot be read, and the problem.
#[rustfmt::skip]
const DAMAGED: &[(&str, &str)] = &[
    ("0.32,abc,1e-6,1e-6,0.1,0.2,9.8,16", "column \"gx\": \"abc\" is not a number"),
    ("0.32,,1e-6,1e-6,0.1,0.2,9.8,16", "column \"gx\": empty, expected a number"),
    ("0.32,nan,1e-6,1e-6,0.1,0.2,9.8,16", "column \"gx\": \"nan\" is not finite"),
    ("0.32,1e-6,1e-6,-inf,0.1,0.2,9.8,16", "column \"gz\": \"-inf\" is not finite"),
    ("0.32,1e-6,1e-6,1e999,0.1,0.2,9.8,16", "column \"gz\": \"1e999\" is not finite"),
    ("0.32,1e-6,1e-6,0x10,0.1,0.2,9.8,16", "column \"gz\": \"0x10\" is not a number"),
    ("0.32,1e-6,1e-6,1e-6,0.1,0.2,NaN,16", "column \"az\": \"NaN\" is not finite"),
    ("0.32,1e-6,1e-6,1e-6,0.1,0.2,9.8,off", "column \"table\": \"off\" is not a number"),
    ("nan,1e-6,1e-6,1e-6,0.1,0.2,9.8,16", "column \"t\": \"nan\" is not finite"),
    ("12:00:00,1e-6,1e-6,1e-6,0.1,0.2,9.8,16", "column \"t\": \"12:00:00\" is not a number"),
    ("0.32,\"1,5\",1e-6,1e-6,0.1,0.2,9.8,16", "column \"gx\": \"1,5\" is not a number; if commas are decimal marks, state decimal = \",\" in [log]"),
    ("0.32,1e-6,1e-6", "3 fields, expected 8; is the line cut short?"),
    ("0.32,1e-6,1e-6,1e-6,0.1,0.2,9.8,16,7,7", "10 fields, expected 8"),
    ("0.32;1e-6;1e-6;1e-6;0.1;0.2;9.8;16", "column \"t\": \"0.32;1e-6;1e-6;1e-6;0.1;0.2;9.8;16\" is not a number"),
    ("0.32,1e-6,1e-6,1e-6,0.1,0.2,9.8,\"16", "a quotation mark is not closed"),
    ("0.32,\0,1e-6,1e-6,0.1,0.2,9.8,16", "not UTF-8 text; is it binary or UTF-16?"),
    ("0.80,1e-6", "2 fields, expected 8; is the line cut short?"),
    ("0.80,,1e-6,1e-6,0.1,0.2,9.8,16", "column \"gx\": empty, expected a number"),
];

/// One such row is a lost sample; two of forty are refused.
#[test]
fn one_damaged_row_is_a_lost_sample() {
    let right = log(40);
    assert_rows(DAMAGED.iter().map(|(text, problem)| {
        let one = with_line(&right, 17, text);
        let loaded = read_files(&[("rig.toml", RIG.as_bytes()), ("run.csv", one.as_bytes())]);
        let left_out = loaded.map(|loaded| (loaded.recording.len(), loaded.summary.left_out));
        let left_out = left_out.map(|(rows, out)| (rows, out[0].line, out[0].reason, out.len()));
        let fault = match left_out {
            Ok(found) => is(&found, &(39, 17, Omission::Damaged, 1)),
            Err(error) => Err(error.to_string()),
        };
        let said = said(RIG, with_line(&one, 19, text));
        let message =
            format!("run.csv:17: {problem}; 2 of 40 rows are damaged, more than one in a hundred");
        (format!("{text:?}"), fault.and(is(said.as_str(), message.as_str())))
    }));
}

/// The number of a line in a log of 40 rows, its replacement, and the message.
#[rustfmt::skip]
const LINES: &[(usize, &str, &str)] = &[
    // The header.
    (1, "t,gx,gy,wz,ax,ay,az,table", "run.csv:1: no column \"gz\"; the columns are \"t\", \"gx\", \"gy\", \"wz\", \"ax\", \"ay\", \"az\", \"table\"; did you mean \"gx\"?"),
    (1, "time,a,b,c,d,e,f,g", "run.csv:1: no column \"gx\"; the columns are \"time\", \"a\", \"b\", \"c\", \"d\", \"e\", \"f\", \"g\""),
    (1, "t,gx,gy,gz,ax,ay,az,gx", "run.csv:1: two columns are called \"gx\""),
    (1, "", "run.csv:2: no column \"gx\"; the columns are \"1\" to \"8\", as the log has no header"),
    (1, "T,gx,gy,gz,ax,ay,az,table", "run.csv:1: no column \"t\"; the columns are \"T\", \"gx\", \"gy\", \"gz\", \"ax\", \"ay\", \"az\", \"table\"; did you mean \"T\"?"),
    // Time.
    (17, "0.30,1e-6,1e-6,1e-6,0.1,0.2,9.8,16", "run.csv:17: time goes from 0.3 s to 0.3 s, it must increase"),
    (17, "0.29,1e-6,1e-6,1e-6,0.1,0.2,9.8,16", "run.csv:17: time goes from 0.3 s to 0.29 s, it must increase"),
    (17, "-0.32,1e-6,1e-6,1e-6,0.1,0.2,9.8,16", "run.csv:17: time goes from 0.3 s to -0.32 s, it must increase"),
    (41, "3.25,1e-6,1e-6,1e-6,0.1,0.2,9.8,40", "run.csv:41: a gap of 2.470000 s after 0.78 s, more than 1 s; cut the log there"),
    // Implausible values.
    (17, "0.32,1e300,1e-6,1e-6,0.1,0.2,9.8,16", "run.csv:17: column \"gx\": 1e300 rad/s is not \
          plausible; check this line and the unit"),
    (17, "0.32,1e-6,1e-6,1e-6,0.1,0.2,-2e9,16", "run.csv:17: column \"az\": -2e9 m/s^2 is not plausible; \
          check this line and the unit"),
    (17, "0.32,1e-6,1e-6,1e-6,0.1,0.2,9.8,360e9", "run.csv:17: column \"table\": 6.283185307179586e9 rad \
          is not plausible; check this line and the unit"),
    // The table angle, in degrees.
    (17, "0.32,1e-6,1e-6,1e-6,0.1,0.2,9.8,185", "run.csv:17: the table angle moves by 0.472 of a turn in \
          one sample, so its direction is ambiguous; log it at a higher rate, or unwrapped"),
];

#[test]
fn one_wrong_line_is_named() {
    let right = log(40);
    assert_rows(LINES.iter().map(|(line, text, message)| {
        let said = said(RIG, with_line(&right, *line, text));
        (format!("line {line} as {text:?}"), is(said.as_str(), *message))
    }));
}

#[test]
fn files_that_hold_no_log_are_refused() {
    let header = "t,gx,gy,gz,ax,ay,az,table\n";
    let one_sample = format!("{header}0.02,1,1,1,1,1,1,1\n");
    let (long, wide) = ("1,".repeat(600_000), "a,".repeat(5000) + "\n1\n");
    let late = log(5) + &"1".repeat(2_000_000);
    let binary = "run.csv:1: not UTF-8 text; is it binary or UTF-16?";
    let elf = b"\x7fELF\x02\x01\x01\0\0\0\0\0\xd8\xa0";
    let cases: [(&str, &[u8], &str); 10] = [
        ("nothing", b"", "run.csv: the file is empty"),
        ("blank lines and a comment", b"\n\n  \n# nothing\n", "run.csv: the file is empty"),
        ("a header", header.as_bytes(), "run.csv: only a header, no samples"),
        ("a sample", one_sample.as_bytes(), "run.csv: 1 sample, at least 2 are needed"),
        (
            "UTF-16 below a header",
            b"t,gx\n\xff\xfe,3\n",
            "run.csv:2: not UTF-8 text; is it binary or UTF-16?",
        ),
        (
            "UTF-16",
            b"\xff\xfet\0,\0",
            "run.csv: this is UTF-16 text, which is not read: save it as UTF-8",
        ),
        ("a program", elf, binary),
        ("a long line", long.as_bytes(), "run.csv:1: a line of more than 1048576 bytes"),
        ("many columns", wide.as_bytes(), "run.csv:1: more than 4096 columns"),
        ("a long line at the end", late.as_bytes(), "run.csv:7: a line of more than 1048576 bytes"),
    ];
    assert_rows(
        cases.iter().map(|(name, log, message)| (name, is(said(RIG, log).as_str(), *message))),
    );
}

#[test]
fn an_absent_log_is_named() {
    assert_eq!(refusal(&[("rig.toml", RIG.as_bytes())]), "cannot read run.csv");
}

#[test]
fn many_columns_are_not_all_listed() {
    let names: Vec<String> = (0..40).map(|n| format!("signal {n}")).collect();
    let row = vec!["1"; 40].join(",");
    let folder = folder(&[
        ("rig.toml", RIG.as_bytes()),
        ("run.csv", format!("{}\n{row}\n{row}\n", names.join(",")).as_bytes()),
    ]);
    let said = rins_io::read(&folder.path().join("rig.toml")).unwrap_err().to_string();
    assert!(said.ends_with("\"signal 28\", \"signal 29\" and 10 more"), "{said}");
}

#[test]
fn a_rate_that_does_not_fit_is_refused() {
    check(
        &replaced(RIG, "rate = \"50 Hz\"", "rate = \"51 Hz\""),
        log(40),
        "run.csv: the rate is 50.000 Hz in the time column and 51.000 Hz in [log] rate",
    );
    // Milliseconds that are declared as seconds give the same error.
    check(
        &replaced(RIG, "unit = \"s\"", "unit = \"ms\""),
        log(40),
        "run.csv: the rate is 50000.000 Hz in the time column and 50.000 Hz in [log] rate",
    );
}

#[test]
fn dead_channels_are_refused() {
    let dead = log(40).replace(",2.5e-6,", ",0,").replace(",3e-6,", ",0,");
    check(
        RIG,
        dead,
        "run.csv: gyro y (\"gy\") is 0 in every sample: the channel is stuck or the wrong column",
    );
    let rows = |n: usize| format!("{:.2},{n},{},{},0,0,0,1\n", 0.02 * n as f64, n + 1, n + 2);
    let all: String = (1..40).map(rows).collect();
    check(
        RIG,
        format!("t,gx,gy,gz,ax,ay,az,table\n{all}"),
        "run.csv: accel x (\"ax\") is 0 in every sample: the channel is stuck or the wrong column",
    );
}

#[test]
fn lost_increments_are_not_guessed() {
    let rig = plain_rig().replace("\"rad/s\"", "\"arcsec\"").replace("\"m/s^2\"", "\"m/s\"");
    let mut lines: Vec<String> = log(40).lines().map(Into::into).collect();
    lines.remove(20);
    check(
        &rig,
        lines.join("\n"),
        "run.csv:21: a gap of 0.040000 s after 0.38 s in a log of increments; state in [log] whether the \
         next increment covers it: gaps = \"accumulated\" or gaps = \"held\"",
    );
}

#[test]
fn parts_of_a_sample_are_refused() {
    let rig = replaced(RIG, "unit = \"s\"", "unit = \"sample\"");
    check(&rig, log(40), "run.csv:2: column \"t\": 0.02 is not a whole number of samples");
}

#[test]
fn the_longest_gap_is_the_callers_choice() {
    let spoilt = with_line(&log(40), 41, "1.5,1e-6,1e-6,1e-6,0.1,0.2,9.8,40");
    let folder = folder(&[("rig.toml", RIG.as_bytes()), ("run.csv", spoilt.as_bytes())]);
    let rig = Rig::read(&folder.path().join("rig.toml")).unwrap();
    assert!(read_log(rig.clone(), LogPolicy { largest_gap: 0.8, ..LogPolicy::default() }).is_ok());
    let error = read_log(rig, LogPolicy { largest_gap: 0.5, ..LogPolicy::default() }).unwrap_err();
    assert_eq!(
        without(&error, folder.path()),
        "run.csv:41: a gap of 0.720000 s after 0.78 s, more than 0.5 s; cut the log there"
    );
}

#[test]
fn stamps_that_are_no_samples_are_refused() {
    let plain = plain_rig().replace("rate = \"50 Hz\"\n", "");
    let stamped = |stamp: &dyn Fn(usize) -> f64| -> String {
        let row = |(index, row): (usize, &str)| {
            let (_, rest) = row.split_once(',').unwrap();
            if index == 0 { format!("{row}\n") } else { format!("{},{rest}\n", stamp(index)) }
        };
        log(40).lines().enumerate().map(row).collect()
    };
    // Four samples come with each packet, one microsecond apart.
    check(
        &plain,
        stamped(&|index| (index / 4) as f64 * 0.08 + (index % 4) as f64 * 1e-6),
        "run.csv: 10 gaps are 0.799970 s of the log's 0.799999 s, more than 50 %; are its time stamps \
         those of samples, or of packets?",
    );
    check(
        &plain,
        stamped(&|index| index as f64 * 1e-9),
        "run.csv: samples are 1.000e-9 s apart, expected from 1e-7 s to 1e4 s; check \
         the time column and its unit",
    );
}

#[test]
fn separate_files_must_be_sampled_together() {
    let rig =
        replaced(&plain_rig(), "accel = { columns", "accel = { path = \"accel.csv\", columns");
    let files = |accel: &str| {
        refusal(&[
            ("rig.toml", rig.as_bytes()),
            ("run.csv", log(40).as_bytes()),
            ("accel.csv", accel.as_bytes()),
        ])
    };
    let said = files(&log(39));
    assert_eq!(said, "accel.csv: 39 samples, but run.csv has 40; they must be sampled together");
    assert_eq!(
        files(&log(40).replace("\n0.40,", "\n0.403,")),
        "accel.csv:21: at 0.403 s where run.csv is at 0.4 s; sensors in separate files must be \
         sampled within a tenth of an interval"
    );
}

#[test]
fn temperatures_must_cover_the_log() {
    let temperature = "temperature = { path = \"t.csv\", time = \"t\", column = \"T\", unit = \"degC\" }\n[attitude]";
    let rig = replaced(RIG, "[attitude]", temperature);
    let files = |temperature: &str| {
        refusal(&[
            ("rig.toml", rig.as_bytes()),
            ("run.csv", log(100).as_bytes()),
            ("t.csv", temperature.as_bytes()),
        ])
    };
    assert_eq!(
        files("t,T\n0.5,20\n0.6,21\n"),
        "t.csv: temperatures from 0.5 s to 0.6 s do not cover the log's 0.02 s"
    );
    assert_eq!(
        files("t,T\n0.5,20\n0.4,21\n"),
        "t.csv:3: time goes from 0.5 s to 0.4 s, it must increase"
    );
    assert_eq!(
        files("t,T\n0.01,20\n0.6,-999\n"),
        "t.csv:3: column \"T\": -9.99e2 degC is not plausible; check this line and the unit"
    );
    assert_eq!(
        files("t,T\n0.5,cold\n0.6,warm\n"),
        "t.csv:2: column \"T\": \"cold\" is not a number; 2 of 2 rows are damaged, more than one in a hundred"
    );
}

#[test]
fn a_log_may_not_outlast_its_table_profile() {
    let table = "[table]\nprofile = [{ rate = \"1 deg/s\", duration = \"0.5 s\" }]\n";
    check(
        &(plain_rig() + table),
        log(40),
        "run.csv: the log lasts 0.800 s, the [table] profile only 0.500 s",
    );
}

/// A text in a PSINS log, its replacement, and the message.
const PSINS_CASES: &[(&str, &str, &str)] = &[
    (
        "34.2 108.9",
        "94.2 108.9",
        "laser.imu:4: the header's latitude is 94.2, expected a latitude from -89.9 to 89.9 deg; the \
         poles at -90 and 90 deg are excluded: east is not defined there",
    ),
    (
        "0 10 9.78",
        "0 0 9.78",
        "laser.imu:4: the header's interval is 0, expected an interval of more than 0.001 ms",
    ),
    (
        "0 10 9.78",
        "0 10 978",
        "laser.imu:4: the header's gravity is 978, expected a gravity from 9.7 to 9.9 m/s^2",
    ),
    (
        "0.1 0.1 0.1 125 125 125",
        "0.1 0.1 0.1 125 0 125",
        "laser.imu:5: the header's accel y scale is 0, expected a scale other than zero",
    ),
    (
        "0 0 -90.6 0 0 0",
        "0 0 -90.6 0 0",
        "laser.imu:3: 5 fields, expected 6; is the line cut short?",
    ),
    (
        "1 2 3 0 0 80\n4 5 6 0 0 80",
        "1 2 x 0 0 80\n4 5 x 0 0 80",
        "laser.imu:6: column \"gyro z\": \"x\" is not a number; 2 of 2 rows are damaged, more than one in a hundred",
    ),
    (
        "1 2 3 0 0 80\n4 5 6 0 0 80",
        "1 2 3 0 0 inf\n4 5 6 0 0 inf",
        "laser.imu:6: column \"accel z\": \"inf\" is not finite; 2 of 2 rows are damaged, more than one in a hundred",
    ),
    (
        "1 2 3 0 0 80\n4 5 6 0 0 80",
        "1 2 3 0 0\n4 5 6 0 0",
        "laser.imu:6: 5 fields, expected 6; is the line cut short?; 2 of 2 rows are damaged, more than one in a hundred",
    ),
    (
        "1 2 3 0 0 80\n4 5 6 0 0 80",
        "1 2 3 0 0 80 9\n4 5 6 0 0 80 9",
        "laser.imu:6: 7 fields, expected 6; 2 of 2 rows are damaged, more than one in a hundred",
    ),
];

const PSINS: &str = "% PSINS\n\n0 0 -90.6 0 0 0\n34.2 108.9 380 0 10 9.78\n\
                     0.1 0.1 0.1 125 125 125\n1 2 3 0 0 80\n4 5 6 0 0 80\n";

#[test]
fn wrong_psins_logs_are_refused() {
    let rig = "[log]\npath = \"laser.imu\"\nformat = \"psins\"\nrate = \"100 Hz\"\n";
    let said = |log: &str, rig: &str| {
        refusal(&[("rig.toml", rig.as_bytes()), ("laser.imu", log.as_bytes())])
    };
    assert_rows(PSINS_CASES.iter().map(|(from, to, message)| {
        let fault = is(said(&replaced(PSINS, from, to), rig).as_str(), *message);
        (format!("{from:?} -> {to:?}"), fault)
    }));
    let one = PSINS.replace("4 5 6 0 0 80\n", "");
    let faster = rig.replace("100 Hz", "200 Hz");
    let stuck: String = (0..20).map(|n| format!("{n} 7 {n} 0 0 80\n")).collect();
    let header = &PSINS[..PSINS.find("1 2 3").unwrap()];
    let stuck = format!("{header}{stuck}");
    let cases = [
        ("nothing", "", rig, "laser.imu: the file is empty"),
        (
            "a part of a header",
            "% PSINS\n0 0 0 0 0 0\n",
            rig,
            "laser.imu: the header has 1 of its 3 rows",
        ),
        ("a sample", &one, rig, "laser.imu: 1 sample, at least 2 are needed"),
        (
            "another rate",
            PSINS,
            &faster,
            "laser.imu: the rate is 100.000 Hz in the time column and 200.000 Hz in [log] rate",
        ),
        (
            "a gyro that says one thing",
            &stuck,
            rig,
            "laser.imu: gyro y is 7 in every sample: the channel is stuck or the wrong column",
        ),
    ];
    assert_rows(
        cases.iter().map(|(name, log, rig, message)| (name, is(said(log, rig).as_str(), *message))),
    );
}
