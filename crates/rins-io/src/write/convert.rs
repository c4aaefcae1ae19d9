//! Conversion of a log to another format, with a new rig file.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use rins_frames::units::{DEG, PPM};

use super::compare::{Difference, differences};
use super::exact::inverted;
use super::rig_text::{column_keys, figures, matrix_keys, push_table};
use super::{LogFile, to_own_axes, write_log};
use crate::document::{Document, Entry, Node};
use crate::error::{IoError, OutputProblem};
use crate::log::{Loaded, LogPolicy, LogSummary, read_log};
use crate::output::{Overwrite, write_files};
use crate::rig::{Axes, LogFormat, Rig};

/// The outcome of a conversion.
#[derive(Clone, Debug, PartialEq)]
pub struct Converted {
    /// The rig file of the new log.
    pub rig: PathBuf,
    /// The original rig file.
    pub old: Rig,
    /// The findings while reading the original log.
    pub summary: LogSummary,
    /// The number of samples.
    pub samples: usize,
    /// The signals that the format cannot contain.
    pub left_out: Vec<&'static str>,
    /// The signals that are not bit-identical when the new log is read.
    pub differences: Vec<Difference>,
    /// The offset that is added to the new log's times to get those of the original \[s\].
    pub time_origin: f64,
}

/// Writes the log of the rig file at `rig` to `log` in another format, and its new rig file beside it,
/// with the extension `toml`.
///
/// The axes of the new log are the sensors' own body axes, right, front and up, or those of its format, whatever the spin axis;
/// the new rig file keeps `[axis]`. The new log is read before it is moved to its place, and every signal that is not
/// bit-identical is reported.
///
/// # Errors
/// [`IoError`] if the run cannot be read, if the format cannot represent it, or if the files cannot be
/// written to their destination. Nothing has then changed.
pub fn convert(
    rig: &Path,
    log: &Path,
    format: LogFile,
    overwrite: Overwrite,
) -> Result<Converted, IoError> {
    convert_changed(rig, log, format, overwrite, |_| Ok("Written by `rins convert`.".into()))
}

/// The same after a modification of the run by `change`, which returns the first line of the new rig file.
///
/// Signals are compared with the run after its modification.
///
/// # Errors
/// As for [`convert`], and the errors of `change`.
pub fn convert_changed<E: From<IoError>>(
    rig: &Path,
    log: &Path,
    format: LogFile,
    overwrite: Overwrite,
    change: impl FnOnce(&mut Loaded) -> Result<String, E>,
) -> Result<Converted, E> {
    let document = Document::read(rig)?;
    let mut loaded = read_log(Rig::read(rig)?, LogPolicy::default())?;
    let opening = change(&mut loaded)?;
    let new_rig = log.with_extension("toml");
    let Some(log_name) = log.file_name().unwrap_or_default().to_str() else {
        let problem = OutputProblem::NotText;
        return Err(IoError::Output { path: log.into(), problem }.into());
    };
    refuse_inputs(&loaded, &[log, &new_rig])?;
    let (loaded, commanded) = without_commanded(loaded);
    let description = Description { document: &document, loaded: &loaded, format, opening };
    let mut least_differences = Vec::new();
    write_files(&[log, &new_rig], overwrite, |folder| {
        let place = folder.join(log_name);
        let staged = place.with_extension("toml");
        let file = File::create(&place).map_err(IoError::file("write", log))?;
        let mut out = BufWriter::with_capacity(1 << 16, file);
        write_log(&along_own_axes(&loaded), format, log, &mut out)?;
        out.into_inner().map_err(|error| IoError::file("write", log)(error.into_error()))?;
        let mut least: Option<(String, Vec<Difference>)> = None;
        for rate in description.rates() {
            let text = description.rig_toml(log_name, rate);
            fs::write(&staged, &text).map_err(IoError::file("write", &new_rig))?;
            let again = Rig::read(&staged).and_then(|rig| read_log(rig, LogPolicy::default()));
            let again = match (again, &least) {
                (Ok(again), _) => again,
                // The other rate is only a second attempt.
                (Err(_), Some(_)) => continue,
                (Err(error), None) => return Err(error),
            };
            let found =
                differences(&loaded.recording, &again.recording, commanded.as_deref(), format);
            if least.as_ref().is_none_or(|(_, before)| found.len() < before.len()) {
                least = Some((text, found));
            }
            if least.as_ref().is_some_and(|(_, found)| found.is_empty()) {
                break;
            }
        }
        if let Some((text, found)) = least {
            fs::write(&staged, text).map_err(IoError::file("write", &new_rig))?;
            least_differences = found;
        }
        Ok(())
    })?;
    let time_origin = if format == LogFile::Euroc { 0.0 } else { loaded.summary.time_origin };
    let left_out = description.left_out();
    let differences = least_differences;
    Ok(Converted {
        rig: new_rig,
        samples: loaded.recording.len(),
        old: loaded.rig,
        summary: loaded.summary,
        left_out,
        differences,
        time_origin,
    })
}

/// The run with its readings along the sensors' own axes.
fn along_own_axes(loaded: &Loaded) -> Cow<'_, Loaded> {
    if loaded.rig.spin == Axes::IDENTITY {
        return Cow::Borrowed(loaded);
    }
    let mut own = loaded.clone();
    to_own_axes(&mut own.recording, &loaded.rig.spin);
    Cow::Owned(own)
}

