//! Reading of `table_angle` and `table_rate` in `[log]`.

use std::path::Path;

use super::log_spec::{AngleColumn, ScaledColumn, TimeColumn};
use super::readings::{Readings, column, unit};
use super::time_keys::{PATH, own_clock};
use crate::error::IoError;
use crate::quantity::{Dimension, kinds};
use crate::section::Section;

const ANGLE: Readings = Readings {
    rate: Dimension::ANGLE,
    increment: Dimension::ANGLE,
    expected: "an angle",
    example: "deg",
};

const RATE: Readings = Readings {
    rate: Dimension::ANGULAR_RATE,
    increment: Dimension::ANGLE,
    expected: "an angular rate",
    example: "deg/s",
};

/// The column of the measured angle, if there is one.
pub(super) fn angle(
    log: &Section<'_>,
    folder: &Path,
    log_time: Option<&TimeColumn>,
) -> Result<Option<AngleColumn>, IoError> {
    let Some((section, figures)) = angle_figures(log)? else { return Ok(None) };
    let factor = sense(&section)? * unit(&section, &[Dimension::ANGLE], &ANGLE)?.factor;
    let file = match section.text("path", PATH)? {
        None if section.has("time") => {
            let reason =
                "a table angle in the log itself has the time of the log; give its file a path";
            return Err(section.conflict("time", reason));
        }
        None => None,
        Some(path) => {
            let clock = own_clock(&section, log_time)?;
            let expected = r#"{ column = "t", unit = "s" }"#;
            Some((folder.join(path), clock.ok_or_else(|| section.missing("time", expected))?))
        }
    };
    Ok(Some(AngleColumn { file, column: column(&section, "column")?, factor, ..figures }))
}

/// The column of the rate, if there is one.
pub(super) fn rate(log: &Section<'_>) -> Result<Option<ScaledColumn>, IoError> {
    let Some(section) = log.inline("table_rate", &["column", "unit", "sense"])? else {
        return Ok(None);
    };
    let factor = sense(&section)? * unit(&section, &[Dimension::ANGULAR_RATE], &RATE)?.factor;
    Ok(Some(ScaledColumn { column: column(&section, "column")?, factor }))
}

/// 1, or -1 for a table that counts opposite to the body's direction of rotation.
pub(super) fn sense(section: &Section<'_>) -> Result<f64, IoError> {
    Ok(section.choice("sense", &[("forward", 1.0), ("reversed", -1.0)])?.unwrap_or(1.0))
}

/// The section `table_angle`, with its keys other than column and unit.
pub(crate) fn angle_figures<'d>(
    log: &Section<'d>,
) -> Result<Option<(Section<'d>, AngleColumn)>, IoError> {
    let known = ["path", "time", "column", "unit", "sense", "noise", "resolution", "latency"];
    let Some(section) = log.inline("table_angle", &known)? else { return Ok(None) };
    let figures = AngleColumn {
        file: None,
        column: String::new(),
        factor: 1.0,
        noise: section.quantity("noise", &kinds::ANGLE_SIGMA)?,
        resolution: section.quantity("resolution", &kinds::ANGLE_RESOLUTION)?,
        latency: section.quantity("latency", &kinds::LATENCY)?,
    };
    Ok(Some((section, figures)))
}
