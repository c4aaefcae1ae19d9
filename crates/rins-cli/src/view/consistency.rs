//! Whether a model fits: the verdict in words, and the whitened innovations.

use nalgebra::SVector;
use rins_calibration::{Consistency, MEASUREMENTS, Verdict};

use rins_report::{Cell, Column, Item, Plot, Reference, Section, Series, Style, Table, Tone};

/// A p-value as a person reads it.
pub(crate) fn probability(p: f64) -> String {
    if p < 1e-12 {
        "below 1e-12".into()
    } else if p < 0.001 {
        format!("= {p:.0e}")
    } else {
        format!("= {p:.3}")
    }
}

/// What the innovations say of the model.
pub(crate) fn consistency_sentence(consistency: &Consistency) -> String {
    let figures = format!(
        "mean NIS {:.2} where {} is expected, whiteness p {}",
        consistency.nis_mean,
        (100.0 * consistency.nis_dof).round() / 100.0,
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

/// Whitened innovations in order of time.
pub(crate) struct Residuals<'a> {
    /// What the rows are.
    pub(crate) channels: [&'static str; MEASUREMENTS],
    /// When each came \[s\].
    pub(crate) times: &'a [f64],
    pub(crate) innovations: &'a [SVector<f64, MEASUREMENTS>],
}

/// Whether the model fits, with the evidence.
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
        heading: heading.into(),
        intro: "If it does, each whitened innovation is a draw from N(0, 1) of its own. Structure that you can see is an \
                effect that the model does not have."
            .into(),
        items,
    }
}
