//! What was measured less what the model says, in time and in table angle, before and after.

use std::f64::consts::TAU;

use rins_diagnosis::Overlay;
use rins_frames::units::{DEG, DEG_PER_HOUR, MICRO_G};

use super::found::DiagnosisOutcome;
use rins_report::{Item, Plot, Section, Series, Style};

/// The channels, and the unit in which each is shown.
const CHANNELS: [(&str, &str, f64); 6] = [
    ("gyro x", "deg/h", DEG_PER_HOUR),
    ("gyro y", "deg/h", DEG_PER_HOUR),
    ("gyro z", "deg/h", DEG_PER_HOUR),
    ("accelerometer x", "µg", MICRO_G),
    ("accelerometer y", "µg", MICRO_G),
    ("accelerometer z", "µg", MICRO_G),
];

/// Over how many parts of a run, and of a revolution, residuals are averaged.
const PARTS: (usize, usize) = (240, 72);

/// Orders of the table angle are shown up to this one, both ways.
const HIGHEST_ORDER: u8 = 8;

/// One section a run.
pub(super) fn overlay_sections(found: &DiagnosisOutcome) -> Vec<Section> {
    let runs = &found.certificate.runs;
    let sections = runs.iter().zip(&found.overlays).map(|(run, overlays)| {
        let heading = if runs.len() > 1 {
            format!("Residuals: {}", run.prepared.name)
        } else {
            "Residuals".to_owned()
        };
        Section {
            heading,
            intro: INTRO.into(),
            items: plots(&run.prepared.run.recording.times, overlays),
        }
    });
    sections.collect()
}

const INTRO: &str = "Residuals: measured minus computed readings for the given and for the extended model, against time and, while the \
                     table rotates, against table angle. Each point is a mean. The residuals of an adequate model are noise around \
                     zero or around a constant offset in body axes. The last plots show the amplitude spectrum of the complex signal \
                     x + iy against harmonic order of the table angle. Order 0 is constant in the body frame, order −1 is constant in \
                     the axis frame, and unequal scale factors of x and y appear at order +1.";

fn plots(times: &[f64], overlays: &[Overlay; 2]) -> Vec<Item> {
    let from = times.first().copied().unwrap_or_default();
    let duration = times.last().copied().unwrap_or_default() - from;
    let in_time = |overlay: &Overlay| -> Vec<Option<usize>> {
        let of = |time: &f64| Some(part((time - from) / duration, PARTS.0));
        times.iter().map(of).take(overlay.residuals.len()).collect()
    };
    let in_angle = |overlay: &Overlay| -> Vec<Option<usize>> {
        let of = |angle: f64| part(angle.rem_euclid(TAU) / TAU, PARTS.1);
        overlay.turned().map(|angle| angle.map(of)).collect()
    };
    let middle = |place: usize, parts: usize| (place as f64 + 0.5) / parts as f64;
    let mut items = Vec::new();
    for (channel, (name, unit, factor)) in CHANNELS.into_iter().enumerate() {
        let plot = |x_label: &str,
                    parts: usize,
                    scale: f64,
                    start: f64,
                    of: &dyn Fn(&Overlay) -> Vec<Option<usize>>| {
            let x: Vec<f64> =
                (0..parts).map(|place| start + scale * middle(place, parts)).collect();
            let series = [("given model", Style::Points), ("extended model", Style::Line)]
                .iter()
                .zip(overlays);
            let series = series.map(|((name, style), overlay)| Series {
                name: (*name).into(),
                x: x.clone(),
                y: means(overlay, channel, &of(overlay), parts)
                    .iter()
                    .map(|mean| mean / factor)
                    .collect(),
                style: *style,
            });
            Item::Plot(Plot {
                title: name.into(),
                x_label: x_label.into(),
                y_label: format!("Residual [{unit}]"),
                series: series.collect(),
                ..Plot::default()
            })
        };
        items.push(plot("Time [s]", PARTS.0, duration, from, &in_time));
        items.push(plot("Table angle [deg]", PARTS.1, TAU / DEG, 0.0, &in_angle));
    }
    items.extend(order_spectra(overlays));
    items
}

/// The residuals across the axis at each harmonic order of the table angle, with its sense.
fn order_spectra(overlays: &[Overlay; 2]) -> Vec<Item> {
    let halves = i32::from(2 * HIGHEST_ORDER);
    let orders: Vec<f64> = (-halves..=halves).map(|half| 0.5 * f64::from(half)).collect();
    let spectra = overlays.each_ref().map(|overlay| overlay.orders(&orders));
    let triads =
        [("Gyros x + iy", "deg/h", DEG_PER_HOUR), ("Accelerometers x + iy", "µg", MICRO_G)];
    let plot = |(triad, (name, unit, factor)): (usize, (&str, &str, f64))| {
        let series =
            [("given model", Style::Points), ("extended model", Style::Line)].iter().zip(&spectra);
        let series = series.map(|((name, style), spectrum)| Series {
            name: (*name).into(),
            x: orders.clone(),
            y: spectrum.iter().map(|of| of[triad] / factor).collect(),
            style: *style,
        });
        Item::Plot(Plot {
            title: name.into(),
            x_label: "Harmonic order of the table angle".into(),
            y_label: format!("Amplitude [{unit}]"),
            series: series.collect(),
            ..Plot::default()
        })
    };
    triads.into_iter().enumerate().map(plot).collect()
}

/// The part of so many that a share lies in.
fn part(share: f64, parts: usize) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share from 0 to 1 of a few hundred"
    )]
    let part = (share * parts as f64) as usize;
    part.min(parts - 1)
}

/// The mean residual of a channel in each part; not a number where there is none.
fn means(overlay: &Overlay, channel: usize, places: &[Option<usize>], parts: usize) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); parts];
    for (residual, place) in overlay.residuals.iter().zip(places) {
        if let Some(place) = place {
            sums[*place].0 += residual[channel];
            sums[*place].1 += 1.0;
        }
    }
    sums.iter().map(|(sum, count)| sum / count).collect()
}
