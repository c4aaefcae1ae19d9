//! The arguments of `rins history`.

use std::path::PathBuf;

use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct History {
    /// Calibration files, rig files (each log is calibrated by itself with the full model), or folders of these
    #[arg(required = true, value_name = "PATH")]
    pub(crate) runs: Vec<PathBuf>,
    /// Date of the run to be predicted, such as 2027-01-31T00:00:00Z; by default the median interval of the runs after the last one
    #[arg(long, value_name = "DATE", value_parser = date)]
    pub(crate) date: Option<f64>,
    /// Its temperature in degC; by default the median of the runs
    #[arg(long, value_name = "DEGC", allow_negative_numbers = true, value_parser = finite)]
    pub(crate) temperature: Option<f64>,
    /// Its time since power-on in minutes; by default the median of the runs
    #[arg(long, value_name = "MIN", value_parser = finite)]
    pub(crate) minutes_since_power_on: Option<f64>,
    /// Folder for result.json and report.html
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

/// A date with its offset from UTC, in seconds since 1970.
fn date(text: &str) -> Result<f64, String> {
    rins::io::date_seconds(text).ok_or_else(|| {
        "expected a date and time with its offset from UTC, such as 2027-01-31T00:00:00Z".into()
    })
}

/// A finite number.
fn finite(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| "expected a finite number".into())
}
