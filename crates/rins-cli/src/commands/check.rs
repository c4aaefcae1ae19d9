//! `rins check`: what a run holds, and what looks wrong with it.

mod mends;
mod oddities;
mod readings;
mod refusal;
mod shows;
mod units;
mod verdicts;
mod words;

use std::fmt::Write as _;
use std::path::Path;

use rins_frames::units::{DEG, DEG_PER_HOUR};
use rins_inspection::{
    CHANNELS, Expected, ExpectedAxis, ExpectedTriad, Inspection, RestSeen, inspect_with,
};
use rins_io::Loaded;
use serde_json::{Value, json};

use self::mends::{mends, mends_in_words};
use self::oddities::oddities;
use self::readings::readings;
pub(crate) use self::refusal::refuse_mistaken;
pub(crate) use self::shows::steady_rates;
use self::units::said_units;
use self::verdicts::{Verdict, verdicts};
use self::words::suspicion_in_words;
use crate::commands::align::table;
use crate::commands::repairs::repairs;
use crate::commands::setup::load;
use crate::commands::statics::{static_intervals, statics_in_words, statics_json};
use crate::outcome::Outcome;
use crate::view::table::aligned;
use rins_io::shown;
use rins_report::number::figure;
use rins_report::{Item, Report, Section, Tone};

/// How many gaps and rests are listed one by one.
const LISTED: usize = 12;

pub(crate) fn run(rig: &Path) -> anyhow::Result<Outcome> {
    let loaded = load(rig)?;
    let inspection = inspected(&loaded);
    let title = format!("Check of {}", shown(rig));
    let rows = rows(&inspection, &loaded);
    let oddities = oddities(&inspection, &loaded);
    let mut text = format!("{title}\n\n{}", aligned(&rows));
    if inspection.rests.len() > 1 {
        let _ = writeln!(text, "\n  rests\n{}", aligned(&rests(&inspection, &loaded)));
    }
    let _ = writeln!(text, "\n{}", aligned(&judged(&inspection, &loaded)[1..]));
    for line in statics_in_words(&inspection.static_intervals, &loaded.rig) {
        let _ = writeln!(text, "  {line}");
    }
    for oddity in &oddities {
        let _ = writeln!(text, "  ! {oddity}");
    }
    if let Some(mend) = mends_in_words(&mends(&inspection, &loaded.rig)) {
        let _ = writeln!(text, "  > {mend}");
    }
    let verdicts = verdicts(&inspection, &loaded);
    let of_tone = |tone: Tone| -> Vec<&str> {
        verdicts.iter().filter(|verdict| verdict.tone == tone).map(|verdict| verdict.item).collect()
    };
    let (odd, bad) = (of_tone(Tone::Warning), of_tone(Tone::Bad));
    let conclusion = match (&odd[..], &bad[..]) {
        ([], []) if oddities.is_empty() => "no anomaly found".to_owned(),
        ([], []) => "no verdict is odd or bad; see the remarks above".to_owned(),
        (odd, []) => format!("odd: {}", odd.join(", ")),
        ([], bad) => format!("bad: {}", bad.join(", ")),
        (odd, bad) => format!("bad: {}; odd: {}", bad.join(", "), odd.join(", ")),
    };
    let _ = writeln!(text, "  {conclusion}");
    let suspected = inspection.suspicions.len();
    let failure = match bad.len() {
        _ if suspected > 0 => Some(format!("{suspected} suspected mistake(s), see above")),
        0 => None,
        _ => Some(format!("bad: {}", bad.join(", "))),
    };
    Ok(Outcome {
        json: json(&inspection, &oddities, &loaded, rig),
        text,
        report: Some(report(&title, &inspection, &oddities, &loaded)),
        failure: failure.map(|why| format!("{}: {why}", shown(&loaded.rig.path))),
        ..Outcome::default()
    })
}

/// What a run holds, held against all that its rig says.
pub(crate) fn inspected(loaded: &Loaded) -> Inspection {
    let rig = &loaded.rig;
    let units = said_units(&rig.log);
    let triad = |spec: Option<rins_imu::TriadSpec>, unit| ExpectedTriad {
        bias_sigma: spec.map(|spec| spec.bias_sigma),
        range: spec.and_then(|spec| spec.range),
        unit,
    };
    let axis = |attitude: rins_io::InitialAttitude| ExpectedAxis {
        angles: attitude.angles,
        sigma: attitude.sigma,
    };
    let expected = Expected {
        station: Some(loaded.station),
        axis: rig.attitude.map(axis),
        table_latency: rig.log.table_angle().and_then(|angle| angle.latency).unwrap_or_default(),
        table_unit: units.table,
        gyro: triad(rig.imu.map(|imu| imu.gyro), units.gyro),
        accel: triad(rig.imu.map(|imu| imu.accel), units.accel),
    };
    // Rig and readers know the sensors by their own axes.
    inspect_with(&loaded.recording, &expected, static_intervals(loaded)).along_own(&rig.spin.into())
}

