//! The noise, for a machine.

use rins_imu::{AllanPoint, CONFIDENCE, NoiseLaw, NoiseTerm, Triad};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::noise::{Channel, Rest, term};
use crate::basis::BasisResult;
use crate::log::{Log, StaticIntervalResult};

/// The result of `rins allan`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AllanResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `allan`.
    pub command: String,
    /// The rig file.
    pub rig: String,
    /// Start and end of the static interval that was used \[s\].
    pub static_interval_s: [f64; 2],
    /// The mean interval between samples \[s\].
    pub interval_s: f64,
    /// How many lost samples were filled in.
    pub lost_samples: usize,
    /// The static intervals of the log.
    pub static_intervals: Vec<StaticIntervalResult>,
    /// The confidence of the bounds.
    pub confidence: f64,
    /// The gyros, then the accelerometers, along the sensors' own axes.
    pub channels: Vec<ChannelResult>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// The noise of one sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ChannelResult {
    /// Such as `gyro.x`.
    pub channel: String,
    /// The unit of the deviation.
    pub unit: String,
    /// The averaging times \[s\].
    pub tau_s: Vec<f64>,
    /// The Allan deviation at each.
    pub deviation: Vec<f64>,
    /// Its lower bound.
    pub low: Vec<f64>,
    /// Its upper bound.
    pub high: Vec<f64>,
    /// What the noise terms make of it.
    pub fitted: Vec<f64>,
    /// By what share of the variance the terms disagree with the deviation.
    pub disagreement: f64,
    /// The spectral lines that were taken out before.
    pub spectral_lines: Vec<LineResult>,
    /// The shortest averaging time from which on the terms explain the deviation \[s\].
    pub explained_from_s: f64,
    /// The noise terms.
    pub terms: Vec<NoiseTermResult>,
}

/// A spectral line: sinusoidal interference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LineResult {
    /// Its frequency \[Hz\].
    pub frequency_hz: f64,
    /// The 1σ of that \[Hz\].
    pub frequency_sigma_hz: f64,
    /// How far its frequency wanders \[Hz\].
    pub width_hz: f64,
    /// Its amplitude, in the unit of the channel.
    pub amplitude: f64,
    /// The 1σ of that.
    pub amplitude_sigma: f64,
}

/// A noise term of one sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NoiseTermResult {
    /// The effect of the catalogue that it is.
    pub id: String,
    /// `Q`, `N`, `B` or `K` of IEEE Std 952.
    pub symbol: String,
    /// Whether it is significant.
    pub significant: bool,
    /// Its value; null if it is not significant.
    pub value: Option<f64>,
    /// The 1σ of that.
    pub sigma: Option<f64>,
    /// The bound, where it is not significant.
    pub upper_bound: Option<f64>,
    /// The unit of all three.
    pub unit: String,
    /// The ids of the terms from which this static interval does not distinguish it.
    pub cannot_tell_from: Vec<String>,
    /// What the data sheet says of it.
    pub data_sheet: Option<f64>,
}

impl AllanResult {
    pub(super) fn of(rest: &Rest, log: &Log) -> Self {
        Self {
            schema: crate::SCHEMA,
            command: "allan".into(),
            rig: log.name.clone(),
            static_interval_s: [rest.span.0, rest.span.1],
            interval_s: rest.interval,
            lost_samples: rest.lost,
            static_intervals: rest.statics.clone(),
            confidence: CONFIDENCE,
            channels: rest.channels.iter().map(ChannelResult::from).collect(),
            basis: BasisResult::of_log(log),
        }
    }
}

impl From<&Channel> for ChannelResult {
    fn from(channel: &Channel) -> Self {
        let triad = match channel.triad {
            Triad::Gyro => "gyro",
            Triad::Accel => "accel",
        };
        let points = &channel.seen.points;
        let unit = channel.unit();
        let column = |of: fn(&AllanPoint) -> f64| -> Vec<f64> {
            points.iter().map(|point| of(point) / unit.factor).collect()
        };
        let lines = channel.lines.iter().map(|line| LineResult {
            frequency_hz: line.frequency,
            frequency_sigma_hz: line.frequency_sigma,
            width_hz: line.width,
            amplitude: line.amplitude / unit.factor,
            amplitude_sigma: line.amplitude_sigma / unit.factor,
        });
        let terms = NoiseLaw::ALL.iter().zip(&channel.seen.strengths);
        Self {
            channel: format!("{triad}.{}", channel.axis),
            unit: unit.symbol.into(),
            tau_s: points.iter().map(|point| point.time).collect(),
            deviation: column(|point| point.deviation),
            low: column(|point| point.bounds.0),
            high: column(|point| point.bounds.1),
            fitted: column(|point| point.fitted),
            disagreement: channel.seen.disagreement,
            spectral_lines: lines.collect(),
            explained_from_s: channel.seen.explained_from,
            terms: terms
                .map(|(law, strength)| NoiseTermResult::of(channel, *law, strength))
                .collect(),
        }
    }
}

impl NoiseTermResult {
    fn of(channel: &Channel, law: NoiseLaw, strength: &NoiseTerm) -> Self {
        let (id, symbol, unit) = term(channel.triad, law);
        let sheet = channel.sheet(law);
        let (value, sigma, below, rivals) = match strength {
            NoiseTerm::Seen { value, sigma, rivals } => {
                (Some(value / unit.factor), Some(sigma / unit.factor), None, rivals.as_slice())
            }
            NoiseTerm::NotSeen { below } => (None, None, Some(below / unit.factor), &[][..]),
        };
        let rivals = rivals.iter().map(|rival| term(channel.triad, *rival).0.to_owned());
        Self {
            id: id.into(),
            symbol: symbol.into(),
            significant: value.is_some(),
            value,
            sigma,
            upper_bound: below,
            unit: unit.symbol.into(),
            cannot_tell_from: rivals.collect(),
            data_sheet: sheet.map(|sheet| sheet / unit.factor),
        }
    }
}
