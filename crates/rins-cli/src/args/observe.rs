//! The command line of `rins observe`.

use std::path::PathBuf;

use clap::Args;
use rins::observe::Want;
use rins_io::Quantity;
use rins_io::quantity::kinds;

#[derive(Debug, Args)]
pub(crate) struct Observe {
    /// The scenario files
    #[arg(required = true, value_name = "SCENARIO")]
    pub(crate) scenarios: Vec<PathBuf>,
    /// The model: full, paper12, baseline (biases, attitude of the spin axis, mounting, `M_xz`, `M_yz` and `S_z`), all
    /// (every effect of the catalogue), or a model file; by default baseline with --separate, and full otherwise
    #[arg(long, value_name = "MODEL")]
    pub(crate) model: Option<String>,
    /// Compare the scenarios side by side; join scenario files with + (A.toml+B.toml) to treat them as runs of one
    /// schedule
    #[arg(long)]
    pub(crate) compare: bool,
    /// Two effects to be separated; the shortest schedule that separates them is proposed
    #[arg(long, value_name = "A,B", value_parser = pair)]
    pub(crate) separate: Option<[String; 2]>,
    /// A parameter and its required 1σ, such as gyro.scale.z=0.1ppm; the shortest schedule that achieves it is proposed
    #[arg(long, value_name = "ID=SIGMA", conflicts_with = "separate", value_parser = want)]
    pub(crate) want: Option<Want>,
    /// Maximum table rate; by default that of the scenario, or 10 deg/s if it is stationary
    #[arg(long, value_name = "RATE", value_parser = table_rate)]
    pub(crate) max_rate: Option<f64>,
    /// Maximum angular acceleration of the table; by default that of the scenario, or 5 deg/s^2
    #[arg(long, value_name = "ACCELERATION", value_parser = table_acceleration)]
    pub(crate) max_acceleration: Option<f64>,
    /// Maximum total duration of all runs of a schedule
    #[arg(long, value_name = "DURATION", default_value = "3600 s", value_parser = duration)]
    pub(crate) max_duration: f64,
    /// Maximum number of spin axis orientations (1 to 3)
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = directions)]
    pub(crate) directions: usize,
    /// Output folder for result.json, report.html and the proposed scenarios, next-1.toml and on
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

fn want(text: &str) -> Result<Want, String> {
    let form = "expected ID=SIGMA, such as gyro.scale.z=0.1ppm";
    let (id, typed) = text.split_once('=').ok_or(form)?;
    let (id, typed) = (id.trim().to_owned(), typed.trim().to_owned());
    if id.is_empty() {
        return Err(form.into());
    }
    let sigma = Quantity::parse(&typed).map_err(|error| error.to_string())?;
    if sigma.value > 0.0 {
        Ok(Want { id, sigma, typed })
    } else {
        Err("a sigma is more than zero".into())
    }
}

fn pair(text: &str) -> Result<[String; 2], String> {
    match text.split(',').map(str::trim).collect::<Vec<_>>()[..] {
        [first, second] if !first.is_empty() && !second.is_empty() => {
            Ok([first.into(), second.into()])
        }
        _ => Err("expected two ids, such as gyro_g_sensitivity,encoder_eccentricity".into()),
    }
}

pub(super) fn table_rate(text: &str) -> Result<f64, String> {
    let rate = kinds::TABLE_RATE.parse(text).map_err(|error| error.to_string())?;
    if rate > 0.0 { Ok(rate) } else { Err("a fastest rate is more than zero".into()) }
}

pub(super) fn table_acceleration(text: &str) -> Result<f64, String> {
    kinds::TABLE_ACCELERATION.parse(text).map_err(|error| error.to_string())
}

pub(super) fn duration(text: &str) -> Result<f64, String> {
    kinds::DURATION.parse(text).map_err(|error| error.to_string())
}

fn directions(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..=3) => Ok(n),
        _ => Err("expected 1, 2 or 3".into()),
    }
}
