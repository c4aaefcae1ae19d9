//! A campaign as text, JSON, report and Parquet file: do estimates scatter as claimed?

use std::fmt::Write as _;
use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use rins_calibration::Estimate;
use rins_campaign::{PARAMETERS, RunFailure, RunResult, Statistics};
use rins_frames::units::{ARCSEC, PPM};
use rins_io::{IoError, Overwrite, Part, Row, write_file, write_part};
use serde_json::{Value, json};

use crate::outcome::Outcome;
use crate::report::{
    Cell, Column, Item, Plot, Report, Section, Series, Style, Table, Tone, render,
};

/// The parameters' units: their names, and what one is in SI units.
pub(crate) const UNITS: [(&str, f64); 3] = [("arcsec", ARCSEC), ("arcsec", ARCSEC), ("ppm", PPM)];

/// The runs that a plot shows of each scenario.
const SHOWN: usize = 2000;

/// A scenario of the grid and what its runs say, in the parameters' units.
struct Scored {
    values: Vec<String>,
    truth: Vector3<f64>,
    runs: Vec<RunResult>,
    statistics: Option<Statistics>,
}

/// Writes results and their report, and says what they say.
pub(crate) fn deliver(
    part: &Part,
    output: &Path,
    source: &str,
    command: &'static str,
    overwrite: Overwrite,
) -> anyhow::Result<Outcome> {
    let scored = scored(part)?;
    let title = format!("Campaign of {source}");
    let page = render(&report(part, &scored, &title));
    let page_path = output.with_extension("html");
    anyhow::ensure!(page_path != output, "{}: the report would go here", output.display());
    write_file(&page_path, overwrite, |out| {
        out.write_all(page.as_bytes()).map_err(|error| IoError::File {
            action: "write",
            path: page_path.clone(),
            source: error,
        })
    })?;
    write_part(output, overwrite, part)?;
    let json = json!({
        "schema": 1,
        "command": command,
        "scenario": source,
        "runs": part.identity.runs,
        "seed": part.identity.seed,
        "shard": [part.identity.shard.0, part.identity.shard.1],
        "results": output.display().to_string(),
        "report": page_path.display().to_string(),
        "cells": scored.iter().map(|cell| cell_json(&part.keys, cell)).collect::<Vec<_>>(),
    });
    let text = text(part, &scored, &title)
        + &format!("\nResults: {}\nReport: {}\n", output.display(), page_path.display());
    Ok(Outcome { json, text, ..Outcome::default() })
}

/// The runs of each scenario that has any.
fn scored(part: &Part) -> anyhow::Result<Vec<Scored>> {
    let mut scored: Vec<Scored> = Vec::new();
    let mut last = None;
    for rows in part.rows.chunks(PARAMETERS.len()) {
        let whole = rows.len() == PARAMETERS.len()
            && rows.iter().zip(PARAMETERS).all(|(row, id)| row.parameter == id);
        anyhow::ensure!(whole, "run {} does not have its three parameters", rows[0].run);
        if last != Some(rows[0].cell) {
            last = Some(rows[0].cell);
            scored.push(Scored {
                values: part.values[usize::try_from(rows[0].cell)?].clone(),
                truth: Vector3::from_fn(|row, _| rows[row].record.truth),
                runs: Vec::new(),
                statistics: None,
            });
        }
        if let Some(cell) = scored.last_mut() {
            cell.runs.push(result(rows));
        }
    }
    for cell in &mut scored {
        cell.statistics = Statistics::of(&cell.truth, &cell.runs);
    }
    Ok(scored)
}

fn result(rows: &[Row]) -> RunResult {
    if !rows[0].failure.is_empty() {
        return Err(RunFailure { reason: rows[0].failure.clone() });
    }
    Ok(Estimate {
        value: Vector3::from_fn(|row, _| rows[row].record.estimate),
        covariance: Matrix3::from_fn(|row, column| rows[row].record.covariances[column]),
        nis_ratio: rows[0].record.nis_ratio,
    })
}

