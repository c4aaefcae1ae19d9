//! A live calibration as text, result and page.

use std::fmt;

use rins_report::number::{decimal, estimate as written, figure};
use rins_report::{Cell, Column, Item, Report, Section, Table};

use super::{LiveEnd, LiveOutcome, LiveResult};
use crate::basis::BasisResult;
use crate::outcome::Outcome;
use crate::table::aligned;

/// The heading of the estimates.
const HEADING: [&str; 5] = ["parameter", "value", "sigma", "unit", "identified"];

impl LiveOutcome {
    /// The number of the epoch's samples, and why the log ended.
    fn sentences(&self) -> Vec<String> {
        let result = LiveResult::from(self);
        let end = match self.end {
            LiveEnd::Closed => "The log was closed",
            LiveEnd::Idle => "The log has stopped growing",
            LiveEnd::Interrupted => "Interrupted",
        };
        let mut told = vec![format!(
            "{end} at {} s: {} samples in {} epochs of {} s.",
            decimal(result.time_s, 3),
            result.samples,
            result.epochs,
            figure(result.epoch_s, 3)
        )];
        if let Some(variance) = result.innovation_variance {
            let variance = figure(variance, 3);
            told.push(format!(
                "Mean squared whitened innovation {variance}; 1 if model and noise describe the run."
            ));
        }
        told.extend(self.notes.iter().cloned());
        told
    }

    /// The estimates in rows.
    fn rows(&self) -> Vec<[String; 5]> {
        let row = |one: super::LiveParameterResult| {
            let (value, sigma) = written(one.value, one.sigma);
            let identified = if one.identified { "yes" } else { "no" };
            [one.id, value, sigma, one.unit, identified.into()]
        };
        LiveResult::from(self).parameters.into_iter().map(row).collect()
    }

    fn title(&self) -> String {
        format!("Live calibration of {} by the model {}", self.name, self.model)
    }
}

impl fmt::Display for LiveOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title())?;
        for sentence in self.sentences() {
            writeln!(f, "  {sentence}")?;
        }
        let mut rows = vec![HEADING.map(String::from).to_vec()];
        rows.extend(self.rows().into_iter().map(Vec::from));
        let table = aligned(&rows);
        writeln!(f)?;
        table.lines().try_for_each(|line| writeln!(f, "{}", line.trim_end()))
    }
}

impl Outcome for LiveOutcome {
    type Result = LiveResult;

    fn result(&self) -> LiveResult {
        self.into()
    }

    fn basis(&self) -> BasisResult {
        self.basis.clone()
    }

    fn report(&self) -> Option<Report> {
        let [id, value, sigma, unit, identified] = HEADING;
        let rows = self.rows().into_iter().map(|row| row.map(Cell::text).to_vec());
        let table = Table {
            columns: vec![
                Column::id(id),
                Column::number(value),
                Column::number(sigma),
                Column::text(unit),
                Column::text(identified),
            ],
            rows: rows.collect(),
            ..Table::default()
        };
        let section = Section {
            heading: "Estimates".into(),
            items: vec![Item::Table(table)],
            ..Section::default()
        };
        Some(Report {
            title: self.title(),
            subtitle: "rins calibrate --live".into(),
            summary: self.sentences(),
            sections: vec![section],
        })
    }
}
