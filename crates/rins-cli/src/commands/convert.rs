//! `rins convert`: a log of one format as one of another, with the rig file that reads it.

use std::fmt::Write as _;
use std::path::Path;

use rins_io::{Converted, LogFile, Overwrite, convert};
use serde_json::{Value, json};

use crate::args::{Convert, Format};
use crate::commands::repairs::repairs;
use crate::outcome::Outcome;
use rins_io::shown;

pub(crate) fn run(arguments: &Convert, overwrite: Overwrite) -> anyhow::Result<Outcome> {
    let Convert { rig, output, format } = arguments;
    let format = format_of(output, *format)?;
    let converted = convert(rig, output, format, overwrite)?;
    let mut text = format!(
        "Converted {} to {}\n  {} samples as {}, read by {}\n",
        shown(rig),
        shown(output),
        converted.samples,
        format.name(),
        shown(&converted.rig)
    );
    for line in remarks(&converted) {
        let _ = writeln!(text, "  {line}");
    }
    Ok(Outcome { json: json(&converted, arguments, format), text, ..Outcome::default() })
}

/// The format of a new log: as it is said, or as its name tells.
pub(crate) fn format_of(output: &Path, said: Option<Format>) -> anyhow::Result<LogFile> {
    if let Some(format) = said {
        return Ok(format.into());
    }
    LogFile::of(output).ok_or_else(|| {
        let names: Vec<&str> = LogFile::ALL.iter().map(|format| format.name()).collect();
        anyhow::anyhow!(
            "{}: the name does not tell a format; say --format, one of {}",
            shown(output),
            names.join(", ")
        )
    })
}

/// What a user must know of what was written.
pub(crate) fn remarks(converted: &Converted) -> Vec<String> {
    let mut lines = Vec::new();
    if converted.differences.is_empty() {
        lines.push("read again, it is the same to the last bit".into());
    }
    for difference in &converted.differences {
        lines.push(format!(
            "! {}: {} number(s) differ when it is read again, by {:.2e} at most",
            difference.signal, difference.numbers, difference.largest
        ));
    }
    lines.extend(
        repairs(&converted.old, &converted.summary).into_iter().map(|told| format!("! {told}")),
    );
    for name in &converted.left_out {
        lines.push(format!("! {name} is left out: the format has no room for it"));
    }
    if converted.time_origin != 0.0 {
        lines.push(format!("! its times are counted from {} s of the log", converted.time_origin));
    }
    lines
}

fn json(converted: &Converted, arguments: &Convert, format: LogFile) -> Value {
    let differences: Vec<Value> = converted
        .differences
        .iter()
        .map(|difference| {
            json!({
                "signal": difference.signal,
                "numbers": difference.numbers,
                "largest": if difference.largest.is_finite() { json!(difference.largest) } else { Value::Null },
            })
        })
        .collect();
    json!({
        "schema": 1,
        "command": "convert",
        "rig": shown(&arguments.rig),
        "log": shown(&arguments.output),
        "new_rig": shown(&converted.rig),
        "format": format.name(),
        "samples": converted.samples,
        "exact": converted.differences.is_empty(),
        "differences": differences,
        "left_out": converted.left_out,
        "time_origin_s": converted.time_origin,
        "repairs": repairs(&converted.old, &converted.summary),
    })
}
