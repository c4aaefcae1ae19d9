//! Goodness of fit of a model: the verdict as a sentence, and the whitened innovations.

use nalgebra::SVector;
use rins_calibration::{Consistency, MEASUREMENTS, Verdict};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};

use rins_report::{Cell, Column, Item, Plot, Reference, Section, Series, Style, Table, Tone};

/// What the innovations say of the model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConsistencyResult {
    /// The mean normalized innovation squared of an epoch.
    pub nis_mean: f64,
    /// How much it would be if the model were right: the mean number of channels of an epoch.
    #[serde(serialize_with = "whole")]
    pub nis_dof: f64,
    /// The p-value of the mean NIS.
    pub nis_p: f64,
    /// The p-value of the whiteness of the innovations.
    pub whiteness_p: f64,
    /// The root mean square of each channel of the whitened innovations: 1 if the model is right.
    pub channel_rms: [f64; MEASUREMENTS],
    /// Whether the verdict is no misfit.
    pub model_fits: bool,
    /// `fits`, `noise_overstated` or `misfit`.
    pub verdict: String,
}

/// Serializes a number as an integer if it is one: if all epochs have the same channels.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes by reference")]
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most six channels")]
fn whole<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if (number.round() - number).abs() < 1e-9 {
        serializer.serialize_u64(number.round() as u64)
    } else {
        serializer.serialize_f64(*number)
    }
}

impl From<&Consistency> for ConsistencyResult {
    fn from(consistency: &Consistency) -> Self {
        let verdict = match consistency.verdict() {
            Verdict::Fits => "fits",
            Verdict::NoiseOverstated => "noise_overstated",
            Verdict::Misfit => "misfit",
        };
        Self {
            nis_mean: consistency.nis_mean,
            nis_dof: consistency.nis_dof,
            nis_p: consistency.nis_p,
            whiteness_p: consistency.whiteness_p,
            channel_rms: consistency.channel_rms,
            model_fits: consistency.verdict() != Verdict::Misfit,
            verdict: verdict.into(),
        }
    }
}

/// A p-value as text.
pub(crate) fn probability(p: f64) -> String {
    if p < 1e-12 {
        "< 1e-12".into()
    } else if p < 0.001 {
        format!("= {p:.0e}")
    } else {
        format!("= {p:.3}")
    }
}

/// The goodness of fit as a sentence.
pub(crate) fn consistency_sentence(consistency: &Consistency) -> String {
    let figures = format!(
        "mean NIS {:.2}, expected {}; whiteness test p {}",
        consistency.nis_mean,
        (100.0 * consistency.nis_dof).round() / 100.0,
        probability(consistency.whiteness_p)
    );
    match consistency.verdict() {
        Verdict::Fits => {
            format!("The innovations are consistent with the model ({figures}).")
        }
        Verdict::NoiseOverstated => format!(
            "The innovations are smaller than the stated noise ({figures}): the sigmas are too large rather than too small."
        ),
        Verdict::Misfit => format!(
            "The model does not fit the data: {} ({figures}). The sigmas do not include the errors that unmodeled effects \
             cause in the estimates.",
            failed_tests(consistency)
        ),
    }
}

/// The failed consistency tests of a misfit, in words.
fn failed_tests(consistency: &Consistency) -> &'static str {
    match (consistency.is_too_large(), consistency.is_colored()) {
        (true, true) => "the innovations are too large and not white",
        (true, false) => "the innovations are too large",
        (false, _) => "the innovations are not white",
    }
}

/// Whitened innovations in the order of time.
pub(crate) struct Residuals<'a> {
    /// The names of the rows.
    pub(crate) channels: [&'static str; MEASUREMENTS],
    /// The time of each column \[s\].
    pub(crate) times: &'a [f64],
    pub(crate) innovations: &'a [SVector<f64, MEASUREMENTS>],
}

/// The report section on the goodness of fit, with the evidence.
pub(crate) fn consistency_section(
    heading: &str,
    consistency: &Consistency,
    residuals: &Residuals<'_>,
) -> Section {
    let rows = (0..MEASUREMENTS).map(|channel| {
        vec![
            Cell::text(residuals.channels[channel]),
            Cell::Number { value: consistency.channel_rms[channel], decimals: 3 },
            Cell::Number { value: consistency.periodogram_distance[channel], decimals: 4 },
        ]
    });
    let plots = (0..MEASUREMENTS).map(|channel| {
        Item::Plot(Plot {
            title: residuals.channels[channel].into(),
            x_label: "Time [s]".into(),
            y_label: "Whitened innovation [σ]".into(),
            series: vec![Series {
                name: "innovation".into(),
                x: residuals.times.to_vec(),
                y: residuals.innovations.iter().map(|nu| nu[channel]).collect(),
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
            "The expected RMS is 1. An RMS below 1 means that the assumed noise is too large; an RMS above 1 means that it is too \
             small or that an error is not modeled. The last column is the largest distance of the cumulative periodogram from \
             that of white noise (Kolmogorov-Smirnov distance)."
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
        heading: heading.into(),
        intro: "If the model is correct, the whitened innovations are independent and N(0, 1) distributed. Visible structure is \
                the sign of an unmodeled effect."
            .into(),
        items,
    }
}
