//! Reading `[log]`: which column of which file is what.

use std::ffi::OsStr;
use std::path::Path;

use super::axes::Axes;
use super::log_spec::{
    AngleColumn, ColumnSpec, Gaps, LogFormat, LogSpec, Reading, ScaledColumn, Stamp,
    TemperatureColumn, TimeColumn, TimeUnit, TriadColumns,
};
use crate::error::IoError;
use crate::quantity::{Dimension, QuantityError, Unit, kinds};
use crate::section::Section;

/// The keys of `[log]`.
pub(crate) const KEYS: [&str; 10] = [
    "path",
    "format",
    "rate",
    "time",
    "gyro",
    "accel",
    "table_angle",
    "table_rate",
    "temperature",
    "gaps",
];

const FORMATS: [(&str, Format); 3] =
    [("csv", Format::Csv), ("psins", Format::Psins), ("kf-gins", Format::KfGins)];

#[derive(Clone, Copy, PartialEq)]
enum Format {
    Csv,
    Psins,
    KfGins,
}

pub(super) fn read(root: &Section<'_>, folder: &Path) -> Result<LogSpec, IoError> {
    let Some(log) = root.section("log", &KEYS)? else {
        return Err(root.missing("[log]", "path, time, gyro and accel"));
    };
    let rate = log.quantity("rate", &kinds::SAMPLE_RATE)?;
    let triad_keys = ["path", "columns", "unit", "scale", "offset", "axes"];
    let gyro = log.inline("gyro", &triad_keys)?;
    let accel = log.inline("accel", &triad_keys)?;
    let path = match (log.text("path", PATH)?, &gyro, &accel) {
        (Some(path), ..) => path,
        (None, Some(gyro), Some(accel)) if gyro.has("path") && accel.has("path") => {
            gyro.text("path", PATH)?.unwrap_or_default()
        }
        _ => return Err(log.missing("path", PATH)),
    };
    let format = format(&log, path)?;
    let path = folder.join(path);
    let gyro_axes = axes(gyro.as_ref())?;
    let accel_axes = axes(accel.as_ref())?;
    let spec = LogSpec { path, format: LogFormat::Psins, rate, gyro_axes, accel_axes };
    match format {
        Format::Psins => {
            let own = ["time", "table_angle", "table_rate", "temperature", "gaps"];
            refuse_own(&log, &own, "a psins log has no such column")?;
            let own = ["path", "columns", "unit", "scale", "offset"];
            for triad in [&gyro, &accel].into_iter().flatten() {
                refuse_own(triad, &own, "a psins log's header says so itself")?;
            }
            Ok(spec)
        }
        Format::KfGins => {
            refuse_own(&log, &["time"], "a kf-gins log's first column is the time in s")?;
            let own = ["columns", "unit", "scale", "offset"];
            for triad in [&gyro, &accel].into_iter().flatten() {
                refuse_own(triad, &own, "a kf-gins log's columns are fixed")?;
            }
            let columns = kf_gins(&log, folder, &spec.path)?;
            // The format's axes are front, right, down; ours are right, front, up.
            let body = Axes::parse(["y", "x", "-z"]).expect("each axis once");
            Ok(LogSpec {
                format: LogFormat::Columns(Box::new(columns)),
                gyro_axes: spec.gyro_axes.after(&body),
                accel_axes: spec.accel_axes.after(&body),
                ..spec
            })
        }
        Format::Csv => {
            let time = time(&log, rate)?;
            let (Some(gyro), Some(accel)) = (&gyro, &accel) else {
                let (key, unit) =
                    if gyro.is_none() { ("gyro", "deg/s") } else { ("accel", "m/s^2") };
                let example = format!("{{ columns = [\"x\", \"y\", \"z\"], unit = \"{unit}\" }}");
                return Err(log.missing(key, example));
            };
            let gyro = triad(gyro, folder, &spec.path, &GYRO)?;
            let accel = triad(accel, folder, &spec.path, &ACCEL)?;
            let columns = others(&log, folder, ColumnSpec::of(time, gyro, accel))?;
            Ok(LogSpec { format: LogFormat::Columns(Box::new(columns)), ..spec })
        }
    }
}

const PATH: &str = r#"the log's file, such as "run.csv""#;

