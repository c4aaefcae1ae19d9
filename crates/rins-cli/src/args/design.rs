//! The command line of `rins design`.

use std::path::PathBuf;

use clap::Args;
use rins::DesignGoal;
use rins_io::Axes;
use rins_io::quantity::kinds;

use super::observe::{duration, table_acceleration, table_rate};

#[derive(Debug, Args)]
pub(crate) struct Design {
    /// The scenario files: IMU, site, table and given schedule
    #[arg(required = true, value_name = "SCENARIO")]
    pub(crate) scenarios: Vec<PathBuf>,
    /// The goal: a parameter (gyro.scale.x), position@24h (position error after 24 h in service), D or A (D- or A-optimal for all
    /// sensor parameters; D:ID,ID for some), or two effects that are to be separated (A/B)
    #[arg(long = "for", value_name = "GOAL", value_parser = DesignGoal::parse)]
    pub(crate) goal: DesignGoal,
    /// The model: full, paper12, baseline, all, or a model file; by default baseline for two effects, and full otherwise
    #[arg(long, value_name = "MODEL")]
    pub(crate) model: Option<String>,
    /// Total duration of all runs; by default that of the scenarios
    #[arg(long, value_name = "DURATION", value_parser = duration)]
    pub(crate) duration: Option<f64>,
    /// Maximum table rate; by default that of the scenario, or 10 deg/s if it is stationary
    #[arg(long, value_name = "RATE", value_parser = table_rate)]
    pub(crate) max_rate: Option<f64>,
    /// Angular acceleration of the table; by default that of the scenario, or 5 deg/s^2
    #[arg(long, value_name = "ACCELERATION", value_parser = table_acceleration)]
    pub(crate) max_acceleration: Option<f64>,
    /// Maximum number of spin axis orientations (1 to 6); 1 is that of the scenario
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = directions)]
    pub(crate) directions: usize,
    /// Tilts of the spin axis that the table allows, such as "0 deg,45 deg,90 deg"; by default any from 0 to 90 deg
    #[arg(long, value_name = "TILTS", value_delimiter = ',', value_parser = tilt)]
    pub(crate) tilts: Option<Vec<f64>>,
    /// Axes of the IMU that can be mounted along the spin axis, such as x,y,z or x,-x; by default that of the scenario. With x, y and z
    /// the schedule of 19 positions is compared as well
    #[arg(long, value_name = "AXES", value_delimiter = ',', value_parser = mounting, allow_hyphen_values = true)]
    pub(crate) mountings: Vec<Axes>,
    /// Mission file of the system in service, of which the first scheme is used, for position@...; by default the scenario's site and
    /// axis, rotating back and forth
    #[arg(long, value_name = "MISSION")]
    pub(crate) service: Option<PathBuf>,
    /// Output folder for result.json, report.html and the scenario of the schedule: next.toml, or next-1.toml and on
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

fn directions(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..=6) => Ok(n),
        _ => Err("expected 1 to 6".into()),
    }
}

fn mounting(text: &str) -> Result<Axes, String> {
    Axes::spin(text.trim()).ok_or_else(|| "expected x, y, z, -x, -y or -z".into())
}

fn tilt(text: &str) -> Result<f64, String> {
    kinds::TURN.parse(text.trim()).map_err(|error| error.to_string())
}