/// What distinguishes a scenario of the grid.
fn label(keys: &[String], values: &[String]) -> String {
    let pairs = keys.iter().zip(values).map(|(key, value)| format!("{key} = {value}"));
    let label = pairs.collect::<Vec<_>>().join(", ");
    if label.is_empty() { "the scenario".into() } else { label }
}

fn verdict(statistics: &Statistics) -> (Tone, &'static str) {
    if statistics.is_honest() {
        (Tone::Good, "as claimed")
    } else if statistics.nees > statistics.nees_bounds[1] {
        (Tone::Bad, "larger than claimed")
    } else {
        (Tone::Warning, "smaller than claimed")
    }
}

fn text(part: &Part, scored: &[Scored], title: &str) -> String {
    let mut text = format!("{title}\n");
    for cell in scored {
        let Some(statistics) = &cell.statistics else {
            let _ = writeln!(text, "\n  {}: too few runs", label(&part.keys, &cell.values));
            continue;
        };
        let [least, most] = statistics.nees_bounds;
        let _ = writeln!(
            text,
            "\n  {}: {} runs, {} failed; errors are {}\n    NEES {:.3} (honest from {least:.3} to {most:.3}), NIS {:.4} of 1",
            label(&part.keys, &cell.values),
            statistics.runs,
            statistics.failed,
            verdict(statistics).1,
            statistics.nees,
            statistics.nis_ratio
        );
        for ((id, (unit, _)), honesty) in PARAMETERS.iter().zip(UNITS).zip(&statistics.parameters) {
            let _ = writeln!(
                text,
                "    {id:22} mean error {:+.5} {unit}, spread {:.5}, claimed {:.5}, 95 % intervals hold {:.1} %",
                honesty.mean_error,
                honesty.spread,
                honesty.claimed,
                100.0 * honesty.coverage
            );
        }
    }
    text
}

fn cell_json(keys: &[String], cell: &Scored) -> Value {
    let grid: serde_json::Map<String, Value> =
        keys.iter().cloned().zip(cell.values.iter().map(|value| json!(value))).collect();
    let Some(statistics) = &cell.statistics else {
        return json!({ "grid": grid, "runs": cell.runs.len() });
    };
    let parameters = PARAMETERS.iter().zip(UNITS).zip(&statistics.parameters).enumerate();
    let parameters: Vec<Value> = parameters
        .map(|(row, ((id, (unit, _)), honesty))| {
            json!({
                "id": id,
                "unit": unit,
                "truth": cell.truth[row],
                "mean_error": honesty.mean_error,
                "spread": honesty.spread,
                "claimed": honesty.claimed,
                "coverage_95": honesty.coverage,
            })
        })
        .collect();
    json!({
        "grid": grid,
        "runs": statistics.runs,
        "failed": statistics.failed,
        "nees": statistics.nees,
        "nees_dof": PARAMETERS.len(),
        "nees_bounds_99": statistics.nees_bounds,
        "nis_ratio": statistics.nis_ratio,
        "honest": statistics.is_honest(),
        "parameters": parameters,
    })
}

fn report(part: &Part, scored: &[Scored], title: &str) -> Report {
    let honest = scored.iter().filter_map(|cell| cell.statistics.as_ref());
    let honest = honest.filter(|statistics| statistics.is_honest()).count();
    let failed: usize = scored.iter().filter_map(|cell| cell.statistics).map(|s| s.failed).sum();
    let mut summary = vec![format!(
        "In {honest} of {} scenarios the errors scatter as the covariances claim.",
        scored.len()
    )];
    if failed > 0 {
        summary.push(format!("{failed} runs have no estimates; the results say why."));
    }
    let mut sections = vec![overview(part, scored)];
    for (row, id) in PARAMETERS.iter().enumerate() {
        sections.push(parameter_section(scored, row, id));
    }
    let (shard, of) = part.identity.shard;
    Report {
        title: title.into(),
        subtitle: format!(
            "{} runs of each scenario, seed {}, shard {shard} of {of}",
            part.identity.runs, part.identity.seed
        ),
        summary,
        sections,
    }
}

