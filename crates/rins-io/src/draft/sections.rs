//! The parts of a draft for which a log has little information: site, format, attitude, data sheet, axis.

use rins_imu::{GRADES, Preset, SENSORS};

use super::page::{Page, text};
use super::sample::Sample;
use crate::log::Delimiter;
use crate::rig::Decimal;

pub(super) fn site(page: &mut Page) {
    page.section("site");
    page.leave("latitude", r#""? deg""#, "north positive");
    page.optional("height", r#""? m""#, "above the ellipsoid; sea level unless stated");
    page.optional("gravity", r#""? m/s^2""#, "if it was measured; else the WGS84 normal gravity");
}

pub(super) fn kf_gins(page: &mut Page) {
    let why = "time and six increments without names, the last accelerometer pointing down";
    page.guess("format", &text("kf-gins"), why);
    page.remark("Columns: time in s, angles about front, right, down in rad, velocities in m/s.");
}

/// Writes the layout of the log's columns.
pub(super) fn shape(page: &mut Page, sample: &Sample) {
    let between = match sample.delimiter {
        Delimiter::Tab => "tabs",
        Delimiter::Semicolon => "semicolons",
        Delimiter::Comma => "commas",
        Delimiter::Blanks => "blanks",
        Delimiter::Other(_) => "the delimiter of its first line",
    };
    let header = if sample.names.is_some() {
        "named by a header"
    } else {
        "without names, so they are called \"1\", \"2\" and so on"
    };
    let (count, rows) = (sample.count, sample.rows());
    let rows = if sample.whole {
        format!("All {rows} rows were read.")
    } else {
        format!("{rows} rows, distributed over the log, were read.")
    };
    if sample.decimal == Decimal::Comma {
        page.known("decimal", &text(","));
    }
    if sample.format == "csv" {
        page.remark(&format!("{count} columns between {between}, {header}."));
    } else {
        page.remark(&format!("{count} columns of numbers."));
    }
    page.remark(&rows);
    let words: Vec<String> = (0..sample.count)
        .filter(|column| !sample.is_numeric(*column) && sample.clocks[*column].is_none())
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
        "The attitude of the axis frame at table angle zero, east-north-up. It may be left",
    );
    page.remark("out if the log begins with a static interval for the alignment (`rins align`).");
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
        "the commanded motion from the first row on",
    );
}

pub(super) fn imu(page: &mut Page) {
    page.blank();
    page.remark(
        "The data sheet: that of a grade or of a sensor, or values of your own, or both. If it is",
    );
    page.remark("left out, a grade is assumed from the readings at rest, and the result says so.");
    page.closed_section("imu");
    let names = |presets: &[Preset]| {
        let names: Vec<String> = presets.iter().map(|preset| text(preset.name)).collect();
        names.join(", ")
    };
    page.optional("grade", r#""?""#, &names(&GRADES));
    page.optional("sensor", r#""?""#, &format!("instead of a grade: {}", names(&SENSORS)));
    page.closed_section("imu.gyro");
    page.optional(
        "noise",
        r#""? deg/h/sqrt(Hz)""#,
        "white noise; or as an angle random walk, \"? deg/sqrt(h)\"",
    );
    page.optional("bias_sigma", r#""? deg/h""#, "biases, 1 sigma");
    page.optional("scale_sigma", r#""? ppm""#, "scale errors, 1 sigma");
    page.optional("misalignment_sigma", r#""? arcsec""#, "misalignments, 1 sigma");
    page.closed_section("imu.accel");
    page.optional(
        "noise",
        r#""? ug/sqrt(Hz)""#,
        "white noise; or as a velocity random walk, \"? m/s/sqrt(h)\"",
    );
    page.optional("bias_sigma", r#""? ug""#, "as for the gyros");
    page.optional("scale_sigma", r#""? ppm""#, "as for the gyros");
    page.optional("misalignment_sigma", r#""? arcsec""#, "as for the gyros");
}

pub(super) fn default_spin(page: &mut Page) {
    page.blank();
    page.remark("The body axis along the spin axis of the table.");
    page.closed_section("axis");
    page.optional("spin", r#""z""#, "z unless another is given, such as \"-x\"");
}
