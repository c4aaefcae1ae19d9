//! The report page of a campaign of a model.

use rins_campaign::{EcdfBand, PosteriorStatistics, QuantityStatistics};
use rins_io::Heading;
use rins_report::{Band, Cell, Column, Item, Plot, Report, Section, Series, Style, Table, Tone};

use super::result::{Observability, Verdicts, in_words};
use super::scored::Scored;
use super::text::{p_value, ranks, setting, size};
use crate::campaign::outcome::label;

/// The maximum number of scenarios with tables and plots of their own.
const DETAILED: usize = 8;

/// The report page.
pub(super) fn report(heading: &Heading, scored: &[Scored<'_>], title: &str) -> Report {
    let judged = || scored.iter().filter_map(|cell| cell.statistics.as_ref());
    let consistent = judged().filter(|(statistics, _)| statistics.is_consistent()).count();
    let uniform = judged().filter(|(_, verdicts)| verdicts.failed() == 0).count();
    let failed: usize = scored.iter().map(|cell| cell.failed).sum();
    let n = scored.len();
    let mut summary = vec![format!(
        "In {consistent} of {n} scenarios the covariances are consistent with the errors; in {uniform} of {n} the ranks of \
         the true values in their posteriors are uniform."
    )];
    if failed > 0 {
        summary.push(format!("{failed} runs have no estimates; the results state the reasons."));
    }
    if n > DETAILED {
        summary.push(format!(
            "The first {DETAILED} scenarios have tables and plots; the JSON result has all."
        ));
    }
    let mut sections = vec![overview(heading, scored)];
    for cell in scored.iter().take(DETAILED) {
        if let Some((statistics, verdicts)) = &cell.statistics {
            sections.push(of_cell(heading, cell, statistics, verdicts));
        }
    }
    let (shard, of) = heading.identity.shard;
    Report {
        title: title.into(),
        subtitle: format!(
            "{} runs of each scenario, seed {}, shard {shard} of {of}; {}",
            heading.identity.runs,
            heading.identity.seed,
            setting(heading)
        ),
        summary,
        sections,
    }
}

/// A number with decimals.
const fn number(value: f64, decimals: usize) -> Cell {
    Cell::Number { value, decimals }
}

/// A row for each scenario.
fn overview(heading: &Heading, scored: &[Scored<'_>]) -> Section {
    let row = |cell: &Scored<'_>| {
        let name = Cell::text(label(&heading.keys, cell.values));
        let Some((statistics, verdicts)) = &cell.statistics else {
            return vec![
                name,
                number((cell.runs - cell.failed) as f64, 0),
                number(cell.failed as f64, 0),
            ];
        };
        let tone = match (statistics.is_consistent(), statistics.nees > statistics.nees_bounds[1]) {
            (true, _) => Tone::Good,
            (false, true) => Tone::Bad,
            (false, false) => Tone::Warning,
        };
        let is_uniform = verdicts.failed() == 0;
        vec![
            name,
            number(statistics.runs as f64, 0),
            number(cell.failed as f64, 0),
            number(cell.not_converged as f64, 0),
            number(statistics.nees, 3),
            number(statistics.nees_dof, 3),
            number(statistics.nees_bounds[0], 3),
            number(statistics.nees_bounds[1], 3),
            number(statistics.nis_ratio, 4),
            Cell::badge(tone, size(statistics)),
            Cell::badge(
                if is_uniform { Tone::Good } else { Tone::Bad },
                if is_uniform {
                    "uniform".into()
                } else {
                    format!("{} not uniform", verdicts.failed())
                },
            ),
        ]
    };
    let numbers =
        ["Runs", "Failed", "Not converged", "NEES", "expected", "from", "to", "NIS / dof"];
    let columns = std::iter::once(Column::text("Scenario"))
        .chain(numbers.map(Column::number))
        .chain([Column::text("Errors"), Column::text("Ranks")]);
    Section {
        heading: "Scenarios".into(),
        intro: "The NEES is the squared error of the well-determined combinations of the parameters, normalized by their covariance. 99 % \
                of campaigns with consistent covariances lie within the bounds. The rank of a true value in its posterior is uniform over \
                the runs if the posterior is calibrated; the verdict has 1 % of false alarms for each scenario."
            .into(),
        items: vec![Item::Table(Table {
            caption: "Consistency of each scenario".into(),
            columns: columns.collect(),
            rows: scored.iter().map(row).collect(),
        })],
    }
}

/// Tables and plots of a scenario.
fn of_cell(
    heading: &Heading,
    cell: &Scored<'_>,
    statistics: &PosteriorStatistics,
    verdicts: &Verdicts,
) -> Section {
    let ids = cell.ids();
    let mut items = vec![
        Item::Table(parameters(cell, statistics, verdicts)),
        Item::Table(combinations(statistics, verdicts, &ids)),
    ];
    for (name, prefix) in [("Gyros", "gyro"), ("Accelerometers", "accel")] {
        items.extend(ecdf(name, statistics, &ids, |id| id.starts_with(prefix)));
    }
    items.extend(ecdf("Other parameters", statistics, &ids, |id| {
        !id.starts_with("gyro") && !id.starts_with("accel")
    }));
    let names: Vec<String> =
        (1..=statistics.of_combinations.len()).map(|place| place.to_string()).collect();
    items.extend(plot(
        "Well-determined combinations",
        &statistics.band,
        names.iter().zip(&statistics.of_combinations),
    ));
    items.push(Item::Table(coverage(statistics, &ids, &names)));
    let sentence = ranks(verdicts);
    Section {
        heading: match label(&heading.keys, cell.values) {
            name if name == "the scenario" => "Posteriors and true values".into(),
            name => name,
        },
        intro: format!(
            "{}{}. A curve that leaves its band shows a posterior that is not calibrated: an S falling first has sigmas that are too large, \
             one rising first has sigmas that are too small, and an arc is a bias.",
            sentence[..1].to_uppercase(),
            &sentence[1..]
        ),
        items,
    }
}

/// The cells that parameters and combinations share.
fn shared(quantity: &QuantityStatistics) -> [Cell; 4] {
    let [low, high] = quantity.rms_ratio_interval_95;
    let p_value = Cell::text(p_value(quantity.p_value));
    [number(quantity.rms_ratio, 3), number(low, 3), number(high, 3), p_value]
}

/// The columns of these cells.
fn shared_columns() -> [Column; 4] {
    ["RMS error/σ", "from", "to", "p ranks"].map(Column::number)
}

/// The coverage of the intervals of each parameter and combination.
fn coverage(statistics: &PosteriorStatistics, ids: &[String], names: &[String]) -> Table {
    let columns = ["68 %", "95 %", "99.7 %"]
        .into_iter()
        .flat_map(|name| [name, "from", "to"].map(Column::number));
    let row = |(name, quantity): (String, &QuantityStatistics)| {
        let cells = quantity.coverage.iter().flat_map(|one| {
            let [low, high] = one.interval_95;
            [one.fraction, low, high].map(|part| number(100.0 * part, 1))
        });
        std::iter::once(Cell::Text(name)).chain(cells).collect()
    };
    let parameters = ids.iter().cloned().zip(&statistics.parameters);
    let names = names.iter().map(|name| format!("combination {name}"));
    let combinations = names.zip(&statistics.of_combinations);
    Table {
        caption: "Coverage of central intervals in percent, with 95 % intervals (Clopper-Pearson)"
            .into(),
        columns: std::iter::once(Column::id("Parameter")).chain(columns).collect(),
        rows: parameters.chain(combinations).map(row).collect(),
    }
}

fn badge(calibrated: Option<bool>) -> Cell {
    match calibrated {
        Some(true) => Cell::badge(Tone::Good, "calibrated"),
        Some(false) => Cell::badge(Tone::Bad, "not calibrated"),
        None => Cell::badge(Tone::Neutral, "not tested"),
    }
}

fn parameters(cell: &Scored<'_>, statistics: &PosteriorStatistics, verdicts: &Verdicts) -> Table {
    let columns = [Column::id("Parameter"), Column::text("Unit")]
        .into_iter()
        .chain(["Prior σ", "σ"].map(Column::number))
        .chain([Column::number("Bias")])
        .chain(shared_columns())
        .chain([Column::text("Posterior"), Column::text("Observability")]);
    let row = |(place, quantity): (usize, &QuantityStatistics)| {
        let parameter = &cell.parameters[place];
        let figure = |value: f64| Cell::text(rins_report::number::figure(value, 3));
        let mut cells = vec![
            Cell::text(&parameter.id),
            Cell::text(&parameter.unit),
            figure(quantity.prior_sigma_rms),
            figure(quantity.sigma_rms),
            Cell::Estimate { value: quantity.mean_error, sigma: quantity.mean_error_sigma },
        ];
        cells.extend(shared(quantity));
        let observability = verdicts.observability[place];
        let tone = match observability {
            Observability::Observable => Tone::Good,
            Observability::InCombination | Observability::Unobservable => Tone::Warning,
        };
        cells.push(badge(verdicts.parameters[place]));
        let words = match observability {
            Observability::InCombination => "in combination",
            other => other.words(),
        };
        cells.push(Cell::badge(tone, words));
        cells
    };
    Table {
        caption: "Parameters: root mean squares over the runs, bias with its standard error".into(),
        columns: columns.collect(),
        rows: statistics.parameters.iter().enumerate().map(row).collect(),
    }
}

fn combinations(statistics: &PosteriorStatistics, verdicts: &Verdicts, ids: &[String]) -> Table {
    let columns = [Column::number("Combination"), Column::number("σ / prior σ")]
        .into_iter()
        .chain([Column::number("Bias")])
        .chain(shared_columns())
        .chain([Column::text("Posterior"), Column::text("Weights of parameters over prior σ")]);
    let row = |(place, quantity): (usize, &QuantityStatistics)| {
        let mut cells = vec![
            number((place + 1) as f64, 0),
            Cell::text(rins_report::number::figure(quantity.sigma_rms, 3)),
            Cell::Estimate { value: quantity.mean_error, sigma: quantity.mean_error_sigma },
        ];
        cells.extend(shared(quantity));
        cells.push(badge(Some(verdicts.combinations[place])));
        cells.push(Cell::text(in_words(&statistics.combinations, place, ids)));
        cells
    };
    Table {
        caption: "Well-determined combinations (eigenvectors of the posterior covariance in units of the prior sigmas)".into(),
        columns: columns.collect(),
        rows: statistics.of_combinations.iter().enumerate().map(row).collect(),
    }
}

/// The plot of the parameters that are selected by their ids, if there are any.
fn ecdf(
    title: &str,
    statistics: &PosteriorStatistics,
    ids: &[String],
    is_shown: impl Fn(&str) -> bool,
) -> Option<Item> {
    let all = ids.iter().zip(&statistics.parameters);
    plot(title, &statistics.band, all.filter(|(id, _)| is_shown(id)))
}

fn plot<'q>(
    title: &str,
    band: &EcdfBand,
    quantities: impl Iterator<Item = (&'q String, &'q QuantityStatistics)>,
) -> Option<Item> {
    let with_ends = |inner: &[f64], ends: [f64; 2]| {
        let [first, last] = ends;
        std::iter::once(first).chain(inner.iter().copied()).chain([last]).collect::<Vec<f64>>()
    };
    let points: Vec<f64> = EcdfBand::points().collect();
    let x = with_ends(&points, [0.0, 1.0]);
    let series: Vec<Series> = quantities
        .map(|(id, quantity)| Series {
            name: id.clone(),
            x: x.clone(),
            y: with_ends(&quantity.ecdf_difference, [0.0; 2]),
            style: Style::Line,
        })
        .collect();
    let [lower, upper] = band.differences().map(|edge| with_ends(&edge, [0.0; 2]));
    (!series.is_empty()).then(|| {
        Item::Plot(Plot {
            title: title.into(),
            x_label: "Rank of the true value in its posterior".into(),
            y_label: "ECDF − uniform".into(),
            series,
            bands: vec![Band { name: "95 %, simultaneous".into(), x: x.clone(), lower, upper }],
            caption: "A calibrated posterior stays within the band with a probability of 95 %."
                .into(),
            ..Plot::default()
        })
    })
}