/// A row for each scenario.
fn overview(part: &Part, scored: &[Scored]) -> Section {
    let row = |cell: &Scored| {
        let name = Cell::text(label(&part.keys, &cell.values));
        let Some(statistics) = &cell.statistics else { return vec![name] };
        let number = |value: f64, decimals: usize| Cell::Number { value, decimals };
        let (tone, word) = verdict(statistics);
        vec![
            name,
            number(statistics.runs as f64, 0),
            number(statistics.failed as f64, 0),
            number(statistics.nees, 3),
            number(statistics.nees_bounds[0], 3),
            number(statistics.nees_bounds[1], 3),
            number(statistics.nis_ratio, 4),
            Cell::badge(tone, word),
        ]
    };
    let numbers = ["Runs", "Failed", "NEES", "from", "to", "NIS / dof"];
    let columns = std::iter::once(Column::text("Scenario"))
        .chain(numbers.map(Column::number))
        .chain([Column::text("Errors")]);
    Section {
        heading: "Scenarios".into(),
        intro: "The mean normalised squared error of the three parameters is 3 where the \
                covariances are honest; 99 % of such campaigns lie within the bounds."
            .into(),
        items: vec![Item::Table(Table {
            caption: "What the runs say together".into(),
            columns: columns.collect(),
            rows: scored.iter().map(row).collect(),
        })],
    }
}

/// The errors of one parameter beside what is claimed for them.
fn parameter_section(scored: &[Scored], row: usize, id: &str) -> Section {
    let unit = UNITS[row].0;
    let error = |run: &Estimate, truth: f64| {
        let sigma = run.covariance[(row, row)].sqrt();
        ((run.value[row] - truth) / sigma, sigma)
    };
    let mut points = Series { name: "a run".into(), style: Style::Points, ..Series::default() };
    let (mut claimed, mut spread) = (
        Series { name: "claimed 1σ".into(), style: Style::Steps, ..Series::default() },
        Series { name: "spread of the runs".into(), style: Style::Points, ..Series::default() },
    );
    for (place, cell) in scored.iter().enumerate() {
        let found: Vec<&Estimate> = cell.runs.iter().filter_map(|run| run.as_ref().ok()).collect();
        let shown = found.len().min(SHOWN);
        for (index, run) in found.iter().take(shown).enumerate() {
            points.x.push(place as f64 + index as f64 / shown as f64);
            points.y.push(error(run, cell.truth[row]).0);
        }
        if let Some(statistics) = &cell.statistics {
            let honesty = &statistics.parameters[row];
            claimed.x.push(place as f64);
            claimed.y.push(honesty.claimed);
            spread.x.push(place as f64);
            spread.y.push(honesty.spread);
        }
    }
    let x_label = "Scenario, in the order of the table, from 0";
    let reference = |value: f64, name: &str| crate::report::Reference { name: name.into(), value };
    Section {
        heading: id.into(),
        intro: "Where covariances are honest, one run in 20 lies beyond ±1.96.".into(),
        items: vec![
            Item::Plot(Plot {
                title: "Errors over the sigma claimed".into(),
                x_label: x_label.into(),
                y_label: "Error / σ".into(),
                series: vec![points],
                references: vec![reference(1.96, "95 %"), reference(-1.96, "95 %")],
                ..Plot::default()
            }),
            Item::Plot(Plot {
                title: "Sigma claimed and spread found".into(),
                x_label: x_label.into(),
                y_label: format!("1σ [{unit}]"),
                series: vec![claimed, spread],
                ..Plot::default()
            }),
        ],
    }
}
