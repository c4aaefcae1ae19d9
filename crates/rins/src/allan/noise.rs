//! The noise of six sensors over a static interval.

use std::ops::Range;

use anyhow::Context;
use nalgebra::Vector3;
use rins_frames::{Increments, SignedAxes};
use rins_imu::{
    AllanPlan, Axis, NoiseLaw, NoiseSeen, NoiseTerm, SpectralLine, Triad, TriadSpec, take_out_lines,
};
use rins_inspection::QuantizationGrids;
use rins_io::{Axes, Gaps, Loaded, LogFormat, Rig, TriadColumns, shown};
use rins_report::number::figure;
use rins_terms::{Unit, catalogue};

use super::filled::{Filled, MOST_FILLED, unbroken};
use crate::log::{
    StaticIntervalResult, longest, none_found, static_intervals, statics_in_words, statics_result,
};

/// The shortest static interval whose noise is estimated \[s\].
const SHORTEST_REST: f64 = 10.0;

/// An apparent quantization noise that exceeds that of the resolution by this many sigmas is attributed to another cause.
const BEYOND_RESOLUTION: f64 = 4.0;

/// The noise of six sensors over a static interval.
#[derive(Debug)]
pub(super) struct Rest {
    /// Its start and end \[s\].
    pub(super) span: (f64, f64),
    /// The mean interval between samples \[s\].
    pub(super) interval: f64,
    /// The gyros, then the accelerometers.
    pub(super) channels: Vec<Channel>,
    /// The number of lost samples that were filled in.
    pub(super) lost: usize,
    /// The static intervals, for the JSON result.
    pub(super) statics: Vec<StaticIntervalResult>,
    /// Remarks on the samples that were used.
    pub(super) remarks: Vec<String>,
}

/// The noise of one sensor.
#[derive(Debug)]
pub(super) struct Channel {
    pub(super) triad: Triad,
    pub(super) axis: Axis,
    pub(super) seen: NoiseSeen,
    /// The spectral lines that were removed before the noise was estimated.
    pub(super) lines: Vec<SpectralLine>,
    /// The data sheet of the triad.
    sheet: Option<TriadSpec>,
}

impl Channel {
    /// The unit of the deviation.
    pub(super) const fn unit(&self) -> Unit {
        match self.triad {
            Triad::Gyro => Unit::DEG_PER_HOUR,
            Triad::Accel => Unit::MICRO_G,
        }
    }

    /// The noise parameter of a law by the data sheet, in SI units.
    pub(super) fn sheet(&self, law: NoiseLaw) -> Option<f64> {
        let sheet = self.sheet?;
        match law {
            NoiseLaw::Quantisation => None,
            NoiseLaw::White => Some(sheet.noise_density),
            NoiseLaw::Flicker => sheet.bias_instability,
            NoiseLaw::RandomWalk => sheet.random_walk,
        }
    }
}

/// The catalogue effect of a noise law, the symbol of its noise parameter, and the unit of the parameter.
pub(super) const fn term(triad: Triad, law: NoiseLaw) -> (&'static str, &'static str, Unit) {
    match (triad, law) {
        (Triad::Gyro, NoiseLaw::Quantisation) => {
            (catalogue::GYRO_QUANTISATION.id, "Q", Unit::ARCSEC)
        }
        (Triad::Gyro, NoiseLaw::White) => {
            let unit = Unit::new("deg/h/sqrt(Hz)", Unit::DEG_PER_HOUR.factor);
            (catalogue::GYRO_NOISE_LEVEL.id, "N", unit)
        }
        (Triad::Gyro, NoiseLaw::Flicker) => {
            (catalogue::GYRO_BIAS_INSTABILITY.id, "B", Unit::DEG_PER_HOUR)
        }
        (Triad::Gyro, NoiseLaw::RandomWalk) => {
            (catalogue::GYRO_RATE_RANDOM_WALK.id, "K", Unit::DEG_PER_HOUR_PER_ROOT_HOUR)
        }
        (Triad::Accel, NoiseLaw::Quantisation) => {
            (catalogue::ACCEL_QUANTISATION.id, "Q", Unit::MICROMETRE_PER_SECOND)
        }
        (Triad::Accel, NoiseLaw::White) => {
            (catalogue::ACCEL_NOISE_LEVEL.id, "N", Unit::new("ug/sqrt(Hz)", Unit::MICRO_G.factor))
        }
        (Triad::Accel, NoiseLaw::Flicker) => {
            (catalogue::ACCEL_BIAS_INSTABILITY.id, "B", Unit::MICRO_G)
        }
        (Triad::Accel, NoiseLaw::RandomWalk) => {
            (catalogue::ACCEL_RATE_RANDOM_WALK.id, "K", Unit::MICRO_G_PER_ROOT_HOUR)
        }
    }
}

