//! The arguments of `rins calibrate`.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::{Args, ValueEnum};
use rins::ModelChoice;

use super::repeated::twice;
use crate::choices::Noise;

#[derive(Debug, Args)]
pub(crate) struct Calibrate {
    /// The rig files: one, or several runs of one IMU
    #[arg(required = true, value_name = "RIG")]
    pub(crate) rigs: Vec<PathBuf>,
    /// Folder for result.json and report.html, and without --live calibration.toml and model.toml
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
    /// The model: paper12 (`M_xz`, `M_yz` and `S_z` by the 12-state filter of Nie et al. (2019)), full (biases, scale errors,
    /// misalignments, attitude of the spin axis), or a model file; by default paper12 for one run with an encoder angle
    /// or a commanded table rate and a known attitude of the axis, and full otherwise
    #[arg(long, value_parser = ModelChoice::parse)]
    pub(crate) model: Option<ModelChoice>,
    /// Source of the noise parameters; paper12 always uses the data sheet
    #[arg(long, value_enum, default_value_t = Noise::Likely)]
    pub(crate) noise: Noise,
    /// Calibrate while the log is written: `--live` follows the growing log of the rig file, `--live=-` reads its rows from standard
    /// input. The model is full or a model file; the noise parameters are those of the data sheet
    #[arg(
        long,
        value_enum,
        value_name = "SOURCE",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "log"
    )]
    pub(crate) live: Option<LiveSource>,
    #[command(flatten, next_help_heading = "Options of --live")]
    pub(crate) live_options: Live,
}

/// The source of the rows of a live log.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LiveSource {
    /// The log that the rig file names
    Log,
    /// Standard input
    #[value(name = "-")]
    Stdin,
}

#[derive(Debug, Args)]
pub(crate) struct Live {
    /// File for the state of the filter, which is written again and again
    #[arg(long, requires = "live", value_name = "FILE")]
    pub(crate) checkpoint: Option<PathBuf>,
    /// Continue from the checkpoint; rows up to its time are passed over
    #[arg(long, requires = "checkpoint")]
    pub(crate) resume: bool,
    /// Show the estimates on a page at this address while the command runs; by default only for this computer
    #[arg(
        long,
        requires = "live",
        value_name = "ADDRESS",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "127.0.0.1:8080"
    )]
    pub(crate) serve: Option<SocketAddr>,
    /// Interval of the lines and of the checkpoints
    #[arg(long, requires = "live", value_name = "SECONDS", default_value_t = 1.0, value_parser = seconds)]
    pub(crate) every: f64,
    /// End if no row comes for this time
    #[arg(long, requires = "live", value_name = "SECONDS", default_value_t = 10.0, value_parser = seconds)]
    pub(crate) idle: f64,
    /// Duration of the samples at the start from which the attitude of the axis is found
    #[arg(long, requires = "live", value_name = "SECONDS", default_value_t = 10.0, value_parser = seconds)]
    pub(crate) start: f64,
    /// Expected duration of the run: epochs are then those of a finished run of this duration; by default 0.1 s
    #[arg(long, requires = "live", value_name = "SECONDS", value_parser = seconds)]
    pub(crate) duration: Option<f64>,
}

/// A time of more than zero \[s\].
fn seconds(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| (1e-3..=1e9).contains(number));
    number.ok_or_else(|| "expected a number of seconds from 0.001 to 1e9".into())
}

impl Calibrate {
    /// Why this command line cannot be meant, if it cannot.
    pub(super) fn refusal(&self) -> Option<(ErrorKind, String)> {
        let conflict = |message: &str| Some((ErrorKind::ArgumentConflict, message.into()));
        if self.rigs.len() > 1 && self.model == Some(ModelChoice::Paper12) {
            return conflict("--model paper12 takes one rig; full takes several");
        }
        if self.live.is_some() && self.rigs.len() > 1 {
            return conflict("--live takes one rig");
        }
        if self.live.is_some() && self.model == Some(ModelChoice::Paper12) {
            return conflict(
                "--model paper12 takes a finished log; --live takes full or a model file",
            );
        }
        twice(self.rigs.iter())
    }
}
