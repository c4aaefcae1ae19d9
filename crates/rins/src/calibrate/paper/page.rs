//! A calibration, for a terminal and for a browser.

use std::fmt::Write as _;

use nalgebra::Vector3;
use rins_calibration::{AttitudeSource, Calibration, EstimatePoint, MEASUREMENTS};
use rins_frames::units::{ARCSEC, DEG};
use rins_report::{
    Band, Cell, Column, Item, Matrix, Plot, Report, Scale, Section, Series, Style, Table, Tone,
};

use super::observability::{SYSTEMATIC_NOTE, meaning};
use crate::consistency::{Residuals, consistency_section, consistency_sentence};
use crate::free_navigation::{gain_sentence, navigation_section};
use crate::identifiability::OBSERVABLE;
use crate::table::aligned;

/// In place of the value of a parameter that has none of its own.
const NONE: &str = "–";

/// What the rows of the innovation are.
const CHANNELS: [&str; MEASUREMENTS] =
    ["velocity east", "velocity north", "velocity up", "table x", "table y", "table z"];

/// The summary for a terminal.
pub(super) fn calibration_text(calibration: &Calibration, title: &str) -> String {
    let mut text = format!("{title}\n");
    for sentence in summary(calibration) {
        let _ = writeln!(text, "  {sentence}");
    }
    text.push('\n');
    let mut rows =
        vec![["parameter", "value", "sigma", "unit", "observability"].map(String::from).to_vec()];
    rows.extend(calibration.parameters.iter().map(|parameter| {
        let factor = parameter.kind.factor();
        // The value is the combination's, and stands with it.
        let own = |value: f64| {
            if parameter.identifiable() { format!("{:.4}", value / factor) } else { NONE.into() }
        };
        vec![
            parameter.id.clone(),
            own(parameter.value),
            own(parameter.sigma),
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
    let consistency = consistency_sentence(&calibration.consistency);
    let gain = gain_sentence("M_xz, M_yz and S_z", before, after);
    let mut sentences = vec![gain, consistency];
    let combined = calibration.parameters.iter().filter(|p| !p.identifiable()).count();
    if combined > 0 {
        let which = if combined == calibration.parameters.len() {
            "each parameter".to_owned()
        } else {
            format!("{combined} of the {} parameters", calibration.parameters.len())
        };
        sentences.push(format!(
            "Under this schedule {which} cannot be separated from a gyro bias: the estimate is their combination, and its compensation \
             holds at this rate only. A run with equal times in both directions separates them.",
        ));
    }
    if calibration.attitude_source == AttitudeSource::Aligned {
        sentences.push(
            "The attitude at the start was found over the static interval before the table turned."
                .into(),
        );
    }
    sentences
}

/// The report page.
pub(super) fn calibration_report(calibration: &Calibration, title: &str, subtitle: &str) -> Report {
    Report {
        title: title.into(),
        subtitle: subtitle.into(),
        summary: summary(calibration),
        sections: vec![
            parameters_section(calibration),
            history_section(calibration),
            navigation_section(
                "Free inertial navigation before and after",
                &calibration.before,
                &calibration.after,
            ),
            consistency_section(
                "Does the model fit?",
                &calibration.consistency,
                &Residuals {
                    channels: CHANNELS,
                    times: &calibration.innovation_times,
                    innovations: &calibration.innovations,
                },
            ),
        ],
    }
}

fn parameters_section(calibration: &Calibration) -> Section {
    let rows = calibration.parameters.iter().map(|parameter| {
        let factor = parameter.kind.factor();
        let (estimate, badge) = if parameter.identifiable() {
            let (value, sigma) = (parameter.value / factor, parameter.sigma / factor);
            (Cell::Estimate { value, sigma }, Cell::badge(Tone::Good, OBSERVABLE))
        } else {
            (Cell::text(NONE), Cell::badge(Tone::Warning, "combination"))
        };
        vec![
            Cell::text(&parameter.id),
            estimate,
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
        intro: "The errors are those of measured = true + bias + (S + M) true. To compensate, solve it for the true rate; \
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
                    Column::text("observability"),
                ],
                rows: rows.collect(),
            }),
            Item::Note(Tone::Neutral, SYSTEMATIC_NOTE.into()),
            Item::Matrix(Matrix {
                caption: "Correlation of the estimates".into(),
                labels: calibration.parameters.iter().map(|p| p.id.clone()).collect(),
                values: (0..3)
                    .map(|row| (0..3).map(|column| calibration.correlation[(row, column)]).collect())
                    .collect(),
            }),
            Item::Text(format!(
                "The attitude of the axis frame is an augmented state. Its 1σ, by the whole run, is {:.2}″ about east, {:.2}″ about \
                 north and {:.1}″ about up. The tilts include the accelerometers' constant errors.",
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
            title: parameter.id.clone(),
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
                name: parameter.id.clone(),
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
        heading: "Convergence of the estimates".into(),
        intro: format!(
            "Each estimate with its 3σ band, from where its sigma has come down to {SETTLED} times the last."
        ),
        items: plots.chain(std::iter::once(sigma)).collect(),
    }
}
