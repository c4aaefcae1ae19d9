//! The noise over a static interval as sentences, tables and plots.

use std::fmt::Write as _;

use rins_imu::{CONFIDENCE, NoiseLaw, NoiseTerm, Triad};

use super::noise::{Channel, Rest, term};
use crate::table::{aligned, report_table};
use rins_report::number::{estimate, figure};
use rins_report::{Band, Item, Plot, Report, Scale, Section, Series, Style};

/// The noise as text for a terminal.
pub(super) fn allan_text(rest: &Rest, title: &str) -> String {
    let mut text = format!("{title}\n");
    for sentence in sentences(rest) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {sentence}");
    }
    text.push('\n');
    text.push_str(&aligned(&rows(&rest.channels)));
    text
}

/// The noise as a report page.
pub(super) fn allan_report(rest: &Rest, title: String, log: &str) -> Report {
    let triads = [Triad::Gyro, Triad::Accel].map(|triad| {
        rest.channels.iter().filter(|channel| channel.triad == triad).collect::<Vec<_>>()
    });
    Report {
        title,
        subtitle: format!("rins allan: {log}"),
        summary: sentences(rest),
        sections: vec![
            Section {
                heading: "Allan deviation".into(),
                intro: format!(
                    "A slope of −1 is quantization, of −½ white noise, a floor is bias instability, and a slope of +½ a random \
                     walk. The bands hold the true deviation with {:.0} %.",
                    CONFIDENCE * 100.0
                ),
                items: triads.iter().map(|triad| Item::Plot(plot(triad))).collect(),
            },
            Section {
                heading: "Noise terms".into(),
                intro: "A term that is not significant has an upper bound (<).".into(),
                items: vec![Item::Table(report_table(&rows(&rest.channels)))],
            },
        ],
    }
}

fn sentences(rest: &Rest) -> Vec<String> {
    let times = rest.channels[0].seen.points.iter().map(|point| point.time);
    let longest = times.fold(0.0, f64::max);
    let mut sentences = vec![format!(
        "Over a static interval of {:.0} s, from {} to {} s; averaging times from {} to {} s.",
        rest.span.1 - rest.span.0,
        figure(rest.span.0, 6),
        figure(rest.span.1, 6),
        figure(rest.interval, 3),
        figure(longest, 3),
    )];
    sentences.extend(rest.remarks.iter().cloned());
    sentences.extend(rest.channels.iter().filter_map(lines));
    sentences.extend(rest.channels.iter().filter_map(off_the_laws));
    sentences
}

/// The spectral lines in a sensor's readings.
fn lines(channel: &Channel) -> Option<String> {
    let unit = channel.unit();
    let told: Vec<String> = channel
        .lines
        .iter()
        .map(|line| {
            let (amplitude, sigma) =
                estimate(line.amplitude / unit.factor, line.amplitude_sigma / unit.factor);
            let wanders = if line.width > 0.0 {
                format!(", wandering within {} Hz,", figure(line.width, 2))
            } else {
                String::new()
            };
            let frequency = figure(line.frequency, 4);
            format!("{frequency} Hz{wanders} of {amplitude} ± {sigma} {}", unit.symbol)
        })
        .collect();
    (!told.is_empty()).then(|| {
        format!(
            "{} {} has a spectral line at {}: it is removed before the noise is estimated.",
            channel.triad,
            channel.axis,
            told.join(", at ")
        )
    })
}

/// The part of a sensor's deviation that the four noise laws do not explain.
fn off_the_laws(channel: &Channel) -> Option<String> {
    let seen = &channel.seen;
    let sensor = format!("{} {}", channel.triad, channel.axis);
    if seen.disagreement >= 1.0 {
        return Some(format!(
            "No sum of the four noise terms is near the deviation of {sensor}: its values are orders of magnitude."
        ));
    }
    let from = (seen.explained_from > seen.points[0].time)
        .then(|| format!("only from {} s on", figure(seen.explained_from, 3)));
    let within = (seen.disagreement > 0.0)
        .then(|| format!("to within {} % of the variance", figure(seen.disagreement * 100.0, 2)));
    let limits: Vec<String> = from.into_iter().chain(within).collect();
    let explain =
        format!("The four noise terms explain the deviation of {sensor} {}", limits.join(" and "));
    (!limits.is_empty()).then(|| {
        explain
            + ": it also holds dither, vibration, a filter or base motion; the sigmas allow for it."
    })
}

