//! Conversion of a log to another format, with a new rig file.

use std::fmt;
use std::path::{Path, PathBuf};

use rins_io::{Converted, LogFile, Overwrite, shown};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::basis::BasisResult;
use crate::error::Result;
use crate::log::repairs;
use crate::outcome::Outcome;

/// The options of [`convert`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConvertOptions {
    /// The new log; its rig file lies beside it and ends in `.toml`.
    pub output: PathBuf,
    /// The format of the new log; by default it follows from the extension of its name.
    pub format: Option<LogFile>,
    /// Whether existing files may be replaced.
    pub overwrite: Overwrite,
}

/// A log that was converted to another format.
#[derive(Debug)]
pub struct Conversion {
    rig: String,
    output: PathBuf,
    format: LogFile,
    converted: Converted,
    basis: BasisResult,
}

/// The result of `rins convert`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConvertResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `convert`.
    pub command: String,
    /// The rig file.
    pub rig: String,
    /// The new log.
    pub log: String,
    /// The rig file of the new log.
    pub new_rig: String,
    /// The format of the new log.
    pub format: String,
    /// How many samples were written.
    pub samples: usize,
    /// Whether the new log, read again, is the same to the last bit.
    pub exact: bool,
    /// What differs when it is read again.
    pub differences: Vec<DifferenceResult>,
    /// What the format has no room for.
    pub left_out: Vec<String>,
    /// The time of the log from which the new one counts \[s\].
    pub time_origin_s: f64,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// A signal that differs when a new log is read again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DifferenceResult {
    /// The signal.
    pub signal: String,
    /// How many of its numbers differ.
    pub numbers: usize,
    /// The largest difference, in the signal's SI unit; null if it is no number.
    pub largest: Option<f64>,
}

/// Converts a log to another format, and writes its new rig file.
///
/// # Errors
/// If a file cannot be read or written, or the format does not follow from the name of the new log.
///
/// ```
/// use rins::{ConvertOptions, Outcome, Overwrite};
/// let folder = tempfile::tempdir()?;
/// rins::demo::log(folder.path())?;
/// let output = folder.path().join("run.parquet");
/// let options = ConvertOptions { output, format: None, overwrite: Overwrite::Refuse };
/// let conversion = rins::convert(&folder.path().join("rig.toml"), options)?;
/// assert!(conversion.result().exact);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn convert(rig: &Path, options: ConvertOptions) -> Result<Conversion> {
    let ConvertOptions { output, format, overwrite } = options;
    let format = format_of(&output, format)?;
    let converted = rins_io::convert(rig, &output, format, overwrite)?;
    let basis = basis_of(&converted)?;
    Ok(Conversion { rig: shown(rig), output, format, converted, basis })
}

impl fmt::Display for Conversion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "Converted {} to {}\n  {} samples as {}, read by {}",
            self.rig,
            shown(&self.output),
            self.converted.samples,
            self.format.name(),
            shown(&self.converted.rig)
        )?;
        remarks(&self.converted).into_iter().try_for_each(|line| writeln!(f, "  {line}"))
    }
}

impl Outcome for Conversion {
    type Result = ConvertResult;

    fn result(&self) -> ConvertResult {
        let converted = &self.converted;
        let differences = converted.differences.iter().map(|difference| DifferenceResult {
            signal: difference.signal.to_string(),
            numbers: difference.numbers,
            largest: difference.largest.is_finite().then_some(difference.largest),
        });
        ConvertResult {
            schema: crate::SCHEMA,
            command: "convert".into(),
            rig: self.rig.clone(),
            log: shown(&self.output),
            new_rig: shown(&converted.rig),
            format: self.format.name().into(),
            samples: converted.samples,
            exact: converted.differences.is_empty(),
            differences: differences.collect(),
            left_out: converted.left_out.iter().map(|name| (*name).to_owned()).collect(),
            time_origin_s: converted.time_origin,
            basis: self.basis.clone(),
        }
    }

    fn basis(&self) -> BasisResult {
        self.basis.clone()
    }
}

/// The basis of a converted log.
pub(crate) fn basis_of(converted: &Converted) -> anyhow::Result<BasisResult> {
    let Converted { old, summary, .. } = converted;
    let basis = BasisResult::of_rig(old, old.input_files()?);
    Ok(BasisResult { repairs: repairs(old, summary), ..basis })
}

/// The format of a new log: the given one, or that of the extension of its name.
pub(crate) fn format_of(output: &Path, said: Option<LogFile>) -> anyhow::Result<LogFile> {
    if let Some(format) = said {
        return Ok(format);
    }
    LogFile::of(output).ok_or_else(|| {
        let names: Vec<&str> = LogFile::ALL.iter().map(|format| format.name()).collect();
        anyhow::anyhow!(
            "{}: the file name has no known extension; state --format, one of {}",
            shown(output),
            names.join(", ")
        )
    })
}

/// Remarks on the written log.
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
