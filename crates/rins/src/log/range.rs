//! The range of temperatures and rates that a calibration covers, and the check of another run against it.

use rins_frames::units::DEG;
use rins_io::{CalibratedRange, Calibration, Loaded};
use rins_motion::Recording;
use rins_terms::{Model, Need, Role, TermInstance};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use rins_io::{date_text, shown};
use rins_report::number::figure;

/// The averaging time of a rate \[s\], so that noise does not widen the covered range.
const MEAN_OVER: f64 = 1.0;

/// A day \[s\].
pub(crate) const DAY: f64 = 86_400.0;

/// A rate counts as covered if it exceeds the highest calibrated rate by less than this fraction.
const SAME_RATE: f64 = 0.1;

/// The range that runs cover: temperature, and rate about the spin axis.
pub(crate) fn covered<'r>(recordings: impl IntoIterator<Item = &'r Recording>) -> CalibratedRange {
    let mut range = CalibratedRange::default();
    for recording in recordings {
        let temperatures = recording.temperature.iter().flatten().copied();
        temperatures.for_each(|value| widen(&mut range.temperature, value));
        rates(recording).for_each(|rate| widen(&mut range.rate, rate));
    }
    range
}

fn widen(range: &mut Option<[f64; 2]>, value: f64) {
    let [low, high] = range.unwrap_or([value; 2]);
    *range = Some([low.min(value), high.max(value)]);
}

/// The mean rates about the spin axis, each over [`MEAN_OVER`] \[rad/s\].
fn rates(recording: &Recording) -> impl Iterator<Item = f64> {
    let mut samples = recording.increments.iter();
    std::iter::from_fn(move || {
        let (mut angle, mut time) = (0.0, 0.0);
        for sample in samples.by_ref() {
            angle += sample.angle.components().z;
            time += sample.interval;
            if time >= MEAN_OVER {
                return Some(angle / time);
            }
        }
        None
    })
}

/// The part of a run outside the calibrated range.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Beyond {
    /// The same as sentences.
    pub(crate) notes: Vec<String>,
    /// The same for the JSON result; `None` if there is no calibration.
    pub(crate) outside: Option<OutsideRange>,
}

/// What of a log lies outside of what a calibration covers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OutsideRange {
    /// The temperature, if it does \[°C\].
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub temperature_degc: Option<OutsideTemperature>,
    /// The rate about the axis of rotation, if it does \[deg/s\].
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub rate_deg_s: Option<OutsideRate>,
    /// How many days after the calibration the log was made, if that is a day or more; negative before it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub days: Option<f64>,
    /// Whether the log is of another power-on, as far as both state one; turn-on biases are other ones then.
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    pub power_on: bool,
}

/// A temperature outside of what a calibration covers \[°C\].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OutsideTemperature {
    /// The lowest and the highest of the log.
    pub log: [f64; 2],
    /// The lowest and the highest that were calibrated.
    pub calibrated: [f64; 2],
    /// By how much it is outside.
    pub outside: f64,
}

/// A rate outside of what a calibration covers \[deg/s\].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OutsideRate {
    /// The fastest of the log.
    pub log: f64,
    /// The fastest that was calibrated.
    pub calibrated: f64,
}

