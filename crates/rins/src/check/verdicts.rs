//! Verdicts on the possible gross errors of a log.

use rins_frames::EARTH_RATE;
use rins_frames::units::DEG_PER_HOUR;
use rins_inspection::{CHANNELS, Inspection, Suspicion};
use rins_io::{Loaded, Omission};

use super::inspected::{extremes, gaps, longest, step_in_words};
use super::shows::shows;
use super::words::suspicion_in_words;
use crate::log::BEYOND_DATA_SHEET;
use rins_report::Tone;
use rins_report::number::{estimate, figure};

/// The jitter of time stamps above which it is reported, as a fraction of a sample interval.
const ODD_JITTER: f64 = 0.02;

/// A difference of the table latency from the stated one is reported from this number of sigmas, and this fraction of a sample
/// interval, on: a variation of the gyro scale factor looks like a small latency.
const ODD_SIGMAS: f64 = 10.0;
const ODD_SHARE: f64 = 2.5e-3;

/// The verdict on one item.
#[derive(Debug)]
pub(super) struct Verdict {
    pub(super) item: &'static str,
    pub(super) tone: Tone,
    pub(super) says: String,
}

impl Verdict {
    /// The verdict as one word.
    pub(super) fn word(&self) -> &'static str {
        match self.tone {
            Tone::Good => "good",
            Tone::Neutral => "fact",
            Tone::Warning => "odd",
            Tone::Bad => "bad",
        }
    }
}

/// All verdicts, in the order of inspection.
pub(super) fn verdicts(inspection: &Inspection, loaded: &Loaded) -> Vec<Verdict> {
    let mut all = times(inspection, loaded);
    all.extend(channels(inspection, loaded));
    all.extend(meaning(inspection, loaded));
    all.extend(table(inspection, loaded));
    all.extend(contents(inspection, loaded));
    all
}

fn verdict(item: &'static str, tone: Tone, says: impl Into<String>) -> Verdict {
    Verdict { item, tone, says: says.into() }
}

fn times(inspection: &Inspection, loaded: &Loaded) -> Vec<Verdict> {
    let timing = &inspection.timing;
    let jitter = timing.jitter / timing.interval;
    let repeated =
        loaded.summary.left_out.iter().filter(|out| out.reason == Omission::Repeated).count();
    vec![
        verdict(
            "rate and jitter",
            if jitter > ODD_JITTER { Tone::Warning } else { Tone::Good },
            format!(
                "{:.3} Hz, {:.4} ms rms, {:.1} % of an interval",
                1.0 / timing.interval,
                timing.jitter * 1e3,
                100.0 * jitter
            ),
        ),
        verdict(
            "gaps",
            if timing.gaps.is_empty() { Tone::Good } else { Tone::Warning },
            gaps(inspection, loaded),
        ),
        verdict(
            "duplicates",
            if repeated == 0 { Tone::Good } else { Tone::Warning },
            format!("{repeated} repeated line(s)"),
        ),
        // The reader refuses logs with either.
        verdict("time order", Tone::Good, "time stamps increase strictly"),
        verdict("finite", Tone::Good, "every number is finite"),
    ]
}

/// The suspicions of one kind as a verdict, or the given text if there are none.
fn suspected(
    inspection: &Inspection,
    item: &'static str,
    is_one: impl Fn(&Suspicion) -> bool,
    without: impl Into<String>,
) -> Verdict {
    let found: Vec<String> = inspection
        .suspicions
        .iter()
        .filter(|suspicion| is_one(suspicion))
        .map(suspicion_in_words)
        .collect();
    if found.is_empty() {
        verdict(item, Tone::Good, without)
    } else {
        verdict(item, Tone::Bad, found.join("; "))
    }
}

fn channels(inspection: &Inspection, loaded: &Loaded) -> Vec<Verdict> {
    let ranges = loaded.rig.imu.is_some_and(|imu| imu.gyro.range.or(imu.accel.range).is_some());
    let unsaturated = if ranges {
        "no reading is at the range of the data sheet"
    } else {
        "no clipped readings; the data sheet states no range"
    };
    let steps: Vec<String> = inspection
        .resolution
        .iter()
        .enumerate()
        .filter_map(|(channel, step)| {
            step.map(|step| format!("{} {}", CHANNELS[channel], step_in_words(channel, step)))
        })
        .collect();
    let quantised = if steps.is_empty() {
        verdict("quantization", Tone::Good, "no quantization grid is visible")
    } else {
        verdict("quantization", Tone::Neutral, format!("the LSBs are {}", steps.join(", ")))
    };
    vec![
        suspected(
            inspection,
            "stuck",
            |s| matches!(s, Suspicion::StuckChannel { .. } | Suspicion::Sticks { .. }),
            "no channel has a constant output",
        ),
        suspected(
            inspection,
            "saturated",
            |s| matches!(s, Suspicion::Saturated { .. } | Suspicion::FlatTop { .. }),
            unsaturated,
        ),
        suspected(
            inspection,
            "spikes",
            |s| matches!(s, Suspicion::Spike { .. }),
            "no isolated outliers",
        ),
        quantised,
    ]
}

/// The given verdict, or a neutral one with the reason if the log cannot show it.
fn unless_shown(shown: bool, verdict: Verdict, why: &str) -> Verdict {
    if shown || verdict.tone == Tone::Bad {
        verdict
    } else {
        Verdict { tone: Tone::Neutral, says: format!("not observable: {why}"), ..verdict }
    }
}

