//! Invalid logs.

use super::files::Spoil;
use super::files::Spoil::{
    All, Column, Content, Field, Folder, Line, Lines, Nothing, Replace, Without,
};
use super::{DATA, Row, files, refused};
use crate::support::rins_in;

const LOG: &str = "run.csv";
const CHECK: &str = "check rig.toml";
const ALIGN: &str = "align rig.toml";
const NAVIGATE: &str = "navigate rig.toml";
const CALIBRATE: &str = "calibrate rig.toml";

/// The log as a file.
const FILE: &[Row] = &[
    ("a folder", CHECK, Folder(LOG), &["cannot read run.csv", "directory"]),
    ("empty", CHECK, Content(LOG, b""), &["run.csv: ", "empty"]),
    ("blank lines", CHECK, Content(LOG, b"\n\n \n"), &["run.csv: ", "empty"]),
    ("only a header", CHECK, Lines(LOG, 1), &["run.csv: only a header, no samples"]),
    ("one sample", CHECK, Lines(LOG, 2), &["run.csv: 1 sample, at least 2 are needed"]),
    ("not UTF-8", CHECK, Line(LOG, 1, b"\xff\xfe,1,2,3,4,5,6,7"), &["run.csv:2: not UTF-8 text"]),
    ("zero bytes", CHECK, Line(LOG, 1, b"0.4,\0\0\0,2,3,4,5,6,7"), &["run.csv:2: not UTF-8 text"]),
    (
        "UTF-16",
        CHECK,
        Content(LOG, b"\xff\xfet\0i\0m\0e\0\n\0"),
        &["run.csv: this is UTF-16 text, which is not read", "UTF-16"],
    ),
    (
        "prose",
        CHECK,
        Content(LOG, b"Once upon a time\nthere was a log.\n"),
        &["run.csv:1: no column \"gyro_x\""],
    ),
    (
        "another column of the same name",
        CHECK,
        Replace(LOG, "gyro_y", "gyro_x"),
        &["run.csv:1: two columns are called \"gyro_x\""],
    ),
];

/// A log in `rins init`, before its columns are described.
const DRAFTED: &[Row] = &[
    ("no file", "init no.csv", Nothing, &["cannot read no.csv", "No such file"]),
    ("a folder", "init run.csv", Folder(LOG), &["cannot read run.csv", "directory"]),
    ("empty", "init run.csv", Content(LOG, b""), &["run.csv: ", "empty"]),
    ("not UTF-8", "init run.csv", Line(LOG, 1, b"\xff\xfe,1"), &["run.csv:2: not UTF-8 text"]),
];

/// The text of a rig that states only that its log has the format of PSINS.
const PSINS_RIG: Spoil = Content("rig.toml", b"[log]\npath = \"run.csv\"\nformat = \"psins\"\n");

/// PSINS logs, whose header is part of the data.
const PSINS: &[Row] = &[
    (
        "half a header",
        CHECK,
        All(&[PSINS_RIG, Content(LOG, b"% log\n0 0 0 0 0 0\n34.2 108.9 400 0 10 9.8\n")]),
        &["run.csv: the header has 2 of its 3 rows"],
    ),
    (
        "beyond the pole",
        CHECK,
        All(&[PSINS_RIG, Content(LOG, b"0 0 0 0 0 0\n134.2 108.9 400 0 10 9.8\n.1 .1 .1 1 1 1\n1 2 3 4 5 6\n")]),
        &["run.csv:2: the header's latitude is 134.2"],
    ),
    (
        "no time from one sample to the next",
        CHECK,
        All(&[PSINS_RIG, Content(LOG, b"0 0 0 0 0 0\n34.2 108.9 400 0 0 9.8\n.1 .1 .1 1 1 1\n1 2 3 4 5 6\n")]),
        &["run.csv:2: the header's interval is 0, expected an interval"],
    ),
    (
        "a word",
        CHECK,
        All(&[PSINS_RIG, Content(LOG, b"0 0 0 0 0 0\n34.2 108.9 400 0 10 9.8\n.1 .1 .1 1 1 1\n1 two 3 4 5 6\n1 two 3 4 5 7\n")]),
        &["run.csv:4:", "\"two\" is not a number"],
    ),
];

