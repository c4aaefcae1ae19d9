//! Statements of conformity with the tolerances of the rig file (ISO/IEC 17025:2017, 7.8.6).

use std::collections::BTreeMap;

use rins_design::coverage_factor;
use rins_report::number::figure;
use rins_report::{Cell, Column, Item, Section, Table};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::certificate::Certificate;
use crate::log::Log;

/// The decision rule, in words.
const RULE: &str = "Decision rule (ILAC-G8:09/2019, 4.2.3, non-binary statement with a guard band of the expanded uncertainty U, 95 %): pass \
                    if |value| + U is within the tolerance T, conditional pass if only |value| is, conditional fail if |value| - U is \
                    within T but |value| is not, fail otherwise";

/// Whether an error is within its tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Conformity {
    /// The error is within the tolerance with its expanded uncertainty.
    Pass,
    /// The estimate is within the tolerance.
    ConditionalPass,
    /// The estimate is beyond the tolerance by less than its expanded uncertainty.
    ConditionalFail,
    /// The error is beyond the tolerance with its expanded uncertainty.
    Fail,
    /// The runs do not determine the error by itself.
    NotDetermined,
}

impl Conformity {
    /// Of an estimate with this expanded uncertainty.
    fn of(value: f64, expanded: f64, tolerance: f64) -> Self {
        match value.abs() {
            size if size + expanded <= tolerance => Self::Pass,
            size if size <= tolerance => Self::ConditionalPass,
            size if size - expanded <= tolerance => Self::ConditionalFail,
            _ => Self::Fail,
        }
    }

    const fn words(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::ConditionalPass => "conditional pass",
            Self::ConditionalFail => "conditional fail",
            Self::Fail => "fail",
            Self::NotDetermined => "not determined",
        }
    }
}

/// The statement on one error, in the unit of the parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConformityResult {
    /// The id of the parameter.
    pub id: String,
    /// The largest magnitude that is permitted.
    pub tolerance: f64,
    /// The estimate; null if the error is not determined.
    pub value: Option<f64>,
    /// The expanded uncertainty of 95 %; null if the error is not determined.
    pub expanded: Option<f64>,
    /// The unit.
    pub unit: String,
    /// The statement.
    pub statement: Conformity,
}

/// The tolerances that the rig files state, by parameter, in the units of results.
///
/// # Errors
/// If two rig files state different tolerances.
pub(super) fn tolerances(logs: &[Log]) -> anyhow::Result<BTreeMap<String, f64>> {
    let mut stated = logs.iter().filter_map(|log| Some((log, log.loaded.rig.tolerance.as_ref()?)));
    let Some((first, tolerance)) = stated.next() else { return Ok(BTreeMap::new()) };
    if let Some((other, _)) = stated.find(|(_, other)| *other != tolerance) {
        anyhow::bail!(
            "{}: [tolerance] differs from that of {}, expected the same of one IMU",
            other.name,
            first.name
        );
    }
    let all = rins_io::parameters(tolerance).into_iter().filter(|one| one.value > 0.0);
    Ok(all.map(|one| (one.id, one.value)).collect())
}

impl ConformityResult {
    /// The statements of a calibration, one per tolerance.
    pub(super) fn all(certificate: &Certificate) -> Vec<Self> {
        certificate
            .tolerances
            .iter()
            .map(|(id, tolerance)| Self::of(certificate, id, *tolerance))
            .collect()
    }

    fn of(certificate: &Certificate, id: &str, tolerance: f64) -> Self {
        let parameters = &certificate.fit.parameters;
        let unit = rins_io::parameters(&rins_imu::ImuError::default())
            .into_iter()
            .find(|one| one.id == id)
            .map_or("", |one| one.unit);
        let prior_dominated = certificate.identifiability.unobservable();
        let is_own = |place: &usize| {
            parameters[*place].parameter.id == id
                && certificate.identifiability.parameters[*place].aliases.is_empty()
                && !prior_dominated.contains(place)
        };
        let mut places = (0..parameters.len()).filter(is_own);
        // An error that belongs to each run has no single value.
        let (Some(place), None) = (places.next(), places.next()) else {
            return Self {
                id: id.into(),
                tolerance,
                value: None,
                expanded: None,
                unit: unit.into(),
                statement: Conformity::NotDetermined,
            };
        };
        let in_unit = |si: f64| si / parameters[place].parameter.unit.factor;
        let (value, sigma) = certificate.value(place);
        let factor = certificate
            .uncertainty(place)
            .map_or_else(|| coverage_factor(sigma, &[]), |uncertainty| uncertainty.coverage_factor);
        let (value, expanded) = (in_unit(value), in_unit(factor * sigma));
        Self {
            id: id.into(),
            tolerance,
            value: Some(value),
            expanded: Some(expanded),
            unit: unit.into(),
            statement: Conformity::of(value, expanded, tolerance),
        }
    }

    /// The estimate with its uncertainty, and the tolerance.
    fn words(&self) -> String {
        let Self { id, tolerance, value, expanded, unit, statement } = self;
        let tolerance = format!("tolerance {} {unit}", figure(*tolerance, 3));
        match value.zip(*expanded) {
            Some((value, expanded)) => {
                let (value, expanded) = rins_report::number::estimate(value, expanded);
                format!(
                    "{id} = {value} ± {expanded} {unit} (95 %), {tolerance}: {}",
                    statement.words()
                )
            }
            None => format!("{id}, {tolerance}: {}", statement.words()),
        }
    }
}

/// What does not pass without condition, or that all does.
pub(super) fn conformity_sentences(certificate: &Certificate) -> Vec<String> {
    let all = ConformityResult::all(certificate);
    if all.is_empty() {
        return Vec::new();
    }
    let others: Vec<String> = all
        .iter()
        .filter(|one| one.statement != Conformity::Pass)
        .map(|one| format!("Conformity: {}.", one.words()))
        .collect();
    if others.is_empty() {
        let number = all.len();
        return vec![format!("Conformity: all {number} errors with a tolerance pass.")];
    }
    others
}

/// The statements and their decision rule; `None` without tolerances.
pub(super) fn conformity_section(certificate: &Certificate) -> Option<Section> {
    let all = ConformityResult::all(certificate);
    if all.is_empty() {
        return None;
    }
    let number = |value: Option<f64>| {
        Cell::text(value.map_or_else(|| "not determined".into(), |value| figure(value, 4)))
    };
    let rows = all.iter().map(|one| {
        vec![
            Cell::text(&one.id),
            number(one.value),
            number(one.expanded),
            number(Some(one.tolerance)),
            Cell::text(&one.unit),
            Cell::text(one.statement.words()),
        ]
    });
    let columns = ["estimate", "expanded uncertainty (95 %)", "tolerance"].map(Column::number);
    let columns = [Column::id("parameter")].into_iter().chain(columns);
    let columns = columns.chain([Column::text("unit"), Column::text("statement")]).collect();
    let table = Table { caption: RULE.into(), columns, rows: rows.collect() };
    Some(Section {
        heading: "Statement of conformity".into(),
        intro: String::new(),
        items: vec![Item::Table(table)],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_statement_follows_from_the_guard_band() {
        let statements = [4.0, 4.9, 5.1, 6.1].map(|value| Conformity::of(-value, 1.0, 5.0));
        assert_eq!(
            statements,
            [
                Conformity::Pass,
                Conformity::ConditionalPass,
                Conformity::ConditionalFail,
                Conformity::Fail
            ]
        );
    }
}
