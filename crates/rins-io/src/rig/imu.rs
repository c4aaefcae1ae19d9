//! The data sheet in a rig file: `[imu.gyro]` and `[imu.accel]`.

use rins_imu::{ImuSpec, TriadSpec};

use crate::error::IoError;
use crate::quantity::{Kind, kinds};
use crate::section::Section;

/// The kinds of one triad's data-sheet values.
struct Figures {
    noise: &'static Kind,
    bias_sigma: &'static Kind,
    bias_instability: &'static Kind,
    random_walk: &'static Kind,
    reading: &'static Kind,
}

const GYRO: Figures = Figures {
    noise: &kinds::GYRO_NOISE,
    bias_sigma: &kinds::GYRO_BIAS_SIGMA,
    bias_instability: &kinds::GYRO_BIAS_INSTABILITY,
    random_walk: &kinds::GYRO_RANDOM_WALK,
    reading: &kinds::GYRO_READING,
};

const ACCEL: Figures = Figures {
    noise: &kinds::ACCEL_NOISE,
    bias_sigma: &kinds::ACCEL_BIAS_SIGMA,
    bias_instability: &kinds::ACCEL_BIAS_INSTABILITY,
    random_walk: &kinds::ACCEL_RANDOM_WALK,
    reading: &kinds::ACCEL_READING,
};

pub(super) fn read(root: &Section<'_>) -> Result<Option<ImuSpec>, IoError> {
    let Some(imu) = root.section("imu", &["gyro", "accel"])? else { return Ok(None) };
    let gyro = triad(&imu, "gyro", &GYRO)?;
    let accel = triad(&imu, "accel", &ACCEL)?;
    Ok(Some(ImuSpec { gyro, accel }))
}

fn triad(imu: &Section<'_>, key: &str, figures: &Figures) -> Result<TriadSpec, IoError> {
    let known = [
        "noise",
        "bias_sigma",
        "scale_sigma",
        "misalignment_sigma",
        "bias_instability",
        "random_walk",
        "range",
        "resolution",
    ];
    let Some(section) = imu.section(key, &known)? else {
        return Err(imu.missing(key, format!("a section [imu.{key}]")));
    };
    Ok(TriadSpec {
        noise_density: section.require_quantity("noise", figures.noise)?,
        bias_sigma: section.require_quantity("bias_sigma", figures.bias_sigma)?,
        scale_sigma: section.require_quantity("scale_sigma", &kinds::RATIO_SIGMA)?,
        misalignment_sigma: section.require_quantity("misalignment_sigma", &kinds::ANGLE_SIGMA)?,
        bias_instability: section.quantity("bias_instability", figures.bias_instability)?,
        random_walk: section.quantity("random_walk", figures.random_walk)?,
        range: section.quantity("range", figures.reading)?,
        resolution: section.quantity("resolution", figures.reading)?,
    })
}
