//! The command line.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use rins::ModelChoice;
use rins_io::{LogFile, Overwrite};

use crate::choices::Noise;

mod calibrate;
mod campaign;
mod design;
mod history;
mod mission;
mod observe;
mod repeated;

pub(crate) use self::calibrate::{Calibrate, LiveSource};
pub(crate) use self::campaign::{Merge, MonteCarlo};
pub(crate) use self::design::Design;
pub(crate) use self::history::History;
pub(crate) use self::mission::Mission;
pub(crate) use self::observe::Observe;
use self::repeated::twice;

/// Simulate, check, align, navigate and calibrate an IMU on a single-axis rate table.
///
/// A rig file (rig.toml) describes a run: the log, the site, the table and the data sheets of the sensors.
/// `rins init LOG` drafts one. Start with `rins demo`.
#[derive(Debug, Parser)]
#[command(name = "rins", version, max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Print the result as one JSON object on standard output
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Overwrite existing results
    #[arg(long, global = true)]
    pub(crate) force: bool,
}

impl Arguments {
    /// The command line, or why it cannot be meant; help and version are refusals with exit code 0.
    pub(crate) fn read(words: impl IntoIterator<Item = OsString>) -> Result<Self, clap::Error> {
        let arguments = Self::try_parse_from(words)?;
        let refusal = match &arguments.command {
            Command::Calibrate(calibrate) => calibrate.refusal().map(|why| ("calibrate", why)),
            Command::Diagnose(diagnose) => {
                twice(diagnose.rigs.iter().chain(&diagnose.held_out)).map(|why| ("diagnose", why))
            }
            _ => None,
        };
        if let Some((name, (kind, message))) = refusal {
            let mut command = Self::command();
            command.build();
            let of = command.find_subcommand_mut(name).expect("the command has just been read");
            return Err(of.error(kind, message));
        }
        Ok(arguments)
    }

