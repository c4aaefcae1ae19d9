//! The temperature in a scenario: `[truth] temperature`.

use rins_simulation::Temperature;

use crate::document::{Entry, Node};
use crate::error::IoError;
use crate::quantity::kinds;
use crate::section::{CELSIUS, Section};

/// Reads a temperature such as `"20 degC"`, or a table that describes its profile.
pub(super) fn read(truth: &Section<'_>) -> Result<Option<Temperature>, IoError> {
    let Some(Entry { value, .. }) = truth.get("temperature") else { return Ok(None) };
    if !matches!(value.node, Node::Table(_)) {
        return Ok(truth.celsius("temperature")?.map(Temperature::Constant));
    }
    let known = ["start", "ramp", "rise", "time_constant", "amplitude", "period"];
    let Some(table) = truth.inline("temperature", &known)? else { return Ok(None) };
    let Some(start) = table.celsius("start")? else {
        return Err(table.missing("start", CELSIUS));
    };
    let kinds = [
        ("ramp", &["ramp"][..]),
        ("rise", &["rise", "time_constant"]),
        ("amplitude", &["amplitude", "period"]),
    ];
    let kind = kinds.into_iter().find(|(key, _)| table.has(key));
    let Some((kind, keys)) = kind else {
        return Err(
            table.missing("ramp", "one of ramp, rise with time_constant, amplitude with period")
        );
    };
    if let Some(stray) = known[1..].iter().find(|key| table.has(key) && !keys.contains(key)) {
        return Err(table.conflict(stray, format!("does not go with {kind}")));
    }
    let difference = |key| table.require_quantity(key, &kinds::TEMPERATURE_DIFFERENCE);
    Ok(Some(match kind {
        "ramp" => Temperature::Ramp {
            start,
            rate: table.require_quantity("ramp", &kinds::TEMPERATURE_RATE)?,
        },
        "rise" => Temperature::WarmUp {
            start,
            rise: difference("rise")?,
            time_constant: table.require_quantity("time_constant", &kinds::DURATION)?,
        },
        _ => Temperature::Sinus {
            start,
            amplitude: difference("amplitude")?,
            period: table.require_quantity("period", &kinds::DURATION)?,
        },
    }))
}
