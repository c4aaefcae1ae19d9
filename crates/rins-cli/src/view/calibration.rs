//! A calibration, for a terminal and for a browser.

use std::fmt::Write as _;

use nalgebra::Vector3;
use rins_calibration::{
    AttitudeSource, Calibration, Consistency, EstimatePoint, MEASUREMENTS, Parameter, Verdict,
};
use rins_frames::units::{ARCSEC, DEG};

use crate::report::{
    Band, Cell, Column, Item, Matrix, Plot, Reference, Report, Scale, Section, Series, Style,
    Table, Tone,
};
use crate::view::navigation::{attitude_plot, velocity_plot};
use crate::view::table::aligned;

/// What the three estimates also carry, from accelerometer errors that the model does not have.
pub(crate) const SYSTEMATIC_NOTE: &str = "Zero velocity also sees accelerometer biases, which this \
model does not have. Of a bias of 200 ug about 0.03 arcsec and 0.1 ppm may be in the estimates \
beyond sigma, of a larger one more.";

/// A change of the velocity error by less than this factor is none.
const LEAST_GAIN: f64 = 1.5;

/// What the rows of the innovation are.
const CHANNELS: [&str; MEASUREMENTS] =
    ["velocity east", "velocity north", "velocity up", "table x", "table y", "table z"];

/// A parameter as a person reads it: `M_xz`, or the combination that the schedule shows.
pub(crate) fn meaning(parameter: &Parameter) -> String {
    if parameter.identifiable() {
        return "alone, by this schedule".into();
    }
    let partners: Vec<String> = parameter
        .partners
        .iter()
        .map(|partner| {
            let share = partner.share * partner.kind.factor() / parameter.kind.factor();
            let sign = if share < 0.0 { "-" } else { "+" };
            let unit = parameter.kind.unit();
            format!("{sign} {:.4} {unit}/({}) x {}", share.abs(), partner.kind.unit(), partner.id)
        })
        .collect();
    format!("only the combination {} {}", parameter.id, partners.join(" "))
}

/// The summary for a terminal.
pub(crate) fn calibration_text(calibration: &Calibration, title: &str) -> String {
    let mut text = format!("{title}\n");
    for sentence in summary(calibration) {
        let _ = writeln!(text, "  {sentence}");
    }
    text.push('\n');
    let mut rows =
        vec![["parameter", "value", "sigma", "unit", "what it is"].map(String::from).to_vec()];
    rows.extend(calibration.parameters.iter().map(|parameter| {
        let factor = parameter.kind.factor();
        vec![
            parameter.id.into(),
            format!("{:.4}", parameter.value / factor),
            format!("{:.4}", parameter.sigma / factor),
            parameter.kind.unit().into(),
            meaning(parameter),
        ]
    }));
    text.push_str(&aligned(&rows));
    let _ = writeln!(text, "\n  {SYSTEMATIC_NOTE}");
    text
}

/// The result in plain words.
fn summary(calibration: &Calibration) -> Vec<String> {
    let (before, after) = (&calibration.before, &calibration.after);
    let duration = match (before.history.first(), before.history.last()) {
        (Some(first), Some(last)) => last.time - first.time,
        _ => 0.0,
    };
    let consistency = consistency_sentence(&calibration.consistency);
    let gain = gain_sentence(before.velocity.norm(), after.velocity.norm(), duration);
    let mut sentences = vec![gain, consistency];
    let combined = calibration.parameters.iter().filter(|p| !p.identifiable()).count();
    if combined > 0 {
        let which = if combined == calibration.parameters.len() {
            "any of the parameters".to_owned()
        } else {
            format!("{combined} of the {} parameters", calibration.parameters.len())
        };
        sentences.push(format!(
            "This schedule leaves gyro bias in {which}: what is estimated, and what compensating it undoes \
             at this rate, is the combination. Turn as long backwards as forwards to keep it out.",
        ));
    }
    if calibration.attitude_source == AttitudeSource::Aligned {
        sentences.push(
            "The attitude at the start was found from the rest before the table turned.".into(),
        );
    }
    sentences
}

/// What compensating the estimates does to free navigation.
fn gain_sentence(before: f64, after: f64, duration: f64) -> String {
    let navigation =
        format!("the velocity error after {duration:.0} s of free inertial navigation");
    if after * LEAST_GAIN < before {
        // Beyond this the remainder is the noise's, and its ratio means nothing.
        let ratio = (before / after.max(1e-9)).min(1e6);
        format!(
            "Compensating the gyro errors along the spin axis brings {navigation} from {before:.3} m/s down to \
             {after:.4} m/s, {ratio:.0} times less."
        )
    } else if before * LEAST_GAIN < after {
        format!(
            "Compensating the estimates makes it worse: {navigation} goes from {before:.3} m/s up to {after:.3} m/s."
        )
    } else {
        format!(
            "Compensating the estimates gains nothing: {navigation} is {before:.3} m/s before and {after:.3} m/s after."
        )
    }
}