fn rows(inspection: &Inspection, loaded: &Loaded) -> Vec<Vec<String>> {
    let recording = &loaded.recording;
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let duration: f64 = recording.increments.iter().map(|sample| sample.interval).sum();
    let timing = &inspection.timing;
    let mut rows = vec![
        row("log", shown(&loaded.rig.log.path)),
        row("samples", format!("{} over {duration:.2} s", recording.len())),
        row(
            "rate",
            format!("{:.3} Hz, jitter {:.3} ms rms", 1.0 / timing.interval, timing.jitter * 1e3),
        ),
        row("gaps", gaps(inspection, loaded)),
        row("rest", rest(inspection)),
        row(
            "turns",
            format!(
                "{:.2} about body {}, either way",
                inspection.turns,
                loaded.rig.spin.spin_name()
            ),
        ),
    ];
    if let Some(rest) = longest(inspection) {
        let seen = rest.mean.rates.specific_force.norm();
        rows.push(row(
            "gravity",
            format!(
                "{seen:.5} m/s^2 in the longest rest, {:+.0} ppm of the station's {:.5}",
                (seen / loaded.station.gravity - 1.0) * 1e6,
                loaded.station.gravity
            ),
        ));
        let rate = rest.mean.rates.angular_rate.norm() / DEG_PER_HOUR;
        rows.push(row(
            "rate at rest",
            if inspection.earth_rate_visible {
                format!("{rate:.3} deg/h in the longest one; that of the Earth is 15.041")
            } else {
                format!("{rate:.0} deg/h, in which the Earth's 15.041 does not show")
            },
        ));
    }
    for (channel, resolution) in inspection.resolution.iter().enumerate() {
        if let Some(step) = resolution {
            rows.push(row(
                &format!("{} resolution", CHANNELS[channel]),
                format!("{} an increment", step_in_words(channel, *step)),
            ));
        }
    }
    rows.push(row("table", table_in_words(loaded)));
    if let Some(ratio) = inspection.spin_ratio {
        let value =
            format!("the gyro about the axis of rotation counts {ratio:.6} of the table's turn");
        rows.push(row("spin", value));
    }
    if let (Some(first), Some(last)) = (
        recording.temperature.as_ref().and_then(|t| t.first()),
        recording.temperature.as_ref().and_then(|t| t.last()),
    ) {
        rows.push(row(
            "temperature",
            format!("{first:.2} degC at the start, {last:.2} at the end"),
        ));
    }
    rows
}

/// The verdicts as rows of a table, below a row of headings.
fn judged(inspection: &Inspection, loaded: &Loaded) -> Vec<Vec<String>> {
    let head = ["on", "verdict", ""].map(String::from).to_vec();
    let row = |verdict: Verdict| vec![verdict.item.into(), verdict.word().into(), verdict.says];
    let rows = verdicts(inspection, loaded).into_iter().map(row);
    std::iter::once(head).chain(rows).collect()
}

fn gaps(inspection: &Inspection, loaded: &Loaded) -> String {
    let timing = &inspection.timing;
    let mut gaps = timing.gaps.clone();
    let Some(longest) = gaps.iter().map(|(_, length)| *length).reduce(f64::max) else {
        return "none".into();
    };
    // Where all cannot be listed, the longest are.
    let more = if gaps.len() > LISTED { ", ..." } else { "" };
    if gaps.len() > LISTED {
        gaps.sort_by(|a, b| b.1.total_cmp(&a.1));
    }
    let at: Vec<String> = gaps
        .iter()
        .take(LISTED)
        .map(|(index, _)| format!("{:.3}", loaded.recording.times[*index]))
        .collect();
    let single = gaps.iter().filter(|(_, length)| *length < 2.5 * timing.interval).count();
    format!(
        "{}, {single} of them one lost sample; the longest {:.1} ms; at {}{more} s",
        gaps.len(),
        longest * 1e3,
        at.join(", ")
    )
}

fn rest(inspection: &Inspection) -> String {
    let lasting = inspection.rests.iter().fold(0.0, |sum, rest| sum + rest.mean.duration);
    match inspection.rests.len() {
        0 => "none of a second or more".into(),
        1 => format!("1 span of {lasting:.1} s"),
        spans => format!("{spans} spans, {lasting:.1} s in all"),
    }
}

fn longest(inspection: &Inspection) -> Option<&RestSeen> {
    inspection.rests.iter().max_by(|a, b| a.mean.duration.total_cmp(&b.mean.duration))
}

fn step_in_words(channel: usize, step: f64) -> String {
    if channel < 3 {
        format!("{} arcsec", figure(step / DEG * 3600.0, 4))
    } else {
        format!("{} mm/s", figure(step * 1e3, 4))
    }
}

fn table_in_words(loaded: &Loaded) -> String {
    let recording = &loaded.recording;
    match (&recording.table_angle, &recording.table_rate) {
        (Some(angle), _) => {
            let (least, most) = extremes(angle);
            format!(
                "angle read, from {:.3} to {:.3} turns",
                least / (360.0 * DEG),
                most / (360.0 * DEG)
            )
        }
        (None, Some(rate)) => {
            let (least, most) = extremes(rate);
            format!("rate given, from {:.4} to {:.4} deg/s", least / DEG, most / DEG)
        }
        (None, None) => "neither angle nor rate".into(),
    }
}