/// A damaged line: its name, the command, and the damage.
#[rustfmt::skip]
const DAMAGED: &[(&str, &str, Spoil)] = &[
    ("text in a number", CHECK, Field(9, "gyro_y", "1.2.3")),
    ("a word", NAVIGATE, Field(9, "accel_z", "error")),
    ("hexadecimal", CHECK, Field(9, "gyro_y", "0x1f")),
    ("nothing in a number", CHECK, Field(9, "gyro_y", "")),
    ("NaN", CALIBRATE, Field(100, "gyro_z", "nan")),
    ("NaN of the table", CALIBRATE, Field(100, "table_angle", "NaN")),
    ("infinity", CALIBRATE, Field(100, "accel_x", "inf")),
    ("minus infinity", NAVIGATE, Field(100, "accel_x", "-Infinity")),
    ("1e400", ALIGN, Field(100, "accel_x", "1e400")),
    ("NaN as a time", CHECK, Field(7, "time", "nan")),
    ("a line is cut", CHECK, Line(LOG, 1601, b"50,1,2,3,4")),
    ("the last number is cut", CHECK, Replace(LOG, "e0\n", "e\n")),
    ("a field too many", CHECK, Line(LOG, 4, b"0.3,1,2,3,4,5,6,7,8")),
    ("an open quotation mark", CHECK, Field(6, "time", "\"0.5")),
    ("not UTF-8", CHECK, Line(LOG, 5, b"\xff\xfe,1,2,3,4,5,6,7")),
    ("zero bytes", CALIBRATE, Line(LOG, 5, b"0.4,\0\0\0,2,3,4,5,6,7")),
];

/// One damaged line is a lost sample for every command, and its result states it.
#[test]
fn one_damaged_line_is_a_lost_sample() {
    for (name, arguments, spoil) in DAMAGED {
        let folder = files::Folder::new();
        folder.spoil(spoil);
        let finished = rins_in(folder.path(), &format!("{arguments} -o out --json"));
        assert_eq!((finished.code, finished.err.as_str()), (Some(0), ""), "{name}");
        assert!(finished.out.contains("1 line(s), from "), "{name}: {}", finished.out);
        assert!(finished.out.contains("are damaged"), "{name}: {}", finished.out);
    }
}

/// Lines that are all alike.
const LINES: &[Row] = &[
    (
        "a column of words",
        CHECK,
        Column("gyro_y", "x"),
        &["run.csv:2: column \"gyro_y\": \"x\" is not a number; ", "rows are damaged, more than one in a hundred"],
    ),
    (
        "decimal commas",
        CHECK,
        All(&[
            Content(LOG, b"time;gyro_x;gyro_y;gyro_z;accel_x;accel_y;accel_z;table_angle\n0,1;1,5;2;3;4;5;6;7\n0,2;1;2;3;4;5;6;7\n"),
        ]),
        &["run.csv:2: column", "is not a number; if commas are decimal marks, state decimal = \",\" in [log]"],
    ),
];

/// Time.
const TIMES: &[Row] = &[
    (
        "time going backwards",
        CHECK,
        Field(50, "time", "1.4"),
        &["run.csv:50: time goes from 1.5 s to 1.4 s, it must increase"],
    ),
    (
        "the same time twice",
        CHECK,
        Field(50, "time", "1.5"),
        &["run.csv:50: time goes from 1.5 s to 1.5 s, it must increase"],
    ),
    (
        "time that stands",
        CHECK,
        Column("time", "1"),
        &["run.csv:3: time goes from 1 s to 1 s, it must increase"],
    ),
    (
        "a gap of ten seconds",
        CALIBRATE,
        Without(LOG, 322..=641),
        &["run.csv:322: a gap of 10.031250 s after 10 s, more than 1 s; cut the log there"],
    ),
    (
        "a gap among increments",
        CALIBRATE,
        Without(LOG, 322..=337),
        &[
            "run.csv:322: a gap of 0.531250 s after 10 s in a log of increments",
            "gaps = \"accumulated\" or gaps = \"held\"",
        ],
    ),
    (
        "a table at a whole number of turns that no double can tell",
        CHECK,
        Field(60, "table_angle", "1e308"),
        &["run.csv:60: column \"table_angle\": 1e308 rad is not plausible"],
    ),
    (
        "milliseconds of a slow clock for seconds",
        CHECK,
        All(&[
            Content(LOG, b"time,gyro_x,gyro_y,gyro_z,accel_x,accel_y,accel_z,table_angle\n0,1,2,3,4,5,6,7\n20000,2,1,4,3,6,5,7\n40000,3,3,1,2,4,1,7\n"),
        ]),
        &["run.csv: samples are 2.000e4 s apart, expected from 1e-7 s to 1e4 s; check the time column"],
    ),
    (
        "a leap to the end of time",
        CHECK,
        Field(1601, "time", "1e18"),
        &["run.csv:1601: column \"time\": 1e18 s is not plausible"],
    ),
];