    pub(crate) const fn overwrite(&self) -> Overwrite {
        if self.force { Overwrite::Force } else { Overwrite::Refuse }
    }
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Calibrate, compensate and navigate a built-in example run; no input files needed
    Demo(Demo),
    /// Draft a rig file from a log; guesses are marked for you to confirm
    Init(Init),
    /// Write a simulated data set (run.csv, rig.toml, truth.json) from a scenario
    Simulate(Simulate),
    /// Write a log in another format, and a matching rig file
    Convert(Convert),
    /// Inspect a run: sampling rate, gaps, static intervals, gravity, Earth rate, probable errors of units, signs and axes
    Check(Input),
    /// Estimate the noise parameters from a static interval, with Allan deviations and their 95 % confidence bounds
    Allan(Input),
    /// Align over a static interval: level from gravity, north from the Earth's rotation
    Align(Input),
    /// Free inertial navigation from standstill, with or without a calibration
    Navigate(Navigate),
    /// Estimate sensor errors from runs on the table, with navigation before and after compensation
    Calibrate(Calibrate),
    /// Identify unmodeled effects in a run, and measure the gain in predicting held-out data
    ///
    /// The model is estimated. Hypotheses of one or several effects of the catalogue, at all event times and harmonic orders, are then
    /// compared by their marginal likelihood times their prior probability: effects are added, dropped and exchanged until no change
    /// is more probable. The result states the p-value of each effect and its credible set of alternatives. In several runs, errors of
    /// the sensors that differ between the runs are hypotheses too. Residual structure that no effect explains is reported as such. An
    /// error of units, signs or axes ends the command; the message states the correction.
    Diagnose(Diagnose),
    /// Predict the observability of parameters under a rotation schedule, and propose the schedule to run next
    ///
    /// The Fisher information of a run on the parameters of a model is computed from the scenario's motion, site and data
    /// sheet, without simulated noise and errors. For each parameter the result is its observability (by itself, or in a
    /// combination), its sigma from the data alone, and its sigma with the data sheet as prior.
    ///
    /// Several scenarios are runs of one IMU: the parameters of the sensors are common to all runs; attitude, turn-on
    /// biases and the parameters of the encoder and the base are separate for each run. An effect is named by its id, or by that
    /// of one of its parameters (accel.bias.x).
    ///
    /// Two effects are separated if the part of the signature of each, at its typical magnitude, that neither the other
    /// effect nor the model parameters can explain is at least 6 sigma, in the least favorable direction.
    Observe(Observe),
    /// Optimize a rotation schedule for a parameter, a position error in service, a set of parameters, or two effects
    ///
    /// The schedule consists of rotations and static intervals in up to N orientations of the spin axis, within the limits of the table
    /// and the duration. The share of each is optimized on the Fisher information; the gap of the equivalence theorem bounds what any
    /// other schedule of them gains. The shares are rounded to a profile that the table can run, whose information is computed exactly.
    /// The result compares it with the given schedule and with usual ones of the same duration.
    ///
    /// All runs are of one power-on: the turn-on biases are the same in each.
    Design(Design),
    /// Simulate and calibrate a scenario many times to test the consistency of the covariances (NEES)
    MonteCarlo(MonteCarlo),
    /// Merge the partial results of a Monte Carlo campaign
    Merge(Merge),
    /// Write a log compensated by a calibration, and a matching rig file
    Apply(Apply),
    /// Compare two calibrations of one IMU: differences in units of their standard uncertainty
    Compare(Compare),
    /// Test whether parameters are the same in several runs, name how they vary (drift, warm-up, temperature, turn-on), and predict the
    /// next run
    ///
    /// Compares the estimates of bias, scale error and misalignment from several runs.
    ///
    /// Each parameter is tested for homogeneity: is it the same in all runs? Hypotheses of how it varies are compared by their marginal
    /// likelihood: linear drift over the date or since power-on, exponential warm-up, a polynomial of temperature, thermal hysteresis, turn-on
    /// repeatability, a random walk, a change at a date, a run or a unit unlike the others. Each cause has a credible set of alternatives. The
    /// forecast of the next run is the mean over all hypotheses.
    ///
    /// The conditions come from the rig files, [run] serial, series (one name for each power-on) and started, and from the
    /// temperature of the logs.
    History(History),
    /// Predict the position error of a system after days in service, for several schemes of rotation
    ///
    /// The mission file states the site, the carrier's legs and sway, the schemes and the errors: [errors] has errors of a certain size,
    /// [imu] a data sheet. The errors are propagated linearly, with the Schuler, Foucault and Earth-rate oscillations and the growth of the
    /// longitude. The result has the position error east and north by the stated errors, and CEP50, CEP95 and TRMS by the uncertainties of
    /// the data sheet, or by what a calibration leaves.
    ///
    /// With --runs, missions with drawn errors are navigated by strapdown as well. With --want, the result states which standard deviations of
    /// the sensor errors hold a wanted position error.
    Mission(Mission),
    /// Print a script that completes commands, options and file names in a shell
    ///
    /// For bash: rins completions bash > ~/.local/share/bash-completion/completions/rins
    Completions(Completions),
    /// Write a man page of each command
    #[command(hide = true)]
    Man(ManPages),
}

#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// The shell
    #[arg(value_enum)]
    pub(crate) shell: Shell,
}

#[derive(Debug, Args)]
pub(crate) struct ManPages {
    /// Output folder
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct Demo {
    /// Output folder
    #[arg(short, long, value_name = "DIR", default_value = "rins-demo")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct Init {
    /// The log: CSV text or a PSINS text log
    pub(crate) log: PathBuf,
    /// The rig file; by default it is printed
    #[arg(short, long, value_name = "RIG")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct Simulate {
    /// The scenario: a rig file with a section [truth] (errors, effects, temperature, noise, seed)
    pub(crate) scenario: PathBuf,
    /// Folder for the run
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Seed of the random numbers; by default the scenario's
    #[arg(long)]
    pub(crate) seed: Option<u64>,
}

#[derive(Debug, Args)]
pub(crate) struct Convert {
    /// The rig file
    pub(crate) rig: PathBuf,
    /// The new log; its rig file has the same name with the extension .toml
    #[arg(short, long, value_name = "LOG")]
    pub(crate) output: PathBuf,
    /// The format; by default the extension decides: .csv, .parquet, .mat, .imu (psins) or .bin (psins-bin)
    #[arg(long, value_enum)]
    pub(crate) format: Option<Format>,
}

/// The formats that logs are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Text with a header
    Csv,
    /// A Parquet file
    Parquet,
    /// MATLAB level 5 matrices
    Mat,
    /// A PSINS text log
    Psins,
    /// PSINS binary: rows [wm vm t] of float64
    PsinsBin,
    /// KF-GINS text
    KfGins,
    /// EuRoC and Kalibr CSV
    Euroc,
}