/// The part of a run outside the calibrated range; `terms` are the terms of the calibration in this run.
///
/// # Errors
/// If the calibration is of another IMU, if a term depends on a temperature that the log lacks, or would be extrapolated further than
/// the calibrated range allows, unless `extrapolate`.
pub(crate) fn beyond(
    calibration: &Calibration,
    terms: &Model,
    loaded: &Loaded,
    extrapolate: bool,
) -> anyhow::Result<Beyond> {
    let (log, file) = (shown(&loaded.rig.log.path), shown(&calibration.path));
    let here = covered([&loaded.recording]);
    ensure_temperature(&log, &file, terms, &loaded.recording)?;
    let (run, measured) = (&loaded.rig.run, &calibration.measured);
    if let (Some(own), Some(of)) = (&run.serial, &measured.serial) {
        anyhow::ensure!(
            own == of,
            "{log}: the rig file states the IMU {own:?}, and {file} is a calibration of {of:?}: use one of the same IMU"
        );
    }
    let mut beyond = Beyond::default();
    let (temperature, rate) = (calibration.range.temperature, calibration.range.rate);
    let mut outside = OutsideRange::default();
    if let Some((range, calibrated)) = here.temperature.zip(temperature) {
        let by = (range[1] - calibrated[1]).max(calibrated[0] - range[0]);
        if format!("{by:.1}").parse::<f64>().is_ok_and(|by| by > 0.0) {
            let degrees = |[low, high]: [f64; 2]| format!("{low:.1} to {high:.1} degC");
            let mut note = format!(
                "Temperature {}, calibrated from {}: {by:.1} K outside",
                degrees(range),
                degrees(calibrated)
            );
            let cost = cost(terms, by);
            if cost.is_empty() {
                note += "; the calibration has no coefficient of temperature, so that what this costs is not known.";
            } else {
                note += "; the coefficients then add, 1σ, ";
                note += &cost.join(", ");
                note.push('.');
            }
            let far = !cost.is_empty() && by > calibrated[1] - calibrated[0];
            anyhow::ensure!(
                extrapolate || !far,
                "{log}: {note} That is further than the range that was calibrated is wide: calibrate over more of it, or \
                 pass --extrapolate"
            );
            beyond.notes.push(note);
            outside.temperature_degc =
                Some(OutsideTemperature { log: range, calibrated, outside: by });
        }
    }
    let largest = |range: [f64; 2]| range[0].abs().max(range[1].abs());
    if let Some((range, calibrated)) = here.rate.map(largest).zip(rate.map(largest))
        && range > (1.0 + SAME_RATE) * calibrated
    {
        let [range, calibrated] = [range, calibrated].map(|rate| rate / DEG);
        beyond.notes.push(format!(
            "Rate about the axis of rotation up to {} deg/s, calibrated up to {} deg/s: whether scale errors are the same at \
             higher rates is not known.",
            figure(range, 4),
            figure(calibrated, 4)
        ));
        outside.rate_deg_s = Some(OutsideRate { log: range, calibrated });
    }
    if let Some((own, of)) = run.started.as_ref().zip(measured.started.as_ref()) {
        let days = (own.seconds - of.seconds) / DAY;
        if days.abs() >= 1.0 {
            beyond.notes.push(format!(
                "Calibrated on {}, {:.0} days {} this log: what changed in between is not known.",
                date_text(of.seconds),
                days.abs(),
                if days > 0.0 { "before" } else { "after" }
            ));
            outside.days = Some(days);
        }
    }
    if let Some((own, of)) =
        run.series.as_ref().zip(measured.series.as_ref()).filter(|(a, b)| a != b)
    {
        beyond.notes.push(format!(
            "The calibration is of another power-on ({of:?}, this log {own:?}): turn-on biases are not the same."
        ));
        outside.power_on = true;
    }
    beyond.outside = Some(outside);
    Ok(beyond)
}

/// Refuses a model that depends on temperature if the log has none; `holder` names the file of the model.
pub(crate) fn ensure_temperature(
    log: &str,
    holder: &str,
    model: &Model,
    recording: &Recording,
) -> anyhow::Result<()> {
    let needs = |chosen: &&TermInstance| chosen.term.needs.contains(&Need::Temperature);
    let needing = model.terms.iter().find(needs).filter(|_| recording.temperature.is_none());
    if let Some(TermInstance { term, .. }) = needing {
        anyhow::bail!(
            "{log}: {holder} holds {}, which depends on temperature, and the log has none: declare its column as [log] \
             temperature",
            term.id
        );
    }
    Ok(())
}

/// The uncertainty from temperature coefficients `outside` kelvin beyond the range: the largest of each term.
fn cost(terms: &Model, outside: f64) -> Vec<String> {
    let of_temperature = terms.terms.iter().filter(|of| of.reference_temperature().is_some());
    let largest = of_temperature.filter_map(|chosen| {
        let sigmas = chosen.roles.iter().zip(chosen.term.parameters).map(|(role, parameter)| {
            let sigma = if let Role::Within(sigma) = role { *sigma } else { 0.0 };
            (outside * sigma / parameter.unit.factor, parameter.unit.symbol)
        });
        let (sigma, unit) = sigmas.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let unit = unit.strip_suffix("/K").unwrap_or(unit);
        Some(format!("{} {unit} ({})", figure(sigma, 2), chosen.term.id))
    });
    largest.collect()
}
