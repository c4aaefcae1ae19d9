//! The data sheet in a rig file: `[imu] grade` or `sensor`, `[imu.gyro]` and `[imu.accel]`.

use rins_imu::{GRADES, ImuSpec, Preset, SENSORS, TriadSpec};

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

/// The data sheet, and the grade or sensor that gives the values which the rig file does not state.
pub(super) fn read(
    root: &Section<'_>,
) -> Result<(Option<ImuSpec>, Option<&'static Preset>), IoError> {
    let Some(imu) = root.section("imu", &["grade", "sensor", "gyro", "accel"])? else {
        return Ok((None, None));
    };
    let preset = preset(&imu)?;
    let gyro = triad(&imu, "gyro", &GYRO, preset.map(|preset| preset.imu.gyro))?;
    let accel = triad(&imu, "accel", &ACCEL, preset.map(|preset| preset.imu.accel))?;
    Ok((Some(ImuSpec { gyro, accel }), preset))
}

/// The grade or the sensor.
fn preset(imu: &Section<'_>) -> Result<Option<&'static Preset>, IoError> {
    let named = |key: &str, presets: &'static [Preset]| {
        let names: Vec<String> =
            presets.iter().map(|preset| format!("{:?}", preset.name)).collect();
        let expected = format!("one of {}", names.join(", "));
        let Some(name) = imu.text(key, &expected)? else { return Ok(None) };
        let known = presets.iter().any(|preset| preset.name.eq_ignore_ascii_case(name));
        let preset = Preset::named(name).filter(|_| known);
        preset.map(Some).ok_or_else(|| imu.not_allowed(key, &expected))
    };
    match (named("grade", &GRADES)?, named("sensor", &SENSORS)?) {
        (Some(_), Some(_)) => Err(imu.conflict("grade", "a sensor is stated too")),
        (grade, sensor) => Ok(grade.or(sensor)),
    }
}

fn triad(
    imu: &Section<'_>,
    key: &str,
    figures: &Figures,
    preset: Option<TriadSpec>,
) -> Result<TriadSpec, IoError> {
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
    let section = match (imu.section(key, &known)?, preset) {
        (Some(section), _) => section,
        (None, Some(preset)) => return Ok(preset),
        (None, None) => {
            return Err(imu.missing(key, format!("a section [imu.{key}], or a grade of the IMU")));
        }
    };
    let or_preset = |key: &str, kind: &Kind, of: fn(&TriadSpec) -> f64| match &preset {
        Some(preset) => Ok(section.quantity(key, kind)?.unwrap_or_else(|| of(preset))),
        None => section.require_quantity(key, kind),
    };
    Ok(TriadSpec {
        noise_density: or_preset("noise", figures.noise, |sheet| sheet.noise_density)?,
        bias_sigma: or_preset("bias_sigma", figures.bias_sigma, |sheet| sheet.bias_sigma)?,
        scale_sigma: or_preset("scale_sigma", &kinds::RATIO_SIGMA, |sheet| sheet.scale_sigma)?,
        misalignment_sigma: or_preset("misalignment_sigma", &kinds::ANGLE_SIGMA, |sheet| {
            sheet.misalignment_sigma
        })?,
        bias_instability: section.quantity("bias_instability", figures.bias_instability)?,
        random_walk: section.quantity("random_walk", figures.random_walk)?,
        range: section.quantity("range", figures.reading)?,
        resolution: section.quantity("resolution", figures.reading)?,
    })
}
