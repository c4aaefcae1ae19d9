//! What schedules show as text, result, page and files.

use std::fmt;

use rins_report::Report;

use super::Observability;
use super::page::report;
use super::result::ObserveResult;
use super::words::text;
use crate::basis::BasisResult;
use crate::outcome::Outcome;

impl fmt::Display for Observability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&text(&self.0))
    }
}

impl Outcome for Observability {
    type Result = ObserveResult;

    fn result(&self) -> ObserveResult {
        ObserveResult::of(&self.0)
    }

    fn basis(&self) -> BasisResult {
        self.0.basis.clone()
    }

    fn report(&self) -> Option<Report> {
        Some(report(&self.0))
    }

    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let scenarios = self.0.scenarios.iter().enumerate();
        scenarios
            .map(|(place, text)| (format!("next-{}.toml", place + 1), text.clone().into_bytes()))
            .collect()
    }
}
