//! The arguments of `rins mission`.

use std::path::PathBuf;

use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct Mission {
    /// Mission file
    #[arg(value_name = "MISSION")]
    pub(crate) file: PathBuf,
    /// Calibration file: the sensor errors that are left have its covariance, those that it does not state that of the data sheet
    #[arg(long, value_name = "FILE")]
    pub(crate) calibration: Option<PathBuf>,
    /// Folder for result.json and report.html
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}
