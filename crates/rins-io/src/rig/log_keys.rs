//! Reading of `[log]`: the files and columns of a log.

use std::ffi::OsStr;
use std::path::Path;

use super::axes::Axes;
use super::formats::Fixed;
use super::log_spec::{
    ColumnSpec, Decimal, Gaps, LogFormat, LogSpec, OwnClock, Reading, RowFilter, Stamp, Table,
    TemperatureColumn, TextForm, TimeColumn, TimeUnit, TriadColumns,
};
use super::log_times::Clock;
use super::readings::{
    ACCEL, GYRO, NUMBERS, Readings, column, example, refuse_own, scale_of, unit,
};
use super::table_columns;
use super::time_keys::{PATH, own_clock, time_column};
use crate::error::IoError;
use crate::quantity::kinds;
use crate::section::Section;

/// The keys of `[log]`.
pub(crate) const KEYS: [&str; 16] = [
    "path",
    "format",
    "decimal",
    "skip",
    "imu",
    "rate",
    "time",
    "gyro",
    "accel",
    "table_angle",
    "table_rate",
    "temperature",
    "gaps",
    "static",
    "window",
    "clock_accuracy",
];

const SOME_COLUMNS: &str = r#"one to three columns such as ["x", "y", "z"]"#;

/// The keys of columns of text.
const TEXT_KEYS: [&str; 2] = ["decimal", "skip"];

const FORMATS: [(&str, Format); 8] = [
    ("csv", Format::Table(Table::Text)),
    ("parquet", Format::Table(Table::Parquet)),
    ("mat", Format::Table(Table::Mat)),
    ("psins", Format::Psins),
    ("psins-bin", Format::Fixed(Fixed::PsinsBinary)),
    ("kf-gins", Format::Fixed(Fixed::KfGins)),
    ("euroc", Format::Fixed(Fixed::Euroc)),
    ("novatel", Format::Fixed(Fixed::NovAtel)),
];

/// The formats, for an error message.
const ANY_FORMAT: &str =
    r#""csv", "parquet", "mat", "psins", "psins-bin", "kf-gins", "euroc" or "novatel""#;

#[derive(Clone, Copy, PartialEq)]
enum Format {
    /// Columns that the rig file defines.
    Table(Table),
    /// Columns that the format defines.
    Fixed(Fixed),
    /// Columns that the log's header defines.
    Psins,
}

pub(super) fn read(root: &Section<'_>, folder: &Path) -> Result<LogSpec, IoError> {
    let Some(log) = root.section("log", &KEYS)? else {
        return Err(root.missing("[log]", "path, time, gyro and accel"));
    };
    let rate = log.quantity("rate", &kinds::SAMPLE_RATE)?;
    let gyro =
        log.inline("gyro", &["path", "where", "columns", "unit", "scale", "offset", "axes"])?;
    let accel = log.inline(
        "accel",
        &["path", "where", "time", "columns", "unit", "scale", "offset", "axes"],
    )?;
    let path = match (log.text("path", PATH)?, &gyro, &accel) {
        (Some(path), ..) => path,
        (None, Some(only), None) | (None, None, Some(only)) if only.has("path") => {
            only.text("path", PATH)?.unwrap_or_default()
        }
        (None, Some(gyro), Some(accel)) if gyro.has("path") && accel.has("path") => {
            gyro.text("path", PATH)?.unwrap_or_default()
        }
        _ => return Err(log.missing("path", PATH)),
    };
    let format = format(&log, path)?;
    if format != Format::Fixed(Fixed::NovAtel) {
        refuse_own(&log, &["imu"], "only a novatel log's counts depend on the IMU")?;
    }
    let path = folder.join(path);
    let gyro_axes = axes(gyro.as_ref())?;
    let accel_axes = axes(accel.as_ref())?;
    let spec = LogSpec {
        path,
        format: LogFormat::Psins,
        rate,
        gyro_axes,
        accel_axes,
        window: None,
        static_spans: Vec::new(),
    };
    let spec = of_format(&log, folder, format, spec, [gyro.as_ref(), accel.as_ref()])?;
    let time = match &spec.format {
        LogFormat::Columns(columns) => columns.time.as_ref(),
        LogFormat::Psins => None,
    };
    let clock = Clock::of(&log, time, spec.rate);
    Ok(LogSpec { window: clock.window()?, static_spans: clock.static_spans()?, ..spec })
}