/// The noise over the longest static interval, with lost samples filled in.
pub(super) fn rest(loaded: &Loaded) -> anyhow::Result<Rest> {
    let recording = &loaded.recording;
    let log = shown(&loaded.rig.log.path);
    let still = longest(loaded, SHORTEST_REST).ok_or_else(|| {
        let none = none_found(loaded, SHORTEST_REST);
        anyhow::anyhow!("{log}: {none}; noise is identified over static intervals only")
    })?;
    let accumulated = matches!(
        &loaded.rig.log.format,
        LogFormat::Columns(columns) if columns.gaps == Some(Gaps::Accumulated)
    );
    let (span, filled, remark) = match Filled::of(recording, still.clone(), accumulated) {
        Some(filled) => {
            let remark = (filled.lost > 0).then(|| {
                format!(
                    "{} lost samples, {:.2} % of the interval, are filled in from those beside them.",
                    filled.lost,
                    100.0 * filled.share()
                )
            });
            (still, filled, remark)
        }
        None => {
            let part = unbroken(recording, still.clone());
            let lasting = |span: &Range<usize>| -> f64 {
                recording.increments[span.clone()].iter().map(|sample| sample.interval).sum()
            };
            let remark = format!(
                "Of the static interval of {:.0} s only {:.0} s are used, the longest part without a gap: more than \
                 {:.0} % of it is lost.",
                lasting(&still),
                lasting(&part),
                100.0 * MOST_FILLED
            );
            let filled = Filled::whole(recording, part.clone());
            (part, filled, Some(remark))
        }
    };
    let interval = filled.interval;
    let duration = interval * filled.samples.len() as f64;
    anyhow::ensure!(
        duration >= SHORTEST_REST * (1.0 - 1e-9),
        "{log}: gaps leave at most {duration:.1} s of a static interval in one piece, and {SHORTEST_REST} s are needed"
    );
    let plan = AllanPlan::new(filled.samples.len(), interval).with_context(|| log.clone())?;
    let own_axes = SignedAxes::from(loaded.rig.spin);
    let combs = resolutions(loaded, interval);
    let (mut channels, mut beyond) = (Vec::new(), Vec::new());
    let sensors = loaded.rig.log.sensors();
    for (triad, sensors) in [Triad::Gyro, Triad::Accel].into_iter().zip(sensors) {
        for axis in Axis::ALL {
            if !sensors[axis.index()] {
                continue;
            }
            let of = |sample: &Increments| match triad {
                Triad::Gyro => own_axes.undo(sample.angle.components())[axis.index()],
                Triad::Accel => own_axes.undo(sample.velocity.components())[axis.index()],
            };
            let lasting: f64 = filled.samples.iter().map(|sample| sample.interval).sum();
            let mean = filled.samples.iter().map(of).sum::<f64>() / lasting;
            // The mean over each sample's own interval is subtracted: otherwise jitter of the intervals turns gravity into noise.
            let mut noise: Vec<f64> =
                filled.samples.iter().map(|sample| of(sample) - mean * sample.interval).collect();
            let lines = take_out_lines(&mut noise, interval);
            let mut seen = plan.noise(&noise).with_context(|| format!("{log}: {triad} {axis}"))?;
            let sheet = loaded.rig.imu.map(|imu| match triad {
                Triad::Gyro => imu.gyro,
                Triad::Accel => imu.accel,
            });
            let capped = combs[3 * usize::from(triad == Triad::Accel) + axis.index()]
                .and_then(|most| cap_quantisation(&mut seen, most, triad, axis));
            beyond.extend(capped);
            channels.push(Channel { triad, axis, seen, lines, sheet });
        }
    }
    let statics = static_intervals(loaded);
    let start = recording.times[span.start] - recording.increments[span.start].interval;
    let start = if start.abs() < 1e-6 * interval { 0.0 } else { start };
    let mut remarks: Vec<String> = remark.into_iter().chain(beyond).collect();
    remarks.extend(names_in_words(&loaded.rig));
    remarks.extend(statics_in_words(&statics, &loaded.rig));
    Ok(Rest {
        span: (start, recording.times[span.end - 1]),
        interval,
        channels,
        lost: filled.lost,
        statics: statics_result(&statics, |interval| {
            (interval.span.start > span.start || interval.span.end < span.end)
                .then(|| "static, but only the longest interval is used".into())
        }),
        remarks,
    })
}

