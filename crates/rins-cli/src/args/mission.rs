//! The arguments of `rins mission`.

use std::path::PathBuf;

use clap::Args;
use rins::mission::WantedFigure;

#[derive(Debug, Args)]
pub(crate) struct Mission {
    /// Mission file
    #[arg(value_name = "MISSION")]
    pub(crate) file: PathBuf,
    /// Calibration file: the sensor errors that are left have its covariance, those that it does not state that of the data sheet
    #[arg(long, value_name = "FILE")]
    pub(crate) calibration: Option<PathBuf>,
    /// Number of missions with drawn errors that are navigated by strapdown for each scheme, beside the linear propagation
    #[arg(long, value_name = "N")]
    pub(crate) runs: Option<u32>,
    /// Seed of the drawn errors
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Position error that is to be held, such as "1 nmi / 24 h" (TRMS): the standard deviations that hold it
    #[arg(long, value_name = "FIGURE", value_parser = WantedFigure::parse)]
    pub(crate) want: Option<WantedFigure>,
    /// Folder for result.json and report.html
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}