/// Reads the keys that depend on the format.
fn of_format(
    log: &Section<'_>,
    folder: &Path,
    format: Format,
    spec: LogSpec,
    [gyro, accel]: [Option<&Section<'_>>; 2],
) -> Result<LogSpec, IoError> {
    match format {
        Format::Psins => {
            let own = ["time", "table_angle", "table_rate", "temperature", "gaps"];
            refuse_own(log, &own, "a psins log has no such column")?;
            refuse_own(log, &TEXT_KEYS, "a psins log has numbers of a fixed form")?;
            let own = ["path", "where", "time", "columns", "unit", "scale", "offset"];
            for triad in [gyro, accel].into_iter().flatten() {
                refuse_own(triad, &own, "the header of a psins log states it")?;
            }
            Ok(spec)
        }
        Format::Fixed(fixed) => {
            let columns = fixed.columns(log, [gyro, accel], &spec.path)?;
            let columns = others(log, folder, columns)?;
            Ok(LogSpec {
                format: LogFormat::Columns(Box::new(columns)),
                gyro_axes: spec.gyro_axes.after(&fixed.axes()),
                accel_axes: spec.accel_axes.after(&fixed.axes()),
                ..spec
            })
        }
        Format::Table(table) => {
            let layout = (table, time(log, spec.rate)?);
            let imu = match (gyro, accel) {
                (Some(gyro), Some(accel)) => {
                    both_triads((gyro, accel), layout, &spec.path, folder)?
                }
                (None, None) => return Err(log.missing("gyro", example(&GYRO))),
                some => some_sensors(some, layout, &spec.path, folder)?,
            };
            let columns = others(log, folder, imu)?;
            Ok(LogSpec { format: LogFormat::Columns(Box::new(columns)), ..spec })
        }
    }
}

/// The columns of three gyros and three accelerometers.
fn both_triads(
    (gyro, accel_section): (&Section<'_>, &Section<'_>),
    (table, time): (Table, Option<TimeColumn>),
    path: &Path,
    folder: &Path,
) -> Result<ColumnSpec, IoError> {
    let gyro = triad(gyro, folder, path, &GYRO)?;
    let accel_clock = own_clock(accel_section, time.as_ref())?;
    let accel = triad(accel_section, folder, path, &ACCEL)?;
    if table != Table::Text && (gyro.rows.is_some() || accel.rows.is_some()) {
        return Err(accel_section.conflict("where", "selects rows of text logs"));
    }
    if accel.path == gyro.path && accel.rows != gyro.rows {
        if accel.rows.is_none() || gyro.rows.is_none() {
            let reason = "rows of one sensor: state those of gyro and of accel";
            return Err(accel_section.conflict("where", reason));
        }
        if time.is_none() {
            let reason = "rows of two sensors need a time column";
            return Err(accel_section.conflict("where", reason));
        }
    }
    // Rows of their own have times of their own.
    let accel_clock = match (accel_clock, &time) {
        (None, Some(time)) if accel.rows != gyro.rows && accel.path == gyro.path => {
            Some(OwnClock { time: time.clone(), offset: 0.0 })
        }
        (clock, _) => clock,
    };
    Ok(ColumnSpec { accel_clock, ..ColumnSpec::of(table, time, gyro, accel) })
}

/// The columns of a log of gyros alone, or of accelerometers alone: one to three of them.
fn some_sensors(
    (gyro, accel): (Option<&Section<'_>>, Option<&Section<'_>>),
    (table, time): (Table, Option<TimeColumn>),
    path: &Path,
    folder: &Path,
) -> Result<ColumnSpec, IoError> {
    let sensors = |section: Option<&Section<'_>>, readings| {
        let Some(section) = section else { return Ok(None) };
        refuse_own(section, &["time", "where"], "it belongs to a log of gyros and accelerometers")?;
        let names = section.list_of_texts("columns", SOME_COLUMNS)?;
        if !(1..=3).contains(&names.len()) {
            return Err(section.not_allowed("columns", SOME_COLUMNS));
        }
        let mut names = names.into_iter();
        triad_of(section, folder, (path, [(); 3].map(|()| names.next())), readings).map(Some)
    };
    let (gyro, accel) = (sensors(gyro, &GYRO)?, sensors(accel, &ACCEL)?);
    let absent = gyro.iter().chain(&accel).map(TriadColumns::absent).next();
    let gyro = gyro.or_else(|| absent.clone());
    let accel = accel.or(absent);
    let (Some(gyro), Some(accel)) = (gyro, accel) else { unreachable!("one of them is stated") };
    Ok(ColumnSpec::of(table, time, gyro, accel))
}

fn format(log: &Section<'_>, path: &str) -> Result<Format, IoError> {
    if let Some(format) = log.choice("format", &FORMATS)? {
        return Ok(format);
    }
    let ending = Path::new(path).extension().map(OsStr::to_ascii_lowercase);
    match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("csv" | "tsv" | "txt" | "dat" | "asc") => Ok(Format::Table(Table::Text)),
        Some("parquet") => Ok(Format::Table(Table::Parquet)),
        Some("mat") => Ok(Format::Table(Table::Mat)),
        _ => Err(log.missing("format", format!("{ANY_FORMAT} for a file of this name"))),
    }
}

