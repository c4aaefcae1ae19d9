//! A folder with valid files, and faults that are applied to one of them.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use rins_testing::{data_sheets, site};
use tempfile::TempDir;

use crate::support::rins_in;

/// 20 s at rest, a rotation of 30 s, 32 samples per second, so that times are exact in binary.
const SCENARIO: &str = concat!(
    site!(),
    r#"
[log]
rate = "32 Hz"
table_angle = { noise = "0.3 arcsec", resolution = "0.01 arcsec" }

[table]
profile = [{ rate = "0 deg/s", duration = "20 s" }, { rate = "10 deg/s", duration = "30 s" }]

[attitude]
roll = "30 deg"
pitch = "20 deg"
yaw = "40 deg"
sigma = "0.05 deg"

"#,
    data_sheets!(),
    r#"
[truth]
seed = 1
gyro = { scale = ["0 ppm", "0 ppm", "300 ppm"] }
"#
);

/// The rig of the scenario's run.
const RIG: &str = concat!(
    site!(),
    r#"
[log]
path = "run.csv"
rate = "32 Hz"
time = { column = "time", unit = "s" }
gyro = { columns = ["gyro_x", "gyro_y", "gyro_z"], unit = "rad" }
accel = { columns = ["accel_x", "accel_y", "accel_z"], unit = "m/s" }
table_angle = { column = "table_angle", unit = "rad", noise = "0.3 arcsec" }

[attitude]
roll = "30 deg"
pitch = "20 deg"
yaw = "40 deg"
sigma = "0.05 deg"

"#,
    data_sheets!()
);

/// The files of a valid run.
const FILES: [&str; 4] = ["scenario.toml", "rig.toml", "run.csv", "calibration.toml"];

/// A fault of the valid files in a folder.
#[derive(Debug)]
pub(super) enum Spoil {
    /// No fault: the arguments are invalid.
    Nothing,
    /// The first of these texts in a file is replaced by the second.
    Replace(&'static str, &'static str, &'static str),
    /// The content of a file is replaced by this.
    Content(&'static str, &'static [u8]),
    /// A file is copied to another name.
    Copy(&'static str, &'static str),
    /// A line of a file, from 1, is replaced by this.
    Line(&'static str, usize, &'static [u8]),
    /// A field of the log: its line, from 1, its column, and its replacement.
    Field(usize, &'static str, &'static str),
    /// Every number in a column of the log is replaced by this.
    Column(&'static str, &'static str),
    /// Only this number of lines of a file remains.
    Lines(&'static str, usize),
    /// Lines of a file, from 1, are removed.
    Without(&'static str, std::ops::RangeInclusive<usize>),
    /// This number of bytes at the end of a file is cut off.
    Cut(&'static str, usize),
    /// A file is replaced by a folder.
    Folder(&'static str),
    /// A folder with one file is created.
    Filled(&'static str, &'static str),
    /// Several faults.
    All(&'static [Self]),
}

/// A temporary folder with the files of a valid run.
pub(super) struct Folder(TempDir);

impl Folder {
    pub(super) fn new() -> Self {
        static GOOD: OnceLock<TempDir> = OnceLock::new();
        let good = GOOD.get_or_init(good);
        let folder = tempfile::tempdir().unwrap();
        for name in FILES {
            fs::copy(good.path().join(name), folder.path().join(name)).unwrap();
        }
        Self(folder)
    }

    pub(super) fn path(&self) -> &Path {
        self.0.path()
    }

    /// Applies a fault, and returns its line.
    pub(super) fn spoil(&self, spoil: &Spoil) -> usize {
        let path = |name| self.path().join(name);
        let read = |name| fs::read_to_string(path(name)).unwrap();
        let lines = |name| read(name).lines().map(str::to_owned).collect::<Vec<String>>();
        let write =
            |name, lines: &[String]| fs::write(path(name), lines.join("\n") + "\n").unwrap();
        match *spoil {
            Spoil::Nothing => 0,
            Spoil::Replace(name, from, to) => {
                let text = read(name);
                let place = text.find(from).unwrap_or_else(|| panic!("no {from:?} in {name}"));
                fs::write(path(name), text.replacen(from, to, 1)).unwrap();
                text[..place].matches('\n').count() + 1
            }
            Spoil::Content(name, content) => {
                fs::write(path(name), content).unwrap();
                1
            }
            Spoil::Copy(name, other) => {
                fs::copy(path(name), path(other)).unwrap();
                1
            }
            Spoil::Line(name, line, text) => {
                let all = lines(name);
                let mut content = all[..line - 1].join("\n").into_bytes();
                content.extend([b"\n", text, b"\n"].concat());
                content.extend(all[line..].join("\n").into_bytes());
                fs::write(path(name), content).unwrap();
                line
            }
            Spoil::Field(line, column, text) => {
                let mut all = lines("run.csv");
                all[line - 1] = with_field(&all[0], &all[line - 1], column, text);
                write("run.csv", &all);
                line
            }
            Spoil::Column(column, text) => {
                let mut all = lines("run.csv");
                for line in 1..all.len() {
                    all[line] = with_field(&all[0], &all[line], column, text);
                }
                write("run.csv", &all);
                2
            }
            Spoil::Lines(name, count) => {
                write(name, &lines(name)[..count]);
                count
            }
            Spoil::Without(name, ref range) => {
                let mut all = lines(name);
                all.drain(range.start() - 1..*range.end());
                write(name, &all);
                *range.start()
            }
            Spoil::Cut(name, count) => {
                let text = read(name);
                let text = &text[..text.len() - count];
                fs::write(path(name), text).unwrap();
                text.lines().count()
            }
            Spoil::Folder(name) => {
                fs::remove_file(path(name)).unwrap();
                fs::create_dir(path(name)).unwrap();
                0
            }
            Spoil::Filled(folder, name) => {
                fs::create_dir_all(path(folder)).unwrap();
                fs::write(path(folder).join(name), "{}").unwrap();
                0
            }
            Spoil::All(spoils) => spoils.iter().fold(0, |_, spoil| self.spoil(spoil)),
        }
    }
}

/// A row of the log with another text in one of its columns.
fn with_field(header: &str, row: &str, column: &str, text: &str) -> String {
    let place = header.split(',').position(|name| name == column).expect("a column of the log");
    let mut fields: Vec<&str> = row.split(',').collect();
    fields[place] = text;
    fields.join(",")
}

/// Creates the files of a valid run.
fn good() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let done = |arguments: &str| {
        let finished = rins_in(folder.path(), arguments);
        assert_eq!(finished.code, Some(0), "{arguments}: {}", finished.err);
    };
    fs::write(path("scenario.toml"), SCENARIO).unwrap();
    fs::write(path("rig.toml"), RIG).unwrap();
    done("simulate scenario.toml -o run");
    fs::copy(path("run/run.csv"), path("run.csv")).unwrap();
    done("calibrate rig.toml -o made");
    fs::copy(path("made/calibration.toml"), path("calibration.toml")).unwrap();
    folder
}
