//! How results are shown: numbers in the units of their field, tables and plots.

mod allan;
mod calibration;
pub(crate) mod campaign;
mod certificate;
mod comparison;
mod consistency;
mod diagnosis;
mod navigation;
mod noise;
pub(crate) mod table;
pub(crate) mod told;
mod worth;

pub(crate) use allan::{allan_report, allan_text};
pub(crate) use calibration::{SYSTEMATIC_NOTE, calibration_report, calibration_text, meaning};
pub(crate) use certificate::{certificate_report, certificate_text, departure_in_words, quantity};
pub(crate) use comparison::{comparison_report, comparison_text};
pub(crate) use diagnosis::{diagnosis_report, diagnosis_text, size_in_words, structure_in_words};
pub(crate) use navigation::{attitude_plot, position_plot, velocity_plot};
pub(crate) use worth::{budget_section, compensation_section, settings_in_words, symbol};

use rins_frames::EulerAngles;
use rins_frames::units::DEG;
use serde_json::{Value, json};

/// Roll, pitch and yaw in degrees, as JSON.
pub(crate) fn euler_json(angles: &EulerAngles) -> Value {
    json!({"roll": angles.roll / DEG, "pitch": angles.pitch / DEG, "yaw": angles.yaw / DEG})
}