impl From<Format> for LogFile {
    fn from(format: Format) -> Self {
        match format {
            Format::Csv => Self::Csv,
            Format::Parquet => Self::Parquet,
            Format::Mat => Self::Mat,
            Format::Psins => Self::Psins,
            Format::PsinsBin => Self::PsinsBinary,
            Format::KfGins => Self::KfGins,
            Format::Euroc => Self::Euroc,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct Input {
    /// The rig file
    pub(crate) rig: PathBuf,
    /// Output folder for result.json, report.html and other files
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct Navigate {
    #[command(flatten)]
    pub(crate) input: Input,
    /// Calibration file; the readings are compensated with it before navigation
    #[arg(long, value_name = "FILE")]
    pub(crate) calibration: Option<PathBuf>,
    /// Compensate even if the temperature is outside the calibrated range by more than the width of this range
    #[arg(long, requires = "calibration")]
    pub(crate) extrapolate: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Diagnose {
    /// The rig files: one, or several runs of one IMU
    #[arg(required = true, value_name = "RIG")]
    pub(crate) rigs: Vec<PathBuf>,
    /// Folder for result.json, report.html, model.toml (the extended model) and calibration.toml
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
    /// Measure the predictive gain on this held-out run; by default on the last 30 % of every segment
    #[arg(long, value_name = "RIG")]
    pub(crate) held_out: Option<PathBuf>,
    /// Measure the predictive gain also at the fastest rate of the table, with estimates from the slower rates
    #[arg(long)]
    pub(crate) transfer: bool,
    /// The model: full (biases, scale errors, misalignments, attitude of the spin axis), or a model file
    #[arg(long, default_value = "full", value_parser = ModelChoice::parse_estimated)]
    pub(crate) model: ModelChoice,
    /// Evaluate the effects of this model file instead of a search
    #[arg(long, alias = "suppose", value_name = "FILE")]
    pub(crate) hypothesis: Option<PathBuf>,
    /// Source of the noise parameters
    #[arg(long, value_enum, default_value_t = Noise::Likely)]
    pub(crate) noise: Noise,
    /// Estimate the false alarm rate: simulate DRAWS runs with the extended model and the estimated noise, diagnose each of them,
    /// and report the fraction in which anything is found. This takes DRAWS times as long as the diagnosis, on all cores
    #[arg(long, value_name = "DRAWS", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) bootstrap: Option<u32>,
}

#[derive(Debug, Args)]
pub(crate) struct Apply {
    /// The rig file
    pub(crate) rig: PathBuf,
    /// The calibration file
    #[arg(long, value_name = "FILE")]
    pub(crate) calibration: PathBuf,
    /// The new log; its rig file has the same name with the extension .toml
    #[arg(short, long, value_name = "LOG")]
    pub(crate) output: PathBuf,
    /// The format; by default the extension decides: .csv, .parquet, .mat, .imu (psins) or .bin (psins-bin)
    #[arg(long, value_enum)]
    pub(crate) format: Option<Format>,
    /// Compensate even if the temperature is outside the calibrated range by more than the width of this range
    #[arg(long)]
    pub(crate) extrapolate: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Compare {
    /// Earlier calibration file
    pub(crate) before: PathBuf,
    /// Later calibration file
    pub(crate) after: PathBuf,
    /// Folder for result.json and report.html
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

impl Command {
    /// The folder of the results, if there is one.
    pub(crate) fn folder(&self) -> Option<&Path> {
        match self {
            Self::Demo(demo) => Some(&demo.output),
            Self::Simulate(simulate) => Some(&simulate.output),
            // These write their one or two files themselves.
            Self::Init(_)
            | Self::Convert(_)
            | Self::MonteCarlo(_)
            | Self::Merge(_)
            | Self::Apply(_)
            | Self::Completions(_) => None,
            Self::Check(input) | Self::Allan(input) | Self::Align(input) => input.output.as_deref(),
            Self::Navigate(navigate) => navigate.input.output.as_deref(),
            Self::Observe(observe) => observe.output.as_deref(),
            Self::Design(design) => design.output.as_deref(),
            Self::Calibrate(calibrate) => calibrate.output.as_deref(),
            Self::Diagnose(diagnose) => diagnose.output.as_deref(),
            Self::Compare(compare) => compare.output.as_deref(),
            Self::History(history) => history.output.as_deref(),
            Self::Mission(mission) => mission.output.as_deref(),
            Self::Man(pages) => Some(&pages.output),
        }
    }
}