fn extremes(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &value| {
        (least.min(value), most.max(value))
    })
}

fn rests(inspection: &Inspection, loaded: &Loaded) -> Vec<Vec<String>> {
    let mut rows = vec![
        ["from [s]", "to [s]", "gravity [m/s^2]", "rate [deg/h]", ""].map(String::from).to_vec(),
    ];
    rows.extend(inspection.rests.iter().take(LISTED).map(|rest| {
        let times = &loaded.recording.times;
        vec![
            format!("{:.2}", times[rest.span.start]),
            format!("{:.2}", times[rest.span.end - 1]),
            format!("{:.5}", rest.mean.rates.specific_force.norm()),
            format!("{:.3}", rest.mean.rates.angular_rate.norm() / DEG_PER_HOUR),
            String::new(),
        ]
    }));
    if inspection.rests.len() > LISTED {
        rows.push(vec![format!("and {} more", inspection.rests.len() - LISTED)]);
    }
    rows
}

fn report(title: &str, inspection: &Inspection, oddities: &[String], loaded: &Loaded) -> Report {
    let mut rows = rows(inspection, loaded);
    rows.insert(0, ["", ""].map(String::from).to_vec());
    let verdict = if inspection.suspicions.is_empty() {
        "Units, signs and axes agree with gravity and with the table, as far as this log shows them."
    } else {
        "Something is wrong with units, signs or axes: see below before you use this log."
    };
    let mut summary = vec![verdict.to_owned()];
    summary.extend(oddities.iter().cloned());
    summary.extend(statics_in_words(&inspection.static_intervals, &loaded.rig));
    let mut items: Vec<Item> = inspection
        .suspicions
        .iter()
        .map(|suspicion| Item::Note(Tone::Bad, suspicion_in_words(suspicion)))
        .collect();
    if let Some(mend) = mends_in_words(&mends(inspection, &loaded.rig)) {
        items.push(Item::Note(Tone::Bad, format!("To mend it: {mend}.")));
    }
    items.push(Item::Table(table(&rows)));
    if inspection.rests.len() > 1 {
        items.push(Item::Table(table(&rests(inspection, loaded))));
    }
    Report {
        title: title.into(),
        subtitle: format!("rins check: {}", shown(&loaded.rig.log.path)),
        summary,
        sections: vec![
            Section { heading: "What is in it".into(), intro: String::new(), items },
            Section {
                heading: "Verdicts".into(),
                intro: "One on each thing that can be wrong with a log: good, a fact that is neither, odd, or bad.".into(),
                items: vec![Item::Table(table(&judged(inspection, loaded)))],
            },
            Section {
                heading: "Readings".into(),
                intro: "Mean rates and specific forces over each interval, along the body axes."
                    .into(),
                items: readings(inspection, loaded),
            },
        ],
    }
}

fn json(inspection: &Inspection, oddities: &[String], loaded: &Loaded, rig: &Path) -> Value {
    let times = &loaded.recording.times;
    let rests: Vec<Value> = inspection
        .rests
        .iter()
        .map(|rest| {
            json!({
                "from_s": times[rest.span.start],
                "to_s": times[rest.span.end - 1],
                "gravity_m_s2": rest.mean.rates.specific_force.norm(),
                "rate_deg_h": rest.mean.rates.angular_rate.norm() / DEG_PER_HOUR,
            })
        })
        .collect();
    let gaps: Vec<Value> = inspection
        .timing
        .gaps
        .iter()
        .map(|(index, length)| json!({"at_s": times[*index], "length_s": length}))
        .collect();
    let suspicions: Vec<String> = inspection.suspicions.iter().map(suspicion_in_words).collect();
    let mends: Vec<Value> = mends(inspection, &loaded.rig)
        .iter()
        .map(|mend| {
            let names = |axes: &Option<rins_io::Axes>| axes.map(|axes| axes.names());
            json!({
                "gyro_axes": names(&mend.gyro),
                "accel_axes": names(&mend.accel),
                "table_sense": mend.table.map(|sense| sense.name()),
            })
        })
        .collect();
    json!({
        "schema": 1,
        "command": "check",
        "rig": shown(rig),
        "samples": loaded.recording.len(),
        "rate_hz": 1.0 / inspection.timing.interval,
        "jitter_rms_s": inspection.timing.jitter,
        "gaps": gaps,
        "rests": rests,
        "static_intervals": statics_json(&inspection.static_intervals, |_| None),
        "turns": inspection.turns,
        "spin_ratio": inspection.spin_ratio,
        "table_latency_s": inspection.table_lag.map(|lag| lag.latency),
        "table_latency_sigma_s": inspection.table_lag.map(|lag| lag.sigma),
        "earth_rate_visible": inspection.earth_rate_visible,
        "expected_gravity_m_s2": loaded.station.gravity,
        "suspicions": suspicions,
        "mends": mends,
        "oddities": oddities,
        "verdicts": verdicts(inspection, loaded).iter().map(Verdict::json).collect::<Vec<_>>(),
        "repairs": repairs(&loaded.rig, &loaded.summary),
    })
}
