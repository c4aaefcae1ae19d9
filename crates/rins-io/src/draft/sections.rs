//! The parts of a draft that a log says little of: place, format, attitude, data sheet, axis.

use super::page::{Page, text};
use super::sample::Sample;
use crate::log::Delimiter;

pub(super) fn site(page: &mut Page) {
    page.blank();
    page.remark("Where the table stands:");
    page.closed_section("site");
    page.leave("latitude", r#""? deg""#, "north positive");
    page.leave("longitude", r#""? deg""#, "east positive");
    page.leave("height", r#""? m""#, "above the ellipsoid");
    page.optional("gravity", r#""? m/s^2""#, "if it was measured; else the WGS84 normal gravity");
}

pub(super) fn kf_gins(page: &mut Page) {
    let why = "time and six increments without names, the last accelerometer pointing down";
    page.guess("format", &text("kf-gins"), why);
    page.remark("Columns: time in s, angles about front, right, down in rad, velocities in m/s.");
}

/// Says how the log's columns stand.
pub(super) fn shape(page: &mut Page, sample: &Sample) {
    let between = match sample.delimiter {
        Delimiter::Tab => "tabs",
        Delimiter::Semicolon => "semicolons",
        Delimiter::Comma => "commas",
        Delimiter::Blanks => "blanks",
        Delimiter::Other(_) => "what its first line says",
    };
    let header = if sample.names.is_some() {
        "named by a header"
    } else {
        "without names, so they are called \"1\", \"2\" and so on"
    };
    let (count, rows) = (sample.count, sample.rows());
    let rows = if sample.whole {
        format!("All {rows} rows were looked at.")
    } else {
        format!("{rows} rows from all through the log were looked at.")
    };
    page.remark(&format!("{count} columns between {between}, {header}."));
    page.remark(&rows);
    let words: Vec<String> = (0..sample.count)
        .filter(|column| !sample.is_numeric(*column))
        .take(8)
        .map(|column| text(&sample.name(column)))
        .collect();
    if !words.is_empty() {
        page.remark(&format!("No numbers in {}: cannot be used.", words.join(", ")));
    }
}

pub(super) fn attitude(page: &mut Page) {
    page.blank();
    page.remark(
        "The attitude of the table's axis frame at table angle zero, east-north-up. It may be left",
    );
    page.remark("out where the log begins with a rest from which it can be found (`rins align`).");
    page.closed_section("attitude");
    page.optional("roll", r#""? deg""#, "about y, north at yaw zero");
    page.optional("pitch", r#""? deg""#, "about x, east at yaw zero");
    page.optional("yaw", r#""? deg""#, "about up, from north to west positive");
    page.optional("sigma", r#""? deg""#, "the standard deviation of their errors");
}

pub(super) fn profile(page: &mut Page) {
    page.closed_section("table");
    page.optional(
        "profile",
        r#"[{ rate = "? deg/s", duration = "? s" }]"#,
        "what was commanded from the first row on",
    );
}

pub(super) fn imu(page: &mut Page) {
    page.blank();
    page.remark(
        "What the data sheets say. `rins check` does without; calibration needs all of it.",
    );
    page.closed_section("imu.gyro");
    page.leave(
        "noise",
        r#""? deg/h/sqrt(Hz)""#,
        "white noise; or as an angle random walk, \"? deg/sqrt(h)\"",
    );
    page.leave("bias_sigma", r#""? deg/h""#, "how large biases are, 1 sigma");
    page.leave("scale_sigma", r#""? ppm""#, "how large scale factor errors are, 1 sigma");
    page.leave("misalignment_sigma", r#""? arcsec""#, "how large misalignments are, 1 sigma");
    page.closed_section("imu.accel");
    page.leave(
        "noise",
        r#""? ug/sqrt(Hz)""#,
        "white noise; or as a velocity random walk, \"? m/s/sqrt(h)\"",
    );
    page.leave("bias_sigma", r#""? ug""#, "as for the gyros");
    page.leave("scale_sigma", r#""? ppm""#, "as for the gyros");
    page.leave("misalignment_sigma", r#""? arcsec""#, "as for the gyros");
}

pub(super) fn default_spin(page: &mut Page) {
    page.blank();
    page.remark("The body axis that the table turns about.");
    page.closed_section("axis");
    page.optional("spin", r#""z""#, "z unless another is given, such as \"-x\"");
}