/// Contradictions of the readings.
const READINGS: &[Row] = &[
    (
        "a gyro that is always zero",
        CHECK,
        Column("gyro_y", "0"),
        &["run.csv: gyro y (\"gyro_y\") is 0 in every sample: the channel is stuck"],
    ),
    (
        "a gyro that repeats",
        CHECK,
        Column("gyro_z", "0.02"),
        &["run.csv: gyro z (\"gyro_z\") is 0.02 in every sample"],
    ),
    (
        "gyros that are always zero",
        CALIBRATE,
        All(&[Column("gyro_x", "0"), Column("gyro_y", "0"), Column("gyro_z", "0")]),
        &["run.csv: gyro x (\"gyro_x\") is 0 in every sample"],
    ),
    (
        "accelerometers that are always zero",
        CHECK,
        All(&[Column("accel_x", "0"), Column("accel_y", "0"), Column("accel_z", "0")]),
        &["run.csv: accel x (\"accel_x\") is 0 in every sample"],
    ),
    (
        "a table that leaps by almost half a turn",
        CALIBRATE,
        Field(60, "table_angle", "2.9"),
        &[
            "run.csv:60: the table angle moves by 0.46",
            "of a turn in one sample, so its direction is ambiguous",
        ],
    ),
    (
        "a table that never turns",
        CALIBRATE,
        Column("table_angle", "0"),
        &[
            "run.csv: the table turns by 0.000 deg in all, the gyro about the axis of rotation by 300.",
        ],
    ),
    (
        "a run that never turns",
        CALIBRATE,
        Lines(LOG, 250),
        &["run.csv: the table turns by 0.000 deg in all", "cannot be observed"],
    ),
    (
        "a run that hardly turns",
        CALIBRATE,
        Lines(LOG, 684),
        &[
            "run.csv: only 43 samples remain after the static interval at the start; at least 100 are needed",
        ],
    ),
    (
        "no rest to align on",
        ALIGN,
        Without(LOG, 2..=641),
        &["run.csv: the IMU is never static for 5 s"],
    ),
    (
        "neither attitude nor rest",
        CALIBRATE,
        All(&[
            Without(LOG, 2..=641),
            Replace(
                "rig.toml",
                "[attitude]\nroll = \"30 deg\"\npitch = \"20 deg\"\nyaw = \"40 deg\"\nsigma = \"0.05 deg\"\n",
                "",
            ),
        ]),
        &[
            "run.csv: the rig gives no [attitude], and none can be found: the IMU is never static for 5 s",
        ],
    ),
    (
        "a gyro reading that is finite, but only just",
        CHECK,
        Field(200, "gyro_x", "1e300"),
        &[
            "run.csv:200: column \"gyro_x\": 1e300 rad is not plausible; check this line and the unit",
        ],
    ),
    (
        "the same, calibrated",
        CALIBRATE,
        Field(200, "gyro_x", "-1e300"),
        &["run.csv:200: column \"gyro_x\": -1e300 rad is not plausible"],
    ),
    (
        "the same of an accelerometer",
        NAVIGATE,
        Field(200, "accel_y", "1e300"),
        &["run.csv:200: column \"accel_y\": 1e300 m/s is not plausible"],
    ),
    (
        "the same, aligned on",
        ALIGN,
        Field(200, "accel_z", "1e300"),
        &["run.csv:200: column \"accel_z\": 1e300 m/s is not plausible"],
    ),
    (
        "a table in degrees that is calibrated",
        CALIBRATE,
        Replace("rig.toml", "\"table_angle\", unit = \"rad\"", "\"table_angle\", unit = \"deg\""),
        &[
            "rig.toml: the gyro about the axis of rotation measures 57.",
            "of the table's rotation",
            "the table's angle in rad were declared as deg",
        ],
    ),
    (
        "a gyro triad upside down that is calibrated",
        CALIBRATE,
        Replace("rig.toml", "unit = \"rad\"", "unit = \"rad\", axes = [\"x\", \"-y\", \"-z\"]"),
        &[
            "rig.toml: the gyro about the axis of rotation measures -1.0",
            "the direction of rotation of the table is opposite to that of the gyro",
        ],
    ),
];

#[test]
fn log_that_cannot_be_read() {
    refused(DATA, FILE);
}

#[test]
fn log_that_cannot_be_drafted_from() {
    refused(DATA, DRAFTED);
}

#[test]
fn psins_log_that_is_none() {
    refused(DATA, PSINS);
}

#[test]
fn line_that_holds_no_numbers() {
    refused(DATA, LINES);
}

#[test]
fn time_that_does_not_go_on() {
    refused(DATA, TIMES);
}

#[test]
fn readings_that_no_sensor_gives() {
    refused(DATA, READINGS);
}
