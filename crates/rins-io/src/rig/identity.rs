//! Which IMU a run is of, when it was made, and by whom: `[run]` and `[lab]`.

use crate::error::IoError;
use crate::log::date_seconds;
use crate::quantity::kinds;
use crate::section::Section;

/// Which IMU a run is of, and when it was made: `[run]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunIdentity {
    /// The id of the run.
    pub id: Option<String>,
    /// The maker of the IMU.
    pub maker: Option<String>,
    /// The model of the IMU.
    pub model: Option<String>,
    /// The serial number of the IMU.
    pub serial: Option<String>,
    /// The name of the series of runs between which the IMU was not switched off. They have the same turn-on biases.
    pub series: Option<String>,
    /// When the run started.
    pub started: Option<Started>,
    /// The time since power-on at the start of the run \[s\].
    pub since_power_on: Option<f64>,
    /// A remark.
    pub note: Option<String>,
}

/// When a run started.
#[derive(Clone, Debug, PartialEq)]
pub struct Started {
    /// As it is written in the file: RFC 3339.
    pub text: String,
    /// Since 1970 \[s\].
    pub seconds: f64,
}

/// Who made a measurement: `[lab]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Laboratory {
    /// The name of the laboratory.
    pub name: Option<String>,
    /// The operator.
    pub operator: Option<String>,
    /// The procedure.
    pub procedure: Option<String>,
}

/// The keys of `[run]`.
const KEYS: [&str; 8] =
    ["id", "maker", "model", "serial", "series", "started", "since_power_on", "note"];

/// The form of `started`.
const STARTED: &str = r#"a date and time with its offset from UTC, such as "2026-11-26T10:00:00Z""#;

/// Reads `[run]`, which may be left out.
pub(super) fn run(root: &Section<'_>) -> Result<RunIdentity, IoError> {
    let Some(run) = root.section("run", &KEYS)? else { return Ok(RunIdentity::default()) };
    Ok(RunIdentity {
        id: named(&run, "id", r#"a name of the run, such as "7""#)?,
        maker: named(&run, "maker", "the maker of the IMU")?,
        model: named(&run, "model", "the model of the IMU")?,
        serial: named(&run, "serial", r#"a serial number, such as "FOG-0012""#)?,
        series: named(
            &run,
            "series",
            r#"one name for all runs of a power-on, such as "2026-11-26 a""#,
        )?,
        started: started(&run, "started")?,
        since_power_on: run.quantity("since_power_on", &kinds::TIME_SINCE)?,
        note: named(&run, "note", "a text")?,
    })
}

/// Reads `[lab]`, which may be left out.
pub(super) fn laboratory(root: &Section<'_>) -> Result<Laboratory, IoError> {
    let Some(lab) = root.section("lab", &["name", "operator", "procedure"])? else {
        return Ok(Laboratory::default());
    };
    Ok(Laboratory {
        name: named(&lab, "name", "the name of the laboratory")?,
        operator: named(&lab, "operator", "the name of the operator")?,
        procedure: named(&lab, "procedure", "the name of the procedure")?,
    })
}

/// A date with a time and an offset from UTC.
pub(crate) fn started(section: &Section<'_>, key: &str) -> Result<Option<Started>, IoError> {
    let Some(text) = section.text(key, STARTED)? else { return Ok(None) };
    let seconds = date_seconds(text);
    match seconds {
        Some(seconds) => Ok(Some(Started { text: text.into(), seconds })),
        None => Err(section.not_allowed(key, STARTED)),
    }
}

/// A text that is not empty.
pub(crate) fn named(
    section: &Section<'_>,
    key: &str,
    expected: &str,
) -> Result<Option<String>, IoError> {
    match section.text(key, expected)? {
        Some("") => Err(section.not_allowed(key, expected)),
        text => Ok(text.map(Into::into)),
    }
}
