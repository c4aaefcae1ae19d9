//! The arguments of `rins history`.

use std::path::PathBuf;

use clap::Args;

/// Compares the estimates of bias, scale error and misalignment from several runs.
///
/// Each parameter is tested for homogeneity: is it the same in all runs? Hypotheses of how it varies are compared by their marginal
/// likelihood: linear drift over the date or since power-on, exponential warm-up, a polynomial of temperature, thermal hysteresis, turn-on
/// repeatability, a random walk, a change at a date, a run or a unit unlike the others. Each cause has a credible set of alternatives. The
/// forecast of the next run is the mean over all hypotheses.
///
/// The conditions come from the rig files, [run] serial, series (one name for each power-on) and started, and from the
/// temperature of the logs.
#[derive(Debug, Args)]
pub(crate) struct History {
    /// Calibration files, rig files (each log is calibrated by itself with the full model), or folders of these
    #[arg(required = true, value_name = "PATH")]
    pub(crate) runs: Vec<PathBuf>,
    /// Date of the run to be predicted, such as 2027-01-31T00:00:00Z; by default the median interval of the runs after the last one
    #[arg(long, value_name = "DATE", value_parser = date)]
    pub(crate) date: Option<f64>,
    /// Its temperature \[degC\]; by default the median of the runs
    #[arg(long, value_name = "DEGC", allow_negative_numbers = true, value_parser = finite)]
    pub(crate) temperature: Option<f64>,
    /// Its time since power-on \[min\]; by default the median of the runs
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
