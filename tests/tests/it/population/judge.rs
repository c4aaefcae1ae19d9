//! Comparison of a result with the truth.

use std::collections::HashMap;
use std::fmt;

use serde_json::Value;

use super::imu::{ARCSEC, DEG_H, MICRO_G, PPM};
use super::run::Truths;

const NAMES: [&str; 3] = ["x", "y", "z"];

/// A known parameter or combination of a result.
#[derive(Clone, Debug)]
pub(crate) struct Known {
    pub(crate) id: String,
    pub(crate) combination: bool,
    /// The error of the value, also in sigmas.
    pub(crate) error: f64,
    pub(crate) sigma: f64,
    pub(crate) sigmas: f64,
}

impl fmt::Display for Known {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { id, error, sigma, sigmas, .. } = self;
        let of = if self.combination { "combination with " } else { "" };
        write!(f, "{of}{id}: error {error:.4} of sigma {sigma:.4}, {sigmas:.2} sigmas")
    }
}

/// The true values by id and run, in the units of results; runs are counted from 1, and 0 is all of them.
pub(crate) fn table(truths: &Truths) -> HashMap<(String, u64), f64> {
    let mut values = HashMap::new();
    let triads = [("gyro", &truths.imu.gyro), ("accel", &truths.imu.accel)];
    for (sensor, triad) in triads {
        for (row, one) in NAMES.iter().enumerate() {
            for (column, other) in NAMES.iter().enumerate() {
                let (id, unit) = if row == column {
                    (format!("{sensor}.scale.{one}"), PPM)
                } else {
                    (format!("{sensor}.misalignment.{one}{other}"), ARCSEC)
                };
                values.insert((id, 0), triad.shape[(row, column)] / unit);
            }
        }
    }
    for (run, of) in (1..).zip(&truths.runs) {
        for (axis, name) in NAMES.iter().enumerate() {
            values.insert((format!("gyro.bias.{name}"), run), of.bias[0][axis] / DEG_H);
            values.insert((format!("accel.bias.{name}"), run), of.bias[1][axis] / MICRO_G);
            if let Some(attitude) = of.attitude {
                values.insert((format!("axis.attitude.{name}"), run), attitude[axis] / ARCSEC);
            }
        }
    }
    values
}

fn truth(values: &HashMap<(String, u64), f64>, of: &Value) -> Option<f64> {
    let id = of["id"].as_str()?.to_owned();
    let run = of["run"].as_u64().unwrap_or(1);
    values.get(&(id.clone(), 0)).or_else(|| values.get(&(id, run))).copied()
}

/// All parameters and combinations of a result that are known and have a true value.
pub(crate) fn known(result: &Value, truths: &Truths) -> Vec<Known> {
    let values = table(truths);
    let mut found: Vec<Known> = Vec::new();
    for parameter in result["parameters"].as_array().expect("a list of parameters") {
        if parameter["observability"] == "prior_dominated" {
            continue;
        }
        let partners = parameter["combination"].as_array().expect("a list of partners");
        let terms = partners
            .iter()
            .map(|partner| Some(truth(&values, partner)? * partner["coefficient"].as_f64()?));
        let Some(sum) = terms.sum::<Option<f64>>() else { continue };
        let Some(own) = truth(&values, parameter) else { continue };
        let number = |key: &str| parameter[key].as_f64().expect("a number");
        let (error, sigma) = (number("value") - own - sum, number("sigma"));
        let sigmas = error / sigma;
        // One combination can be listed under each of its parameters.
        let is_same = |other: &Known| (other.sigmas.abs() - sigmas.abs()).abs() < 1e-6;
        if !partners.is_empty() && found.iter().any(is_same) {
            continue;
        }
        found.push(Known {
            id: parameter["id"].as_str().expect("an id").to_owned(),
            combination: !partners.is_empty(),
            error,
            sigma,
            sigmas,
        });
    }
    found
}