fn time(log: &Section<'_>, rate: Option<f64>) -> Result<Option<TimeColumn>, IoError> {
    let Some(time) = log.inline("time", &["column", "columns", "unit", "stamp"])? else {
        return match rate {
            Some(_) => Ok(None),
            None => Err(log.missing(
                "time",
                r#"{ column = "t", unit = "s" }, or a rate where there is no time column"#,
            )),
        };
    };
    let time = time_column(&time)?;
    if time.unit == TimeUnit::Samples && rate.is_none() {
        return Err(
            log.missing("rate", r#"a sampling rate such as "50 Hz", as time counts samples"#)
        );
    }
    Ok(Some(time))
}

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
    triad_of(triad, folder, (log, columns.map(|name| Some(name.into()))), readings)
}

/// The triad of these columns.
fn triad_of(
    triad: &Section<'_>,
    folder: &Path,
    (log, columns): (&Path, [Option<String>; 3]),
    readings: &Readings,
) -> Result<TriadColumns, IoError> {
    let unit = unit(triad, &[readings.rate, readings.increment], readings)?;
    let reading = if unit.dimension == readings.rate {
        Reading::Rate(unit.factor)
    } else {
        Reading::Increment(unit.factor)
    };
    let scale = scale_of(triad)?;
    let rows = match triad.inline("where", &["column", "value"])? {
        None => None,
        Some(filter) => {
            let expected = r#"the text of the rows that are read, such as "Gyro""#;
            let Some(value) = filter.text("value", expected)? else {
                return Err(filter.missing("value", expected));
            };
            Some(RowFilter { column: column(&filter, "column")?, value: value.into() })
        }
    };
    Ok(TriadColumns {
        rows,
        path: triad.text("path", PATH)?.map_or_else(|| log.into(), |path| folder.join(path)),
        columns,
        reading,
        offset: triad.numbers("offset", NUMBERS)?.unwrap_or([0.0; 3]),
        scale,
    })
}

fn axes(triad: Option<&Section<'_>>) -> Result<Axes, IoError> {
    let expected = r#"three axes such as ["-y", "x", "z"], each once"#;
    let Some(triad) = triad else { return Ok(Axes::IDENTITY) };
    match triad.texts("axes", expected)? {
        Some(names) => Axes::parse(names).ok_or_else(|| triad.not_allowed("axes", expected)),
        None => Ok(Axes::IDENTITY),
    }
}

impl ColumnSpec {
    /// Columns of the IMU alone.
    pub(super) fn of(
        table: Table,
        time: Option<TimeColumn>,
        gyro: TriadColumns,
        accel: TriadColumns,
    ) -> Self {
        Self {
            table,
            text: TextForm::default(),
            time,
            gyro,
            accel,
            accel_clock: None,
            table_angle: None,
            table_rate: None,
            temperature: None,
            gaps: None,
        }
    }
}

/// The form of a log's text.
fn text_form(log: &Section<'_>, table: Table) -> Result<TextForm, IoError> {
    if !matches!(table, Table::Text | Table::Numbers) {
        refuse_own(log, &TEXT_KEYS, "only columns of text have it")?;
    }
    let decimals = [(".", Decimal::Point), (",", Decimal::Comma)];
    let skip =
        log.count("skip", "a number of lines before the header or the first row, such as 12")?;
    Ok(TextForm { decimal: log.choice("decimal", &decimals)?.unwrap_or_default(), skip })
}

/// Adds the columns other than the IMU's.
fn others(log: &Section<'_>, folder: &Path, imu: ColumnSpec) -> Result<ColumnSpec, IoError> {
    let text = text_form(log, imu.table)?;
    let table_angle = table_columns::angle(log, folder, imu.time.as_ref())?;
    let table_rate = table_columns::rate(log)?;
    let gaps = [("accumulated", Gaps::Accumulated), ("held", Gaps::Held)];
    let gaps = log.choice("gaps", &gaps)?;
    let temperature = temperature(log, folder, imu.time.as_ref())?;
    Ok(ColumnSpec { text, table_angle, table_rate, temperature, gaps, ..imu })
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
            return Err(
                section.conflict("time", "a temperature in the log itself has the time of the log")
            );
        }
        None => None,
        Some(path) => {
            let Some(TimeUnit::Seconds(unit)) = log_time.map(|time| time.unit) else {
                let reason = "needs a log with a time in s, ms, us or ns to be compared with";
                return Err(section.conflict("path", reason));
            };
            let column = column(&section, "time")?;
            let unit = TimeUnit::Seconds(unit);
            let time = TimeColumn { column, unit, split: None, stamp: Stamp::End };
            Some((folder.join(path), time))
        }
    };
    let column = column(&section, "column")?;
    match section.choice("unit", &[("degC", 0.0), ("K", -273.15)])? {
        Some(offset) => Ok(Some(TemperatureColumn { file, column, offset })),
        None => Err(section.missing("unit", r#""degC" or "K""#)),
    }
}
