//! The static intervals of a log: one search for all commands, and the remarks on its result.

use std::ops::Range;

use nalgebra::Vector3;
use rins_frames::units::DEG_PER_SECOND;
use rins_frames::{InFrame, SignedAxes};
use rins_imu::TriadSpec;
use rins_inspection::{SensorFigures, StaticInterval, StaticIntervals, StaticOptions};
use rins_io::{Loaded, Rig};
use rins_motion::Recording;
use rins_report::number::decimal;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The maximum number of spans that are listed in a line.
const LISTED: usize = 8;

/// The options of the search from the statements of a rig file on static intervals and sensors.
fn options(rig: &Rig) -> StaticOptions {
    let figures = |of: fn(&rins_imu::ImuSpec) -> &TriadSpec| {
        rig.imu.as_ref().map(of).map_or_else(SensorFigures::default, |sheet| SensorFigures {
            bias_sigma: Some(sheet.bias_sigma),
            noise_density: Some(sheet.noise_density),
            resolution: sheet.resolution,
        })
    };
    StaticOptions {
        gyro: figures(|imu| &imu.gyro),
        accel: figures(|imu| &imu.accel),
        stated: rig.log.static_spans.clone(),
        ..StaticOptions::default()
    }
}

/// The static intervals of a log, stated by its rig file or detected.
pub(crate) fn static_intervals(loaded: &Loaded) -> StaticIntervals {
    let options = options(&loaded.rig);
    if loaded.rig.log.is_complete() {
        return StaticIntervals::of(&loaded.recording, &options);
    }
    StaticIntervals::of(&with_ideal_sensors(loaded), &options)
}

/// The recording with readings of a static IMU for the sensors that the log does not have: no rotation, and specific force as
/// large as gravity.
fn with_ideal_sensors(loaded: &Loaded) -> Recording {
    let spin = SignedAxes::from(loaded.rig.spin);
    let [_, accels] = loaded.rig.log.sensors();
    let mut recording = loaded.recording.clone();
    let samples = &mut recording.increments;
    let lasting: f64 = samples.iter().map(|sample| sample.interval).sum();
    let gained: Vector3<f64> = samples.iter().map(|sample| sample.velocity.components()).sum();
    let mean = gained.norm() / lasting;
    let missing = (loaded.station.gravity.powi(2) - mean.powi(2)).max(0.0).sqrt();
    if let Some(absent) = accels.iter().position(|is_there| !is_there) {
        let along = spin.apply(&Vector3::ith(absent, missing));
        for sample in samples {
            sample.velocity += InFrame::from_components(along * sample.interval);
        }
    }
    recording
}

/// The longest static interval, if its duration is at least `shortest` \[s\].
pub(crate) fn longest(loaded: &Loaded, shortest: f64) -> Option<Range<usize>> {
    let found = static_intervals(loaded);
    let longest = found.longest()?;
    (longest.duration() >= shortest * (1.0 - 1e-9)).then(|| longest.span.clone())
}

/// The message that there is no static interval of `shortest` \[s\], with the assumptions of the search.
pub(crate) fn none_found(loaded: &Loaded, shortest: f64) -> String {
    let found = static_intervals(loaded);
    let message = format!("the IMU is never static for {shortest} s");
    let rejected: Vec<String> = found
        .all
        .iter()
        .filter(|interval| !interval.used())
        .take(LISTED)
        .filter_map(|interval| Some(format!("{}: {}", span(interval), interval.remark()?)))
        .collect();
    if rejected.is_empty() {
        return message;
    }
    // A sensor that drifts, as in a thermal chamber, looks like one that moves.
    format!(
        "{message} ({}); if it was, state the interval in the rig file: [log] static = [[\"0 s\", \"600 s\"]]",
        rejected.join("; ")
    )
}

fn span(interval: &StaticInterval) -> String {
    format!("{}-{} s", decimal(interval.start, 1), decimal(interval.end, 1))
}

/// A span over which the IMU is static, or might be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StaticIntervalResult {
    /// Its start \[s\], in the time of the log.
    pub start_s: f64,
    /// Its end \[s\].
    pub end_s: f64,
    /// Whether this command uses it as a static interval.
    pub used: bool,
    /// Why it is not used, or what is to be known of it.
    pub why: Option<String>,
    /// Whether the rig file states it.
    pub stated: bool,
    /// The run that it is in, from 1, where a result is of several runs.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub run: Option<usize>,
}

/// The spans for the JSON result; `unused` states why a command does not use a span that it could use.
pub(crate) fn statics_result(
    found: &StaticIntervals,
    unused: impl Fn(&StaticInterval) -> Option<String>,
) -> Vec<StaticIntervalResult> {
    let interval = |interval: &StaticInterval| {
        let why = if interval.used() { unused(interval) } else { None };
        StaticIntervalResult {
            start_s: interval.start,
            end_s: interval.end,
            used: interval.used() && why.is_none(),
            why: why.or_else(|| interval.remark()),
            stated: interval.stated,
            run: None,
        }
    };
    found.all.iter().map(interval).collect()
}

/// The reason for not using a span, of a command that uses the longest interval only.
pub(crate) fn only(span: &Range<usize>) -> impl Fn(&StaticInterval) -> Option<String> {
    move |interval| {
        (interval.span != *span).then(|| "static, but only the longest interval is used".into())
    }
}

/// The reason for not using a span, of a command that uses all intervals of at least `shortest` \[s\].
pub(crate) fn lasting(shortest: f64) -> impl Fn(&StaticInterval) -> Option<String> {
    move |interval| {
        (interval.duration() < shortest * (1.0 - 1e-9))
            .then(|| format!("static, but shorter than {shortest} s"))
    }
}

/// Remarks on the intervals: those not used and why, contradictions to the rig file, and assumptions.
pub(crate) fn statics_in_words(found: &StaticIntervals, rig: &Rig) -> Vec<String> {
    let mut lines = Vec::new();
    let told = |used: bool| {
        let of: Vec<&StaticInterval> = found
            .all
            .iter()
            .filter(|interval| interval.used() == used && interval.remark().is_some())
            .collect();
        let listed = of.iter().take(LISTED).map(|interval| {
            format!("{} {}", span(interval), interval.remark().unwrap_or_default())
        });
        let mut listed: Vec<String> = listed.collect();
        if of.len() > LISTED {
            listed.push(format!("and {} more", of.len() - LISTED));
        }
        listed.join("; ")
    };
    let (used, unused) = (told(true), told(false));
    if !used.is_empty() {
        lines.push(format!("Static intervals: {used}."));
    }
    if !unused.is_empty() {
        lines.push(format!("Not used as static intervals: {unused}."));
        if rig.imu.is_none() {
            lines.push(format!(
                "No bias_sigma of the gyros is stated: a constant rate of up to {:.1} deg/s about the vertical is assumed to be \
                 a bias.",
                StaticOptions::default().assumed_bias / DEG_PER_SECOND
            ));
        }
    }
    lines
}
