//! Reading of `time` in `[log]` and its parts.

use super::log_spec::{Coarse, OwnClock, SplitTime, Stamp, TimeColumn, TimeUnit};
use super::readings::column;
use crate::error::IoError;
use crate::quantity::kinds;
use crate::section::Section;

pub(super) const PATH: &str = r#"the log's file, such as "run.csv""#;

const TWO_COLUMNS: &str = r#"the two columns whose sum is the time, such as ["sec", "nanosec"]"#;

const TWO_UNITS: &str = r#"the units of the two columns: ["s", "ns"], ["week", "s"] or ["date", "s"]; the second is a smaller one of "s", "ms", "us" and "ns""#;

/// The units of the second of two columns, and their number in a second.
const SMALL_UNITS: [(&str, i64); 4] =
    [("s", 1), ("ms", 1_000), ("us", 1_000_000), ("ns", 1_000_000_000)];

/// The units of the first of two columns, and the seconds that its numbers count.
const COARSE_UNITS: [(&str, Coarse); 3] =
    [("s", Coarse::Seconds(1)), ("week", Coarse::Seconds(604_800)), ("date", Coarse::Date)];

pub(super) fn time_column(time: &Section<'_>) -> Result<TimeColumn, IoError> {
    let stamps = [("start", Stamp::Start), ("middle", Stamp::Middle), ("end", Stamp::End)];
    let stamp = time.choice("stamp", &stamps)?.unwrap_or(Stamp::End);
    if time.has("columns") {
        return in_two_columns(time, stamp);
    }
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
    Ok(TimeColumn { column, unit, split: None, stamp })
}

/// A time that is the sum of two columns.
fn in_two_columns(time: &Section<'_>, stamp: Stamp) -> Result<TimeColumn, IoError> {
    if time.has("column") {
        return Err(time.conflict("column", "time.columns names the two columns of the time"));
    }
    let columns = time.list_of_texts("columns", TWO_COLUMNS)?;
    let [first, second] = &columns[..] else {
        return Err(time.not_allowed("columns", TWO_COLUMNS));
    };
    if first == second {
        return Err(time.conflict("columns", "names a column twice"));
    }
    if !time.has("unit") {
        return Err(time.missing("unit", TWO_UNITS));
    }
    let units = time.list_of_texts("unit", TWO_UNITS)?;
    let [coarse, small] = &units[..] else {
        return Err(time.not_allowed("unit", TWO_UNITS));
    };
    let coarse = COARSE_UNITS.iter().find(|(name, _)| name == coarse);
    let small = SMALL_UNITS.iter().find(|(name, _)| name == small);
    match (coarse, small) {
        (Some(&(name, coarse)), Some(&(small, per_second))) if name != small => Ok(TimeColumn {
            column: first.clone(),
            unit: TimeUnit::Seconds(1.0),
            split: Some(SplitTime { coarse, column: second.clone(), per_second }),
            stamp,
        }),
        _ => Err(time.not_allowed("unit", TWO_UNITS)),
    }
}

/// The accelerometers' own clock, if the rig file defines one.
pub(super) fn own_clock(
    accel: &Section<'_>,
    log_time: Option<&TimeColumn>,
) -> Result<Option<OwnClock>, IoError> {
    let Some(section) = accel.inline("time", &["column", "columns", "unit", "stamp", "offset"])?
    else {
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