/// A p-value as a person reads it.
fn probability(p: f64) -> String {
    if p < 1e-12 {
        "below 1e-12".into()
    } else if p < 0.001 {
        format!("= {p:.0e}")
    } else {
        format!("= {p:.3}")
    }
}

fn consistency_sentence(consistency: &Consistency) -> String {
    let figures = format!(
        "mean NIS {:.2} where {} is expected, whiteness p {}",
        consistency.nis_mean,
        consistency.nis_dof,
        probability(consistency.whiteness_p)
    );
    match consistency.verdict() {
        Verdict::Fits => {
            format!("The innovations are what the model says they should be ({figures}).")
        }
        Verdict::NoiseOverstated => format!(
            "The innovations are smaller than the rig's noise figures claim ({figures}): the sigmas are too \
             large rather than too small."
        ),
        Verdict::Misfit => format!(
            "The model does not fit these data ({figures}): there is more in them than its states, \
             and the sigmas do not hold what that does to the estimates."
        ),
    }
}

/// The report page.
pub(crate) fn calibration_report(calibration: &Calibration, title: &str, subtitle: &str) -> Report {
    Report {
        title: title.into(),
        subtitle: subtitle.into(),
        summary: summary(calibration),
        sections: vec![
            parameters_section(calibration),
            history_section(calibration),
            navigation_section(calibration),
            consistency_section(calibration),
        ],
    }
}

fn parameters_section(calibration: &Calibration) -> Section {
    let rows = calibration.parameters.iter().map(|parameter| {
        let factor = parameter.kind.factor();
        let badge = if parameter.identifiable() {
            Cell::badge(Tone::Good, "identifiable")
        } else {
            Cell::badge(Tone::Warning, "combination")
        };
        vec![
            Cell::text(parameter.id),
            Cell::Estimate { value: parameter.value / factor, sigma: parameter.sigma / factor },
            Cell::text(parameter.kind.unit()),
            badge,
            Cell::text(meaning(parameter)),
        ]
    });
    let axis = calibration.nav_from_table.euler_angles();
    let attitude =
        [("roll", axis.roll), ("pitch", axis.pitch), ("yaw", axis.yaw)].map(|(name, angle)| {
            vec![Cell::text(name), Cell::Number { value: angle / DEG, decimals: 5 }]
        });
    Section {
        heading: "Parameters".into(),
        intro: "Values follow eq. (1): measured = true + bias + [S, M] true. To compensate, solve it for the true rate; \
                calibration.toml does so."
            .into(),
        items: vec![
            Item::Table(Table {
                caption: "Estimates, 1σ".into(),
                columns: vec![
                    Column::id("parameter"),
                    Column::number("estimate"),
                    Column::text("unit"),
                    Column::text("under this schedule"),
                    Column::text("what it is"),
                ],
                rows: rows.collect(),
            }),
            Item::Note(Tone::Neutral, SYSTEMATIC_NOTE.into()),
            Item::Matrix(Matrix {
                caption: "Correlation of the estimates".into(),
                labels: calibration.parameters.iter().map(|p| p.id.to_owned()).collect(),
                values: (0..3)
                    .map(|row| (0..3).map(|column| calibration.correlation[(row, column)]).collect())
                    .collect(),
            }),
            Item::Text(format!(
                "The attitude of the axis frame rides along, as the whole run shows it: known about east to {:.2}″, about \
                 north to {:.2}″ and about up to {:.1}″ (1σ). Tilts hold the accelerometers' constant errors.",
                calibration.axis_sigma.x / ARCSEC,
                calibration.axis_sigma.y / ARCSEC,
                calibration.axis_sigma.z / ARCSEC
            )),
            Item::Table(Table {
                caption: "Axis attitude".into(),
                columns: vec![Column::text("angle"), Column::number("deg")],
                rows: attitude.to_vec(),
            }),
        ],
    }
}

/// The history from where every sigma has come down to this many times its last: what is before
/// would press the rest flat.
const SETTLED: f64 = 20.0;

