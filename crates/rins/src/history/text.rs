//! A history in words.

use std::fmt::Write as _;

use rins_history::Conditions;
use rins_io::date_text;
use rins_report::number::figure;

use super::{Predicted, RunHistory};
use crate::homogeneity::{INTERVAL, homogeneity, summary};
use crate::log::DAY;
use crate::table::aligned;

/// The summary for a terminal.
pub(super) fn history_text(history: &RunHistory) -> String {
    let mut text = format!("{}\n", title(history));
    // Writing to a string cannot fail, here and below.
    for sentence in summary(&history.comparison) {
        let _ = writeln!(text, "  {sentence}");
    }
    let _ = write!(text, "\n{}", aligned(&homogeneity(&history.comparison)));
    let _ = write!(text, "\n  {}\n{}", predicted_run(history), aligned(&forecasts(history)));
    let scores = scores(history);
    if scores.len() > 1 {
        let _ = write!(text, "\n  Runs predicted from the runs before them\n{}", aligned(&scores));
    }
    for remark in &history.remarks {
        let _ = write!(text, "\n  {remark}\n");
    }
    text
}

pub(super) fn title(history: &RunHistory) -> String {
    format!("History of {} runs", history.comparison.names.len())
}

/// The conditions of the run that is predicted.
pub(super) fn predicted_run(history: &RunHistory) -> String {
    let Conditions { date, since_power_on, temperature, .. } = history.next;
    let mut under: Vec<String> = Vec::new();
    under.extend(date.map(|days| date_text(days * DAY)));
    under.extend(
        since_power_on.map(|time| format!("{} min after power-on", figure(time / 60.0, 3))),
    );
    under.extend(temperature.map(|value| format!("{value:.1} °C")));
    under.push("another power-on".into());
    format!("Forecast of the next run: {}", under.join(", "))
}

/// The forecasts as a table.
pub(super) fn forecasts(history: &RunHistory) -> Vec<Vec<String>> {
    let mut rows =
        vec![["parameter", "mean", "1σ", "95 % from", "to", "unit"].map(String::from).to_vec()];
    let parameters = history.comparison.history.quantities().iter().zip(&history.comparison.units);
    for ((one, unit), predicted) in parameters.zip(&history.forecasts) {
        match predicted {
            Predicted::Forecast(forecast) => {
                let (low, high) = forecast.interval(INTERVAL);
                rows.push(vec![
                    one.id.clone(),
                    figure(forecast.mean(), 5),
                    figure(forecast.sigma(), 2),
                    figure(low, 5),
                    figure(high, 5),
                    (*unit).into(),
                ]);
            }
            Predicted::Lacks(why) => {
                let dash = || "–".to_string();
                rows.push(vec![one.id.clone(), dash(), dash(), dash(), dash(), why.clone()]);
            }
        }
    }
    rows
}

/// How well runs are predicted, as a table.
pub(super) fn scores(history: &RunHistory) -> Vec<Vec<String>> {
    let head = ["parameter", "inside 95 %", "CRPS", "last value", "mean", "line", "unit"];
    let mut rows = vec![head.map(String::from).to_vec()];
    let parameters = history.comparison.history.quantities().iter().zip(&history.comparison.units);
    for ((one, unit), score) in parameters.zip(&history.scores) {
        let Some(crps) = score.crps else { continue };
        let inside = score.runs.iter().filter(|(_, forecast, value, _)| {
            let (low, high) = forecast.interval(INTERVAL);
            low <= *value && *value <= high
        });
        let mut row = vec![one.id.clone(), format!("{} of {}", inside.count(), score.runs.len())];
        row.extend(crps.map(|crps| figure(crps, 3)));
        row.push((*unit).into());
        rows.push(row);
    }
    rows
}