/// Refuses outputs that would overwrite inputs.
fn refuse_inputs(loaded: &Loaded, outputs: &[&Path]) -> Result<(), IoError> {
    let mut inputs = vec![loaded.rig.path.as_path(), loaded.rig.log.path.as_path()];
    if let LogFormat::Columns(columns) = &loaded.rig.log.format {
        inputs.extend([columns.gyro.path.as_path(), columns.accel.path.as_path()]);
        let temperature = columns.temperature.as_ref().and_then(|column| column.file.as_ref());
        inputs.extend(temperature.map(|(path, _)| path.as_path()));
    }
    let inputs: Vec<PathBuf> = inputs.iter().filter_map(|path| path.canonicalize().ok()).collect();
    for output in outputs {
        if output.canonicalize().is_ok_and(|output| inputs.contains(&output)) {
            let problem = OutputProblem::IsInput;
            return Err(IoError::Output { path: output.to_path_buf(), problem });
        }
    }
    Ok(())
}

/// The run without table rates that the profile of its rig file repeats, and these rates.
fn without_commanded(mut loaded: Loaded) -> (Loaded, Option<Vec<f64>>) {
    let measured = match &loaded.rig.log.format {
        LogFormat::Columns(columns) => columns.table_rate.is_some(),
        LogFormat::Psins => false,
    };
    // A profile begins with its log, whose start may have been cut off.
    let whole = loaded.summary.redivided.is_none_or(|redivided| redivided.late <= 0.0);
    let commanded = if measured || !whole { None } else { loaded.recording.table_rate.take() };
    (loaded, commanded)
}

/// A run with the content of its new rig file.
struct Description<'d> {
    document: &'d Document,
    loaded: &'d Loaded,
    format: LogFile,
    /// The first line of its rig file.
    opening: String,
}

impl Description<'_> {
    /// The rates that the new rig file may state so that the first interval is unchanged \[Hz\].
    fn rates(&self) -> Vec<Option<f64>> {
        let first = self.loaded.recording.increments.first().map(|sample| sample.interval);
        let of_first = first.and_then(|interval| inverted(interval, 1.0 / interval, f64::recip));
        let stated = self.loaded.rig.log.rate;
        let mut rates = vec![stated, None, of_first];
        rates.dedup();
        rates
    }

    fn left_out(&self) -> Vec<&'static str> {
        if self.format.holds_more_than_the_imu() {
            return Vec::new();
        }
        super::signals::others(&self.loaded.recording).into_iter().map(|(name, _)| name).collect()
    }

    fn rig_toml(&self, log_name: &str, rate: Option<f64>) -> String {
        let Self { document, loaded, opening, .. } = self;
        let mut text = format!("# {}\n", opening.replace(char::is_control, " "));
        if loaded.rig.station.is_none() {
            let site = loaded.station.site;
            let angle = |angle: f64| match inverted(angle, angle / DEG, |degrees| degrees * DEG) {
                Some(degrees) => format!("{degrees} deg"),
                None => format!("{angle} rad"),
            };
            let (latitude, longitude) = (angle(site.latitude), angle(site.longitude));
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "\n[site]\nlatitude = \"{latitude}\"\nlongitude = \"{longitude}\"\nheight = \"{} m\"",
                site.height
            );
        }
        let profile_is_void =
            loaded.summary.redivided.is_some_and(|redivided| redivided.late > 0.0);
        for Entry { key, value, .. } in &document.root {
            match (key.as_str(), &value.node) {
                ("log", Node::Table(entries)) => {
                    let angle = entries.iter().find(|entry| entry.key == "table_angle");
                    let angle = angle.map_or_else(String::new, |entry| figures(&entry.value));
                    text.push_str(&self.log_keys(log_name, rate, &angle));
                }
                ("table", Node::Table(entries)) if profile_is_void => {
                    let is_kept =
                        |entry: &&Entry| entry.key == "wobble" || entry.key.ends_with("_accuracy");
                    let kept: Vec<Entry> = entries.iter().filter(is_kept).cloned().collect();
                    push_table(&mut text, "table", &kept);
                }
                (key, Node::Table(entries)) => push_table(&mut text, key, entries),
                _ => {}
            }
        }
        text
    }

    fn log_keys(&self, log_name: &str, rate: Option<f64>, angle: &str) -> String {
        let recording = &self.loaded.recording;
        let mut keys = format!("\n[log]\npath = {log_name:?}\nformat = {:?}\n", self.format.name());
        if let Some(rate) = rate {
            let _ = writeln!(keys, "rate = \"{rate} Hz\"");
        }
        if let Some(clock) = self.loaded.rig.accuracy.clock {
            let _ = writeln!(keys, "clock_accuracy = \"{} ppm\"", clock / PPM);
        }
        match self.format {
            LogFile::Csv | LogFile::Parquet => keys.push_str(&column_keys(recording, angle)),
            LogFile::Mat => keys.push_str(&matrix_keys(recording, angle)),
            _ => {}
        }
        let holds_rates = self.format == LogFile::Euroc;
        if !(self.loaded.summary.gaps.is_empty() || holds_rates || self.format == LogFile::Psins) {
            keys.push_str("gaps = \"accumulated\"\n");
        }
        // A format without a time column counts from the start of the log.
        let spans = &self.loaded.rig.log.static_spans;
        if matches!(self.format, LogFile::Csv | LogFile::Parquet | LogFile::Mat)
            && !spans.is_empty()
        {
            let spans: Vec<String> =
                spans.iter().map(|[from, to]| format!("[\"{from} s\", \"{to} s\"]")).collect();
            let _ = writeln!(keys, "static = [{}]", spans.join(", "));
        }
        keys
    }
}
