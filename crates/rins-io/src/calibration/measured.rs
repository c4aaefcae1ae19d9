//! When and how the runs of a calibration were made: `[measured]`.

use std::fmt::Write as _;

use crate::document::quoted;
use crate::error::IoError;
use crate::quantity::kinds;
use crate::rig::{Laboratory, Started, named, started};
use crate::section::Section;

/// When and how the runs of a calibration were made, as far as their rig files and logs say it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measured {
    /// The serial number of the IMU.
    pub serial: Option<String>,
    /// The name of the power-on, which runs without a power cycle in between share.
    pub series: Option<String>,
    /// When the first run started.
    pub started: Option<Started>,
    /// The time since power-on at the middle of the run \[s\].
    pub since_power_on: Option<f64>,
    /// The mean temperature \[°C\].
    pub temperature: Option<f64>,
    /// The direction in which the temperature changed: 1 up, -1 down.
    pub warming: Option<f64>,
    /// Who made the measurement.
    pub laboratory: Laboratory,
}

/// The keys of `[measured]`.
const KEYS: [&str; 9] = [
    "serial",
    "series",
    "started",
    "since_power_on",
    "temperature",
    "temperature_is",
    "laboratory",
    "operator",
    "procedure",
];

/// How the temperature may change.
const CHANGES: [(&str, f64); 2] = [("rising", 1.0), ("falling", -1.0)];

/// Reads `[measured]`, which may be left out.
pub(super) fn read(root: &Section<'_>) -> Result<Measured, IoError> {
    let Some(section) = root.section("measured", &KEYS)? else { return Ok(Measured::default()) };
    Ok(Measured {
        serial: named(&section, "serial", "a serial number")?,
        series: named(&section, "series", "the name of a power-on")?,
        started: started(&section, "started")?,
        since_power_on: section.quantity("since_power_on", &kinds::TIME_SINCE)?,
        temperature: section.celsius("temperature")?,
        warming: section.choice("temperature_is", &CHANGES)?,
        laboratory: Laboratory {
            name: named(&section, "laboratory", "the name of the laboratory")?,
            operator: named(&section, "operator", "the name of the operator")?,
            procedure: named(&section, "procedure", "the name of the procedure")?,
        },
    })
}

/// The section, as it is written; nothing if nothing is known.
pub(super) fn written(measured: &Measured) -> String {
    let Measured { serial, series, started, since_power_on, temperature, warming, laboratory } =
        measured;
    let mut lines = String::new();
    // Writing to a string cannot fail.
    let mut text = |key: &str, value: Option<&str>| {
        if let Some(value) = value {
            let _ = writeln!(lines, "{key} = {}", quoted(value));
        }
    };
    text("serial", serial.as_deref());
    text("series", series.as_deref());
    text("started", started.as_ref().map(|started| started.text.as_str()));
    text("since_power_on", since_power_on.map(|time| format!("{time} s")).as_deref());
    text("temperature", temperature.map(|value| format!("{value} degC")).as_deref());
    let change = CHANGES.iter().find(|(_, sign)| Some(*sign) == *warming);
    text("temperature_is", change.map(|(word, _)| *word));
    text("laboratory", laboratory.name.as_deref());
    text("operator", laboratory.operator.as_deref());
    text("procedure", laboratory.procedure.as_deref());
    if lines.is_empty() { lines } else { format!("\n{COMMENT}[measured]\n{lines}") }
}

/// The comment above the section.
const COMMENT: &str = "# When and how the runs were made.\n";
