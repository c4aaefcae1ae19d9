//! A calibration with any model, for a terminal and for a browser.

use std::fmt::Write as _;

use rins_calibration::MEASUREMENTS;
use rins_estimation::{Estimate, correlation};
use rins_frames::units::DEG;
use rins_report::number::estimate as written;
use rins_report::{Cell, Column, Item, Matrix, Report, Section, Table, Tone};
use rins_terms::catalogue;

use super::certificate::{Certificate, CertifiedRun};
use super::compensation_guide::{budget_section, compensation_section};
use super::conformity::{conformity_section, conformity_sentences};
use super::departure::departure_in_words;
use super::noise::{noise_section, noise_sentence};
use super::uncertainty_words::{uncertainty_section, uncertainty_sentences};
use crate::consistency::{Residuals, consistency_section, consistency_sentence};
use crate::free_navigation::{gain_sentence, navigation_section};
use crate::homogeneity::RunComparison;
use crate::identifiability::{badge, gauge_sentences, observability, rank_sentence};
use crate::table::aligned;

/// What the rows of an innovation are.
const CHANNELS: [&str; MEASUREMENTS] = [
    "tilt of the spin axis about x of the axis frame",
    "tilt of the spin axis about y of the axis frame",
    "table angle",
    "velocity along x of the axis frame",
    "velocity along y of the axis frame",
    "velocity along z of the axis frame",
];

/// The summary for a terminal.
pub(super) fn certificate_text(certificate: &Certificate) -> String {
    let mut text = format!("{}\n", certificate.title());
    for sentence in summary(certificate) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {sentence}");
    }
    text.push('\n');
    let several = certificate.runs.len() > 1;
    let mut rows = vec![
        ["parameter", "run", "value", "sigma", "unit", "observability"].map(String::from).to_vec(),
    ];
    for (place, estimate) in certificate.fit.parameters.iter().enumerate() {
        let unit = estimate.parameter.unit;
        let (value, sigma) = written(estimate.value / unit.factor, estimate.sigma / unit.factor);
        rows.push(vec![
            estimate.parameter.id.clone(),
            run_name(estimate.run),
            value,
            sigma,
            unit.symbol.into(),
            observability(&certificate.identifiability, place, Some(certificate.value(place))),
        ]);
    }
    if !several {
        for row in &mut rows {
            row.remove(1);
        }
    }
    text.push_str(&aligned(&rows));
    for sentence in gauge_sentences(&certificate.identifiability) {
        let _ = writeln!(text, "  {sentence}");
    }
    text
}

fn run_name(run: Option<usize>) -> String {
    run.map_or_else(String::new, |run| (run + 1).to_string())
}

/// The result in plain words.
fn summary(certificate: &Certificate) -> Vec<String> {
    let mut sentences: Vec<String> = certificate
        .departed()
        .into_iter()
        .map(|of| departure_in_words(certificate, of) + ".")
        .collect();
    if let Some(comparison) = &certificate.comparison {
        sentences.extend(comparison.differences_of_joint_estimate());
    }
    let gains = certificate.runs.iter().map(|run| {
        let gain = gain_sentence("the estimated errors", &run.before, &run.after);
        if certificate.runs.len() > 1 { format!("{}: {gain}", run.prepared.name) } else { gain }
    });
    sentences.extend(gains);
    sentences.extend(conformity_sentences(certificate));
    sentences.extend(uncertainty_sentences(certificate));
    sentences.push(consistency_sentence(&certificate.consistency));
    sentences.push(rank_sentence(&certificate.identifiability));
    sentences.push(noise_sentence(certificate));
    sentences.extend(certificate.remarks.iter().cloned());
    sentences
}

/// The report page.
pub(super) fn certificate_report(certificate: &Certificate) -> Report {
    let mut sections = vec![parameters_section(certificate)];
    sections.extend(conformity_section(certificate));
    sections.extend(uncertainty_section(certificate));
    sections.push(correlation_section(certificate));
    sections.extend(certificate.comparison.as_ref().map(RunComparison::section));
    let several = certificate.runs.len() > 1;
    let of = |heading: &str, run: &CertifiedRun| {
        if several { format!("{heading}: {}", run.prepared.name) } else { heading.to_owned() }
    };
    for run in &certificate.runs {
        sections.push(navigation_section(
            &of("Free inertial navigation before and after", run),
            &run.before,
            &run.after,
        ));
    }
    sections.push(compensation_section(certificate.fit.model()));
    for run in &certificate.runs {
        let ids: Vec<&str> = run
            .places
            .iter()
            .map(|&place| certificate.fit.parameters[place].parameter.id.as_str())
            .collect();
        sections.push(budget_section(&of("Error budget", run), &ids, &run.budget));
    }
    sections.push(noise_section(certificate));
    for run in &certificate.runs {
        sections.push(consistency_section(
            &of("Does the model fit?", run),
            &run.consistency,
            &Residuals { channels: CHANNELS, times: &run.times, innovations: &run.innovations },
        ));
    }
    let samples: usize = certificate.runs.iter().map(|run| run.prepared.samples()).sum();
    Report {
        title: certificate.title(),
        subtitle: format!(
            "rins calibrate, model {}: {} parameters from {samples} samples",
            certificate.model,
            certificate.fit.parameters.len()
        ),
        summary: summary(certificate),
        sections,
    }
}