fn history_section(calibration: &Calibration) -> Section {
    let last = calibration.history.last().map_or(Vector3::zeros(), |point| point.sigma);
    let settled = |point: &EstimatePoint| (0..3).all(|row| point.sigma[row] <= SETTLED * last[row]);
    let from = calibration.history.iter().position(settled).unwrap_or_default();
    let history = &calibration.history[from..];
    let time: Vec<f64> = history.iter().map(|point| point.time).collect();
    let plots = calibration.parameters.iter().enumerate().map(|(row, parameter)| {
        let factor = parameter.kind.factor();
        let estimate = |sigmas: f64| {
            let of = |p: &EstimatePoint| (p.estimate[row] + sigmas * p.sigma[row]) / factor;
            history.iter().map(of).collect::<Vec<f64>>()
        };
        Item::Plot(Plot {
            title: parameter.id.into(),
            x_label: "Time [s]".into(),
            y_label: format!("Estimate [{}]", parameter.kind.unit()),
            series: vec![Series {
                name: "estimate".into(),
                x: time.clone(),
                y: estimate(0.0),
                style: Style::Line,
            }],
            bands: vec![Band {
                name: "±3σ".into(),
                x: time.clone(),
                lower: estimate(-3.0),
                upper: estimate(3.0),
            }],
            ..Plot::default()
        })
    });
    let sigma = Item::Plot(Plot {
        title: "Sigma".into(),
        x_label: "Time [s]".into(),
        y_label: "1σ [arcsec, ppm]".into(),
        y_scale: Scale::Logarithmic,
        series: calibration
            .parameters
            .iter()
            .enumerate()
            .map(|(row, parameter)| Series {
                name: parameter.id.into(),
                x: calibration.history.iter().map(|point| point.time).collect(),
                y: calibration
                    .history
                    .iter()
                    .map(|point| point.sigma[row] / parameter.kind.factor())
                    .collect(),
                style: Style::Line,
            })
            .collect(),
        caption: "From the prior on; a slope of -1/2 is averaging of white noise.".into(),
        ..Plot::default()
    });
    Section {
        heading: "How the estimates settle".into(),
        intro: format!(
            "Each estimate with its 3σ band, from where its sigma has come down to {SETTLED} times the last."
        ),
        items: plots.chain(std::iter::once(sigma)).collect(),
    }
}

fn navigation_section(calibration: &Calibration) -> Section {
    let runs = [("before", &calibration.before), ("after", &calibration.after)];
    let rows = runs.map(|(name, run)| {
        let number = |value: f64, decimals| Cell::Number { value, decimals };
        let angles = [run.attitude_error.roll, run.attitude_error.pitch, run.attitude_error.yaw];
        let mut row = vec![Cell::text(name), number(run.velocity.x, 4), number(run.velocity.y, 4)];
        row.extend(angles.map(|angle| number(angle / DEG, 5)));
        row
    });
    Section {
        heading: "Free inertial navigation before and after".into(),
        intro: "The run navigated freely from rest, twice from the same attitude: as recorded, and compensated. The truth is \
                a velocity of zero and an axis that does not move."
            .into(),
        items: vec![
            Item::Table(Table {
                caption: "Errors at the end".into(),
                columns: ["", "v east [m/s]", "v north [m/s]", "roll [deg]", "pitch [deg]", "yaw [deg]"]
                    .iter()
                    .enumerate()
                    .map(|(place, name)| {
                        if place == 0 { Column::text(*name) } else { Column::number(*name) }
                    })
                    .collect(),
                rows: rows.to_vec(),
            }),
            Item::Plot(velocity_plot(&runs)),
            Item::Plot(attitude_plot(&runs)),
        ],
    }
}

fn consistency_section(calibration: &Calibration) -> Section {
    let consistency = &calibration.consistency;
    let rows = (0..MEASUREMENTS).map(|channel| {
        vec![
            Cell::text(CHANNELS[channel]),
            Cell::Number { value: consistency.channel_rms[channel], decimals: 3 },
            Cell::Number { value: consistency.periodogram_distance[channel], decimals: 4 },
        ]
    });
    let plots = (0..MEASUREMENTS).map(|channel| {
        let innovations = &calibration.innovations;
        let time = calibration.innovation_times.clone();
        Item::Plot(Plot {
            title: CHANNELS[channel].into(),
            x_label: "Time [s]".into(),
            y_label: "Whitened innovation [σ]".into(),
            series: vec![Series {
                name: "innovation".into(),
                x: time,
                y: innovations.iter().map(|nu| nu[channel]).collect(),
                style: Style::Line,
            }],
            references: [-3.0, 3.0]
                .map(|value| Reference { name: format!("{value:+.0}σ"), value })
                .to_vec(),
            ..Plot::default()
        })
    });
    let tone = match consistency.verdict() {
        Verdict::Fits => Tone::Good,
        Verdict::NoiseOverstated => Tone::Neutral,
        Verdict::Misfit => Tone::Warning,
    };
    let verdict = consistency_sentence(consistency);
    let mut items = vec![
        Item::Note(tone, verdict),
        Item::Text(
            "RMS is 1 for a right model; below 1, more noise was claimed than there is. The last column is the largest \
             distance of the cumulative periodogram from that of white noise."
                .into(),
        ),
        Item::Table(Table {
            caption: "Whitened innovations".into(),
            columns: vec![
                Column::text("channel"),
                Column::number("RMS"),
                Column::number("periodogram distance"),
            ],
            rows: rows.collect(),
        }),
    ];
    items.extend(plots);
    Section {
        heading: "Does the model fit?".into(),
        intro: "If it does, each whitened innovation is a draw from N(0, 1) of its own. Structure that you can see is an \
                effect that the model does not have."
            .into(),
        items,
    }
}