/// How the sensors of an incomplete triad are called, whose axes the columns do not tell.
fn names_in_words(rig: &Rig) -> Option<String> {
    let LogFormat::Columns(columns) = &rig.log.format else { return None };
    let named = |sensor: &str, triad: &TriadColumns, axes: &Axes| -> Vec<String> {
        let SignedAxes { source, .. } = (*axes).into();
        let column =
            |axis: &Axis| Some((axis.to_string(), triad.columns[source[axis.index()]].as_ref()?));
        let of_triad: Vec<_> = Axis::ALL.iter().filter_map(column).collect();
        let is_incomplete = of_triad.len() < 3;
        let told = of_triad.into_iter().map(|(axis, name)| format!("{name:?} is {sensor} {axis}"));
        told.filter(|_| is_incomplete).collect()
    };
    let mut told = named("gyro", &columns.gyro, &rig.log.gyro_axes);
    told.extend(named("accelerometer", &columns.accel, &rig.log.accel_axes));
    (!told.is_empty()).then(|| format!("Of the columns, {}.", told.join(", ")))
}

/// Limits the quantization noise to that of the resolution, `most` \[rad or m/s\]; returns a remark if the estimate exceeds it.
fn cap_quantisation(seen: &mut NoiseSeen, most: f64, triad: Triad, axis: Axis) -> Option<String> {
    let place = NoiseLaw::ALL.iter().position(|law| *law == NoiseLaw::Quantisation)?;
    let strength = &mut seen.strengths[place];
    match *strength {
        NoiseTerm::Seen { value, sigma, .. } if value > most + BEYOND_RESOLUTION * sigma => {
            *strength = NoiseTerm::NotSeen { below: most };
            let (_, _, unit) = term(triad, NoiseLaw::Quantisation);
            Some(format!(
                "An apparent quantization noise of {} {} in {triad} {axis} is more than the resolution makes, {}: vibration, or a filter.",
                figure(value / unit.factor, 3),
                unit.symbol,
                figure(most / unit.factor, 3)
            ))
        }
        NoiseTerm::NotSeen { ref mut below } => {
            *below = below.min(most);
            None
        }
        NoiseTerm::Seen { .. } => None,
    }
}

/// The 1σ of the quantization error of an increment of each channel, along the sensors' own axes \[rad or m/s\].
fn resolutions(loaded: &Loaded, interval: f64) -> [Option<f64>; 6] {
    let combs = QuantizationGrids::of(&loaded.recording);
    let step = |channel: usize| {
        let QuantizationGrids { increments, rates } = combs[channel];
        let of_rates = rates.map(|comb| comb.step * interval);
        let steps = increments.map(|comb| comb.step).into_iter().chain(of_rates);
        steps.max_by(f64::total_cmp).map(|step| step / 12.0_f64.sqrt())
    };
    let axes = SignedAxes::from(loaded.rig.spin);
    // The axis of the run along each of the sensors' own axes.
    let places = axes.undo(&Vector3::new(1.0, 2.0, 3.0)).abs();
    std::array::from_fn(|own| {
        let along = (0..3).find(|along| (places[own % 3] - (*along as f64 + 1.0)).abs() < 0.5)?;
        step(own / 3 * 3 + along)
    })
}