fn parameters_section(certificate: &Certificate) -> Section {
    let identifiability = &certificate.identifiability;
    let several = certificate.runs.len() > 1;
    let rows = certificate.fit.parameters.iter().enumerate().map(|(place, estimate)| {
        let unit = estimate.parameter.unit;
        let wide = 3.0 * estimate.parameter.sigma;
        let mut row = vec![
            Cell::text(&estimate.parameter.id),
            Cell::text(run_name(estimate.run)),
            Cell::Estimate {
                value: estimate.value / unit.factor,
                sigma: estimate.sigma / unit.factor,
            },
            Cell::text(unit.symbol),
            Cell::Bar {
                value: (estimate.value - estimate.expected) / wide,
                sigma: estimate.sigma / wide,
            },
            badge(identifiability, place),
            Cell::text(if identifiability.parameters[place].identifiable {
                String::new()
            } else {
                observability(identifiability, place, Some(certificate.value(place)))
            }),
        ];
        if !several {
            row.remove(1);
        }
        row
    });
    let mut columns = vec![
        Column::id("parameter"),
        Column::number("run"),
        Column::number("estimate"),
        Column::text("unit"),
        Column::text("relative to prior (±3 prior σ)"),
        Column::text("class"),
        Column::text("observability"),
    ];
    if !several {
        columns.remove(1);
    }
    let decimals = attitude_decimals(certificate);
    let axes = certificate.runs.iter().map(|run| {
        let angles = run.nav_from_table.euler_angles();
        let mut row = vec![Cell::text(&run.prepared.name)];
        row.extend(
            [angles.roll, angles.pitch, angles.yaw]
                .map(|angle| Cell::Number { value: angle / DEG, decimals }),
        );
        row
    });
    let mut items = vec![
        Item::Table(Table { caption: "Estimates, 1σ".into(), columns, rows: rows.collect() }),
        Item::Table(Table {
            caption: "Attitude of the axis frame (uncertainty: axis.attitude)".into(),
            columns: vec![
                Column::text("run"),
                Column::number("roll [deg]"),
                Column::number("pitch [deg]"),
                Column::number("yaw [deg]"),
            ],
            rows: axes.collect(),
        }),
    ];
    let gauges = gauge_sentences(identifiability).into_iter();
    items.splice(1..1, gauges.map(|sentence| Item::Note(Tone::Neutral, sentence)));
    Section {
        heading: "Parameters".into(),
        intro: "The errors are those of measured = true + bias + (S + M) true + terms. Estimates and sigmas are marginal and \
                include the prior. The bar shows the estimate minus the prior mean; its whisker is 1σ of the estimate. For a \
                parameter that is observable only in a combination, the last column has the estimate and sigma of the \
                combination. An unobservable or prior-dominated parameter keeps its prior mean. Parameters specific to one run have \
                the number of the run."
            .into(),
        items,
    }
}

/// The decimals of an attitude in degrees: down to the second digit of the smallest sigma of `axis.attitude`.
fn attitude_decimals(certificate: &Certificate) -> usize {
    let is_attitude =
        |estimate: &&Estimate| estimate.parameter.id.starts_with(catalogue::AXIS_ATTITUDE.id);
    let sigmas = certificate.fit.parameters.iter().filter(is_attitude);
    let least = sigmas.map(|estimate| estimate.sigma / DEG).fold(f64::INFINITY, f64::min);
    let is_enough = |decimals: &u8| 10.0_f64.powi(-i32::from(*decimals)) < least;
    (0..5).find(is_enough).map_or(5, |decimals| usize::from(decimals) + 1)
}

fn correlation_section(certificate: &Certificate) -> Section {
    let correlation = correlation(&certificate.fit.covariance);
    let labels = certificate.fit.parameters.iter().map(|estimate| {
        let run = if certificate.runs.len() > 1 { run_name(estimate.run) } else { String::new() };
        format!("{} {run}", estimate.parameter.id).trim_end().to_owned()
    });
    Section {
        heading: "Correlations".into(),
        intro: "The shade shows the magnitude of the correlation coefficient. The covariance is in calibration.toml, the \
                correlations are in result.json."
            .into(),
        items: vec![Item::Matrix(Matrix {
            caption: "Correlation of the estimates".into(),
            labels: labels.collect(),
            values: correlation.row_iter().map(|row| row.iter().copied().collect()).collect(),
        })],
    }
}
