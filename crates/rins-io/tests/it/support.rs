//! Rigs and logs for tests of invalid input.

use std::fs;
use std::path::Path;

use rins_io::{IoError, Loaded, read};
use rins_testing::{assert_rows, data_sheets, is, site};
use tempfile::TempDir;

/// The section of a site.
pub(crate) const SITE: &str = concat!(site!(), "\n");

/// A valid rig file.
pub(crate) const RIG: &str = concat!(
    "\n",
    site!(),
    r#"
[log]
path = "run.csv"
rate = "50 Hz"
time = { column = "t", unit = "s" }
gyro = { columns = ["gx", "gy", "gz"], unit = "rad/s" }
accel = { columns = ["ax", "ay", "az"], unit = "m/s^2" }
table_angle = { column = "table", unit = "deg", noise = "0.3 arcsec" }

[attitude]
roll = "30 deg"
pitch = "20 deg"
yaw = "40 deg"
sigma = "0.1 deg"

"#,
    data_sheets!()
);

/// [`RIG`] without its table angle.
pub(crate) fn plain_rig() -> String {
    let angle = "table_angle = { column = \"table\", unit = \"deg\", noise = \"0.3 arcsec\" }\n";
    replaced(RIG, angle, "")
}

/// `text` with the only occurrence of `from` replaced by `to`.
pub(crate) fn replaced(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from:?} must occur once");
    text.replace(from, to)
}

/// Asserts that invalid files are refused: each case has a text in the file `right`, its replacement,
/// and the complete message.
pub(crate) fn assert_refused<T>(
    right: &str,
    cases: &[(&str, &str, &str)],
    parse: impl Fn(&str) -> Result<T, IoError>,
) {
    assert_rows(cases.iter().map(|(from, to, message)| {
        let fault = match parse(&replaced(right, from, to)) {
            Ok(_) => Err("is taken".into()),
            Err(error) => is(error.to_string().as_str(), *message),
        };
        (format!("{from:?} -> {to:?}"), fault)
    }));
}

/// A valid log of `rows` rows at 50 Hz.
pub(crate) fn log(rows: usize) -> String {
    let mut text = String::from("t,gx,gy,gz,ax,ay,az,table\n");
    for row in 1..=rows {
        let time = row as f64 * 0.02;
        let small = row as f64 * 1e-6;
        text.push_str(&format!("{time:.2},{small},2e-6,{small:e},0.1,0.2,{},{row}\n", 9.8 + small));
    }
    // A gyro with constant output would be treated as stuck.
    text.replace(",2e-6,", ",2.5e-6,").replacen(",2.5e-6,", ",3e-6,", 1)
}

/// `text` with line `line` (from 1) replaced by `to`.
pub(crate) fn with_line(text: &str, line: usize, to: &str) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    lines[line - 1] = to;
    lines.join("\n") + "\n"
}

/// Reads the rig `rig.toml` among `files`.
pub(crate) fn read_files(files: &[(&str, &[u8])]) -> Result<Loaded, IoError> {
    let folder = folder(files);
    read(&folder.path().join("rig.toml"))
}

/// The error of reading `files`, without the folder's name.
pub(crate) fn refusal(files: &[(&str, &[u8])]) -> String {
    let folder = folder(files);
    let error = read(&folder.path().join("rig.toml")).unwrap_err();
    without(&error, folder.path())
}

/// A temporary folder with `files`.
pub(crate) fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

/// An error's text without the folder's name.
pub(crate) fn without(error: &IoError, folder: &Path) -> String {
    error.to_string().replace(&format!("{}/", folder.display()), "")
}
