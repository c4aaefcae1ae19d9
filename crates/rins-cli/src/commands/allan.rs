//! `rins allan`: the noise that a rest shows, sensor by sensor.

use std::ops::Range;
use std::path::Path;

use anyhow::Context;
use rins_imu::{AllanPlan, Axis, CONFIDENCE, NoiseLaw, NoiseSeen, Strength, Triad, TriadSpec};
use rins_io::Loaded;
use rins_motion::{Recording, median};
use rins_terms::Unit;
use serde_json::{Value, json};

use crate::commands::align::longest_rest;
use crate::commands::check::refuse_mistaken;
use crate::commands::setup::{load, shown};
use crate::outcome::Outcome;
use crate::view::{allan_report, allan_text};

/// The shortest rest whose noise is looked at \[s\].
const SHORTEST_REST: f64 = 10.0;

/// An interval that is so many times the usual one holds a gap, across which nothing is averaged.
const GAP: f64 = 1.5;

/// The noise of six sensors over a rest.
#[derive(Debug)]
pub(crate) struct Rest {
    /// Its start and end \[s\].
    pub(crate) span: (f64, f64),
    /// The mean interval between samples \[s\].
    pub(crate) interval: f64,
    /// The gyros, then the accelerometers.
    pub(crate) channels: Vec<Channel>,
}

/// What one sensor shows.
#[derive(Debug)]
pub(crate) struct Channel {
    pub(crate) triad: Triad,
    pub(crate) axis: Axis,
    pub(crate) seen: NoiseSeen,
    /// What the data sheet says of the triad.
    sheet: Option<TriadSpec>,
}

impl Channel {
    /// The unit of the deviation.
    pub(crate) const fn unit(&self) -> Unit {
        match self.triad {
            Triad::Gyro => Unit::DEG_PER_HOUR,
            Triad::Accel => Unit::MICRO_G,
        }
    }

    /// The strength that the data sheet gives a law, in SI units.
    pub(crate) fn sheet(&self, law: NoiseLaw) -> Option<f64> {
        let sheet = self.sheet?;
        match law {
            NoiseLaw::Quantisation => None,
            NoiseLaw::White => Some(sheet.noise_density),
            NoiseLaw::Flicker => sheet.bias_instability,
            NoiseLaw::RandomWalk => sheet.random_walk,
        }
    }
}

/// The effect of the catalogue that a law is, the letter of its strength, and the unit of that.
pub(crate) const fn term(triad: Triad, law: NoiseLaw) -> (&'static str, &'static str, Unit) {
    match (triad, law) {
        (Triad::Gyro, NoiseLaw::Quantisation) => ("gyro_quantisation", "Q", Unit::ARCSEC),
        (Triad::Gyro, NoiseLaw::White) => {
            let unit = Unit::new("deg/h/sqrt(Hz)", Unit::DEG_PER_HOUR.factor);
            ("gyro_noise_level", "N", unit)
        }
        (Triad::Gyro, NoiseLaw::Flicker) => ("gyro_bias_instability", "B", Unit::DEG_PER_HOUR),
        (Triad::Gyro, NoiseLaw::RandomWalk) => {
            ("gyro_rate_random_walk", "K", Unit::DEG_PER_HOUR_PER_ROOT_HOUR)
        }
        (Triad::Accel, NoiseLaw::Quantisation) => {
            ("accel_quantisation", "Q", Unit::MICROMETRE_PER_SECOND)
        }
        (Triad::Accel, NoiseLaw::White) => {
            ("accel_noise_level", "N", Unit::new("ug/sqrt(Hz)", Unit::MICRO_G.factor))
        }
        (Triad::Accel, NoiseLaw::Flicker) => ("accel_bias_instability", "B", Unit::MICRO_G),
        (Triad::Accel, NoiseLaw::RandomWalk) => {
            ("accel_rate_random_walk", "K", Unit::MICRO_G_PER_ROOT_HOUR)
        }
    }
}

pub(crate) fn run(rig: &Path) -> anyhow::Result<Outcome> {
    let loaded = load(rig)?;
    refuse_mistaken(&loaded)?;
    let rest = rest(&loaded)?;
    let (title, log) = (format!("Noise of {}", shown(rig)), &loaded.rig.log.path);
    Ok(Outcome {
        json: json(&rest, rig),
        text: allan_text(&rest, &title),
        report: Some(allan_report(&rest, title, &log.display().to_string())),
        ..Outcome::default()
    }
    .of_log(&loaded))
}

