//! A campaign as text, JSON, report and Parquet file: do the errors agree with the covariances?

use std::cell::RefCell;
use std::fmt::Write as _;
use std::path::Path;

use nalgebra::Vector3;
use rins_campaign::{PARAMETERS, Statistics, Tally};
use rins_io::{Heading, IoError, Overwrite};
use rins_report::{Cell, Column, Item, Plot, Report, Section, Series, Style, Table, Tone};

use super::execution::Rows;
use super::outcome::{CampaignOutcome, Files, Source, label};
use super::result::CellResult;
use super::runs::{Run, UNITS};

/// The maximum number of runs in a plot, of each scenario and in total.
const SHOWN: [usize; 2] = [2000, 50_000];

/// A scenario of the grid with the statistics of its runs.
struct Scored<'a> {
    values: &'a [String],
    cell: usize,
    truth: Vector3<f64>,
    tally: Tally,
    /// The errors of the first runs with estimates, divided by their sigmas.
    errors: Vec<Vector3<f64>>,
    statistics: Option<Statistics>,
}

/// Writes the results and their report, and returns the outcome.
///
/// The runs come in the order of scenarios and runs and are written one by one; only the data that the report needs are kept.
pub(super) fn deliver(
    heading: &Heading,
    runs: impl Iterator<Item = Result<Run, IoError>>,
    output: &Path,
    source: Source<'_>,
    overwrite: Overwrite,
) -> anyhow::Result<CampaignOutcome> {
    let title = format!("Campaign of {}", source.0);
    let files = Files::of(output)?;
    let scored = RefCell::new(Vec::new());
    let rows =
        runs.map(|run| run.map(|run| Scored::add(&mut scored.borrow_mut(), heading, &run).rows()));
    files.write(overwrite, heading, rows, || {
        let mut scored = scored.borrow_mut();
        for cell in scored.iter_mut() {
            cell.statistics = cell.tally.statistics();
        }
        report(heading, &scored, &title)
    })?;
    let scored = scored.into_inner();
    let cells = scored.iter().map(|cell| cell_result(&heading.keys, cell)).collect();
    Ok(files.outcome(heading, source, cells, text(heading, &scored, &title)))
}

impl<'a> Scored<'a> {
    /// Adds a run to its scenario, which is the last one or a new one.
    fn add<'r>(all: &mut Vec<Self>, heading: &'a Heading, run: &'r Run) -> &'r Run {
        if all.last().is_none_or(|last| last.cell != run.cell) {
            all.push(Self {
                values: &heading.values[run.cell],
                cell: run.cell,
                truth: run.truth,
                tally: Tally::new(run.truth),
                errors: Vec::new(),
                statistics: None,
            });
        }
        let [of_each, of_all] = SHOWN;
        let shown = (of_all / heading.values.len().max(1)).clamp(1, of_each);
        if let Some(cell) = all.last_mut() {
            cell.tally.add(&run.result);
            if let Ok(found) = &run.result
                && cell.errors.len() < shown
            {
                let sigma = found.covariance.diagonal().map(f64::sqrt);
                cell.errors.push((found.value - run.truth).component_div(&sigma));
            }
        }
        run
    }
}

fn verdict(statistics: &Statistics) -> (Tone, &'static str) {
    if statistics.is_honest() {
        (Tone::Good, "consistent with their sigmas")
    } else if statistics.nees > statistics.nees_bounds[1] {
        (Tone::Bad, "larger than their sigmas state")
    } else {
        (Tone::Warning, "smaller than their sigmas state")
    }
}

