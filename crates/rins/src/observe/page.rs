//! What was found of schedules, as a report page.

use super::found::{ObservabilityStudy, Observed};
use super::words::{comparison, pair_sentences, proposal_sentences, row};
use crate::identifiability::{badge, gauge_sentences, list, rank_sentence};
use rins_report::{Cell, Column, Item, Report, Section, Table, Tone};

pub(super) fn report(found: &ObservabilityStudy) -> Report {
    let names: Vec<String> =
        found.observed.iter().map(|observed| observed.schedule.name.clone()).collect();
    let first = &found.observed[0];
    let mut summary = Vec::new();
    if found.observed.len() == 1 {
        summary.extend(proposal_sentences(found));
        summary.push(rank_sentence(&first.identifiability));
        summary.extend(first.pair.iter().flat_map(|pair| pair_sentences(pair, found)));
    } else {
        summary.extend(found.observed.iter().map(|observed| {
            format!("{}: {}", observed.schedule.name, rank_sentence(&observed.identifiability))
        }));
    }
    let mut sections = Vec::new();
    if found.observed.len() > 1 {
        sections.push(comparison_section(found));
    }
    sections.extend(found.observed.iter().map(schedule_section));
    Report {
        title: format!("Observability under {}", list(&names)),
        subtitle: format!("rins observe, model {}", found.model),
        summary,
        sections,
    }
}

fn comparison_section(found: &ObservabilityStudy) -> Section {
    let mut rows = comparison(found).into_iter();
    let heads = rows.next().unwrap_or_default();
    let columns = heads.iter().take(heads.len() - 1).enumerate();
    let columns = columns
        .map(|(place, head)| if place == 0 { Column::id("") } else { Column::number(head.clone()) })
        .collect();
    let rows = rows.map(|row| row.into_iter().map(Cell::text).collect()).collect();
    Section {
        heading: "Side by side".into(),
        intro: "1σ of each parameter with what is known beforehand; a star marks what is not observable by itself."
            .into(),
        items: vec![Item::Table(Table { caption: "Schedules".into(), columns, rows })],
    }
}

fn schedule_section(observed: &Observed) -> Section {
    let identifiability = &observed.identifiability;
    let rows = (0..identifiability.unknowns.len()).map(|place| {
        let [id, unit, known, data, both, meaning] = row(identifiability, place);
        vec![
            Cell::text(id),
            Cell::text(known),
            Cell::text(data),
            Cell::text(both),
            Cell::text(unit),
            badge(identifiability, place),
            Cell::text(meaning),
        ]
    });
    let mut items = vec![Item::Table(Table {
        caption: "Predicted 1σ".into(),
        columns: vec![
            Column::id("parameter"),
            Column::number("prior σ"),
            Column::number("σ, data only"),
            Column::number("σ, data and prior"),
            Column::text("unit"),
            Column::text("class"),
            Column::text("observability"),
        ],
        rows: rows.collect(),
    })];
    let gauges = gauge_sentences(identifiability).into_iter();
    items.extend(gauges.map(|sentence| Item::Note(Tone::Neutral, sentence)));
    Section {
        heading: observed.schedule.name.clone(),
        intro: format!(
            "{:.0} s. {} The least observable direction has an information of {:.0e}, the null space {:.0e}.",
            observed.schedule.duration(),
            rank_sentence(identifiability),
            identifiability.rank.least_told,
            identifiability.rank.most_null
        ),
        items,
    }
}