/// A row for each sensor and law, after a row of headings.
fn rows(channels: &[Channel]) -> Vec<Vec<String>> {
    let head = ["noise", "value", "1σ", "unit", "remark"].map(String::from).to_vec();
    let rows = channels.iter().flat_map(|channel| {
        let laws = NoiseLaw::ALL.into_iter().zip(&channel.seen.strengths);
        laws.map(move |(law, strength)| row(channel, law, strength))
    });
    std::iter::once(head).chain(rows).collect()
}

fn row(channel: &Channel, law: NoiseLaw, strength: &NoiseTerm) -> Vec<String> {
    let (_, symbol, unit) = term(channel.triad, law);
    let sensor = format!("{} {}", channel.triad, channel.axis);
    let (value, sigma, remark) = match strength {
        NoiseTerm::Seen { value, sigma, rivals } => {
            let (shown, sigma) = estimate(value / unit.factor, sigma / unit.factor);
            let rivals: Vec<&str> = rivals.iter().map(|rival| words(*rival)).collect();
            let mut remarks = Vec::new();
            if !rivals.is_empty() {
                remarks.push(format!("not distinguished from {}", rivals.join(" or ")));
            }
            if let Some(sheet) = channel.sheet(law).filter(|sheet| *sheet > 0.0) {
                remarks.push(format!("{} times the data sheet's value", figure(value / sheet, 3)));
            }
            if (channel.triad, law) == (Triad::Gyro, NoiseLaw::White) {
                let walk = value / rins_frames::units::DEG_PER_ROOT_HOUR;
                remarks.push(format!("{} deg/sqrt(h)", figure(walk, 3)));
            }
            (shown, sigma, remarks.join("; "))
        }
        NoiseTerm::NotSeen { below } => {
            (format!("< {}", figure(below / unit.factor, 2)), "–".into(), "not significant".into())
        }
    };
    vec![format!("{sensor}, {} {symbol}", words(law)), value, sigma, unit.symbol.into(), remark]
}

/// The name of a law.
const fn words(law: NoiseLaw) -> &'static str {
    match law {
        NoiseLaw::Quantisation => "quantization",
        NoiseLaw::White => "white noise",
        NoiseLaw::Flicker => "bias instability",
        NoiseLaw::RandomWalk => "random walk",
    }
}

/// The Allan deviations of a triad's sensors, their bounds, and the fit of the noise laws.
fn plot(channels: &[&Channel]) -> Plot {
    let mut plot = Plot {
        x_label: "Averaging time [s]".into(),
        x_scale: Scale::Logarithmic,
        y_scale: Scale::Logarithmic,
        caption: "Broken: the sum of the significant terms.".into(),
        ..Plot::default()
    };
    for channel in channels {
        let unit = channel.unit();
        let points = &channel.seen.points;
        let x: Vec<f64> = points.iter().map(|point| point.time).collect();
        let column = |of: fn(&rins_imu::AllanPoint) -> f64| -> Vec<f64> {
            points.iter().map(|point| of(point) / unit.factor).collect()
        };
        let series = |name: String, y: Vec<f64>, style| Series { name, x: x.clone(), y, style };
        plot.title = match channel.triad {
            Triad::Gyro => "Gyros".into(),
            Triad::Accel => "Accelerometers".into(),
        };
        plot.y_label = format!("Allan deviation [{}]", unit.symbol);
        plot.bands.push(Band {
            name: format!("{}, {:.0} %", channel.axis, CONFIDENCE * 100.0),
            x: x.clone(),
            lower: column(|point| point.bounds.0),
            upper: column(|point| point.bounds.1),
        });
        let (found, mut fitted) = (column(|point| point.deviation), column(|point| point.fitted));
        let unexplained = x.iter().take_while(|time| **time < channel.seen.explained_from).count();
        // The fitted curve has a gap where the laws were not compared with the deviation.
        fitted[..unexplained].fill(f64::NAN);
        plot.series.push(series(channel.axis.to_string(), found, Style::Line));
        plot.series.push(series(format!("{}, fitted", channel.axis), fitted, Style::Dashed));
    }
    plot
}
