//! The changes between two calibrations as text and as a report page.

use std::fmt::Write as _;

use super::{Comparison, Moved};
use crate::consistency::probability;
use crate::table::aligned;
use rins_report::number::figure;
use rins_report::{Cell, Column, Item, Report, Section, Table, Tone};

/// The change in sigmas above which a parameter counts as changed.
const MOVED: f64 = 3.0;

/// The summary for a terminal.
pub(super) fn comparison_text(comparison: &Comparison) -> String {
    let mut text = format!("{}\n", title(comparison));
    for sentence in summary(comparison) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {sentence}");
    }
    text.push('\n');
    let mut rows = vec![
        ["parameter", "before", "after", "difference", "sigma", "sigmas", "unit"]
            .map(String::from)
            .to_vec(),
    ];
    rows.extend(comparison.moved.iter().map(|moved| {
        vec![
            moved.id.clone(),
            figure(moved.values[0], 4),
            figure(moved.values[1], 4),
            figure(moved.difference(), 4),
            figure(moved.sigma, 4),
            format!("{:+.1}", moved.sigmas_moved()),
            moved.unit.into(),
        ]
    }));
    text.push_str(&aligned(&rows));
    for assumption in &comparison.basis.assumptions {
        let _ = write!(text, "\n  {assumption}\n");
    }
    text
}

fn title(comparison: &Comparison) -> String {
    format!("From {} to {}", comparison.names[0], comparison.names[1])
}

fn has_moved(moved: &Moved) -> bool {
    moved.sigmas_moved().abs() > MOVED
}

fn summary(comparison: &Comparison) -> Vec<String> {
    let moved: Vec<&str> =
        comparison.moved.iter().filter(|m| has_moved(m)).map(|m| m.id.as_str()).collect();
    let total = comparison.moved.len();
    let mut sentences = vec![if moved.is_empty() {
        format!("None of {total} parameters changed by more than {MOVED} sigma of the difference.")
    } else {
        format!(
            "{} of {total} parameters changed by more than {MOVED} sigma of the difference: {}.",
            moved.len(),
            moved.join(", ")
        )
    }];
    if let Some(together) = comparison.together {
        sentences.push(format!(
            "Together, with all correlations: chi-square {} with {} degrees of freedom, p {}.",
            figure(together.chi_square, 4),
            together.dof,
            probability(together.p)
        ));
    }
    for (name, only) in comparison.names.iter().zip(&comparison.only) {
        if !only.is_empty() {
            sentences.push(format!("Only {name} has estimated {}.", only.join(", ")));
        }
    }
    sentences.push(
        "Biases change from one turn-on to the next; scale errors and misalignments should not."
            .into(),
    );
    sentences
}

/// The report page.
pub(super) fn comparison_report(comparison: &Comparison) -> Report {
    let rows = comparison.moved.iter().map(|moved| {
        let off = moved.sigmas_moved();
        let badge = if has_moved(moved) {
            Cell::badge(Tone::Warning, "changed")
        } else {
            Cell::badge(Tone::Good, "as before")
        };
        vec![
            Cell::text(&moved.id),
            Cell::Estimate { value: moved.values[0], sigma: moved.sigmas[0] },
            Cell::Estimate { value: moved.values[1], sigma: moved.sigmas[1] },
            Cell::Estimate { value: moved.difference(), sigma: moved.sigma },
            Cell::text(moved.unit),
            Cell::Number { value: off, decimals: 1 },
            Cell::Bar { value: off / 10.0, sigma: 0.1 },
            badge,
        ]
    });
    Report {
        title: title(comparison),
        subtitle: "rins compare".into(),
        summary: summary(comparison),
        sections: vec![Section {
            heading: "Changes".into(),
            intro: "Differences are after minus before, their sigmas those of both together. Bars reach to ten sigmas."
                .into(),
            items: vec![Item::Table(Table {
                caption: "Parameters that both have estimated, 1σ".into(),
                columns: vec![
                    Column::id("parameter"),
                    Column::number("before"),
                    Column::number("after"),
                    Column::number("difference"),
                    Column::text("unit"),
                    Column::number("in sigmas"),
                    Column::text("within ±10σ"),
                    Column::text(""),
                ],
                rows: rows.collect(),
            })],
        }],
    }
}