fn meaning(inspection: &Inspection, loaded: &Loaded) -> Vec<Verdict> {
    let rests = !inspection.rests.is_empty();
    let turns = inspection.spin_ratio.is_some();
    let is_unit = |s: &Suspicion| {
        matches!(
            s,
            Suspicion::Gravity { .. }
                | Suspicion::SpinScale { .. }
                | Suspicion::Triads { .. }
                | Suspicion::TurningTriads { .. }
        )
    };
    let is_axis = |s: &Suspicion| {
        matches!(
            s,
            Suspicion::SpinAxis { .. }
                | Suspicion::Level { .. }
                | Suspicion::EarthRate { .. }
                | Suspicion::Latitude { .. }
                | Suspicion::Handedness { .. }
        )
    };
    let whole = inspection.turns_whole;
    let of_gyro = if turns { "the gyros measure the table's rotation" } else { "gyros not shown" };
    let of_accel =
        if rests || whole { "accelerometers show gravity" } else { "accelerometers not shown" };
    let evidence = format!("{of_gyro}, {of_accel}");
    let level = (rests || whole) && loaded.rig.attitude.is_some();
    let earth = if inspection.earth_rate_visible { ", the Earth's rate" } else { "" };
    let signs = match (level, turns) {
        (true, true) => {
            format!("gravity{earth} and the table's rotation lie along the stated axes")
        }
        (true, false) => format!("gravity{earth} lies along the stated axes"),
        (false, _) => {
            "the table turns about z; the directions of x and y are not observable".into()
        }
    };
    let nothing = "the IMU is neither static nor follows a table";
    let no_axes = if rests { "needs an [attitude], or a table that turns" } else { nothing };
    vec![
        unless_shown(
            rests || turns,
            suspected(inspection, "units", is_unit, evidence.clone()),
            nothing,
        ),
        unless_shown(
            rests || turns,
            suspected(inspection, "rate or increment", is_unit, evidence),
            nothing,
        ),
        unless_shown(
            level || turns,
            suspected(inspection, "signs and axes", is_axis, signs),
            no_axes,
        ),
    ]
}

fn table(inspection: &Inspection, loaded: &Loaded) -> Vec<Verdict> {
    let Some(ratio) = inspection.spin_ratio else {
        return vec![verdict("table", Tone::Neutral, "no table that turns was read")];
    };
    let mut all = vec![suspected(
        inspection,
        "table's motion",
        |s| matches!(s, Suspicion::SpinProfile { .. }),
        "the gyro about the axis of rotation and the table turn at the same times",
    )];
    let ratio = inspection.table_lag.map_or(ratio, |lag| lag.ratio);
    all.push(verdict(
        "clock ratio",
        Tone::Neutral,
        format!(
            "rotation by the gyro about the spin axis over the table's: {ratio:.7}, the product of its scale factor and the ratio of the \
             clocks"
        ),
    ));
    let stated = loaded.rig.log.table_angle().and_then(|angle| angle.latency).unwrap_or_default();
    all.push(match inspection.table_lag {
        None => verdict("latency", Tone::Neutral, "not observable: the table's angle was not read at two rates"),
        Some(lag) => {
            let off = (lag.latency - stated).abs();
            let odd = off > (ODD_SIGMAS * lag.sigma).max(ODD_SHARE * inspection.timing.interval);
            let (latency, sigma) = estimate(lag.latency * 1e3, lag.sigma * 1e3);
            verdict(
                "latency",
                if odd { Tone::Warning } else { Tone::Good },
                format!(
                    "the latency of the table's angle is {latency} ms (1 sigma {sigma} ms), the rig file states {} ms",
                    figure(stated * 1e3, 4)
                ),
            )
        }
    });
    all
}

fn contents(inspection: &Inspection, loaded: &Loaded) -> Vec<Verdict> {
    let temperature = match &loaded.recording.temperature {
        None => "no temperature channel".into(),
        Some(list) => {
            let (least, most) = extremes(list);
            format!("from {least:.2} to {most:.2} degC")
        }
    };
    let rest = match longest(inspection) {
        None => verdict(
            "static intervals",
            Tone::Warning,
            "none of a second or more: nothing to align on",
        ),
        Some(rest) => {
            let rate = rest.mean.rates.angular_rate.norm();
            let told = format!(
                "{} span(s), the longest of {:.1} s at {:.3} deg/h",
                inspection.rests.len(),
                rest.mean.duration,
                rate / DEG_PER_HOUR
            );
            let scatter = rest.mean.angular_rate_sigma.norm();
            // Three biases of the data sheet's sigma make as much as their root mean square.
            let beyond = loaded.rig.imu.filter(|imu| {
                let expected = (3.0 * imu.gyro.bias_sigma.powi(2) + scatter.powi(2)).sqrt();
                (rate - EARTH_RATE).abs() > BEYOND_DATA_SHEET * expected
            });
            match beyond {
                Some(imu) => verdict(
                    "static intervals",
                    Tone::Warning,
                    format!(
                        "{told}, which is not the Earth's 15.041 to within the data sheet's bias_sigma of {:.3} deg/h",
                        imu.gyro.bias_sigma / DEG_PER_HOUR
                    ),
                ),
                None => verdict("static intervals", Tone::Neutral, told),
            }
        }
    };
    let turns = format!(
        "{:.2} revolutions, {:.0} deg, sum of both directions",
        inspection.turns,
        inspection.turns * 360.0
    );
    let shows = shows(inspection, loaded);
    let shows = if shows.is_empty() {
        verdict("what it can show", Tone::Warning, "neither an alignment nor a calibration")
    } else {
        verdict("what it can show", Tone::Neutral, shows.join("; "))
    };
    vec![
        verdict("temperature", Tone::Neutral, temperature),
        rest,
        verdict("turns", Tone::Neutral, turns),
        shows,
    ]
}
