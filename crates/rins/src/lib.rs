//! Calibration and diagnosis of a rotational INS from the log of an IMU on a rate table: the library for users.
//!
//! | question | function | result |
//! | --- | --- | --- |
//! | what does this log contain? | [`init`](init()) | [`InitResult`](init::InitResult) |
//! | what is wrong with this log? | [`check`](check()) | [`CheckResult`](check::CheckResult) |
//! | how noisy is the IMU? | [`allan`](allan()) | [`AllanResult`](allan::AllanResult) |
//! | what is its attitude? | [`align`](align()) | [`AlignResult`](align::AlignResult) |
//! | which errors does free navigation reach? | [`navigate`](navigate()) | [`NavigateResult`](navigate::NavigateResult) |
//! | which errors does the IMU have? | [`calibrate`](calibrate()) | [`CalibrateResult`](calibrate::CalibrateResult) |
//! | which errors, while the log is written? | [`live::LiveCalibration`] | [`LiveResult`](live::LiveResult) |
//! | which effects are unmodeled? | [`diagnose`](diagnose()) | [`DiagnoseResult`](diagnose::DiagnoseResult) |
//! | what is observable under a schedule? | [`observe`](observe()) | [`ObserveResult`](observe::ObserveResult) |
//! | which schedule is optimal? | [`design`](design()) | [`DesignResult`](design::DesignResult) |
//! | what changed between calibrations? | [`compare`](compare()) | [`CompareResult`](compare::CompareResult) |
//! | how do parameters vary between runs? | [`history`](history()) | [`HistoryResult`](history::HistoryResult) |
//! | what position error after days in service? | [`mission`](mission()) | [`MissionResult`](mission::MissionResult) |
//! | do errors agree with covariances? | [`monte_carlo`], [`merge`] | [`CampaignResult`](campaign::CampaignResult) |
//! | a run, a log, a compensated log | [`simulate`](simulate()), [`convert`](convert()), [`apply`](apply()) | theirs |
//!
//! Every function returns an [`Outcome`]. Its text is what the `rins` command prints; its result is a documented struct that
//! `--json` prints and that deserializes again; its page and files are what `-o` writes.
//!
//! ```no_run
//! use rins::{CalibrateOptions, Log, Outcome, Overwrite};
//!
//! let log = Log::open("rig.toml")?;
//! let calibration = rins::calibrate(vec![log], &CalibrateOptions::default())?;
//! print!("{calibration}");
//! calibration.write("out".as_ref(), Overwrite::Refuse)?;
//! # Ok::<(), rins::Error>(())
//! ```
//!
//! Angles, rates and increments inside are in SI units and radians; results name the unit of every number.

pub mod align;
pub mod allan;
pub mod apply;
pub mod calibrate;
pub mod campaign;
pub mod check;
pub mod compare;
pub mod convert;
pub mod demo;
pub mod design;
pub mod diagnose;
pub mod history;
pub mod init;
pub mod live;
pub mod mission;
pub mod navigate;
pub mod observe;
pub mod simulate;

mod basis;
mod consistency;
mod error;
mod finite;
mod free_navigation;
mod homogeneity;
mod identifiability;
mod log;
mod options;
mod outcome;
mod preparation;
mod progress;
mod references;
mod schema;
mod settings;
mod table;

mod values;

pub use rins_estimation as estimation;
pub use rins_frames as frames;
pub use rins_imu as imu;
pub use rins_io as io;
pub use rins_io::Overwrite;
pub use rins_motion as motion;
pub use rins_report as report;
pub use rins_simulation as simulation;
pub use rins_terms as terms;

pub use align::align;
pub use allan::allan;
pub use apply::{ApplyOptions, apply};
pub use basis::{BasisResult, InputResult, ItemResult, MeasurementResult, ProvenanceResult};
pub use calibrate::{CalibrateOptions, calibrate};
pub use campaign::{MonteCarloOptions, TruthChoice, merge, monte_carlo};
pub use check::check;
pub use compare::compare;
pub use consistency::ConsistencyResult;
pub use convert::{ConvertOptions, convert};
pub use design::{DesignGoal, DesignOptions, design};
pub use diagnose::{DiagnoseOptions, diagnose};
pub use error::{Error, Result};
pub use free_navigation::{BeforeAfterResult, NavigationResult};
pub use history::{HistoryOptions, history};
pub use homogeneity::{
    ForecastedResult, HeldOutParameterResult, HeldOutResult, HomogeneityResult, VariantResult,
    VariationResult,
};
pub use identifiability::{
    GaugeResult, IdentifiabilityResult, ObservabilityResult, PredictedResult, SummandResult,
};
pub use init::init;
pub use log::{Log, OutsideRange, OutsideRate, OutsideTemperature, StaticIntervalResult};
pub use mission::{MissionOptions, mission};
pub use navigate::{NavigateOptions, navigate};
pub use observe::{ObserveOptions, observe};
pub use options::{ModelChoice, NoiseChoice};
pub use outcome::Outcome;
pub use progress::{Progress, Step};
pub use schema::schemas;
pub use simulate::simulate;
pub use values::{EstimateResult, EulerDegrees};

/// The version of the results' schema.
pub const SCHEMA: u32 = 2;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