fn format(log: &Section<'_>, path: &str) -> Result<Format, IoError> {
    if log.text("format", r#""csv", "psins" or "kf-gins""#)? == Some("parquet") {
        return Err(log.not_allowed("format", r#""csv", "psins" or "kf-gins""#));
    }
    if let Some(format) = log.choice("format", &FORMATS)? {
        return Ok(format);
    }
    let ending = Path::new(path).extension().map(OsStr::to_ascii_lowercase);
    match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("csv" | "tsv" | "txt" | "dat" | "asc") => Ok(Format::Csv),
        _ => Err(log.missing("format", r#""csv", "psins" or "kf-gins" for a file of this name"#)),
    }
}

fn refuse_own(section: &Section<'_>, keys: &[&str], reason: &str) -> Result<(), IoError> {
    match keys.iter().find(|key| section.has(key)) {
        Some(key) => Err(section.conflict(key, reason)),
        None => Ok(()),
    }
}

fn time(log: &Section<'_>, rate: Option<f64>) -> Result<Option<TimeColumn>, IoError> {
    let Some(time) = log.inline("time", &["column", "unit", "stamp"])? else {
        return match rate {
            Some(_) => Ok(None),
            None => Err(log.missing(
                "time",
                r#"{ column = "t", unit = "s" }, or a rate where there is no time column"#,
            )),
        };
    };
    let column = column(&time, "column")?;
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
    if unit == TimeUnit::Samples && rate.is_none() {
        return Err(
            log.missing("rate", r#"a sampling rate such as "50 Hz", as time counts samples"#)
        );
    }
    let stamps = [("start", Stamp::Start), ("middle", Stamp::Middle), ("end", Stamp::End)];
    let stamp = time.choice("stamp", &stamps)?.unwrap_or(Stamp::End);
    Ok(Some(TimeColumn { column, unit, stamp }))
}

/// The two dimensions of a triad's numbers, and how an error calls them.
struct Readings {
    rate: Dimension,
    increment: Dimension,
    expected: &'static str,
    example: &'static str,
}

const GYRO: Readings = Readings {
    rate: Dimension::ANGULAR_RATE,
    increment: Dimension::ANGLE,
    expected: "an angular rate or an angle increment",
    example: "deg/s",
};

const ACCEL: Readings = Readings {
    rate: Dimension::ACCELERATION,
    increment: Dimension::VELOCITY,
    expected: "a specific force or a velocity increment",
    example: "m/s^2",
};

fn triad(
    triad: &Section<'_>,
    folder: &Path,
    log: &Path,
    readings: &Readings,
) -> Result<TriadColumns, IoError> {
    let names = r#"three columns such as ["x", "y", "z"]"#;
    let Some(columns) = triad.texts("columns", names)? else {
        return Err(triad.missing("columns", names));
    };
    if columns[0] == columns[1] || columns[1] == columns[2] || columns[0] == columns[2] {
        return Err(triad.conflict("columns", "names a column twice"));
    }
    let unit = unit(triad, &[readings.rate, readings.increment], readings)?;
    let reading = if unit.dimension == readings.rate {
        Reading::Rate(unit.factor)
    } else {
        Reading::Increment(unit.factor)
    };
    let numbers = "a number, or one for each column";
    let scale = triad.numbers("scale", numbers)?.unwrap_or([1.0; 3]);
    if scale.contains(&0.0) {
        return Err(triad.not_allowed("scale", "factors other than zero"));
    }
    Ok(TriadColumns {
        path: triad.text("path", PATH)?.map_or_else(|| log.into(), |path| folder.join(path)),
        columns: columns.map(Into::into),
        reading,
        offset: triad.numbers("offset", numbers)?.unwrap_or([0.0; 3]),
        scale,
    })
}

fn unit(
    section: &Section<'_>,
    allowed: &[Dimension],
    Readings { expected, example, .. }: &Readings,
) -> Result<Unit, IoError> {
    let words = format!("{expected} such as {example:?}");
    let Some(text) = section.text("unit", &words)? else {
        return Err(section.missing("unit", words));
    };
    let unit = Unit::parse(text).map_err(|error| section.error("unit", error.into()))?;
    if allowed.contains(&unit.dimension) {
        return Ok(unit);
    }
    let problem =
        QuantityError::WrongDimension { text: text.into(), got: unit.dimension, expected, example };
    Err(section.error("unit", problem.into()))
}

fn axes(triad: Option<&Section<'_>>) -> Result<Axes, IoError> {
    let expected = r#"three axes such as ["-y", "x", "z"], each once"#;
    let Some(triad) = triad else { return Ok(Axes::IDENTITY) };
    match triad.texts("axes", expected)? {
        Some(names) => Axes::parse(names).ok_or_else(|| triad.not_allowed("axes", expected)),
        None => Ok(Axes::IDENTITY),
    }
}

fn column(section: &Section<'_>, key: &str) -> Result<String, IoError> {
    let expected = r#"a column's name, or its number as in "1""#;
    section.text(key, expected)?.map(Into::into).ok_or_else(|| section.missing(key, expected))
}

impl ColumnSpec {
    fn of(time: Option<TimeColumn>, gyro: TriadColumns, accel: TriadColumns) -> Self {
        let none = (None, None, None, None);
        let (table_angle, table_rate, temperature, gaps) = none;
        Self { time, gyro, accel, table_angle, table_rate, temperature, gaps }
    }
}

/// The columns besides the IMU's.
fn others(log: &Section<'_>, folder: &Path, imu: ColumnSpec) -> Result<ColumnSpec, IoError> {
    let table_angle = match angle_figures(log)? {
        Some((section, figures)) => {
            let unit = unit(&section, &[Dimension::ANGLE], &ANGLE)?;
            let column = column(&section, "column")?;
            Some(AngleColumn { column, factor: unit.factor, ..figures })
        }
        None => None,
    };
    let table_rate = match log.inline("table_rate", &["column", "unit"])? {
        Some(section) => {
            let factor = unit(&section, &[Dimension::ANGULAR_RATE], &TABLE_RATE)?.factor;
            Some(ScaledColumn { column: column(&section, "column")?, factor })
        }
        None => None,
    };
    let gaps = [("accumulated", Gaps::Accumulated), ("held", Gaps::Held)];
    let gaps = log.choice("gaps", &gaps)?;
    let temperature = temperature(log, folder, imu.time.as_ref())?;
    Ok(ColumnSpec { table_angle, table_rate, temperature, gaps, ..imu })
}

const ANGLE: Readings = Readings {
    rate: Dimension::ANGLE,
    increment: Dimension::ANGLE,
    expected: "an angle",
    example: "deg",
};

const TABLE_RATE: Readings = Readings {
    rate: Dimension::ANGULAR_RATE,
    increment: Dimension::ANGLE,
    expected: "an angular rate",
    example: "deg/s",
};

/// The section `table_angle`, and what it says besides column and unit.
pub(crate) fn angle_figures<'d>(
    log: &Section<'d>,
) -> Result<Option<(Section<'d>, AngleColumn)>, IoError> {
    let known = ["column", "unit", "noise", "resolution", "latency"];
    let Some(section) = log.inline("table_angle", &known)? else { return Ok(None) };
    let figures = AngleColumn {
        column: String::new(),
        factor: 1.0,
        noise: section.quantity("noise", &kinds::ANGLE_SIGMA)?,
        resolution: section.quantity("resolution", &kinds::ANGLE_RESOLUTION)?,
        latency: section.quantity("latency", &kinds::LATENCY)?,
    };
    Ok(Some((section, figures)))
}

fn temperature(
    log: &Section<'_>,
    folder: &Path,
    log_time: Option<&TimeColumn>,
) -> Result<Option<TemperatureColumn>, IoError> {
    let known = ["path", "time", "column", "unit"];
    let Some(section) = log.inline("temperature", &known)? else { return Ok(None) };
    let file = match section.text("path", PATH)? {
        None if section.has("time") => {
            return Err(section.conflict("time", "a temperature in the log itself has its time"));
        }
        None => None,
        Some(path) => {
            let Some(TimeUnit::Seconds(unit)) = log_time.map(|time| time.unit) else {
                let reason = "needs a log with a time in s, ms, us or ns to be compared with";
                return Err(section.conflict("path", reason));
            };
            let column = column(&section, "time")?;
            let time = TimeColumn { column, unit: TimeUnit::Seconds(unit), stamp: Stamp::End };
            Some((folder.join(path), time))
        }
    };
    let column = column(&section, "column")?;
    match section.choice("unit", &[("degC", 0.0), ("K", -273.15)])? {
        Some(offset) => Ok(Some(TemperatureColumn { file, column, offset })),
        None => Err(section.missing("unit", r#""degC" or "K""#)),
    }
}

/// The columns of a KF-GINS increments file: time in s, angles in rad, velocities in m/s.
fn kf_gins(log: &Section<'_>, folder: &Path, path: &Path) -> Result<ColumnSpec, IoError> {
    let triad = |columns: [&str; 3]| TriadColumns {
        path: path.into(),
        columns: columns.map(Into::into),
        reading: Reading::Increment(1.0),
        offset: [0.0; 3],
        scale: [1.0; 3],
    };
    let unit = TimeUnit::Seconds(1.0);
    let time = Some(TimeColumn { column: "1".into(), unit, stamp: Stamp::End });
    others(log, folder, ColumnSpec::of(time, triad(["2", "3", "4"]), triad(["5", "6", "7"])))
}
