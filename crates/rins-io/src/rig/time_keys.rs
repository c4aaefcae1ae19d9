//! Reading of `time` in `[log]` and its parts.

use super::log_spec::{OwnClock, Stamp, TimeColumn, TimeUnit};
use super::readings::column;
use crate::error::IoError;
use crate::quantity::kinds;
use crate::section::Section;

pub(super) const PATH: &str = r#"the log's file, such as "run.csv""#;

pub(super) fn time_column(time: &Section<'_>) -> Result<TimeColumn, IoError> {
    let column = column(time, "column")?;
    let units = [
        ("s", TimeUnit::Seconds(1.0)),
        ("ms", TimeUnit::Seconds(1e-3)),
        ("us", TimeUnit::Seconds(1e-6)),
        ("ns", TimeUnit::Seconds(1e-9)),
        ("sample", TimeUnit::Samples),
    ];
    let Some(unit) = time.choice("unit", &units)? else {
        return Err(time.missing("unit", r#""s", "ms", "us", "ns" or "sample""#));
    };
    let stamps = [("start", Stamp::Start), ("middle", Stamp::Middle), ("end", Stamp::End)];
    let stamp = time.choice("stamp", &stamps)?.unwrap_or(Stamp::End);
    Ok(TimeColumn { column, unit, stamp })
}

/// The accelerometers' own clock, if the rig file defines one.
pub(super) fn own_clock(
    accel: &Section<'_>,
    log_time: Option<&TimeColumn>,
) -> Result<Option<OwnClock>, IoError> {
    let Some(section) = accel.inline("time", &["column", "unit", "stamp", "offset"])? else {
        return Ok(None);
    };
    if !accel.has("path") {
        let reason = "accelerometers in the gyros' file have the gyros' time; give theirs a path";
        return Err(accel.conflict("time", reason));
    }
    let in_seconds = |time: &TimeColumn| matches!(time.unit, TimeUnit::Seconds(_));
    let time = time_column(&section)?;
    if !(in_seconds(&time) && log_time.is_some_and(in_seconds)) {
        let reason = "two clocks are compared in s, ms, us or ns, the log's and this one";
        return Err(accel.conflict("time", reason));
    }
    let offset = section.quantity("offset", &kinds::CLOCK_OFFSET)?.unwrap_or_default();
    Ok(Some(OwnClock { time, offset }))
}
