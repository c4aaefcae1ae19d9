//! How accurate the references of a calibration are: `rate_accuracy` and `angle_accuracy` of `[table]`, `latitude_accuracy` and
//! `gravity_accuracy` of `[site]`, `clock_accuracy` of `[log]`.

use crate::error::IoError;
use crate::quantity::kinds;
use crate::rig::{log_keys, place, table};
use crate::section::Section;

/// The limits of the errors of what a calibration is referred to, as a certificate or a data sheet states them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Accuracy {
    /// Of the table's rate \[rad/s\].
    pub table_rate: Option<f64>,
    /// Of the table's angle \[rad\].
    pub table_angle: Option<f64>,
    /// Of the latitude \[rad\].
    pub latitude: Option<f64>,
    /// Of gravity \[m/s²\].
    pub gravity: Option<f64>,
    /// Of the rate of the log's clock, as a fraction.
    pub clock: Option<f64>,
}

impl Accuracy {
    /// Whether anything is stated.
    pub fn is_stated(&self) -> bool {
        *self != Self::default()
    }
}

/// Reads all of them; each may be left out.
pub(super) fn read(root: &Section<'_>) -> Result<Accuracy, IoError> {
    let mut accuracy = Accuracy::default();
    if let Some(table) = root.section("table", &table::KEYS)? {
        accuracy.table_rate = table.quantity("rate_accuracy", &kinds::RATE_ACCURACY)?;
        accuracy.table_angle = table.quantity("angle_accuracy", &kinds::ANGLE_SIGMA)?;
    }
    if let Some(site) = root.section("site", &place::SITE)? {
        accuracy.latitude = site.quantity("latitude_accuracy", &kinds::ANGLE_SIGMA)?;
        accuracy.gravity = site.quantity("gravity_accuracy", &kinds::GRAVITY_ACCURACY)?;
    }
    if let Some(log) = root.section("log", &log_keys::KEYS)? {
        accuracy.clock = log.quantity("clock_accuracy", &kinds::RATIO_SIGMA)?;
    }
    Ok(accuracy)
}