/// The noise over the longest rest, or where gaps part it over the longest part.
fn rest(loaded: &Loaded) -> anyhow::Result<Rest> {
    let recording = &loaded.recording;
    let log = loaded.rig.log.path.display();
    let still = longest_rest(recording, SHORTEST_REST).ok_or_else(|| {
        anyhow::anyhow!(
            "{log}: the IMU never stands still for {SHORTEST_REST} s, and what it reads on the move is no noise"
        )
    })?;
    let span = unbroken(recording, still);
    let samples = &recording.increments[span.clone()];
    let duration: f64 = samples.iter().map(|sample| sample.interval).sum();
    anyhow::ensure!(
        duration >= SHORTEST_REST * (1.0 - 1e-9),
        "{log}: gaps leave at most {duration:.1} s of rest in one piece, and {SHORTEST_REST} s are needed"
    );
    let interval = duration / samples.len() as f64;
    let plan = AllanPlan::new(samples.len(), interval).with_context(|| log.to_string())?;
    let mut channels = Vec::new();
    for triad in [Triad::Gyro, Triad::Accel] {
        for axis in Axis::ALL {
            let of = |k: usize| match triad {
                Triad::Gyro => samples[k].angle.components()[axis.index()],
                Triad::Accel => samples[k].velocity.components()[axis.index()],
            };
            let mean = (0..samples.len()).map(of).sum::<f64>() / duration;
            // Less the mean over its own interval: where intervals jitter, gravity is no noise.
            let noise: Vec<f64> =
                (0..samples.len()).map(|k| of(k) - mean * samples[k].interval).collect();
            let seen = plan.noise(&noise).with_context(|| format!("{log}: {triad} {axis}"))?;
            let sheet = loaded.rig.imu.map(|imu| match triad {
                Triad::Gyro => imu.gyro,
                Triad::Accel => imu.accel,
            });
            channels.push(Channel { triad, axis, seen, sheet });
        }
    }
    let start = recording.times[span.start] - samples[0].interval;
    Ok(Rest { span: (start, recording.times[span.end - 1]), interval, channels })
}

/// The longest part of these samples without a gap.
fn unbroken(recording: &Recording, span: Range<usize>) -> Range<usize> {
    let samples = &recording.increments;
    let usual = median(samples[span.clone()].iter().map(|sample| sample.interval));
    let longest = GAP * usual.unwrap_or_default();
    let gaps = span.clone().filter(|k| samples[*k].interval > longest);
    let mut parts = Vec::new();
    let mut start = span.start;
    for gap in gaps.chain([span.end]) {
        parts.push(start..gap);
        start = gap + 1;
    }
    parts.into_iter().max_by_key(ExactSizeIterator::len).unwrap_or(span)
}

fn json(rest: &Rest, rig: &Path) -> Value {
    json!({
        "schema": 1,
        "command": "allan",
        "rig": shown(rig),
        "rest_s": [rest.span.0, rest.span.1],
        "interval_s": rest.interval,
        "confidence": CONFIDENCE,
        "channels": rest.channels.iter().map(channel_json).collect::<Vec<_>>(),
    })
}

fn channel_json(channel: &Channel) -> Value {
    let triad = match channel.triad {
        Triad::Gyro => "gyro",
        Triad::Accel => "accel",
    };
    let points = &channel.seen.points;
    let unit = channel.unit();
    let column = |of: fn(&rins_imu::AllanPoint) -> f64| -> Vec<f64> {
        points.iter().map(|point| of(point) / unit.factor).collect()
    };
    let terms = NoiseLaw::ALL.iter().zip(&channel.seen.strengths);
    json!({
        "channel": format!("{triad}.{}", channel.axis),
        "unit": unit.symbol,
        "tau_s": points.iter().map(|point| point.time).collect::<Vec<_>>(),
        "deviation": column(|point| point.deviation),
        "low": column(|point| point.bounds.0),
        "high": column(|point| point.bounds.1),
        "fitted": column(|point| point.fitted),
        "disagreement": channel.seen.disagreement,
        "explained_from_s": channel.seen.explained_from,
        "terms": terms.map(|(law, strength)| term_json(channel, *law, strength)).collect::<Vec<_>>(),
    })
}

fn term_json(channel: &Channel, law: NoiseLaw, strength: &Strength) -> Value {
    let (id, symbol, unit) = term(channel.triad, law);
    let sheet = channel.sheet(law);
    let (value, sigma, below, rivals) = match strength {
        Strength::Seen { value, sigma, rivals } => {
            (Some(value / unit.factor), Some(sigma / unit.factor), None, rivals.as_slice())
        }
        Strength::NotSeen { below } => (None, None, Some(below / unit.factor), &[][..]),
    };
    let rivals: Vec<_> = rivals.iter().map(|rival| term(channel.triad, *rival).0).collect();
    json!({
        "id": id,
        "symbol": symbol,
        "seen": value.is_some(),
        "value": value,
        "sigma": sigma,
        "below": below,
        "unit": unit.symbol,
        "cannot_tell_from": rivals,
        "sheet": sheet.map(|sheet| sheet / unit.factor),
    })
}
