//! A history as a report page.

use rins_report::{Band, Item, Plot, Report, Section, Series, Style};

use super::RunHistory;
use super::text::{forecasts, predicted_run, scores, title};
use crate::homogeneity::{HOMOGENEITY, INTERVAL, homogeneity, summary};
use crate::table::captioned;

/// The report page.
pub(super) fn history_report(history: &RunHistory) -> Report {
    let table = |rows: &[Vec<String>], caption: &str| Item::Table(captioned(caption, rows));
    let mut over_runs: Vec<Item> = vec![table(&homogeneity(&history.comparison), HOMOGENEITY)];
    over_runs
        .extend((0..history.comparison.units.len()).map(|place| Item::Plot(plot(history, place))));
    let mut sections = vec![
        Section {
            heading: "Between runs".into(),
            intro: "Estimates of each run with their 95 % intervals; what is grey was predicted from the runs before.".into(),
            items: over_runs,
        },
        Section {
            heading: "Next run".into(),
            intro: predicted_run(history),
            items: vec![table(
                &forecasts(history),
                "Means over all hypotheses, weighted by their posterior probabilities",
            )],
        },
    ];
    let scores = scores(history);
    if scores.len() > 1 {
        sections.push(Section {
            heading: "Prediction".into(),
            intro: "Each run was predicted from the runs before it. The continuous ranked probability score (CRPS) is in the unit of the \
                    parameter; the smaller the better. Beside it those of the last value, the mean and the line over the date."
                .into(),
            items: vec![table(&scores, "Mean scores")],
        });
    }
    if !history.remarks.is_empty() {
        let items = history.remarks.iter().cloned().map(Item::Text).collect();
        sections.push(Section { heading: "Remarks".into(), intro: String::new(), items });
    }
    Report {
        title: title(history),
        subtitle: "rins history".into(),
        summary: summary(&history.comparison),
        sections,
    }
}

/// The 95 % interval of a normal number, in sigmas.
const WITHIN: f64 = 1.96;

/// A parameter over the runs.
fn plot(history: &RunHistory, place: usize) -> Plot {
    let runs = history.comparison.history.runs();
    let dated = runs.iter().all(|run| run.conditions.date.is_some());
    let first = runs.first().and_then(|run| run.conditions.date).unwrap_or(0.0);
    let x = |run: usize| match runs[run].conditions.date.filter(|_| dated) {
        Some(date) => date - first,
        None => (run + 1) as f64,
    };
    let seen: Vec<(f64, f64, f64)> = (0..runs.len())
        .filter_map(|run| runs[run].value(place).map(|(value, sigma)| (x(run), value, sigma)))
        .collect();
    let column = |of: fn(&(f64, f64, f64)) -> f64| -> Vec<f64> { seen.iter().map(of).collect() };
    let id = &history.comparison.history.quantities()[place].id;
    let predicted = &history.scores[place].runs;
    let ends: Vec<(f64, f64, f64)> = predicted
        .iter()
        .map(|(run, forecast, ..)| {
            let (low, high) = forecast.interval(INTERVAL);
            (x(*run), low, high)
        })
        .collect();
    let mut bands = vec![Band {
        name: "estimate, 95 %".into(),
        x: column(|one| one.0),
        lower: column(|one| one.1 - WITHIN * one.2),
        upper: column(|one| one.1 + WITHIN * one.2),
    }];
    if !ends.is_empty() {
        bands.push(Band {
            name: "predicted, 95 %".into(),
            x: ends.iter().map(|one| one.0).collect(),
            lower: ends.iter().map(|one| one.1).collect(),
            upper: ends.iter().map(|one| one.2).collect(),
        });
    }
    Plot {
        title: id.clone(),
        x_label: if dated { "Days since the first run".into() } else { "Run".into() },
        y_label: format!("{id} [{}]", history.comparison.units[place]),
        bands,
        series: vec![Series {
            name: "estimate".into(),
            x: column(|one| one.0),
            y: column(|one| one.1),
            style: Style::Points,
        }],
        ..Plot::default()
    }
}
