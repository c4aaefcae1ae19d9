//! The uncertainty budget in words and as a section of a page.

use rins_report::number::figure;
use rins_report::{Cell, Column, Item, Section, Table};

use super::certificate::Certificate;
use super::uncertainty::{Reference, Uncertainty};

/// A parameter is in the summary if the references enlarge its uncertainty by more than this fraction.
const ENLARGED: f64 = 0.1;

/// The maximum number of parameters in the summary.
const TOLD: usize = 3;

/// The parameters whose uncertainty the references enlarge most, and their expanded uncertainty.
pub(super) fn uncertainty_sentences(certificate: &Certificate) -> Vec<String> {
    let identifiability = &certificate.identifiability;
    let prior_dominated = identifiability.unobservable();
    let of = |place: usize| {
        let uncertainty = certificate.uncertainty(place)?;
        let (value, sigma) = certificate.value(place);
        let is_own = identifiability.parameters[place].aliases.is_empty();
        let larger = sigma / uncertainty.estimated;
        let is_told = is_own && !prior_dominated.contains(&place) && larger > 1.0 + ENLARGED;
        is_told.then(|| (larger, sentence(certificate, place, (value, sigma), &uncertainty)))
    };
    let mut all: Vec<(f64, String)> =
        (0..certificate.fit.parameters.len()).filter_map(of).collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    all.truncate(TOLD);
    all.into_iter().map(|(_, sentence)| sentence).collect()
}

fn sentence(
    certificate: &Certificate,
    place: usize,
    (value, sigma): (f64, f64),
    uncertainty: &Uncertainty,
) -> String {
    let own = &certificate.fit.parameters[place].parameter;
    let in_unit = |x: f64| x / own.unit.factor;
    let factor = uncertainty.coverage_factor;
    let (value, expanded) = rins_report::number::estimate(in_unit(value), in_unit(factor * sigma));
    let largest = uncertainty.by_reference.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let largest = largest.map_or_else(String::new, |(reference, moved)| {
        format!(
            "; {} contributes {} {}, noise {} {}",
            reference.key(),
            figure(in_unit(moved.abs()), 2),
            own.unit.symbol,
            figure(in_unit(uncertainty.estimated), 2),
            own.unit.symbol
        )
    });
    format!(
        "{} = {value} ± {expanded} {} (95 %, coverage factor {factor:.2}){largest}.",
        own.id, own.unit.symbol
    )
}

/// The uncertainty budget; `None` if the accuracy of no reference is stated.
pub(super) fn uncertainty_section(certificate: &Certificate) -> Option<Section> {
    let references: Vec<Reference> =
        certificate.contributions.iter().map(|one| one.reference).collect();
    if references.is_empty() {
        return None;
    }
    let mut columns = vec![Column::id("parameter"), Column::number("type A: noise, priors")];
    columns.extend(references.iter().map(|one| Column::number(one.key())));
    columns.extend(["combined", "coverage factor", "expanded (95 %)"].map(Column::number));
    columns.push(Column::text("unit"));
    let row = |place: usize| {
        let uncertainty = certificate.uncertainty(place)?;
        let own = &certificate.fit.parameters[place].parameter;
        let (_, sigma) = certificate.value(place);
        let cell = |x: f64| Cell::text(figure(x / own.unit.factor, 3));
        let mut row = vec![Cell::text(own.id.clone()), cell(uncertainty.estimated)];
        row.extend(uncertainty.by_reference.iter().map(|(_, moved)| cell(*moved)));
        row.push(cell(sigma));
        row.push(Cell::text(format!("{:.2}", uncertainty.coverage_factor)));
        row.push(cell(uncertainty.coverage_factor * sigma));
        row.push(Cell::text(own.unit.symbol.to_owned()));
        Some(row)
    };
    let rows = (0..certificate.fit.parameters.len()).filter_map(row).collect();
    let caption = "Standard uncertainties. Type B: the estimate with the reference off by its standard uncertainty (rectangular \
                   distribution, limits of the rig file). Of a parameter that is observable only in a combination, those of the combination";
    Some(Section {
        heading: "Uncertainty budget".into(),
        intro: "JCGM 100:2008; coverage factors of the sum of a normal and the largest rectangular distribution (JCGM 101:2008).".into(),
        items: vec![Item::Table(Table { caption: caption.into(), columns, rows })],
    })
}