fn text(heading: &Heading, scored: &[Scored<'_>], title: &str) -> String {
    let mut text = format!("{title}\n");
    for cell in scored {
        let Some(statistics) = &cell.statistics else {
            let _ = writeln!(text, "\n  {}: too few runs", label(&heading.keys, cell.values));
            continue;
        };
        let [least, most] = statistics.nees_bounds;
        let _ = writeln!(
            text,
            "\n  {}: {} runs, {} failed; errors are {}\n    NEES {:.3} (consistent from {least:.3} to {most:.3}), NIS {:.4} of 1",
            label(&heading.keys, cell.values),
            statistics.runs,
            statistics.failed,
            verdict(statistics).1,
            statistics.nees,
            statistics.nis_ratio
        );
        for ((id, (unit, _)), scatter) in PARAMETERS.iter().zip(UNITS).zip(&statistics.parameters) {
            let _ = writeln!(
                text,
                "    {id:22} mean error {:+.5} {unit}, standard deviation {:.5}, RMS sigma {:.5}, coverage of 95 % intervals {:.1} %",
                scatter.mean_error,
                scatter.spread,
                scatter.claimed,
                100.0 * scatter.coverage
            );
        }
    }
    text
}

fn cell_result(keys: &[String], cell: &Scored<'_>) -> CellResult {
    let grid = keys.iter().cloned().zip(cell.values.iter().cloned()).collect();
    match &cell.statistics {
        None => CellResult::too_few(grid, cell.tally.runs()),
        Some(statistics) => CellResult::of(grid, &cell.truth, statistics),
    }
}

fn report(heading: &Heading, scored: &[Scored<'_>], title: &str) -> Report {
    let consistent = scored.iter().filter_map(|cell| cell.statistics.as_ref());
    let consistent = consistent.filter(|statistics| statistics.is_honest()).count();
    let failed: usize = scored.iter().filter_map(|cell| cell.statistics).map(|s| s.failed).sum();
    let mut summary = vec![format!(
        "In {consistent} of {} scenarios the covariances are consistent with the errors.",
        scored.len()
    )];
    if failed > 0 {
        summary.push(format!("{failed} runs have no estimates; the results say why."));
    }
    let mut sections = vec![overview(heading, scored)];
    for (row, id) in PARAMETERS.iter().enumerate() {
        sections.push(parameter_section(scored, row, id));
    }
    let (shard, of) = heading.identity.shard;
    Report {
        title: title.into(),
        subtitle: format!(
            "{} runs of each scenario, seed {}, shard {shard} of {of}",
            heading.identity.runs, heading.identity.seed
        ),
        summary,
        sections,
    }
}

/// A row for each scenario.
fn overview(heading: &Heading, scored: &[Scored<'_>]) -> Section {
    let row = |cell: &Scored<'_>| {
        let name = Cell::text(label(&heading.keys, cell.values));
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
                covariances are consistent; 99 % of such campaigns lie within the bounds."
            .into(),
        items: vec![Item::Table(Table {
            caption: "What the runs say together".into(),
            columns: columns.collect(),
            rows: scored.iter().map(row).collect(),
        })],
    }
}

/// The errors of one parameter compared with their standard uncertainties.
fn parameter_section(scored: &[Scored<'_>], row: usize, id: &str) -> Section {
    let unit = UNITS[row].0;
    let mut points = Series { name: "a run".into(), style: Style::Points, ..Series::default() };
    let (mut claimed, mut spread) = (
        Series { name: "RMS sigma".into(), style: Style::Steps, ..Series::default() },
        Series { name: "spread of the runs".into(), style: Style::Points, ..Series::default() },
    );
    for (place, cell) in scored.iter().enumerate() {
        for (index, errors) in cell.errors.iter().enumerate() {
            points.x.push(place as f64 + index as f64 / cell.errors.len() as f64);
            points.y.push(errors[row]);
        }
        if let Some(statistics) = &cell.statistics {
            let scatter = &statistics.parameters[row];
            claimed.x.push(place as f64);
            claimed.y.push(scatter.claimed);
            spread.x.push(place as f64);
            spread.y.push(scatter.spread);
        }
    }
    let x_label = "Scenario, in the order of the table, from 0";
    let reference = |value: f64, name: &str| rins_report::Reference { name: name.into(), value };
    Section {
        heading: id.into(),
        intro: "Where covariances are consistent, one run in 20 lies beyond ±1.96.".into(),
        items: vec![
            Item::Plot(Plot {
                title: "Errors over their sigmas".into(),
                x_label: x_label.into(),
                y_label: "Error / σ".into(),
                series: vec![points],
                references: vec![reference(1.96, "95 %"), reference(-1.96, "95 %")],
                ..Plot::default()
            }),
            Item::Plot(Plot {
                title: "RMS sigma and standard deviation of the errors".into(),
                x_label: x_label.into(),
                y_label: format!("1σ [{unit}]"),
                series: vec![claimed, spread],
                ..Plot::default()
            }),
        ],
    }
}
